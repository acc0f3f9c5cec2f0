// SPDX-License-Identifier: Apache-2.0
// Goal: times between checkpoints, their order and the clock are judged, and no later legal checkpoint hides
// a violation. Method: both sides of each limit, the measured defects of another implementation, ends of the
// time line.
#include "mamori/safety/supervision/checkpoint_supervisor.hpp"

#include <array>
#include <cstdint>
#include <initializer_list>
#include <limits>

#include "mamori/safety/supervision/watchdog_gate.hpp"
#include "supervision_rig.hpp"

namespace mamori::safety {
namespace {

using namespace verification;
using Violation = CheckpointViolation;

using literals::operator""_ns;
using literals::operator""_s;

constexpr std::int64_t kFirst = std::numeric_limits<std::int64_t>::min();
constexpr std::int64_t kLast = std::numeric_limits<std::int64_t>::max();

enum class Point : CheckpointIndex { kZero, kOne, kTwo };

constexpr std::array kEntities{supervise(Only::kEntity)};

// A time without an order.
constexpr std::array kTimed{checkpoint(Point::kZero, Only::kEntity), checkpoint(Point::kOne, Only::kEntity)};
constexpr std::array kTimes{deadline(Point::kZero, Point::kOne, {10_ns, 100_ns})};
constexpr SupervisionTable kTimeTable{kEntities, kTimed, {}, kTimes, {}, 1U, 1000U};
using TimeRig = SupervisionRig<kTimeTable>;

// The table on which the defects were measured: 0, 1, 2 in this order, 1 s at most from 0 to 1.
constexpr std::array kOrdered{checkpoint(Point::kZero, Only::kEntity, CheckpointRole::kInitial),
                              checkpoint(Point::kOne, Only::kEntity, CheckpointRole::kInner),
                              checkpoint(Point::kTwo, Only::kEntity, CheckpointRole::kFinal)};
constexpr std::array kOrderTimes{deadline(Point::kZero, Point::kOne, {0_ns, 1_s})};
constexpr std::array kOrder{edge(Point::kZero, Point::kOne), edge(Point::kOne, Point::kTwo)};
constexpr SupervisionTable kOrderTable{kEntities, kOrdered, {}, kOrderTimes, kOrder};
using OrderRig = SupervisionRig<kOrderTable>;

// Two ways through, and one checkpoint that may come at any time.
enum class Way : CheckpointIndex { kBegin, kLeft, kRight, kEnd, kAlone, kAny };
constexpr std::array kWays{
    checkpoint(Way::kBegin, Only::kEntity, CheckpointRole::kInitial),
    checkpoint(Way::kLeft, Only::kEntity, CheckpointRole::kInner),
    checkpoint(Way::kRight, Only::kEntity, CheckpointRole::kInner),
    checkpoint(Way::kEnd, Only::kEntity, CheckpointRole::kFinal),
    checkpoint(Way::kAlone, Only::kEntity, CheckpointRole::kInitialAndFinal),
    checkpoint(Way::kAny, Only::kEntity),
};
constexpr std::array kWayEdges{
    edge(Way::kBegin, Way::kLeft), edge(Way::kBegin, Way::kRight), edge(Way::kLeft, Way::kLeft),
    edge(Way::kLeft, Way::kEnd),   edge(Way::kRight, Way::kEnd),
};
constexpr std::array kAnyAlive{alive(Way::kAny, {1U, 0U, 9U, 1U})};
constexpr SupervisionTable kWayTable{kEntities, kWays, kAnyAlive, {}, kWayEdges};

/// Reports a sequence in one cycle. @return what was found.
Violation judge(std::initializer_list<Way> sequence) {
    SupervisionRig<kWayTable> rig;
    rig.report(Way::kAny, 0);
    for (const Way way : sequence) {
        rig.report(way, 0);
    }
    static_cast<void>(rig.step(0));
    return rig.get_violation();
}

void expect_not_served(SupervisionStatus status) {
    EXPECT_FALSE(may_service_watchdog(to_global_status(status), true));
}

TEST(CheckpointDeadlineTest, TimesInsideTheLimitsAreHealthyBothEndsIncluded) {
    verifies("SWR-SUP-003", Technique::kBoundaryValues);
    TimeRig rig;
    rig.report(Point::kZero, 0);
    rig.report(Point::kOne, 10);
    rig.report(Point::kZero, 1000);
    rig.report(Point::kOne, 1100);

    EXPECT_EQ(rig.step(1100), SupervisionStatus::kOk);
}

TEST(CheckpointDeadlineTest, TimeThatIsTooLongExpires) {
    verifies("SWR-SUP-003", Technique::kBoundaryValues, Polarity::kViolation);
    TimeRig rig;
    rig.report(Point::kZero, 0);
    rig.report(Point::kOne, 101);

    EXPECT_EQ(rig.step(101), SupervisionStatus::kExpired);
    EXPECT_EQ(rig.get_violation(), Violation::kTooLong);
}

TEST(CheckpointDeadlineTest, TimeThatIsTooShortExpires) {
    verifies("SWR-SUP-003", Technique::kBoundaryValues, Polarity::kViolation);
    TimeRig rig;
    rig.report(Point::kZero, 0);
    rig.report(Point::kOne, 9);

    EXPECT_EQ(rig.step(9), SupervisionStatus::kExpired);
    EXPECT_EQ(rig.get_violation(), Violation::kTooShort);
}

TEST(CheckpointDeadlineTest, TimeThatIsStillRunningAtItsLimitIsHealthy) {
    verifies("SWR-SUP-004", Technique::kBoundaryValues);
    TimeRig rig;
    rig.report(Point::kZero, 0);

    EXPECT_EQ(rig.step(50), SupervisionStatus::kOk);
    EXPECT_EQ(rig.step(100), SupervisionStatus::kOk);
    rig.report(Point::kOne, 100);
    EXPECT_EQ(rig.step(5000), SupervisionStatus::kOk) << "a time that has ended does not age";
}

TEST(CheckpointDeadlineTest, FinishThatNeverComesExpiresInTheFirstCycleAfterItsLimit) {
    verifies("SWR-SUP-004", Technique::kFaultInjection, Polarity::kViolation);
    TimeRig rig;
    rig.report(Point::kZero, 0);
    ASSERT_EQ(rig.step(100), SupervisionStatus::kOk);

    EXPECT_EQ(rig.step(101), SupervisionStatus::kExpired);
    EXPECT_EQ(rig.get_violation(), Violation::kMissingFinish);
}

TEST(CheckpointDeadlineTest, StartAnewWithoutAFinishExpires) {
    verifies("SWR-SUP-004", Technique::kErrorGuessing, Polarity::kViolation);
    TimeRig rig;
    rig.report(Point::kZero, 0);
    rig.report(Point::kZero, 20);
    rig.report(Point::kOne, 40);

    EXPECT_EQ(rig.step(40), SupervisionStatus::kExpired);
    EXPECT_EQ(rig.get_violation(), Violation::kMissingFinish);
}

TEST(CheckpointDeadlineTest, FinishWithoutAStartExpires) {
    verifies("SWR-SUP-003", Technique::kErrorGuessing, Polarity::kViolation);
    TimeRig rig;
    rig.report(Point::kOne, 50);

    EXPECT_EQ(rig.step(50), SupervisionStatus::kExpired);
    EXPECT_EQ(rig.get_violation(), Violation::kMissingStart);
}

TEST(CheckpointDeadlineTest, ClockAtTheEndsOfTheTimeLineIsJudgedCorrectly) {
    verifies("SWR-SUP-006", Technique::kBoundaryValues, Polarity::kViolation);
    TimeRig whole;
    whole.report(Point::kZero, kFirst);
    whole.report(Point::kOne, kLast);
    EXPECT_EQ(whole.step(kLast), SupervisionStatus::kExpired);
    EXPECT_EQ(whole.get_violation(), Violation::kTooLong) << "the distance does not wrap";
    TimeRig around_zero;
    around_zero.report(Point::kZero, -50);
    around_zero.report(Point::kOne, 0);
    EXPECT_EQ(around_zero.step(0), SupervisionStatus::kOk) << "tick 0 is an instant like any other";
    TimeRig backwards;
    backwards.report(Point::kZero, 1000);
    EXPECT_EQ(backwards.step(1000), SupervisionStatus::kOk);
    EXPECT_EQ(backwards.step(999), SupervisionStatus::kExpired);
    EXPECT_EQ(backwards.get_violation(), Violation::kClock);
}

TEST(CheckpointOrderTest, EachWayThroughTheGraphIsLegal) {
    verifies("SWR-SUP-024", Technique::kEquivalenceClasses);

    EXPECT_EQ(judge({}), Violation::kNone);
    EXPECT_EQ(judge({Way::kBegin, Way::kLeft, Way::kEnd}), Violation::kNone);
    EXPECT_EQ(judge({Way::kBegin, Way::kRight, Way::kEnd, Way::kAlone, Way::kAlone, Way::kBegin}),
              Violation::kNone);
    EXPECT_EQ(judge({Way::kBegin, Way::kLeft, Way::kLeft, Way::kLeft, Way::kEnd}), Violation::kNone);
    EXPECT_EQ(judge({Way::kBegin, Way::kAny, Way::kLeft, Way::kAny, Way::kEnd, Way::kAny}), Violation::kNone);
}

TEST(CheckpointOrderTest, EachOtherSequenceExpires) {
    verifies("SWR-SUP-024", Technique::kErrorGuessing, Polarity::kViolation);

    EXPECT_EQ(judge({Way::kLeft}), Violation::kOrder) << "not an initial one";
    EXPECT_EQ(judge({Way::kEnd}), Violation::kOrder);
    EXPECT_EQ(judge({Way::kBegin, Way::kEnd}), Violation::kOrder) << "no edge";
    EXPECT_EQ(judge({Way::kBegin, Way::kBegin}), Violation::kOrder);
    EXPECT_EQ(judge({Way::kBegin, Way::kLeft, Way::kRight}), Violation::kOrder);
    EXPECT_EQ(judge({Way::kBegin, Way::kLeft, Way::kBegin}), Violation::kOrder)
        << "an initial one inside a run";
    EXPECT_EQ(judge({Way::kBegin, Way::kAlone}), Violation::kOrder);
    EXPECT_EQ(judge({Way::kBegin, Way::kLeft, Way::kEnd, Way::kEnd}), Violation::kOrder)
        << "behind a final one";
    EXPECT_EQ(judge({Way::kAlone, Way::kLeft}), Violation::kOrder);
}

/// The ways of kWayTable as one reads them in its drawing.
bool may_follow(Way from, Way to) {
    switch (from) {
        case Way::kBegin:
            return to == Way::kLeft || to == Way::kRight;
        case Way::kLeft:
            return to == Way::kLeft || to == Way::kEnd;
        case Way::kRight:
            return to == Way::kEnd;
        case Way::kEnd:
        case Way::kAlone:
            return to == Way::kBegin || to == Way::kAlone;
        case Way::kAny:
            break;
    }
    return false;
}

TEST(CheckpointOrderTest, EverySequenceOfFiveIsJudgedByTheDrawing) {
    verifies("SWR-SUP-024", Technique::kBackToBack, Polarity::kViolation);

    for (unsigned number = 0U; number < 3125U; ++number) {  // 5^5 sequences of the ordered checkpoints
        SupervisionRig<kWayTable> rig;
        rig.report(Way::kAny, 0);
        Way last = Way::kEnd;
        bool is_legal = true;
        unsigned rest = number;
        for (int i = 0; i < 5; ++i) {
            const auto next = static_cast<Way>(rest % 5U);
            rest /= 5U;
            rig.report(next, i);
            is_legal = is_legal && may_follow(last, next);
            last = next;
        }
        static_cast<void>(rig.step(4));
        ASSERT_EQ(rig.get_violation(), is_legal ? Violation::kNone : Violation::kOrder) << number;
    }
}

TEST(CheckpointOrderTest, OrderIsKeptOverCycles) {
    verifies("SWR-SUP-024", Technique::kStateTransition, Polarity::kViolation);
    OrderRig rig;
    rig.report(Point::kZero, 0);
    ASSERT_EQ(rig.step(0), SupervisionStatus::kOk);
    rig.report(Point::kOne, 1);
    ASSERT_EQ(rig.step(1), SupervisionStatus::kOk);

    rig.report(Point::kZero, 2);
    EXPECT_EQ(rig.step(2), SupervisionStatus::kStopped);
    EXPECT_EQ(rig.get_violation(), Violation::kOrder);
}

// The six rows of the defects that were measured in another implementation; cycles of 1 s, no tolerance.
TEST(MeasuredDefectsTest, LegalSequenceIsHealthyAndServed) {
    verifies("SWR-SUP-005");
    OrderRig rig;
    rig.report(Point::kZero, 0);
    rig.report(Point::kOne, 1);
    rig.report(Point::kTwo, 2);

    const SupervisionStatus status = rig.step((1_s).ns);
    EXPECT_EQ(status, SupervisionStatus::kOk);
    EXPECT_EQ(rig.get_status(), EntityStatus::kOk);
    EXPECT_TRUE(may_service_watchdog(to_global_status(status), true));
}

TEST(MeasuredDefectsTest, IllegalEdgeExpiresAndStops) {
    verifies("SWR-SUP-005", Technique::kFaultInjection, Polarity::kViolation);
    OrderRig rig;
    rig.report(Point::kZero, 0);
    rig.report(Point::kTwo, 1);

    const SupervisionStatus status = rig.step((1_s).ns);
    EXPECT_EQ(rig.get_status(), EntityStatus::kExpired);
    EXPECT_EQ(status, SupervisionStatus::kStopped);
    expect_not_served(status);
}

TEST(MeasuredDefectsTest, IllegalEdgeThenALegalOneExpires) {
    verifies("SWR-SUP-005", Technique::kFaultInjection, Polarity::kViolation);
    OrderRig rig;
    rig.report(Point::kZero, 0);
    rig.report(Point::kTwo, 1);
    rig.report(Point::kZero, 2);
    rig.report(Point::kOne, 3);

    const SupervisionStatus status = rig.step((1_s).ns);
    EXPECT_EQ(rig.get_status(), EntityStatus::kExpired);
    EXPECT_EQ(rig.get_violation(), Violation::kOrder);
    expect_not_served(status);
}

TEST(MeasuredDefectsTest, LateFinishExpiresAndStops) {
    verifies("SWR-SUP-005", Technique::kFaultInjection, Polarity::kViolation);
    OrderRig rig;
    rig.report(Point::kZero, 0);
    rig.report(Point::kOne, (5_s).ns);

    const SupervisionStatus status = rig.step((5_s).ns);
    EXPECT_EQ(rig.get_status(), EntityStatus::kExpired);
    EXPECT_EQ(status, SupervisionStatus::kStopped);
    expect_not_served(status);
}

TEST(MeasuredDefectsTest, LateFinishThenALegalCheckpointExpires) {
    verifies("SWR-SUP-005", Technique::kFaultInjection, Polarity::kViolation);
    OrderRig rig;
    rig.report(Point::kZero, 0);
    rig.report(Point::kOne, (5_s).ns);
    rig.report(Point::kTwo, (5_s).ns + 1);
    rig.report(Point::kZero, (5_s).ns + 2);

    const SupervisionStatus status = rig.step((6_s).ns);
    EXPECT_EQ(rig.get_status(), EntityStatus::kExpired);
    EXPECT_EQ(rig.get_violation(), Violation::kTooLong);
    expect_not_served(status);
}

TEST(MeasuredDefectsTest, FinishThatNeverComesExpiresOneCycleAfterStartPlusLimit) {
    verifies("SWR-SUP-005", Technique::kFaultInjection, Polarity::kViolation);
    OrderRig rig;
    rig.report(Point::kZero, 0);

    for (std::int64_t cycle = 1; cycle <= 100; ++cycle) {
        const SupervisionStatus status = rig.step((1_s * cycle).ns);
        ASSERT_EQ(rig.get_status(), cycle > 1 ? EntityStatus::kExpired : EntityStatus::kOk) << cycle;
        ASSERT_EQ(status, cycle > 1 ? SupervisionStatus::kStopped : SupervisionStatus::kOk) << cycle;
    }
    EXPECT_EQ(rig.get_violation(), Violation::kMissingFinish);
}

TEST(CheckpointLatchTest, FirstViolationIsKeptThroughLegalAndIllegalOnes) {
    verifies("SWR-SUP-005", Technique::kStateTransition, Polarity::kViolation);
    TimeRig rig;
    rig.report(Point::kZero, 0);
    rig.report(Point::kOne, 5);
    rig.report(Point::kOne, 6);
    rig.report(Point::kZero, 100);
    rig.report(Point::kOne, 150);
    ASSERT_EQ(rig.step(150), SupervisionStatus::kExpired);
    EXPECT_EQ(rig.get_violation(), Violation::kTooShort);

    for (std::int64_t cycle = 1; cycle < 100; ++cycle) {
        rig.report(Point::kZero, cycle * 1000);
        rig.report(Point::kOne, cycle * 1000 + 50);
        ASSERT_EQ(rig.step(cycle * 1000 + 50), SupervisionStatus::kExpired) << cycle;
    }
    EXPECT_EQ(rig.get_violation(), Violation::kTooShort);
}

TEST(CheckpointClockTest, TickZeroIsAnInstantLikeAnyOther) {
    verifies("SWR-SUP-030", Technique::kBoundaryValues);
    TimeRig rig;
    rig.report(Point::kZero, -50);
    rig.report(Point::kOne, 0);
    rig.report(Point::kZero, 0);
    rig.report(Point::kOne, 50);

    EXPECT_EQ(rig.step(50), SupervisionStatus::kOk);
}

TEST(CheckpointClockTest, StartAtTickZeroWithoutAFinishExpires) {
    verifies("SWR-SUP-030", Technique::kBoundaryValues, Polarity::kViolation);
    TimeRig rig;
    rig.report(Point::kZero, 0);
    ASSERT_EQ(rig.step(0), SupervisionStatus::kOk);

    EXPECT_EQ(rig.step(101), SupervisionStatus::kExpired);
}

TEST(CheckpointClockTest, EndsOfTheTimeLineAreInstantsLikeAnyOther) {
    verifies("SWR-SUP-030", Technique::kBoundaryValues);
    TimeRig rig;
    rig.report(Point::kZero, kFirst);
    rig.report(Point::kOne, kFirst + 100);
    ASSERT_EQ(rig.step(kFirst + 100), SupervisionStatus::kOk);
    rig.report(Point::kZero, kLast - 100);
    rig.report(Point::kOne, kLast);

    EXPECT_EQ(rig.step(kLast), SupervisionStatus::kOk);
}

TEST(CheckpointClockTest, LongestDistanceDoesNotWrapIntoTheLimits) {
    verifies("SWR-SUP-030", Technique::kBoundaryValues, Polarity::kViolation);
    TimeRig finished;
    finished.report(Point::kZero, kFirst);
    finished.report(Point::kOne, kLast);
    EXPECT_EQ(finished.step(kLast), SupervisionStatus::kExpired);
    EXPECT_EQ(finished.get_violation(), Violation::kTooLong);

    TimeRig running;
    running.report(Point::kZero, kFirst);
    EXPECT_EQ(running.step(kLast), SupervisionStatus::kExpired);
    EXPECT_EQ(running.get_violation(), Violation::kMissingFinish);
}

TEST(CheckpointClockTest, ClockThatWrapsOverItsEndExpires) {
    verifies("SWR-SUP-030", Technique::kBoundaryValues, Polarity::kViolation);
    TimeRig rig;
    rig.report(Point::kZero, kLast - 10);
    ASSERT_EQ(rig.step(kLast), SupervisionStatus::kOk);
    rig.report(Point::kOne, kFirst + 10);

    EXPECT_EQ(rig.step(kFirst + 20), SupervisionStatus::kExpired) << "30 ns by a counter that wraps";
    EXPECT_EQ(rig.get_violation(), Violation::kClock);
}

TEST(CheckpointClockTest, ReportsAtTheSameInstantAreHealthy) {
    verifies("SWR-SUP-030", Technique::kBoundaryValues);
    OrderRig rig;
    rig.report(Point::kZero, 7);
    rig.report(Point::kOne, 7);
    rig.report(Point::kTwo, 7);

    EXPECT_EQ(rig.step(7), SupervisionStatus::kOk);
    EXPECT_EQ(rig.step(7), SupervisionStatus::kOk);
}

TEST(CheckpointClockTest, ReportBeforeTheOneBeforeExpires) {
    verifies("SWR-SUP-030", Technique::kFaultInjection, Polarity::kViolation);
    OrderRig rig;
    rig.report(Point::kZero, 7);
    rig.report(Point::kOne, 6);

    EXPECT_EQ(rig.step(7), SupervisionStatus::kStopped);
    EXPECT_EQ(rig.get_violation(), Violation::kClock);
}

TEST(CheckpointClockTest, CycleBeforeTheOneBeforeExpires) {
    verifies("SWR-SUP-030", Technique::kFaultInjection, Polarity::kViolation);
    TimeRig rig;
    ASSERT_EQ(rig.step(7), SupervisionStatus::kOk);

    EXPECT_EQ(rig.step(6), SupervisionStatus::kExpired);
    EXPECT_EQ(rig.get_violation(), Violation::kClock);
}

TEST(CheckpointClockTest, ReportMadeWhileTheCycleBeginsCountsForTheNext) {
    verifies("SWR-SUP-030", Technique::kBoundaryValues);
    TimeRig rig;
    rig.report(Point::kZero, 11);
    ASSERT_EQ(rig.step(10), SupervisionStatus::kOk);
    rig.report(Point::kOne, 21);
    ASSERT_EQ(rig.step(20), SupervisionStatus::kOk) << "each cycle another report is early";
    rig.report(Point::kZero, 31);
    ASSERT_EQ(rig.step(30), SupervisionStatus::kOk);
    ASSERT_EQ(rig.step(31), SupervisionStatus::kOk);

    EXPECT_EQ(rig.step(132), SupervisionStatus::kExpired) << "it began a time at 31";
    EXPECT_EQ(rig.get_violation(), Violation::kMissingFinish);
}

TEST(CheckpointClockTest, ReportOfATimeThatDoesNotComeExpires) {
    verifies("SWR-SUP-030", Technique::kFaultInjection, Polarity::kViolation);
    TimeRig rig;
    rig.report(Point::kZero, kLast);
    ASSERT_EQ(rig.step(10), SupervisionStatus::kOk);

    EXPECT_EQ(rig.step(20), SupervisionStatus::kExpired);
    EXPECT_EQ(rig.get_violation(), Violation::kClock);
    ASSERT_EQ(rig.step(30), SupervisionStatus::kExpired);
    ASSERT_EQ(rig.sut.acknowledge(0U), Status::kOk);
    for (std::int64_t cycle = 40; cycle < 80; cycle += 10) {
        EXPECT_EQ(rig.step(cycle), SupervisionStatus::kOk) << "it does not block the reports behind it";
    }
}

}  // namespace
}  // namespace mamori::safety
