// SPDX-License-Identifier: Apache-2.0
// Goal: virtual time moves on by the modelled execution times, and a budget cuts work off exactly at its end.
// Method: both sides of the deadline, hanging work, second passes, the largest durations.
#include "mamori/ports/virtual_time/virtual_host.hpp"

#include <gtest/gtest.h>

#include "mamori/kernel/system/system.hpp"
#include "mamori/trace/verifies.hpp"
#include "mamori/verification/failed_check.hpp"

namespace mamori::ports::virtual_time {
namespace {

using namespace verification;
using Pass = WindowHost::Pass;

class VirtualHostTest : public ::testing::Test {
  protected:
    bool run(std::size_t component, Instant deadline, Pass pass = Pass::kExecute) {
        return sut_.run_within({&count_call, &calls_, 0U, component, 0U, 1U, pass}, deadline) == 1U;
    }
    static void count_call(void* argument, std::size_t begin, std::size_t end) noexcept {
        *static_cast<int*>(argument) += static_cast<int>(end - begin);
    }

    std::array<Duration, 2> durations_{10_ns, 0_ns};
    IndexedVirtualHost sut_{durations_};
    int calls_{0};
};

TEST_F(VirtualHostTest, TimeBeginsAtZeroAndMovesOnByTheModelledTime) {
    verifies("SWR-VTM-001");

    EXPECT_EQ(sut_.get_now(), Instant{0});
    EXPECT_TRUE(run(0U, Instant{100}));
    EXPECT_EQ(sut_.get_now(), Instant{10});
    EXPECT_TRUE(run(1U, Instant{100}));
    EXPECT_EQ(sut_.get_now(), Instant{10});
    EXPECT_EQ(calls_, 2);
}

TEST_F(VirtualHostTest, AComponentWithoutAnEntryTakesNoTime) {
    verifies("SWR-VTM-001", Technique::kBoundaryValues);

    EXPECT_TRUE(run(2U, Instant{0}));

    EXPECT_EQ(sut_.get_now(), Instant{0});
    EXPECT_EQ(calls_, 1);
}

TEST_F(VirtualHostTest, TheSecondPassTakesNoTime) {
    verifies("SWR-VTM-001", Technique::kEquivalenceClasses);

    EXPECT_TRUE(run(0U, Instant{0}, Pass::kStateUpdate));

    EXPECT_EQ(sut_.get_now(), Instant{0});
    EXPECT_EQ(calls_, 1);
}

TEST_F(VirtualHostTest, TimePassesWithoutWorkAndNeverGoesBack) {
    verifies("SWR-VTM-001", Technique::kBoundaryValues);

    sut_.advance_to(Instant{50});
    sut_.advance_to(Instant{50});

    EXPECT_EQ(sut_.get_now(), Instant{50});
    EXPECT_CHECK_FAILS(sut_.advance_to(Instant{49}), "virtual_host.cpp", 1);
}

TEST_F(VirtualHostTest, AModelledTimeCanBeChangedWithinItsRange) {
    verifies("SWR-VTM-001", Technique::kBoundaryValues);

    EXPECT_EQ(sut_.set_duration(1U, 25_ns), Status::kOk);
    EXPECT_EQ(sut_.set_duration(0U, 0_ns), Status::kOk);
    EXPECT_EQ(sut_.set_duration(2U, 1_ns), Status::kBadParameter);
    EXPECT_EQ(sut_.set_duration(1U, Duration{-1}), Status::kBadParameter);

    EXPECT_TRUE(run(1U, Instant{25}));
    EXPECT_EQ(sut_.get_now(), Instant{25});
}

TEST_F(VirtualHostTest, WorkThatEndsAtTheDeadlineIsInTime) {
    verifies("SWR-VTM-002", Technique::kBoundaryValues);

    EXPECT_TRUE(run(0U, Instant{10}));

    EXPECT_EQ(sut_.get_now(), Instant{10});
}

TEST_F(VirtualHostTest, LateWorkHasItsEffectButIsCutOffAtTheDeadline) {
    verifies("SWR-VTM-002", Technique::kBoundaryValues, Polarity::kViolation);

    EXPECT_FALSE(run(0U, Instant{9}));

    EXPECT_EQ(sut_.get_now(), Instant{9});
    EXPECT_EQ(calls_, 1);
}

TEST_F(VirtualHostTest, HangingWorkHasNoEffectAndIsCutOffAtTheDeadline) {
    verifies("SWR-VTM-002", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_EQ(sut_.set_duration(0U, kNever), Status::kOk);

    EXPECT_FALSE(run(0U, Instant{1000}));

    EXPECT_EQ(sut_.get_now(), Instant{1000});
    EXPECT_EQ(calls_, 0);
}

TEST_F(VirtualHostTest, TheLongestFiniteTimeIsLateAndDoesNotOverflow) {
    verifies("SWR-VTM-002", Technique::kBoundaryValues, Polarity::kViolation);
    sut_.advance_to(Instant{500});
    ASSERT_EQ(sut_.set_duration(0U, kNever - 1_ns), Status::kOk);

    EXPECT_FALSE(run(0U, Instant{1000}));

    EXPECT_EQ(sut_.get_now(), Instant{1000});
    EXPECT_EQ(calls_, 1);
}

TEST_F(VirtualHostTest, ADeadlineThatHasPassedLeavesTheClockWhereItIs) {
    verifies("SWR-VTM-002", Technique::kErrorGuessing, Polarity::kViolation);
    sut_.advance_to(Instant{500});

    EXPECT_FALSE(run(1U, Instant{499}));

    EXPECT_EQ(sut_.get_now(), Instant{500});
}

TEST_F(VirtualHostTest, ANegativeModelledTimeEndsInTheAssertion) {
    verifies("SWR-VTM-002", Technique::kErrorGuessing, Polarity::kViolation);
    durations_[0] = Duration{-1};

    EXPECT_CHECK_FAILS(static_cast<void>(run(0U, Instant{100})), "virtual_host.cpp", 2);
}

class Plain final : public Component {
  public:
    constexpr Plain() noexcept : Component("plain") {}
};
class Other final : public Component {
  public:
    constexpr Other() noexcept : Component("other") {}
};
Plain g_plain;
Other g_other;
Plain g_stranger;
constexpr auto kTimed =
    system(frame(1_us), window("all", 0_ns, 100_ns, budget(100_ns), run(g_plain, g_other)),
           modelled_time(g_other, 30_ns));
MAMORI_CHECK(kTimed);

TEST(VirtualHostForTest, TimesComeFromTheTableAndAreZeroWithoutARow) {
    verifies("SWR-KRN-065");
    VirtualHostFor host{kTimed};
    const auto nothing = [](void*, std::size_t, std::size_t) noexcept {};

    EXPECT_EQ(host.run_within({nothing, nullptr, 0U, 0U, 0U, 1U, Pass::kExecute}, Instant{100}), 1U);
    EXPECT_EQ(host.get_now(), Instant{0});
    EXPECT_EQ(host.run_within({nothing, nullptr, 0U, 1U, 0U, 1U, Pass::kExecute}, Instant{100}), 1U);
    EXPECT_EQ(host.get_now(), Instant{30});
}

TEST(VirtualHostForTest, ATimeIsChangedByItsComponentForOneHostOnly) {
    verifies("SWR-KRN-065", Technique::kInterface);
    VirtualHostFor host{kTimed};
    VirtualHostFor second{kTimed};
    const auto nothing = [](void*, std::size_t, std::size_t) noexcept {};

    EXPECT_EQ(host.set_duration(g_other, 50_ns), Status::kOk);
    EXPECT_EQ(host.run_within({nothing, nullptr, 0U, 0U, 0U, 2U, Pass::kExecute}, Instant{100}), 2U);
    EXPECT_EQ(host.get_now(), Instant{50});
    EXPECT_EQ(second.run_within({nothing, nullptr, 0U, 0U, 0U, 2U, Pass::kExecute}, Instant{100}), 2U);
    EXPECT_EQ(second.get_now(), Instant{30});
}

TEST(VirtualHostForTest, AComponentOfNoTableAndANegativeTimeAreRejected) {
    verifies("SWR-KRN-065", Technique::kInterface, Polarity::kViolation);
    VirtualHostFor host{kTimed};
    std::array<Duration, 1U> durations{};
    IndexedVirtualHost without_table{durations};

    EXPECT_EQ(host.set_duration(g_stranger, 1_ns), Status::kBadParameter);
    EXPECT_EQ(host.set_duration(g_plain, Duration{-1}), Status::kBadParameter);
    EXPECT_EQ(without_table.set_duration(g_plain, 1_ns), Status::kBadParameter);
}

}  // namespace
}  // namespace mamori::ports::virtual_time
