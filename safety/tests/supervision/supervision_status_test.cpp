// SPDX-License-Identifier: Apache-2.0
// Goal: local and global status follow their rules, a mode decides who is supervised, and no change of mode
// hides an expired entity. Method: both sides of each tolerance, changes of mode around each kind of
// violation.
#include "mamori/safety/supervision/supervision_status.hpp"

#include <array>
#include <cstdint>

#include "mamori/kernel/base/constant_init.hpp"
#include "supervision_rig.hpp"

namespace mamori::safety {
namespace {

using namespace verification;
using Violation = CheckpointViolation;

using literals::operator""_ns;

enum class Entity : EntityIndex { kControl, kPlanner };
enum class Point : CheckpointIndex { kRead, kWrite, kPlan, kPlanned };
enum Mode : std::size_t { kIdle, kWork, kTeach, kBeyond };

constexpr std::array kEntities{supervise(Entity::kControl),
                               supervise(Entity::kPlanner, in_modes(kWork, kTeach), 1U)};
constexpr std::array kCheckpoints{
    checkpoint(Point::kRead, Entity::kControl, CheckpointRole::kInitial),
    checkpoint(Point::kWrite, Entity::kControl, CheckpointRole::kFinal),
    checkpoint(Point::kPlan, Entity::kPlanner, CheckpointRole::kInitial),
    checkpoint(Point::kPlanned, Entity::kPlanner, CheckpointRole::kFinal),
};
constexpr std::array kAlives{alive(Point::kRead, {1U, 0U, 0U, 1U}), alive(Point::kPlan, {1U, 0U, 0U, 2U})};
constexpr std::array kDeadlines{deadline(Point::kRead, Point::kWrite, {0_ns, 50_ns}),
                                deadline(Point::kPlan, Point::kPlanned, {0_ns, 150_ns})};
constexpr std::array kEdges{edge(Point::kRead, Point::kWrite), edge(Point::kPlan, Point::kPlanned)};
constexpr SupervisionTable kTable{kEntities, kCheckpoints, kAlives, kDeadlines, kEdges, 3U, 2U};

class SupervisionStatusTest : public ::testing::Test {
  protected:
    void control() {
        rig_.report_as(Entity::kControl, Point::kRead, now_);
        rig_.report_as(Entity::kControl, Point::kWrite, now_ + 10);
    }
    void plan() {
        rig_.report_as(Entity::kPlanner, Point::kPlan, now_ + 20);
        rig_.report_as(Entity::kPlanner, Point::kPlanned, now_ + 30);
    }
    /// Ends a cycle of 100 ns.
    SupervisionStatus step() {
        now_ += 100;
        return rig_.step(now_);
    }
    SupervisionStatus step_with_control() {
        control();
        return step();
    }
    SupervisionStatus step_with_both() {
        plan();
        return step_with_control();
    }
    void set_mode(Mode mode) { ASSERT_EQ(rig_.sut.set_mode(mode, Instant{now_}), Status::kOk); }
    EntityStatus get_control() const { return rig_.sut.get_entity_status(0U); }
    EntityStatus get_planner() const { return rig_.sut.get_entity_status(1U); }
    Status acknowledge(Entity entity) { return rig_.sut.acknowledge(static_cast<EntityIndex>(entity)); }

