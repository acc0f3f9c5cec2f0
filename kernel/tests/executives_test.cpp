// SPDX-License-Identifier: Apache-2.0
// Goal: the executives of a system start and stop as one. Method: components on two cores that note each
// action in one list and fail on request; tables with modes, and with windows on the second core only.
#include "mamori/kernel/run/executives.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "mamori/kernel/base/constant_init.hpp"
#include "mamori/kernel/run/devices.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/trace/verifies.hpp"
#include "mamori/verification/failed_check.hpp"

namespace mamori {
namespace {

using namespace verification;

std::vector<std::string>& heard() {
    static std::vector<std::string> list;
    return list;
}

enum class Fails { kNothing, kInitialize, kActivate, kDeactivate };

class Noter final : public Component {
  public:
    constexpr explicit Noter(const char* name = "noter") noexcept : Component(name) {}
    Fails fails{Fails::kNothing};

    Status on_initialize() noexcept override { return note("initialize", Fails::kInitialize); }
    Status on_activated(ContextHandle) noexcept override { return note("activate", Fails::kActivate); }
    Status on_deactivated(ContextHandle) noexcept override { return note("deactivate", Fails::kDeactivate); }

  private:
    Status note(const char* action, Fails failing) noexcept {
        heard().push_back(std::string{get_name()} + " " + action);
        return fails == failing ? Status::kOutOfResources : Status::kOk;
    }
};

Noter g_left{"left"};
Noter g_right{"right"};
constexpr auto kTwoCores = system(frame(1000_ns), window("left", 0_ns, 400_ns, budget(300_ns), run(g_left)),
                                  window("right", 400_ns, 400_ns, core(1U), budget(300_ns), run(g_right)));

Noter g_idle{"idle"};
enum class Mode { kWork, kHalt };
enum class Command { kStop };
constexpr auto kWithModes =
    system(frame(1000_ns), window("idle", 0_ns, 400_ns, budget(300_ns), run(g_idle)),
           system_mode<Mode::kWork>("work", runs(g_idle)), safe_mode<Mode::kHalt>("halt", runs(g_idle)),
           mode_transition("work", Command::kStop, "halt"));

Noter g_far{"far"};
constexpr auto kSecondCoreOnly =
    system(frame(1000_ns), window("far", 0_ns, 400_ns, core(1U), budget(300_ns), run(g_far)));

Noter g_late{"late"};
Noter g_early{"early"};
constexpr auto kDescending =
    system(frame(1000_ns), window("late", 400_ns, 400_ns, core(1U), budget(300_ns), run(g_late)),
           window("early", 0_ns, 400_ns, budget(300_ns), run(g_early)));

/// Constant-initialised, as on a controller.
MAMORI_CONSTINIT Executives<kTwoCores> g_constant;

class ExecutivesTest : public ::testing::Test {
  protected:
    void SetUp() override { heard().clear(); }
    void TearDown() override {
        g_left.fails = Fails::kNothing;
        g_right.fails = Fails::kNothing;
        static_cast<void>(sut_.stop());
        for (std::size_t core = sut_.size(); core > 0U; --core) {
            static_cast<void>(sut_.get(core - 1U).finalize());
        }
    }
    Executives<kTwoCores> sut_;
};

TEST_F(ExecutivesTest, TableDeterminesCoresAndModes) {
    verifies("SWR-KRN-074", Technique::kInterface, Polarity::kNominal);

    EXPECT_EQ(g_constant.size(), 2U);
    EXPECT_EQ(g_constant.get(1U).get_core(), 1U);
    EXPECT_EQ(detail::find_first_core(make_view(kTwoCores)), 0U);
    EXPECT_EQ(Executives<kWithModes>::kCoreCount, 1U);
    EXPECT_EQ(Executives<kSecondCoreOnly>::kCoreCount, 2U);
    EXPECT_EQ(detail::find_first_core(make_view(kSecondCoreOnly)), 1U);
    EXPECT_EQ(detail::find_first_core(SystemView{}), 0U);
    EXPECT_EQ(detail::count_cores(SystemView{}), 0U);
    EXPECT_EQ(detail::count_cores(make_view(kTwoCores)), 2U);
    EXPECT_EQ(detail::count_cores(make_view(kDescending)), 2U);
    EXPECT_EQ(detail::find_first_core(make_view(kDescending)), 0U);
    EXPECT_CHECK_FAILS(static_cast<void>(g_constant.get(2U)), "run/executives.hpp", 1U);
}

TEST_F(ExecutivesTest, AllCoresAreInitialisedBeforeTheFirstStartAndStoppedInReverseOrder) {
    verifies("SWR-KRN-074", Technique::kRequirementsBased, Polarity::kNominal);
    ASSERT_EQ(sut_.start(), Status::kOk);
    ASSERT_EQ(sut_.stop(), Status::kOk);

    const std::vector<std::string> expected{"left initialize", "right initialize", "left activate",
                                            "right activate",  "right deactivate", "left deactivate"};
    EXPECT_EQ(heard(), expected);
    EXPECT_EQ(sut_.get_failed_core(), kNoIndex);
}

TEST_F(ExecutivesTest, StoppedSystemStartsAgainWithoutASecondInitialisation) {
    verifies("SWR-KRN-074", Technique::kRequirementsBased, Polarity::kNominal);
    ASSERT_EQ(sut_.start(), Status::kOk);
    ASSERT_EQ(sut_.stop(), Status::kOk);
    heard().clear();

    ASSERT_EQ(sut_.start(), Status::kOk);

    EXPECT_EQ(heard(), (std::vector<std::string>{"left activate", "right activate"}));
}

TEST_F(ExecutivesTest, FailedInitialisationStartsNothingAndIsRepeatedFromItsCore) {
    verifies("SWR-KRN-074", Technique::kFaultInjection, Polarity::kViolation);
    g_right.fails = Fails::kInitialize;

    EXPECT_EQ(sut_.start(), Status::kOutOfResources);
    EXPECT_EQ(sut_.get_failed_core(), 1U);
    EXPECT_EQ(heard(), (std::vector<std::string>{"left initialize", "right initialize"}));

    g_right.fails = Fails::kNothing;
    heard().clear();
    EXPECT_EQ(sut_.start(), Status::kOk);
    EXPECT_EQ(sut_.get_failed_core(), kNoIndex);
    EXPECT_EQ(heard(), (std::vector<std::string>{"right initialize", "left activate", "right activate"}));
}

TEST_F(ExecutivesTest, FailedStartStopsTheCoresBeforeIt) {
    verifies("SWR-KRN-074", Technique::kFaultInjection, Polarity::kViolation);
    g_right.fails = Fails::kActivate;

    EXPECT_EQ(sut_.start(), Status::kOutOfResources);

    EXPECT_EQ(sut_.get_failed_core(), 1U);
    EXPECT_EQ(heard().back(), "left deactivate");
}

TEST_F(ExecutivesTest, FailedStartOfTheFirstCoreStartsNoOther) {
    verifies("SWR-KRN-074", Technique::kFaultInjection, Polarity::kViolation);
    g_left.fails = Fails::kActivate;

    EXPECT_EQ(sut_.start(), Status::kOutOfResources);

    EXPECT_EQ(sut_.get_failed_core(), 0U);
    EXPECT_EQ(heard(), (std::vector<std::string>{"left initialize", "right initialize", "left activate"}));
}

TEST_F(ExecutivesTest, FailedStopOfOneCoreStopsTheOthersAndReturnsTheFirstFailure) {
    verifies("SWR-KRN-074", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_EQ(sut_.start(), Status::kOk);
    g_right.fails = Fails::kDeactivate;

    EXPECT_EQ(sut_.stop(), Status::kOutOfResources);

    EXPECT_EQ(heard().back(), "left deactivate");
}

TEST_F(ExecutivesTest, ModesAreThoseOfTheSystem) {
    verifies("SWR-KRN-074", Technique::kInterface, Polarity::kNominal);
    Executives<kWithModes> sut;
    ASSERT_EQ(sut.start(), Status::kOk);

    EXPECT_EQ(sut.get_modes().request(Command::kStop), Status::kOk);
    EXPECT_EQ(sut.get_modes().get_mode<Mode>(), Mode::kWork);

    EXPECT_EQ(sut.stop(), Status::kOk);
    EXPECT_EQ(sut.get(0U).finalize(), Status::kOk);
}

TEST(DevicesTest, FunctionsAreOptionalAndAnActionGetsTheNumberOfTheFrame) {
    verifies("SWR-KRN-073", Technique::kInterface, Polarity::kNominal);
    NoDevices none;
    none.sample(0U, Instant{});
    none.apply(0U, Instant{}, 1_ns);
    std::uint64_t last = 0U;
    const auto note = [&last](std::uint64_t frame) { last = frame; };
    AfterFrame<decltype(note)> devices{note};

    devices.sample(6U, Instant{});
    EXPECT_EQ(last, 0U);
    devices.apply(7U, Instant{}, 1_ns);
    EXPECT_EQ(last, 7U);
}

}  // namespace
}  // namespace mamori
