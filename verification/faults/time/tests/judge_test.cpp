// SPDX-License-Identifier: Apache-2.0
// Goal: the judgement about faults of time can fail, in each of its ways. Method: courses made by hand, of a
// system with two windows and three components; instants in microseconds.
#include "judge.hpp"

#include <gtest/gtest.h>

#include "mamori/trace/verifies.hpp"

namespace mamori::time_faults {
namespace {

using verification::Polarity;
using verification::Technique;
using verification::verifies;

constexpr Instant at(std::int64_t us) noexcept {
    return Instant{us * 1000};
}
Report overrun(std::size_t window, std::size_t component, std::int64_t release_us, std::int64_t woke_us,
               std::int64_t at_us) {
    return {true, window, component, at(release_us), at(woke_us), at(at_us), Duration{0}, Duration{0}};
}
Report late(std::size_t window, std::int64_t release_us, std::int64_t at_us) {
    return {false,      window, kNoIndex, at(release_us), at(at_us), at(at_us), at(at_us) - at(release_us),
            Duration{0}};
}
/// Windows of 300 us with a budget of 200 us at 0 and 300; the first runs component 0, the second 1 and 2.
Verdict judge(const Course& course) {
    const WatchBounds bounds{Duration{1'000'000}, Duration{21'000'000}};
    return judge({Duration{200'000}, {0U, 1U, 1U}, {Duration{300'000}, Duration{300'000}}, bounds}, course);
}
/// Reports without a fault, while looks came late.
Verdict judge_late(const std::vector<Report>& reports, const std::vector<Stall>& late_looks) {
    return judge({reports, {}, {}, {}, {}, late_looks});
}
/// Component 1 takes 1.5 ms, from 5310 us on.
const Deed kDeed{1U, at(5310), at(6810)};

TEST(JudgeTest, AnOverrunIsSeenFromItsReportToTheReturnOfItsWork) {
    verifies("SWR-PRT-007");
    const Verdict verdict =
        judge({{overrun(1U, 1U, 5300, 5310, 5515), overrun(1U, 1U, 6300, 6310, 6310)}, {kDeed}, {}, {}});

    EXPECT_EQ(verdict.injected, 1U);
    EXPECT_TRUE(verdict.is_well());
    EXPECT_EQ(verdict.detection_ns, (std::vector<std::int64_t>{5000})) << "from the end of the budget";
}

TEST(JudgeTest, AReportUnderAnotherNameIsMisnamedAndNoneIsUnseen) {
    verifies("SWR-PRT-007", Technique::kFaultInjection, Polarity::kViolation);
    const Verdict misnamed = judge({{overrun(1U, 2U, 5300, 5310, 5515)}, {kDeed}, {}, {}});
    EXPECT_EQ(misnamed.misnamed, 1U);
    EXPECT_FALSE(misnamed.is_well());
    const Verdict unseen = judge({{}, {kDeed}, {}, {}});
    EXPECT_EQ(unseen.unseen, 1U);
    EXPECT_FALSE(unseen.is_well());
}

TEST(JudgeTest, AReportIsLookedForUntilATickOfTheMachinesOwnTimeAfterTheEnd) {
    verifies("SWR-PRT-007", Technique::kBoundaryValues, Polarity::kViolation);
    const auto judge_report = [](std::int64_t at_us, const std::vector<Stall>& late_looks) {
        return judge(
            {{overrun(1U, 1U, 5300, 5310, at_us)}, {kDeed}, {}, {{at(6000), at(6810)}}, {}, late_looks});
    };
    const std::vector<Stall> late_looks{{at(6820), at(6900)}, {at(7850), at(7900)}};

    EXPECT_EQ(judge_report(7810, {}).seen, 1U);
    EXPECT_EQ(judge_report(7811, {}).unseen, 1U);
    EXPECT_EQ(judge_report(7940, late_looks).seen, 1U) << "80 us, and 50 us within these";
    EXPECT_EQ(judge_report(7941, late_looks).unseen, 1U);
}

TEST(JudgeTest, AReportOneFrameAfterTheDeadlineIsInTimeAndALaterOneIsTardyUnlessTheMachineStoodStill) {
    verifies("SWR-PRT-007", Technique::kBoundaryValues, Polarity::kViolation);
    EXPECT_TRUE(judge({{overrun(1U, 1U, 5300, 5310, 6510)}, {kDeed}, {}, {}}).is_well());
    const Course tardy{{overrun(1U, 1U, 5300, 5310, 6511)}, {kDeed}, {}, {}};
    EXPECT_EQ(judge(tardy).tardy, 1U);
    EXPECT_FALSE(judge(tardy).is_well());
    const Verdict excused = judge({tardy.reports, tardy.deeds, {}, {{at(6000), at(6400)}}});
    EXPECT_EQ(excused.tardy_by_host, 1U);
    EXPECT_TRUE(excused.is_well());
}

TEST(JudgeTest, AReportWithoutAFaultIsInventedUnlessTheMachineTookHalfABudgetAway) {
    verifies("SWR-PRT-007", Technique::kFaultInjection, Polarity::kViolation);
    const std::vector<Report> reports{overrun(0U, 0U, 8000, 8010, 8215)};
    EXPECT_EQ(judge({reports, {kDeed}, {}, {}}).invented, 1U);
    EXPECT_EQ(judge({reports, {}, {}, {}}).unexplained.size(), 1U);
    EXPECT_FALSE(judge({reports, {}, {}, {}}).is_well());
    EXPECT_EQ(judge_late(reports, {{at(7950), at(8099)}}).invented, 1U) << "part of it before the window";
    EXPECT_EQ(judge_late(reports, {{at(7000), at(8100)}}).by_host, 1U);
    EXPECT_EQ(judge_late(reports, {{at(8115), at(9000)}}).by_host, 1U);
    EXPECT_EQ(judge_late(reports, {{at(8116), at(9000)}}).invented, 1U) << "most of it after the report";
    EXPECT_EQ(judge_late(reports, {{at(7900), at(7999)}, {at(8216), at(9000)}}).invented, 1U);
    EXPECT_EQ(judge_late(reports, {{at(8010), at(8060)}, {at(8100), at(8150)}}).suspected, 1U) << "in pieces";
    EXPECT_EQ(judge_late(reports, {{at(8010), at(8060)}, {at(8100), at(8149)}}).invented, 1U);
    EXPECT_EQ(judge_late(reports, {{at(7000), at(8000)}}).suspected, 1U) << "a budget since the frame before";
    EXPECT_EQ(judge_late(reports, {{at(6000), at(7200)}}).suspected, 1U);
    EXPECT_EQ(judge_late(reports, {{at(6000), at(7199)}}).invented, 1U);
    EXPECT_EQ(judge({reports, {}, {}, {{at(8000), at(8200)}}}).invented, 1U) << "no look came late";
    EXPECT_EQ(judge({{late(0U, 8000, 9100)}, {}, {}, {}}).invented, 1U);
    EXPECT_EQ(judge_late({late(0U, 8000, 9100)}, {{at(8000), at(9090)}}).by_host, 1U);
}

TEST(JudgeTest, AReportOfAComponentThatWasReadyAndDidNotRunForHalfItsBudgetIsSuspected) {
    verifies("SWR-PRT-007", Technique::kBoundaryValues, Polarity::kViolation);
    const auto judge_kept = [](const Report& report, std::size_t component, std::int64_t release_us,
                               std::int64_t kept_off_us) {
        Ends ends{2U, 9U};
        ends.set(component, at(release_us), at(release_us + 250), Duration{kept_off_us * 1000});
        return judge({{report}, {}, {}, {}, {}, {}, ends});
    };
    const Report report = overrun(0U, 0U, 8000, 8010, 8210);
    EXPECT_EQ(judge_kept(report, 0U, 8000, 100).suspected, 1U);
    EXPECT_EQ(judge_kept(report, 0U, 8000, 100).invented, 0U);
    EXPECT_FALSE(judge_kept(report, 0U, 8000, 100).is_well());
    EXPECT_EQ(judge_kept(report, 0U, 8000, 99).invented, 1U);
    EXPECT_EQ(judge_kept(overrun(0U, 0U, 8000, 8010, 8209), 0U, 8000, 100).invented, 1U) << "too early";
    EXPECT_EQ(judge_kept(overrun(0U, 0U, 8000, 8250, 8300), 0U, 8000, 100).suspected, 1U)
        << "its window ends first";
    EXPECT_EQ(judge_kept(overrun(0U, 0U, 8000, 8250, 8299), 0U, 8000, 100).invented, 1U);
    EXPECT_EQ(judge_kept(report, 0U, 7000, 100).invented, 1U) << "another frame";
    EXPECT_EQ(judge_kept(report, 1U, 8000, 100).invented, 1U) << "another component";
    EXPECT_EQ(judge_kept(late(0U, 8000, 9100), 0U, 8000, 100).invented, 1U) << "a late release";
    EXPECT_EQ(judge({{report}, {}, {}, {}, {}, {}, Ends{2U, 9U}}).invented, 1U)
        << "it never ran: nothing shows that the host kept it";
}

TEST(JudgeTest, AReportIsSuspectedWhenTheRunnerWasReadyAndDidNotRunForHalfOfItsLateness) {
    verifies("SWR-PRT-007", Technique::kBoundaryValues, Polarity::kViolation);
    const auto judge_kept = [](std::int64_t kept_off_us, std::int64_t woke_us) {
        Report report = late(0U, 8000, woke_us);
        report.kept_off = Duration{kept_off_us * 1000};
        return judge(
            {{report, late(1U, woke_us, woke_us + 1), late(0U, woke_us + 2, woke_us + 1200)}, {}, {}, {}});
    };
    EXPECT_EQ(judge_kept(700, 9400).suspected, 2U)
        << "and what was due before its report, not what came later";
    EXPECT_EQ(judge_kept(700, 9400).invented, 1U);
    EXPECT_EQ(judge_kept(699, 9400).suspected, 0U);
    EXPECT_EQ(judge_kept(100, 8200).suspected, 2U);
    EXPECT_EQ(judge_kept(99, 8198).suspected, 0U);
}

TEST(JudgeTest, WhatWasDueBeforeAReportThatIsSetAsideIsSetAsideToo) {
    verifies("SWR-PRT-007", Technique::kBoundaryValues, Polarity::kViolation);
    const std::vector<Stall> late_looks{{at(8000), at(9390)}};
    const std::vector<Report> near{late(0U, 8000, 9400), late(1U, 9400, 10'700)};
    EXPECT_EQ(judge_late(near, late_looks).by_host, 2U);
    const std::vector<Report> far{near[0U], late(1U, 9401, 10'700)};
    EXPECT_EQ(judge_late(far, {{at(8000), at(8150)}}).by_host, 1U);
    EXPECT_EQ(judge_late(far, {{at(8000), at(8150)}}).invented, 1U);
}

TEST(JudgeTest, AFindingOfTheWatchWhileTheRunnerWasKeptOffIsSetAside) {
    verifies("SWR-PRT-034", Technique::kFaultInjection, Polarity::kViolation);
    using ports::posix_rt::GridFault;
    Course course;
    course.watch.found = {{{GridFault::kOverdue, 0U, at(8000), at(8400)}, at(9000)}};
    EXPECT_EQ(judge(course).watch.invented, 1U);
    course.runner_delays = {{at(8000), at(9400)}};
    EXPECT_EQ(judge(course).watch.invented, 0U);
    EXPECT_EQ(judge(course).watch.by_host, 1U);
    course.runner_delays = {{at(8401), at(9400)}};
    EXPECT_EQ(judge(course).watch.invented, 1U);
}

TEST(JudgeTest, AnInventedReportFailsTheRunAndASuspectedOneMakesItInconclusive) {
    verifies("SWR-VER-022", Technique::kFaultInjection, Polarity::kViolation);
    using verification::assess_run;
    using verification::RunVerdict;
    const std::vector<Report> reports{overrun(0U, 0U, 8000, 8010, 8215)};
    const auto assess = [](Verdict verdict) {
        verdict.frames = 1000U;
        return assess_run(verdict.get_report_evidence()).verdict;
    };
    EXPECT_EQ(assess(judge({reports, {}, {}, {}})), RunVerdict::kFailed);
    EXPECT_EQ(assess(judge_late(reports, {{at(8010), at(8060)}, {at(8100), at(8150)}})),
              RunVerdict::kInconclusive);
    EXPECT_EQ(assess(judge_late(reports, {{at(8010), at(8110)}})), RunVerdict::kPassed) << "set aside";
    EXPECT_EQ(assess(judge({{overrun(1U, 2U, 5300, 5310, 5515)}, {kDeed}, {}, {}})), RunVerdict::kFailed)
        << "wrong name";
    EXPECT_EQ(assess(judge({{}, {kDeed}, {}, {}})), RunVerdict::kFailed) << "no report";
}

TEST(JudgeTest, ReportsThatOneDelayCausesCountAsOneTime) {
    verifies("SWR-PRT-007", Technique::kEquivalenceClasses);
    const Report first = late(0U, 8000, 9400);
    EXPECT_EQ(judge({{first, late(1U, 8300, 9401)}, {}, {}, {}}).times, 1U);
    EXPECT_EQ(judge({{first, late(1U, 9400, 10'900)}, {}, {}, {}}).times, 1U);
    EXPECT_EQ(judge({{first, late(1U, 9401, 10'900)}, {}, {}, {}}).times, 2U);
}

TEST(JudgeTest, WorkThatIsOutOneFrameAfterTheMachineStoodStillIsItsDoingToo) {
    verifies("SWR-PRT-007", Technique::kBoundaryValues);
    const Report first = overrun(0U, 0U, 8000, 8010, 8215);
    const std::vector<Stall> late_looks{{at(8000), at(8210)}};
    EXPECT_TRUE(judge_late({first, overrun(0U, 0U, 9000, 9010, 9010)}, late_looks).is_well());
    EXPECT_EQ(judge_late({first, overrun(0U, 0U, 10000, 10010, 10010)}, late_looks).invented, 1U);
}

TEST(JudgeTest, ALateReleaseIsSeenAtItsWindowAndExplainsThoseUntilTheGridIsMet) {
    verifies("SWR-PRT-007");
    const Delay delay{0U, at(5000), at(6290)};
    const std::vector<Report> reports{late(0U, 5000, 6290), late(1U, 5300, 6291),
                                      overrun(0U, 0U, 6000, 6292, 6300)};
    EXPECT_TRUE(judge({reports, {}, {delay}, {}}).is_well()) << "the last one opened 8 us before its close";

    const Verdict other = judge({{reports[1]}, {}, {delay}, {}});
    EXPECT_EQ(other.unseen, 1U) << "told of another window only";
    const Verdict own = judge({{reports[0], overrun(0U, 0U, 6000, 6050, 6255)}, {}, {delay}, {}});
    EXPECT_EQ(own.invented, 1U) << "that window had its whole budget";
}

TEST(JudgeTest, AStuckGuardMayReportLateButMustNameItsComponentAndExplainsWhatIsLateAfterIt) {
    verifies("SWR-PRT-007", Technique::kFaultInjection, Polarity::kViolation);
    Deed deed = kDeed;
    deed.cause = Cause::kStuckGuard;
    const std::vector<Report> reports{overrun(1U, 1U, 5300, 5310, 6815), late(0U, 6000, 6816)};

    const Verdict verdict = judge({reports, {deed}, {}, {}});
    EXPECT_TRUE(verdict.is_well());
    EXPECT_TRUE(verdict.detection_ns.empty()) << "its time is that of the watch";
    EXPECT_EQ(judge({{reports[1]}, {deed}, {}, {}}).unseen, 1U);
    EXPECT_FALSE(judge({reports, {kDeed}, {}, {}}).is_well()) << "of a guard that works, it is tardy";
    EXPECT_TRUE(judge({{overrun(1U, 1U, 5300, 5401, 6815)}, {deed}, {}, {}}).is_well())
        << "its own window opened late";
    EXPECT_EQ(judge({{overrun(0U, 0U, 6000, 6101, 6815)}, {deed}, {}, {}}).unseen, 1U)
        << "another one that did";
    EXPECT_EQ(judge({{overrun(1U, 1U, 6300, 6401, 6815)}, {deed}, {}, {}}).unseen, 1U)
        << "of the frame after";
}

TEST(JudgeTest, AComponentThatWasLockedOutIsCountedAndMustBeNamed) {
    verifies("SWR-PRT-035", Technique::kFaultInjection, Polarity::kViolation);
    Deed deed = kDeed;
    deed.cause = Cause::kLock;
    const Verdict named = judge({{overrun(1U, 1U, 5300, 5310, 5515)}, {deed, kDeed}, {}, {}});
    EXPECT_EQ(named.locked_out, 1U);
    EXPECT_EQ(named.locked_out_seen, 1U);
    EXPECT_EQ(judge({{overrun(1U, 2U, 5300, 5310, 5515)}, {deed}, {}, {}}).locked_out_seen, 0U);
}

TEST(JudgeTest, AComponentThatFoundTheMutexFreeWasNotLockedOut) {
    verifies("SWR-PRT-035", Technique::kBoundaryValues, Polarity::kViolation);
    const auto judge_wait = [](Duration wait, const std::vector<Report>& reports) {
        return judge({reports, {{1U, at(5310), at(5310) + wait, Cause::kLock}}, {}, {}});
    };
    const Duration budget{200'000};

    EXPECT_EQ(judge_wait(budget, {}).injected, 0U);
    EXPECT_EQ(judge_wait(budget, {}).unseen, 0U);
    EXPECT_EQ(judge_wait(budget + Duration{1}, {}).unseen, 1U);
    EXPECT_EQ(judge_wait(budget, {overrun(1U, 1U, 5300, 5305, 5506)}).locked_out_seen, 1U)
        << "its window had begun before it";
    const Deed work{1U, at(5310), at(5310) + budget};
    EXPECT_EQ(judge({{}, {work}, {}, {}}).unseen, 1U) << "work takes as long as it is told to";
}

TEST(JudgeTest, WhatTheWatchDidNotSeeIsNotWellAndAClockThatItSawIsAFaultOfTheRun) {
    verifies("SWR-PRT-034", Technique::kFaultInjection, Polarity::kViolation);
    using ports::posix_rt::GridFault;
    const ClockFault fault{at(5000), at(30'000), -10'000};
    const Found found{{GridFault::kSlowClock, kNoIndex, Instant{}, at(9000)}, at(40'000)};
    const Verdict seen = judge({{}, {}, {}, {}, {{}, {fault}, {found}}});
    EXPECT_EQ(seen.injected, 1U);
    EXPECT_TRUE(seen.is_well());
    EXPECT_FALSE(judge({{}, {}, {}, {}, {{}, {fault}, {}}}).is_well());
}

TEST(JudgeTest, APageFaultThatNeedsTheDiskOrTooManyOthersAreNotWellWhereMemoryIsLocked) {
    verifies("SWR-PRT-037", Technique::kBoundaryValues, Polarity::kViolation);
    Verdict verdict;
    verdict.has_locked_memory = true;
    verdict.minor_faults = kMinorFaultsMax;
    EXPECT_TRUE(verdict.is_well());
    ++verdict.minor_faults;
    EXPECT_FALSE(verdict.is_well());
    verdict.minor_faults = 0;
    verdict.major_faults = 1;
    EXPECT_FALSE(verdict.is_well());
    verdict.has_locked_memory = false;
    EXPECT_TRUE(verdict.is_well());
}

TEST(JudgeTest, ARunInWhichHardlyAFaultTookEffectIsNoTest) {
    verifies("SWR-PRT-007", Technique::kBoundaryValues, Polarity::kViolation);
    Verdict verdict;
    verdict.requested = 100U;
    verdict.injected = verdict.seen = 95U;
    EXPECT_TRUE(verdict.is_well());
    verdict.injected = verdict.seen = 94U;
    EXPECT_FALSE(verdict.is_well());
}

}  // namespace
}  // namespace mamori::time_faults