    SupervisionRig<kTable> rig_{};
    std::int64_t now_{0};
};

TEST(CheckpointViolationTest, NumbersThatAreStoredOverAResetAreTheseForEver) {
    verifies("SWR-SUP-036", Technique::kInterface);
    constexpr std::array kInOrder{Violation::kNone,    Violation::kLostReport,    Violation::kForeign,
                                  Violation::kClock,   Violation::kOrder,         Violation::kTooShort,
                                  Violation::kTooLong, Violation::kMissingFinish, Violation::kMissingStart,
                                  Violation::kAlive};

    for (std::size_t number = 0U; number < kInOrder.size(); ++number) {
        EXPECT_EQ(static_cast<std::size_t>(kInOrder[number]), number);
    }
    EXPECT_EQ(kCheckpointViolationMax, kInOrder.size() - 1U);
}

TEST_F(SupervisionStatusTest, NothingIsProvenBeforeTheFirstCycle) {
    verifies("SWR-SUP-028", Technique::kStateTransition, Polarity::kViolation);

    EXPECT_EQ(rig_.sut.get_status(), SupervisionStatus::kFailed);
    EXPECT_EQ(get_control(), EntityStatus::kOk);
    EXPECT_EQ(get_planner(), EntityStatus::kDeactivated);
    EXPECT_EQ(rig_.sut.get_first_expired(), kNoEntity);
}

TEST_F(SupervisionStatusTest, WholeIsOkWhileEachActiveEntityIs) {
    verifies("SWR-SUP-028");

    for (int cycle = 0; cycle < 100; ++cycle) {
        ASSERT_EQ(step_with_control(), SupervisionStatus::kOk) << cycle;
    }
    EXPECT_EQ(rig_.sut.get_status(), SupervisionStatus::kOk);
}

TEST_F(SupervisionStatusTest, WholeIsAsBadAsTheWorstEntity) {
    verifies("SWR-SUP-028", Technique::kEquivalenceClasses, Polarity::kViolation);
    set_mode(kWork);
    ASSERT_EQ(step_with_both(), SupervisionStatus::kOk);
    ASSERT_EQ(step_with_control(), SupervisionStatus::kOk);

    ASSERT_EQ(step_with_control(), SupervisionStatus::kOk);
    EXPECT_EQ(step_with_control(), SupervisionStatus::kFailed) << "the planner did not plan in two cycles";
    EXPECT_EQ(get_planner(), EntityStatus::kFailed);
    EXPECT_EQ(step(), SupervisionStatus::kExpired) << "control was silent: the worse one counts";
    EXPECT_EQ(get_control(), EntityStatus::kExpired);
}

TEST_F(SupervisionStatusTest, ExpiredForLongerThanToleratedIsStopped) {
    verifies("SWR-SUP-028", Technique::kBoundaryValues, Polarity::kViolation);
    ASSERT_EQ(step_with_control(), SupervisionStatus::kOk);

    EXPECT_EQ(step(), SupervisionStatus::kExpired);
    EXPECT_EQ(step_with_control(), SupervisionStatus::kExpired) << "as many cycles as tolerated";
    EXPECT_EQ(step_with_control(), SupervisionStatus::kStopped);
}

TEST_F(SupervisionStatusTest, StoppedIsForGood) {
    verifies("SWR-SUP-028", Technique::kStateTransition, Polarity::kViolation);
    ASSERT_EQ(step(), SupervisionStatus::kExpired);
    ASSERT_EQ(step(), SupervisionStatus::kExpired);
    ASSERT_EQ(step(), SupervisionStatus::kStopped);

    EXPECT_EQ(acknowledge(Entity::kControl), Status::kPreconditionNotMet);
    set_mode(kWork);
    EXPECT_EQ(step_with_both(), SupervisionStatus::kStopped);
    EXPECT_EQ(get_control(), EntityStatus::kExpired);
}

TEST_F(SupervisionStatusTest, StoppedOutlivesASpoiledLocalStatus) {
    verifies("SWR-SUP-028", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_EQ(step(), SupervisionStatus::kExpired);
    ASSERT_EQ(step(), SupervisionStatus::kExpired);
    ASSERT_EQ(step(), SupervisionStatus::kStopped);
    rig_.storage.entities[0].violation = Violation::kNone;

    EXPECT_EQ(step_with_control(), SupervisionStatus::kStopped);
}

TEST_F(SupervisionStatusTest, AcknowledgementInTimeStartsTheToleranceAnew) {
    verifies("SWR-SUP-028", Technique::kStateTransition);
    ASSERT_EQ(step(), SupervisionStatus::kExpired);
    ASSERT_EQ(step(), SupervisionStatus::kExpired);
    ASSERT_EQ(acknowledge(Entity::kControl), Status::kOk);
    ASSERT_EQ(step_with_control(), SupervisionStatus::kOk);

    EXPECT_EQ(step(), SupervisionStatus::kExpired);
    EXPECT_EQ(step(), SupervisionStatus::kExpired);
    EXPECT_EQ(step(), SupervisionStatus::kStopped);
}

TEST_F(SupervisionStatusTest, StatusForTheWatchdogIsOkOnlyWhenAllIs) {
    verifies("SWR-SUP-028", Technique::kEquivalenceClasses, Polarity::kViolation);

    EXPECT_EQ(to_global_status(SupervisionStatus::kOk), GlobalStatus::kOk);
    EXPECT_EQ(to_global_status(SupervisionStatus::kFailed), GlobalStatus::kFailed);
    EXPECT_EQ(to_global_status(SupervisionStatus::kExpired), GlobalStatus::kExpired);
    EXPECT_EQ(to_global_status(SupervisionStatus::kStopped), GlobalStatus::kExpired);
    EXPECT_EQ(to_global_status(static_cast<SupervisionStatus>(77)), GlobalStatus::kExpired);
    EXPECT_EQ(calc_worst(GlobalStatus::kOk, GlobalStatus::kExpired), GlobalStatus::kExpired);
    EXPECT_EQ(calc_worst(GlobalStatus::kFailed, GlobalStatus::kOk), GlobalStatus::kFailed);
    EXPECT_EQ(calc_worst(GlobalStatus::kOk, GlobalStatus::kOk), GlobalStatus::kOk);
}

TEST_F(SupervisionStatusTest, FirstExpiredEntityIsNamedUntilAllAreAcknowledged) {
    verifies("SWR-SUP-026");
    set_mode(kWork);
    rig_.report_as(Entity::kPlanner, Point::kPlanned, now_);
    ASSERT_EQ(step_with_control(), SupervisionStatus::kExpired);
    ASSERT_EQ(rig_.sut.get_first_expired(), 1U);
    ASSERT_EQ(step(), SupervisionStatus::kExpired);

    EXPECT_EQ(get_control(), EntityStatus::kExpired);
    EXPECT_EQ(rig_.sut.get_first_expired(), 1U);
    ASSERT_EQ(acknowledge(Entity::kPlanner), Status::kOk);
    ASSERT_EQ(acknowledge(Entity::kControl), Status::kOk);
    ASSERT_EQ(step_with_both(), SupervisionStatus::kOk);
    EXPECT_EQ(rig_.sut.get_first_expired(), kNoEntity);
}

TEST_F(SupervisionStatusTest, LaterExpiredEntityDoesNotTakeThePlaceOfTheFirst) {
    verifies("SWR-SUP-026", Technique::kStateTransition, Polarity::kViolation);
    set_mode(kWork);
    rig_.report_as(Entity::kPlanner, Point::kPlan, now_);
    ASSERT_EQ(step(), SupervisionStatus::kExpired);
    ASSERT_EQ(rig_.sut.get_first_expired(), 0U);
    ASSERT_EQ(step(), SupervisionStatus::kExpired);

    EXPECT_EQ(get_planner(), EntityStatus::kExpired) << "its time is over";
    EXPECT_EQ(rig_.sut.get_first_expired(), 0U);
    EXPECT_EQ(rig_.memory.read().entity, 0U);
}

TEST_F(SupervisionStatusTest, ModeDecidesWhoIsSupervised) {
    verifies("SWR-SUP-029");
    EXPECT_EQ(rig_.sut.get_mode(), kIdle);
    ASSERT_EQ(step_with_control(), SupervisionStatus::kOk) << "nobody plans";

    set_mode(kWork);
    EXPECT_EQ(rig_.sut.get_mode(), kWork);
    EXPECT_EQ(get_planner(), EntityStatus::kOk);
    ASSERT_EQ(step_with_both(), SupervisionStatus::kOk);
    ASSERT_EQ(step_with_control(), SupervisionStatus::kOk);
    set_mode(kTeach);
    ASSERT_EQ(step_with_both(), SupervisionStatus::kOk) << "goes on, since both modes want it";
    set_mode(kIdle);
    EXPECT_EQ(get_planner(), EntityStatus::kDeactivated);
    for (int cycle = 0; cycle < 10; ++cycle) {
        ASSERT_EQ(step_with_control(), SupervisionStatus::kOk) << cycle;
    }
}

TEST_F(SupervisionStatusTest, ReportsOfADeactivatedEntityAreIgnored) {
    verifies("SWR-SUP-029", Technique::kEquivalenceClasses);

    for (int cycle = 0; cycle < 100; ++cycle) {
        rig_.report_as(Entity::kPlanner, Point::kPlanned, now_);
        rig_.report_as(Entity::kPlanner, Point::kRead, now_ - 1);
        ASSERT_EQ(step_with_control(), SupervisionStatus::kOk) << "neither illegal ones nor too many";
    }
    EXPECT_EQ(get_planner(), EntityStatus::kDeactivated);
}

TEST_F(SupervisionStatusTest, ReportOfATimeToComeOfADeactivatedEntityIsIgnored) {
    verifies("SWR-SUP-029", Technique::kErrorGuessing);
    rig_.report_as(Entity::kPlanner, Point::kPlan, 1000000);

    for (int cycle = 0; cycle < 10; ++cycle) {
        ASSERT_EQ(step_with_control(), SupervisionStatus::kOk);
    }
    EXPECT_EQ(get_planner(), EntityStatus::kDeactivated);
}

TEST_F(SupervisionStatusTest, ActivatedEntityIsSupervisedFromThenOn) {
    verifies("SWR-SUP-029", Technique::kStateTransition, Polarity::kViolation);
    ASSERT_EQ(step_with_control(), SupervisionStatus::kOk);
    set_mode(kWork);
    ASSERT_EQ(step_with_control(), SupervisionStatus::kOk);

    EXPECT_EQ(step_with_control(), SupervisionStatus::kFailed) << "its first reference cycle is a whole one";
    EXPECT_EQ(get_planner(), EntityStatus::kFailed);
}

TEST_F(SupervisionStatusTest, EntityThatIsLeftInMidRunBeginsAnew) {
    verifies("SWR-SUP-029", Technique::kStateTransition);
    set_mode(kWork);
    rig_.report_as(Entity::kPlanner, Point::kPlan, now_);
    ASSERT_EQ(step_with_control(), SupervisionStatus::kOk);
    set_mode(kIdle);
    for (int cycle = 0; cycle < 10; ++cycle) {
        ASSERT_EQ(step_with_control(), SupervisionStatus::kOk) << "its time does not run";
    }
    set_mode(kWork);

    EXPECT_EQ(step_with_both(), SupervisionStatus::kOk);
}

TEST_F(SupervisionStatusTest, EntityThatBothModesWantIsNotDisturbed) {
    verifies("SWR-SUP-029", Technique::kStateTransition);
    rig_.report_as(Entity::kControl, Point::kRead, 0);
    ASSERT_EQ(rig_.sut.set_mode(kWork, Instant{5}), Status::kOk);
    rig_.report_as(Entity::kControl, Point::kWrite, 10);

    EXPECT_EQ(step(), SupervisionStatus::kOk) << "its run goes on";
}

TEST_F(SupervisionStatusTest, EntityThatIsLeftDoesNotEndTheTimeOfAnother) {
    verifies("SWR-SUP-029", Technique::kStateTransition, Polarity::kViolation);
    set_mode(kWork);
    rig_.report_as(Entity::kControl, Point::kRead, 0);
    ASSERT_EQ(rig_.sut.set_mode(kIdle, Instant{5}), Status::kOk);

    EXPECT_EQ(rig_.step(51), SupervisionStatus::kExpired);
    EXPECT_EQ(rig_.sut.get_violation(0U), Violation::kMissingFinish);
}

TEST_F(SupervisionStatusTest, ReportOfALaterTimeCountsForTheModeToCome) {
    verifies("SWR-SUP-029", Technique::kBoundaryValues);
    plan();
    control();
    ASSERT_EQ(rig_.step(10), SupervisionStatus::kOk);
    now_ = 10;
    set_mode(kWork);
    ASSERT_EQ(step_with_control(), SupervisionStatus::kOk);

    EXPECT_EQ(get_planner(), EntityStatus::kOk);
    EXPECT_EQ(rig_.storage.alives[1].count, 1U) << "of 20 ns, when it was active";
}

TEST_F(SupervisionStatusTest, UnknownModeIsRefused) {
    verifies("SWR-SUP-029", Technique::kInterface, Polarity::kViolation);

    EXPECT_EQ(rig_.sut.set_mode(kBeyond, Instant{0}), Status::kBadParameter);
    EXPECT_EQ(rig_.sut.get_mode(), kIdle);
}

TEST_F(SupervisionStatusTest, ExpiredEntityStaysExpiredInEveryMode) {
    verifies("SWR-SUP-027", Technique::kStateTransition, Polarity::kViolation);
    set_mode(kWork);
    rig_.report_as(Entity::kPlanner, Point::kPlanned, now_);
    ASSERT_EQ(step_with_control(), SupervisionStatus::kExpired);

    for (const Mode mode : {kIdle, kTeach, kWork}) {
        set_mode(mode);
        EXPECT_EQ(get_planner(), EntityStatus::kExpired) << mode;
    }
    EXPECT_EQ(step_with_both(), SupervisionStatus::kExpired);
    EXPECT_EQ(rig_.sut.get_violation(1U), Violation::kOrder)
        << "of two violations of one report the order is judged first";
}

TEST_F(SupervisionStatusTest, ChangeOfModeDoesNotHideAReportThatWasNotJudgedYet) {
    verifies("SWR-SUP-027", Technique::kFaultInjection, Polarity::kViolation);
    set_mode(kWork);
    rig_.report_as(Entity::kPlanner, Point::kPlanned, now_);

    set_mode(kIdle);
    EXPECT_EQ(get_planner(), EntityStatus::kExpired);
    EXPECT_EQ(step_with_control(), SupervisionStatus::kExpired);
}

TEST_F(SupervisionStatusTest, ChangeOfModeDoesNotHideATimeThatIsOver) {
    verifies("SWR-SUP-027", Technique::kBoundaryValues, Polarity::kViolation);
    set_mode(kWork);
    rig_.report_as(Entity::kPlanner, Point::kPlan, now_);
    ASSERT_EQ(step_with_control(), SupervisionStatus::kOk);

    ASSERT_EQ(rig_.sut.set_mode(kIdle, Instant{151}), Status::kOk);
    EXPECT_EQ(get_planner(), EntityStatus::kExpired);
    EXPECT_EQ(rig_.sut.get_violation(1U), Violation::kMissingFinish);
}

TEST_F(SupervisionStatusTest, TimeThatIsNotOverEndsWithItsMode) {
    verifies("SWR-SUP-027", Technique::kBoundaryValues);
    set_mode(kWork);
    rig_.report_as(Entity::kPlanner, Point::kPlan, now_);
    ASSERT_EQ(step_with_control(), SupervisionStatus::kOk);

    ASSERT_EQ(rig_.sut.set_mode(kIdle, Instant{150}), Status::kOk);
    EXPECT_EQ(get_planner(), EntityStatus::kDeactivated);
}

TEST_F(SupervisionStatusTest, ChangesOfModeDoNotWipeWrongReferenceCycles) {
    verifies("SWR-SUP-027", Technique::kFaultInjection, Polarity::kViolation);
    set_mode(kWork);
    ASSERT_EQ(step_with_control(), SupervisionStatus::kOk);
    ASSERT_EQ(step_with_control(), SupervisionStatus::kFailed);
    set_mode(kIdle);
    ASSERT_EQ(step_with_control(), SupervisionStatus::kOk);
    set_mode(kWork);

    EXPECT_EQ(get_planner(), EntityStatus::kFailed);
    EXPECT_EQ(step_with_control(), SupervisionStatus::kExpired)
        << "the second wrong one: three cycles without a report";
}

TEST_F(SupervisionStatusTest, ClockThatRunsBackwardsAtAChangeOfModeExpiresWhoIsActive) {
    verifies("SWR-SUP-027", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_EQ(step_with_control(), SupervisionStatus::kOk);

    ASSERT_EQ(rig_.sut.set_mode(kWork, Instant{99}), Status::kOk);
    EXPECT_EQ(get_control(), EntityStatus::kExpired);
    EXPECT_EQ(rig_.sut.get_violation(0U), Violation::kClock);
    EXPECT_EQ(get_planner(), EntityStatus::kOk) << "was not active";
}

TEST_F(SupervisionStatusTest, AcknowledgementIsTheWayBack) {
    verifies("SWR-SUP-027", Technique::kStateTransition);
    rig_.report_as(Entity::kControl, Point::kRead, now_);
    ASSERT_EQ(step(), SupervisionStatus::kExpired) << "no finish within 50 ns";
    ASSERT_EQ(acknowledge(Entity::kControl), Status::kOk);
    EXPECT_EQ(get_control(), EntityStatus::kOk);
    EXPECT_EQ(rig_.sut.get_violation(0U), Violation::kNone);

    ASSERT_EQ(step_with_control(), SupervisionStatus::kOk) << "begins with an initial checkpoint";
    EXPECT_EQ(step(), SupervisionStatus::kExpired) << "and is supervised as before";
}

TEST_F(SupervisionStatusTest, AcknowledgementForgetsWrongReferenceCycles) {
    verifies("SWR-SUP-027", Technique::kStateTransition);
    set_mode(kWork);
    for (int cycle = 0; cycle < 4; ++cycle) {
        static_cast<void>(step_with_control());
    }
    ASSERT_EQ(get_planner(), EntityStatus::kExpired);
    ASSERT_EQ(acknowledge(Entity::kPlanner), Status::kOk);

    ASSERT_EQ(step_with_control(), SupervisionStatus::kOk);
    EXPECT_EQ(step_with_control(), SupervisionStatus::kFailed) << "the first wrong one again";
}

TEST_F(SupervisionStatusTest, AcknowledgedEntityGoesOnByTheClockThatWasSetBack) {
    verifies("SWR-SUP-027", Technique::kStateTransition);
    ASSERT_EQ(step_with_control(), SupervisionStatus::kOk);
    now_ = -1000;
    ASSERT_EQ(step(), SupervisionStatus::kExpired);
    ASSERT_EQ(rig_.sut.get_violation(0U), Violation::kClock);
    ASSERT_EQ(acknowledge(Entity::kControl), Status::kOk);

    EXPECT_EQ(step_with_control(), SupervisionStatus::kOk);
}

TEST_F(SupervisionStatusTest, AcknowledgedEntityThatTheModeDoesNotWantIsDeactivated) {
    verifies("SWR-SUP-027", Technique::kStateTransition);
    set_mode(kWork);
    rig_.report_as(Entity::kPlanner, Point::kPlanned, now_);
    set_mode(kIdle);
    ASSERT_EQ(get_planner(), EntityStatus::kExpired);

    ASSERT_EQ(acknowledge(Entity::kPlanner), Status::kOk);
    EXPECT_EQ(get_planner(), EntityStatus::kDeactivated);
    EXPECT_EQ(step_with_control(), SupervisionStatus::kOk);
}

TEST_F(SupervisionStatusTest, AcknowledgementInMidRunExpiresAgain) {
    verifies("SWR-SUP-027", Technique::kErrorGuessing, Polarity::kViolation);
    rig_.report_as(Entity::kControl, Point::kRead, now_);
    ASSERT_EQ(step(), SupervisionStatus::kExpired);
    ASSERT_EQ(acknowledge(Entity::kControl), Status::kOk);
    rig_.report_as(Entity::kControl, Point::kWrite, now_);

    EXPECT_EQ(step(), SupervisionStatus::kExpired) << "the hung run came to its end after all";
}

TEST_F(SupervisionStatusTest, AcknowledgementOfWhatIsNotExpiredIsRefused) {
    verifies("SWR-SUP-027", Technique::kInterface, Polarity::kViolation);

    EXPECT_EQ(rig_.sut.acknowledge(2U), Status::kBadParameter);
    EXPECT_EQ(rig_.sut.acknowledge(kNoEntity), Status::kBadParameter);
    EXPECT_EQ(acknowledge(Entity::kControl), Status::kPreconditionNotMet);
    EXPECT_EQ(acknowledge(Entity::kPlanner), Status::kPreconditionNotMet) << "deactivated";
}

MAMORI_CONSTINIT SupervisionStorage<kTable> constant_storage;
ExpiryStorage constant_expiry;
MAMORI_CONSTINIT ExpiryMemory constant_memory{constant_expiry};
MAMORI_CONSTINIT CheckpointSupervisor constant_supervisor{constant_storage, constant_memory};

TEST_F(SupervisionStatusTest, SupervisorIsAConstantOfTheProgramImage) {
    verifies("SWR-SUP-029", Technique::kInterface);

    EXPECT_EQ(constant_supervisor.get_entity_status(0U), EntityStatus::kOk);
    EXPECT_EQ(constant_supervisor.get_entity_status(1U), EntityStatus::kDeactivated);
}

}  // namespace
}  // namespace mamori::safety
