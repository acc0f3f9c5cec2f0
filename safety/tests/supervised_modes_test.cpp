// SPDX-License-Identifier: Apache-2.0
// Goal: the execution supervision expects exactly the components of the current mode. Method: a table with
// modes, whose steps are reported as the executive does it; each component runs or is silent on both sides of
// a step.
#include <array>

#include "mamori/kernel/system/system.hpp"
#include "mamori/safety/supervision/execution_supervisor.hpp"
#include "mamori/trace/verifies.hpp"

namespace mamori::safety {
namespace {

using namespace literals;
using namespace verification;

class Worker final : public Component {
  public:
    constexpr explicit Worker(const char* name) noexcept : Component(name) {}
};
Worker g_base{"base"};
Worker g_first{"first"};
Worker g_second{"second"};
enum class Command { kSwitch };
enum class Mode { kFirst, kSecond, kHalt };
constexpr auto kSystem =
    system(frame(1_ms), window("all", 0_us, 500_us, budget(400_us), run(g_base, g_first, g_second)),
           system_mode<Mode::kFirst>("first", runs(g_base, g_first)),
           system_mode<Mode::kSecond>("second", runs(g_base, g_second)),
           safe_mode<Mode::kHalt>("halt", runs(g_base)), mode_transition("first", Command::kSwitch, "second"),
           mode_transition("second", Command::kSwitch, "first"));
MAMORI_CHECK(kSystem);

constexpr ComponentLimits kLimits{{1U, 2U}, {Duration{0}, 100_us}, SupervisionScope::kGlobal};
constexpr std::size_t kBase = index_of(kSystem, g_base);
constexpr std::size_t kFirst = index_of(kSystem, g_first);
constexpr std::size_t kSecond = index_of(kSystem, g_second);

class SupervisedModesTest : public ::testing::Test {
  protected:
    void SetUp() override {
        for (const std::size_t component : {kBase, kFirst, kSecond}) {
            ASSERT_EQ(sut_.watch(component, kLimits), Status::kOk);
        }
        sut_.follow_mode(0U);
    }
    /// Three cycles in which these components run. @return the last status.
    GlobalStatus run(std::initializer_list<std::size_t> components) {
        GlobalStatus status = GlobalStatus::kExpired;
        for (int cycle = 0; cycle < 3; ++cycle) {
            for (const std::size_t component : components) {
                sut_.get_records()[component].note_run(now_, now_ + 10_us);
            }
            now_ = now_ + 1_ms;
            status = sut_.step(now_);
        }
        return status;
    }

    ExecutionStorageFor<kSystem> storage_{};
    ExecutionSupervisor sut_{storage_, 10_us};
    Instant now_{};
};

TEST_F(SupervisedModesTest, ComponentsOfOtherModesMayBeSilent) {
    verifies("SWR-CYC-031");
    EXPECT_EQ(run({kBase, kFirst}), GlobalStatus::kOk);
    sut_.on_mode_step(ModeStep::kLeave, 1U, now_);
    EXPECT_EQ(run({kBase}), GlobalStatus::kOk) << "one has left, the other has not entered";
    sut_.on_mode_step(ModeStep::kEnter, 1U, now_);
    EXPECT_EQ(run({kBase, kSecond}), GlobalStatus::kOk);
    sut_.on_mode_step(ModeStep::kSafe, 2U, now_);
    EXPECT_EQ(run({kBase}), GlobalStatus::kOk);
}

TEST_F(SupervisedModesTest, ComponentsOfTheModeMayNot) {
    verifies("SWR-CYC-031", Technique::kFaultInjection, Polarity::kViolation);
    sut_.on_mode_step(ModeStep::kLeave, 1U, now_);
    sut_.on_mode_step(ModeStep::kEnter, 1U, now_);
    EXPECT_EQ(run({kBase, kFirst}), GlobalStatus::kExpired);
    EXPECT_EQ(sut_.get_first_expired(), kSecond);
}

TEST_F(SupervisedModesTest, AComponentOfBothModesKeepsItsCounts) {
    verifies("SWR-CYC-031", Technique::kStateTransition, Polarity::kViolation);
    ASSERT_EQ(run({kBase, kFirst}), GlobalStatus::kOk);
    now_ = now_ + 1_ms;
    sut_.get_records()[kFirst].note_run(now_, now_ + 10_us);
    EXPECT_EQ(sut_.step(now_), GlobalStatus::kFailed) << "the base is late";
    sut_.follow_mode(2U);
    now_ = now_ + 1_ms;
    EXPECT_EQ(sut_.step(now_), GlobalStatus::kExpired);
    EXPECT_EQ(sut_.get_first_expired(), kBase);
}

TEST_F(SupervisedModesTest, AnotherSetAndAModeThatTheTableDoesNotHaveChangeNothing) {
    verifies("SWR-CYC-031", Technique::kBoundaryValues, Polarity::kViolation);
    sut_.on_mode_step(ModeStep::kSet, 2U, now_);
    sut_.follow_mode(3U);
    EXPECT_EQ(run({kBase}), GlobalStatus::kExpired);
    EXPECT_EQ(sut_.get_first_expired(), kFirst);
}

}  // namespace
}  // namespace mamori::safety
