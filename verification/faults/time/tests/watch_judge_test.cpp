// SPDX-License-Identifier: Apache-2.0
// Goal: the judgement about the watch can fail, in each of its ways. Method: courses made by hand; instants
// in microseconds.
#include "watch_judge.hpp"

#include <gtest/gtest.h>

#include "mamori/trace/verifies.hpp"

namespace mamori::time_faults {
namespace {

using ports::posix_rt::GridFault;
using verification::Polarity;
using verification::Technique;
using verification::verifies;

constexpr Instant at(std::int64_t us) noexcept {
    return Instant{us * 1000};
}
Found overdue(std::int64_t due_us, std::int64_t seen_us, std::int64_t cleared_us) {
    return {{GridFault::kOverdue, 0U, at(due_us), at(seen_us)}, at(cleared_us)};
}
Found wrong_clock(GridFault fault, std::int64_t seen_us) {
    return {{fault, kNoIndex, Instant{}, at(seen_us)}, at(seen_us + 20'000)};
}
/// What is overdue must be found in 1 ms, a wrong clock in 21 ms.
WatchVerdict judge(const WatchCourse& course, const std::vector<Stall>& stalls = {}) {
    return judge_watch({Duration{1'000'000}, Duration{21'000'000}}, course, stalls);
}
const Hold kHold{at(5000), at(7000)};
const ClockFault kFast{at(50'000), at(75'000), 10'000};

TEST(WatchJudgeTest, AHangAndAWrongClockAreSeenByTheirFindings) {
    verifies("SWR-PRT-034");
    const WatchVerdict verdict =
        judge({{kHold}, {kFast}, {overdue(5000, 5450, 27'000), wrong_clock(GridFault::kFastClock, 55'000)}});

    EXPECT_TRUE(verdict.is_well());
    EXPECT_EQ(verdict.holds_seen, 1U);
    EXPECT_EQ(verdict.clock_faults_seen, 1U);
    EXPECT_EQ(verdict.overdue_ns, (std::vector<std::int64_t>{450'000}));
    EXPECT_EQ(verdict.rate_ns, (std::vector<std::int64_t>{5'000'000}));
}

TEST(WatchJudgeTest, WithoutAFindingAFaultIsUnseenUnlessAnEarlierOneIsStillLatched) {
    verifies("SWR-PRT-034", Technique::kFaultInjection, Polarity::kViolation);
    EXPECT_EQ(judge({{kHold}, {}, {}}).unseen, 1U);
    EXPECT_EQ(judge({{}, {kFast}, {}}).unseen, 1U);
    EXPECT_FALSE(judge({{kHold}, {}, {}}).is_well());
    EXPECT_EQ(judge({{kHold}, {}, {overdue(3900, 4400, 5000)}}, {{at(3900), at(4200)}}).unseen, 1U)
        << "cleared when it began";
    const WatchVerdict masked = judge({{kHold}, {}, {overdue(3900, 4400, 5001)}}, {{at(3900), at(4200)}});
    EXPECT_EQ(masked.masked, 1U);
    EXPECT_TRUE(masked.is_well());
}

TEST(WatchJudgeTest, AFindingOfAnotherKindOrDirectionIsMisnamed) {
    verifies("SWR-PRT-034", Technique::kFaultInjection, Polarity::kViolation);
    EXPECT_EQ(judge({{kHold}, {}, {wrong_clock(GridFault::kSlowClock, 5500)}}).misnamed, 1U);
    EXPECT_EQ(judge({{}, {kFast}, {wrong_clock(GridFault::kSlowClock, 55'000)}}).misnamed, 1U);
    const WatchVerdict verdict = judge({{}, {kFast}, {overdue(55'000, 55'450, 80'000)}});
    EXPECT_EQ(verdict.misnamed, 1U);
    EXPECT_FALSE(verdict.is_well());
    EXPECT_EQ(judge({{}, {kFast}, {overdue(55'000, 55'450, 80'000)}}, {{at(55'000), at(55'300)}}).masked, 1U)
        << "the machine stood still, and the finding hid the clock";
}

TEST(WatchJudgeTest, AFindingAtItsBoundIsInTimeAndALaterOneIsTardyUnlessTheMachineStoodStill) {
    verifies("SWR-PRT-034", Technique::kBoundaryValues, Polarity::kViolation);
    EXPECT_TRUE(judge({{kHold}, {}, {overdue(5000, 6000, 27'000)}}).is_well());
    const WatchCourse tardy{{kHold}, {}, {overdue(5000, 6001, 27'000)}};
    EXPECT_EQ(judge(tardy).tardy, 1U);
    EXPECT_FALSE(judge(tardy).is_well());
    EXPECT_EQ(judge(tardy, {{at(5600), at(5900)}}).tardy_by_host, 1U);

    EXPECT_TRUE(judge({{}, {kFast}, {wrong_clock(GridFault::kFastClock, 71'000)}}).is_well());
    EXPECT_EQ(judge({{}, {kFast}, {wrong_clock(GridFault::kFastClock, 71'001)}}).tardy, 1U);
}

TEST(WatchJudgeTest, AFindingWithoutAFaultIsInventedUnlessTheMachineStoodStill) {
    verifies("SWR-PRT-034", Technique::kFaultInjection, Polarity::kViolation);
    const WatchCourse course{{}, {}, {overdue(9000, 9450, 30'000)}};
    EXPECT_EQ(judge(course).invented, 1U);
    EXPECT_FALSE(judge(course).is_well());
    EXPECT_EQ(judge(course, {{at(8000), at(8999)}}).invented, 1U) << "over before anything was due";
    EXPECT_EQ(judge(course, {{at(8000), at(9000)}}).by_host, 1U);
    const WatchCourse clock{{}, {}, {wrong_clock(GridFault::kSlowClock, 9450)}};
    EXPECT_EQ(judge(clock, {{at(9000), at(9450)}}).invented, 1U) << "a stall makes no clock wrong";
}

}  // namespace
}  // namespace mamori::time_faults
