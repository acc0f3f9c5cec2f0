// SPDX-License-Identifier: Apache-2.0
// Goal: the judgement about failing partitions can fail, in each of its ways, and excuses a window
// only where the machine was slow or nobody else ran. Method: courses made by hand; instants in microseconds.
#include "judge.hpp"

#include <gtest/gtest.h>

#include "mamori/trace/verifies.hpp"

namespace mamori::partition_faults {
namespace {

using verification::Polarity;
using verification::Technique;
using verification::verifies;

constexpr Instant at(std::int64_t us) noexcept {
    return Instant{us * 1000};
}
constexpr std::int64_t kFrameUs{1000};
/// The deed of most courses: a kill, between two answers.
constexpr std::int64_t kKilled{100'500};
constexpr std::int64_t kLastAnswer{100'200};
constexpr std::int64_t kOver{300'000};

Look good(std::int64_t us) {
    return {at(us), true, true, false, 0U};
}
Look nothing(std::int64_t us) {
    return {at(us), false, false, false, 0U};
}
Look wrong(std::int64_t us) {
    return {at(us), true, false, false, 0U};
}
Look refused(std::int64_t us) {
    return {at(us), false, false, true, 0U};
}
Look skipping(std::int64_t us, std::uint64_t skipped) {
    return {at(us), true, true, false, skipped};
}

/// Good answers in each frame up to one, and none behind it.
std::vector<Look> make_looks(std::int64_t last_us, std::int64_t end_us) {
    std::vector<Look> looks;
    for (std::int64_t us = 200; us <= end_us; us += kFrameUs) {
        looks.push_back(us <= last_us ? good(us) : nothing(us));
    }
    return looks;
}

Deed make_deed(Kind kind) {
    return {kind, at(kKilled), at(kKilled), at(kOver), true};
}

ReactionBegin react(std::int64_t us, PartitionFault fault = PartitionFault::kSilent) {
    return {at(us), fault, true};
}

/// A course with one deed and what arrived.
Course make_course(const Deed& deed, std::vector<Look> looks, std::vector<ReactionBegin> reactions) {
    Course course;
    course.looks = std::move(looks);
    course.reactions = std::move(reactions);
    course.deeds = {deed};
    return course;
}

Course make_kill(std::vector<ReactionBegin> reactions) {
    return make_course(make_deed(Kind::kKill), make_looks(kLastAnswer, kOver), std::move(reactions));
}

bool is_well(const Course& course) {
    Verdict verdict = judge(course);
    verdict.requested = course.deeds.size();
    verdict.has_run = true;
    return verdict.is_well();
}

Outcome judge_one(const Course& course) {
    const Verdict verdict = judge(course);
    EXPECT_EQ(verdict.outcomes.size(), 1U);
    return verdict.outcomes[0U];
}

TEST(PartitionJudgeTest, AReactionIsInTimeUpToTheBoundAndTardyBehindIt) {
    verifies("SWR-PRT-018", Technique::kBoundaryValues, Polarity::kViolation);
    const std::int64_t bound = kKilled + kBound.ns / 1000;

    EXPECT_EQ(judge_one(make_kill({react(kLastAnswer + 50'000)})), Outcome::kInTime);
    EXPECT_TRUE(is_well(make_kill({react(bound)})));
    EXPECT_EQ(judge_one(make_kill({react(bound + 1)})), Outcome::kTardy);
    EXPECT_FALSE(is_well(make_kill({react(bound + 1)})));
    Course excused = make_kill({react(bound + 1)});
    excused.stalls = {{at(120'000), at(120'500)}};
    EXPECT_EQ(judge_one(excused), Outcome::kTardyByHost);
    EXPECT_TRUE(is_well(excused));
    excused.stalls = {{at(90'000), at(90'500)}};
    EXPECT_EQ(judge_one(excused), Outcome::kTardy) << "a stall before the fault excuses nothing";
}

TEST(PartitionJudgeTest, TheTimeOfAReactionCountsFromItsFault) {
    verifies("SWR-PRT-018");
    const Verdict verdict = judge(make_kill({react(kKilled + 51'000)}));

    EXPECT_EQ(verdict.reaction_ns[static_cast<std::size_t>(Kind::kKill)],
              (std::vector<std::int64_t>{51'000'000}));
}

TEST(PartitionJudgeTest, AFaultWithoutAReactionIsUnseen) {
    verifies("SWR-PRT-018", Technique::kFaultInjection, Polarity::kViolation);

    EXPECT_EQ(judge_one(make_kill({})), Outcome::kUnseen);
    EXPECT_EQ(judge_one(make_kill({react(kOver + 1)})), Outcome::kUnseen) << "the partition was over by then";
    EXPECT_FALSE(is_well(make_kill({})));
}

TEST(PartitionJudgeTest, ADeedThatDidNotComeAboutIsNoTestAndTooManyAreNone) {
    verifies("SWR-PRT-018", Technique::kBoundaryValues, Polarity::kViolation);
    Course course = make_kill({});
    course.deeds[0U].is_done = false;
    EXPECT_EQ(judge_one(course), Outcome::kNotDone);
    Verdict verdict;
    verdict.has_run = true;
    verdict.requested = 20U;
    verdict.outcomes.assign(19U, Outcome::kInTime);
    verdict.outcomes.push_back(Outcome::kNotDone);

    EXPECT_TRUE(verdict.is_well());
    verdict.outcomes[0U] = Outcome::kNotDone;
    EXPECT_FALSE(verdict.is_well());
    verdict.outcomes = {Outcome::kInTime};
    EXPECT_FALSE(verdict.is_well()) << "the campaign ended before its last fault";
    verdict.requested = 1U;
    EXPECT_TRUE(verdict.is_well());
    verdict.has_run = false;
    EXPECT_FALSE(verdict.is_well());
}

TEST(PartitionJudgeTest, AReactionThatIsNotTheDeclaredOneOrCannotBeIsMisnamed) {
    verifies("SWR-PRT-018", Technique::kFaultInjection, Polarity::kViolation);
    Course other = make_kill({react(151'000)});
    other.reactions[0U].is_declared = false;
    EXPECT_EQ(judge_one(other), Outcome::kMisnamed);
    EXPECT_FALSE(is_well(other));
    Course dead_flood = make_kill({react(151'000, PartitionFault::kFlooding)});
    dead_flood.looks.back() = nothing(kOver);
    dead_flood.looks[150U] = skipping(150'200, kSkippedMax + 1U);
    EXPECT_EQ(judge_one(dead_flood), Outcome::kMisnamed) << "the dead do not flood";
    Course none = make_kill({react(151'000, PartitionFault::kCount)});
    EXPECT_EQ(judge_one(none), Outcome::kMisnamed);
}

TEST(PartitionJudgeTest, AFloodIsMoreFramesThanTheLimit) {
    verifies("SWR-PRT-018", Technique::kBoundaryValues, Polarity::kViolation);
    const auto make = [](std::uint64_t skipped) {
        std::vector<Look> looks = make_looks(100'200, 101'200);
        looks.back() = skipping(101'200, skipped);
        return make_course(make_deed(Kind::kFlood), looks, {react(101'500, PartitionFault::kFlooding)});
    };

    EXPECT_EQ(judge_one(make(kSkippedMax + 1U)), Outcome::kInTime);
    EXPECT_EQ(judge_one(make(kSkippedMax)), Outcome::kMisnamed);
    EXPECT_EQ(judge(make(kSkippedMax)).invented.size(), 1U);
}

TEST(PartitionJudgeTest, CorruptionIsAFrameThatIsRefusedOrHasAWrongCheck) {
    verifies("SWR-PRT-018", Technique::kEquivalenceClasses, Polarity::kViolation);
    const auto make = [](const Look& last, std::int64_t reacted_us) {
        std::vector<Look> looks = make_looks(100'200, 101'200);
        looks.back() = last;
        return make_course(make_deed(Kind::kCorrupt), looks, {react(reacted_us, PartitionFault::kCorrupt)});
    };

    EXPECT_EQ(judge_one(make(wrong(101'200), 101'500)), Outcome::kInTime);
    EXPECT_EQ(judge_one(make(refused(101'200), 101'500)), Outcome::kInTime);
    EXPECT_EQ(judge_one(make(refused(101'200), 103'200)), Outcome::kInTime);
    EXPECT_EQ(judge_one(make(refused(101'200), 103'201)), Outcome::kMisnamed) << "long ago";
    EXPECT_EQ(judge_one(make(nothing(101'200), 101'500)), Outcome::kMisnamed);
}

TEST(PartitionJudgeTest, WhileSomethingGoodComesTheReactionIsNotDue) {
    verifies("SWR-PRT-018", Technique::kBoundaryValues, Polarity::kViolation);
    const std::int64_t last = 130'200;
    const auto make = [](std::int64_t reacted_us) {
        return make_course(make_deed(Kind::kCorrupt), make_looks(last, kOver), {react(reacted_us)});
    };

    EXPECT_EQ(judge_one(make(last + kBound.ns / 1000)), Outcome::kInTime);
    EXPECT_EQ(judge_one(make(last + kBound.ns / 1000 + 1)), Outcome::kTardy);
}

TEST(PartitionJudgeTest, AReactionWithoutAFaultIsInventedUnlessNothingCame) {
    verifies("SWR-PRT-018", Technique::kFaultInjection, Polarity::kViolation);
    Course course = make_kill({react(50'500), react(151'000)});
    EXPECT_EQ(judge(course).invented.size(), 1U);
    EXPECT_EQ(judge_one(course), Outcome::kInTime) << "the fault has its own";
    EXPECT_FALSE(is_well(course));
    Course late = make_kill({react(151'000), react(kOver + 60'000)});
    late.looks.push_back(good(kOver + 50'200));
    EXPECT_EQ(judge(late).invented.size(), 1U);

    for (std::size_t i = 10U; i < 60U; ++i) {
        course.looks[i] = nothing(course.looks[i].at.ns / 1000);
    }
    course.reactions[0U] = react(9'200 + 50'000);
    EXPECT_EQ(judge(course).by_machine, 1U);
    EXPECT_EQ(judge(course).invented.size(), 0U);
    EXPECT_TRUE(is_well(course));
    course.reactions[0U] = react(9'200 + 49'999);
    EXPECT_EQ(judge(course).invented.size(), 1U) << "before the silence was long enough";
    course.reactions[0U] = react(60'500, PartitionFault::kFlooding);
    course.looks[60U] = skipping(60'200, kSkippedMax + 1U);
    EXPECT_EQ(judge(course).invented.size(), 1U);
    course.stalls = {{at(10'000), at(59'000)}};
    EXPECT_EQ(judge(course).by_machine, 1U) << "the guard could not look";
    EXPECT_EQ(judge(course).invented.size(), 0U);
}

/// Two windows of two frames, all well.
Course make_order() {
    Course course;
    for (const Opening& opening :
         {Opening{0U, at(0)}, Opening{1U, at(500)}, Opening{0U, at(1000)}, Opening{1U, at(1500)}}) {
        course.expected.push_back(opening);
        course.ran.push_back(opening);
        course.openings.push_back({opening, opening.release + 20_us, opening.release + 100_us, false, false});
    }
    return course;
}
/// The same, and the third window was cut off 300 us after its release.
Course make_overrun() {
    Course course = make_order();
    course.openings[2U].is_overrun = true;
    course.openings[2U].end = course.openings[2U].opening.release + 300_us;
    return course;
}

TEST(PartitionJudgeTest, WindowsInTheOrderOfVirtualTimeAreWell) {
    verifies("SWR-PRT-018");

    EXPECT_TRUE(is_well(make_order()));
    EXPECT_EQ(judge(make_order()).quiet.p50_ns, 20'000);
    EXPECT_EQ(judge(make_order()).quiet.openings, 4U);
}

TEST(PartitionJudgeTest, AWindowThatIsLostDoubledOrExchangedIsOutOfOrder) {
    verifies("SWR-PRT-018", Technique::kFaultInjection, Polarity::kViolation);
    Course lost = make_order();
    lost.ran.erase(lost.ran.begin() + 1);
    EXPECT_EQ(judge(lost).disordered, 1U);
    EXPECT_FALSE(is_well(lost));
    Course doubled = make_order();
    doubled.ran.push_back(doubled.ran.back());
    EXPECT_EQ(judge(doubled).disordered, 1U);
    Course exchanged = make_order();
    std::swap(exchanged.ran[1U], exchanged.ran[2U]);
    EXPECT_GT(judge(exchanged).disordered, 0U);
    Course unknown = make_order();
    unknown.expected.clear();
    EXPECT_EQ(judge(unknown).disordered, 4U) << "virtual time did not run";
}

TEST(PartitionJudgeTest, AWindowThatIsMissedOrCutOffHasMovedUnlessTheMachineStoodStill) {
    verifies("SWR-PRT-018", Technique::kFaultInjection, Polarity::kViolation);
    Course missed = make_order();
    missed.openings[2U].is_missed = true;
    missed.ran.erase(missed.ran.begin() + 2);
    EXPECT_EQ(judge(missed).moved.size(), 1U);
    EXPECT_EQ(judge(missed).disordered, 0U);
    EXPECT_FALSE(is_well(missed));
    Course cut = make_order();
    cut.openings[2U].is_overrun = true;
    EXPECT_EQ(judge(cut).moved.size(), 1U);
    EXPECT_EQ(judge(cut).disordered, 0U) << "it had begun";
    std::swap(cut.ran[2U], cut.ran[3U]);
    EXPECT_EQ(judge(cut).disordered, 0U) << "work that was given up came later";
    cut.ran.erase(cut.ran.begin() + 3);
    EXPECT_EQ(judge(cut).disordered, 0U) << "or never";

    missed.stalls = {{at(1050), at(1300)}};
    EXPECT_EQ(judge(missed).moved.size(), 0U);
    EXPECT_EQ(judge(missed).moved_suspected, 1U) << "in part within it";
    EXPECT_FALSE(is_well(missed));
    missed.stalls = {{at(1101), at(1300)}};
    EXPECT_EQ(judge(missed).moved.size(), 1U) << "it was over by then";
}

TEST(PartitionJudgeTest, AWindowFromWhichTheHostTookHalfOfItsBudgetIsSetAsideAndInPiecesSuspected) {
    verifies("SWR-PRT-018", Technique::kBoundaryValues, Polarity::kViolation);
    Course course = make_order();
    course.openings[2U].is_missed = true;
    course.ran.erase(course.ran.begin() + 2);
    const std::int64_t release = course.openings[2U].opening.release.ns / 1000;
    course.openings[2U].end = at(release + 300);

    course.late_looks = {{at(release), at(release + 60)}, {at(release + 100), at(release + 155)}};
    EXPECT_EQ(judge(course).moved.size(), 0U);
    EXPECT_EQ(judge(course).moved_suspected, 1U);
    course.late_looks[1U].end = at(release + 154);
    EXPECT_EQ(judge(course).moved.size(), 1U) << "less than half";
    course.late_looks = {{at(release - 60), at(release)}, {at(release + 300), at(release + 400)}};
    EXPECT_EQ(judge(course).moved.size(), 1U) << "before it and after it";
    course.late_looks = {{at(release), at(release + 115)}};
    EXPECT_EQ(judge(course).moved_by_host, 1U) << "at once";
    EXPECT_TRUE(is_well(course));
    course.late_looks[0U].end = at(release + 114);
    EXPECT_EQ(judge(course).moved.size(), 1U);
}

TEST(PartitionJudgeTest, AWindowInASlowStretchOfTheHostIsSuspected) {
    verifies("SWR-PRT-018", Technique::kBoundaryValues, Polarity::kViolation);
    Course course = make_overrun();
    const std::int64_t release = course.openings[2U].opening.release.ns / 1000;

    // Looks that end before the frame before do not count; those in the window, less than half of its budget,
    // do.
    course.late_looks = {{at(release - 1100), at(release - 1001)},
                         {at(release - 900), at(release - 800)},
                         {at(release - 300), at(release - 220)},
                         {at(release + 100), at(release + 150)}};
    EXPECT_EQ(judge(course).moved.size(), 0U);
    EXPECT_EQ(judge(course).moved_suspected, 1U);
    course.late_looks[2U].end = at(release - 221);
    EXPECT_EQ(judge(course).moved.size(), 1U) << "less than a budget";
}

TEST(PartitionJudgeTest, AWindowThatMovedWhileNobodyElseRanIsNotTheDoingOfThePartition) {
    verifies("SWR-PRT-018", Technique::kBoundaryValues, Polarity::kViolation);
    Course course = make_overrun();
    const std::int64_t release = course.openings[2U].opening.release.ns / 1000;
    EXPECT_EQ(judge(course).moved.size(), 1U) << "nobody looked";

    course.knows_foreign = true;
    course.foreign = {{at(release - 100), at(release + 24)}, {at(release + 300), at(release + 400)}};
    EXPECT_EQ(judge(course).moved.size(), 0U);
    ASSERT_EQ(judge(course).moved_alone.size(), 1U);
    EXPECT_TRUE(judge(course).moved_alone[0U].opening == course.openings[2U].opening);
    course.foreign[0U].end = at(release + 25);
    EXPECT_EQ(judge(course).moved.size(), 1U);
    EXPECT_TRUE(judge(course).moved_alone.empty());
}

verification::RunVerdict assess(const Verdict& verdict) {
    return verification::assess_run(verdict.get_evidence()).verdict;
}

TEST(PartitionJudgeTest, ARunThatCouldNotGoOnFailsUnlessTheHostWasTooSlow) {
    verifies("SWR-VER-022", Technique::kFaultInjection, Polarity::kViolation);
    Verdict verdict;
    verdict.requested = 8U;
    verdict.host.stalls = 500U;
    EXPECT_EQ(assess(verdict), verification::RunVerdict::kFailed);
    verdict.is_too_slow = true;
    EXPECT_EQ(assess(verdict), verification::RunVerdict::kInconclusive);
}

TEST(PartitionJudgeTest, AWindowThatMovedByItselfFailsTheRunUnlessAHundredStallsWereSeen) {
    verifies("SWR-PRT-018", Technique::kBoundaryValues, Polarity::kViolation);
    Verdict verdict;
    verdict.has_run = true;
    verdict.quiet.openings = 100'000U;
    verdict.faulty.openings = 100'000U;
    EXPECT_EQ(assess(verdict), verification::RunVerdict::kPassed);
    verdict.moved_alone.resize(1U);
    EXPECT_FALSE(verdict.is_well());
    EXPECT_EQ(assess(verdict), verification::RunVerdict::kFailed);
    verdict.host.stalls = 99U;
    EXPECT_EQ(assess(verdict), verification::RunVerdict::kFailed);
    verdict.host.stalls = 100U;
    EXPECT_EQ(assess(verdict), verification::RunVerdict::kInconclusive);
    verdict.invented.resize(1U);
    EXPECT_EQ(assess(verdict), verification::RunVerdict::kFailed) << "what arrived is exact";
    verdict.invented.clear();
    verdict.disordered = 1U;
    EXPECT_EQ(assess(verdict), verification::RunVerdict::kFailed);
}

TEST(PartitionJudgeTest, AWindowWhoseWorkIsStillOutSharesTheReasonOfTheFrameBefore) {
    verifies("SWR-PRT-018", Technique::kErrorGuessing, Polarity::kViolation);
    Course course = make_order();
    course.openings[0U].is_overrun = true;
    course.openings[2U].is_overrun = true;
    EXPECT_EQ(judge(course).moved.size(), 2U);

    course.stalls = {{at(0), at(100)}};
    EXPECT_EQ(judge(course).moved.size(), 0U);
    EXPECT_EQ(judge(course).moved_suspected, 1U);
    EXPECT_EQ(judge(course).moved_by_host, 1U) << "behind the first one";
    course.openings[2U].is_overrun = false;
    course.openings[3U].is_overrun = true;
    EXPECT_EQ(judge(course).moved.size(), 1U) << "another window";
}

TEST(PartitionJudgeTest, LatenessAndStallsAreToldApartByWhetherThePartitionWasWell) {
    verifies("SWR-PRT-018", Technique::kBoundaryValues);
    Course course = make_order();
    course.deeds = {{Kind::kStop, at(500), at(500), at(1000), true}};
    course.openings[1U].is_missed = true;
    course.openings[3U].woke = at(1590);
    course.stalls = {{at(499), at(500)}, {at(700), at(800)}, {at(1001), at(1100)}};

    const Verdict verdict = judge(course);
    EXPECT_EQ(verdict.faulty.openings, 2U);
    EXPECT_EQ(verdict.faulty.stalls, 1U);
    EXPECT_EQ(verdict.faulty.moved, 0U) << "it was excused";
    EXPECT_EQ(verdict.faulty.max_ns, 20'000);
    EXPECT_EQ(verdict.faulty.time, 500_us);
    EXPECT_EQ(verdict.quiet.openings, 2U);
    EXPECT_EQ(verdict.quiet.stalls, 2U);
    EXPECT_EQ(verdict.quiet.max_ns, 90'000);
    EXPECT_EQ(verdict.quiet.time, 1100_us);
    course.stalls.clear();
    EXPECT_EQ(judge(course).faulty.moved, 1U);
    EXPECT_EQ(judge(course).quiet.moved, 0U);
}

TEST(PartitionJudgeTest, EachKindAndOutcomeHasAName) {
    verifies("SWR-PRT-018", Technique::kEquivalenceClasses);
    for (std::size_t i = 0U; i < kKindCount; ++i) {
        EXPECT_STRNE(get_name(static_cast<Kind>(i)), "invalid");
    }
    for (std::size_t i = 0U; i < kOutcomeCount; ++i) {
        EXPECT_STRNE(get_name(static_cast<Outcome>(i)), "invalid");
    }
    EXPECT_STREQ(get_name(static_cast<Kind>(kKindCount)), "invalid");
    EXPECT_STREQ(get_name(static_cast<Outcome>(kOutcomeCount)), "invalid");
}

}  // namespace
}  // namespace mamori::partition_faults
