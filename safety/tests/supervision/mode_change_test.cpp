// SPDX-License-Identifier: Apache-2.0
// Goal: a change of mode judges all that was under way, and lets nothing of it into the next time. Method: a
// table of three like entities that are active in one mode only; each in turn does what the others do not.
#include <array>
#include <cstdint>

#include "supervision_rig.hpp"

namespace mamori::safety {
namespace {

using namespace verification;
using Violation = CheckpointViolation;

enum class Entity : EntityIndex { kLeft, kMiddle, kRight };
enum class Point : CheckpointIndex { kLeft, kLeftDone, kMiddle, kMiddleDone, kRight, kRightDone };
enum Mode : std::size_t { kIdle, kWork };

constexpr Duration kLongest{50};
constexpr AliveCount kOnceInTwo{1U, 0U, 0U, 2U};

constexpr std::array kEntities{supervise(Entity::kLeft, in_modes(kWork), 1U),
                               supervise(Entity::kMiddle, in_modes(kWork), 1U),
                               supervise(Entity::kRight, in_modes(kIdle, kWork), 1U)};
constexpr std::array kCheckpoints{
    checkpoint(Point::kLeft, Entity::kLeft, CheckpointRole::kInitial),
    checkpoint(Point::kLeftDone, Entity::kLeft, CheckpointRole::kFinal),
    checkpoint(Point::kMiddle, Entity::kMiddle, CheckpointRole::kInitial),
    checkpoint(Point::kMiddleDone, Entity::kMiddle, CheckpointRole::kFinal),
    checkpoint(Point::kRight, Entity::kRight, CheckpointRole::kInitial),
    checkpoint(Point::kRightDone, Entity::kRight, CheckpointRole::kFinal),
};
constexpr std::array kAlives{alive(Point::kLeft, kOnceInTwo), alive(Point::kMiddle, kOnceInTwo),
                             alive(Point::kRight, kOnceInTwo)};
constexpr std::array kDeadlines{deadline(Point::kLeft, Point::kLeftDone, {Duration{0}, kLongest}),
                                deadline(Point::kMiddle, Point::kMiddleDone, {Duration{0}, kLongest}),
                                deadline(Point::kRight, Point::kRightDone, {Duration{0}, kLongest})};
constexpr std::array kEdges{edge(Point::kLeft, Point::kLeftDone), edge(Point::kMiddle, Point::kMiddleDone),
                            edge(Point::kRight, Point::kRightDone)};
constexpr SupervisionTable kTable{kEntities, kCheckpoints, kAlives, kDeadlines, kEdges, 2U, 100U};
static_assert(is_sound<kTable>());

constexpr std::array kSwitched{Entity::kLeft, Entity::kMiddle};

class ModeChangeTest : public ::testing::Test {
  protected:
    ModeChangeTest() { set_mode(kWork); }

    static Point get_first(Entity entity) {
        return static_cast<Point>(2U * static_cast<std::size_t>(entity));
    }
    void begin(Entity entity) { rig_.report_as(entity, get_first(entity), now_); }
    void finish(Entity entity) {
        const auto done = static_cast<Point>(static_cast<std::size_t>(get_first(entity)) + 1U);
        rig_.report_as(entity, done, now_ + 10);
    }
    void run_all_but(Entity one) {
        for (const Entity entity : {Entity::kLeft, Entity::kMiddle, Entity::kRight}) {
            if (entity != one) {
                begin(entity);
                finish(entity);
            }
        }
    }
    void step() {
        now_ += 100;
        static_cast<void>(rig_.step(now_));
    }
    void set_mode(Mode mode) { ASSERT_EQ(rig_.sut.set_mode(mode, Instant{now_}), Status::kOk); }
    Violation get_violation(Entity entity) const {
        return rig_.sut.get_violation(static_cast<EntityIndex>(entity));
    }
    EntityStatus get_status(Entity entity) const {
        return rig_.sut.get_entity_status(static_cast<EntityIndex>(entity));
    }

    SupervisionRig<kTable> rig_{};
    std::int64_t now_{0};
};

TEST_F(ModeChangeTest, ReportsThatNoCycleHasTakenAreJudgedForEachEntity) {
    verifies("SWR-SUP-027", Technique::kStateTransition, Polarity::kViolation);
    for (const Entity entity : kSwitched) {
        finish(entity);  // without a beginning
        now_ += 20;
        set_mode(kIdle);
        EXPECT_EQ(get_violation(entity), Violation::kOrder);
        set_mode(kWork);
    }
}

TEST_F(ModeChangeTest, TimeThatIsOverIsJudgedForEachDeadline) {
    verifies("SWR-SUP-027", Technique::kBoundaryValues, Polarity::kViolation);
    for (const Entity entity : kSwitched) {
        begin(entity);
        now_ += kLongest.ns + 1;
        set_mode(kIdle);
        EXPECT_EQ(get_violation(entity), Violation::kMissingFinish);
        set_mode(kWork);
    }
}

TEST_F(ModeChangeTest, TimeThatIsNotOverIsForgottenForEachDeadline) {
    verifies("SWR-SUP-027", Technique::kBoundaryValues);
    for (const Entity entity : kSwitched) {
        begin(entity);
        now_ += kLongest.ns;
        set_mode(kIdle);
        now_ += 1000;
        set_mode(kWork);
        EXPECT_EQ(get_violation(entity), Violation::kNone);
    }
}

TEST_F(ModeChangeTest, ReportsOfTheTimeBeforeDoNotCountForEachAlive) {
    verifies("SWR-SUP-027", Technique::kStateTransition);
    for (const Entity entity : kSwitched) {
        begin(entity);
        finish(entity);
        step();
        set_mode(kIdle);
        set_mode(kWork);
        begin(entity);
        finish(entity);
        step();
        EXPECT_EQ(get_status(entity), EntityStatus::kOk) << "one report in this reference cycle";
    }
}

TEST_F(ModeChangeTest, EntityThatReportsInNoModeExpiresHoweverOftenTheModeChanges) {
    verifies("SWR-SUP-042", Technique::kStateTransition, Polarity::kViolation);
    for (const Entity entity : kSwitched) {
        // One cycle at a time, and a reference cycle has two. Two silent cycles may be right.
        for (int cycle = 1; cycle <= 4; ++cycle) {
            run_all_but(entity);
            step();
            EXPECT_EQ(get_violation(entity), cycle < 4 ? Violation::kNone : Violation::kAlive) << cycle;
            EXPECT_EQ(get_status(entity), cycle < 3    ? EntityStatus::kOk
                                          : cycle == 3 ? EntityStatus::kFailed
                                                       : EntityStatus::kExpired);
            set_mode(kIdle);
            set_mode(kWork);
        }
    }
}

TEST_F(ModeChangeTest, ReportAfterTheModeChangeEndsTheSilence) {
    verifies("SWR-SUP-042", Technique::kStateTransition);
    for (int change = 0; change < 20; ++change) {
        if (change % 2 == 1) {
            run_all_but(Entity::kRight);
        }
        begin(Entity::kRight);
        finish(Entity::kRight);
        if (change % 2 == 1) {
            step();
        } else {
            step();
            set_mode(kIdle);
            set_mode(kWork);
        }
        ASSERT_EQ(get_status(Entity::kLeft), EntityStatus::kOk) << change;
    }
}

TEST_F(ModeChangeTest, ReportJustBeforeTheModeChangeEndsTheSilence) {
    verifies("SWR-SUP-042", Technique::kBoundaryValues);
    for (int change = 0; change < 20; ++change) {
        step();
        begin(Entity::kLeft);
        finish(Entity::kLeft);
        now_ += 20;
        set_mode(kIdle);
        set_mode(kWork);
        ASSERT_NE(get_violation(Entity::kLeft), Violation::kAlive) << change;
    }
    EXPECT_EQ(get_status(Entity::kLeft), EntityStatus::kOk);
}

TEST_F(ModeChangeTest, BurstJustBeforeTheModeChangeIsWrongForEachAlive) {
    verifies("SWR-SUP-042", Technique::kBoundaryValues, Polarity::kViolation);
    for (const Entity entity : kSwitched) {
        for (const int reports : {1, 2}) {
            for (int i = 0; i < reports; ++i) {
                begin(entity);
                finish(entity);
                now_ += 20;
            }
            set_mode(kIdle);
            set_mode(kWork);
            EXPECT_EQ(get_status(entity), reports == 1 ? EntityStatus::kOk : EntityStatus::kFailed);
        }
    }
}

TEST_F(ModeChangeTest, WrongReferenceCycleIsCountedOnceWhenItEndsWithTheMode) {
    verifies("SWR-SUP-042", Technique::kBoundaryValues);
    for (int i = 0; i < 2; ++i) {
        begin(Entity::kLeft);
        finish(Entity::kLeft);
        now_ += 20;
    }
    step();
    ASSERT_EQ(get_status(Entity::kLeft), EntityStatus::kFailed);
    set_mode(kIdle);
    set_mode(kWork);

    EXPECT_EQ(get_status(Entity::kLeft), EntityStatus::kFailed) << "one wrong one is tolerated";
    EXPECT_EQ(get_violation(Entity::kLeft), Violation::kNone);
}

// Five reports in ten cycles, at most two silent ones in a row.
constexpr std::array kRareEntities{supervise(Only::kEntity, in_modes(kWork), 1U),
                                   supervise(Entity::kMiddle, kEveryMode)};
constexpr std::array kRareCheckpoints{checkpoint(Point::kLeft, Only::kEntity),
                                      checkpoint(Point::kLeftDone, Entity::kMiddle)};
constexpr std::array kRareAlives{alive(Point::kLeft, {6U, 1U, 4U, 10U}),
                                 alive(Point::kLeftDone, {1U, 0U, 29U, 1U})};
constexpr SupervisionTable kRareTable{kRareEntities, kRareCheckpoints, kRareAlives, {}, {}, 2U, 100U};

TEST(PartOfAReferenceCycleTest, IsJudgedInProportionWhenTheModeEndsIt) {
    verifies("SWR-SUP-042", Technique::kBoundaryValues, Polarity::kViolation);
    // Nine of ten cycles: 4.5 reports, so four are enough.
    for (const int reports : {4, 3}) {
        SupervisionRig<kRareTable> rig;
        ASSERT_EQ(rig.sut.set_mode(kWork, Instant{0}), Status::kOk);
        for (int cycle = 1; cycle <= 9; ++cycle) {
            rig.report_as(Entity::kMiddle, Point::kLeftDone, cycle * 100);
            if (cycle % 3 == 0 || (reports == 4 && cycle == 1)) {
                rig.report(Point::kLeft, cycle * 100);
            }
            ASSERT_EQ(rig.step(cycle * 100), SupervisionStatus::kOk) << cycle;
        }
        ASSERT_EQ(rig.sut.set_mode(kIdle, Instant{950}), Status::kOk);
        ASSERT_EQ(rig.sut.set_mode(kWork, Instant{950}), Status::kOk);
        EXPECT_EQ(rig.get_status(), reports == 4 ? EntityStatus::kOk : EntityStatus::kFailed);
    }
}

TEST(PartOfAReferenceCycleTest, ThatWasRightHealsNothing) {
    verifies("SWR-SUP-042", Technique::kStateTransition, Polarity::kViolation);
    SupervisionRig<kRareTable> rig;
    ASSERT_EQ(rig.sut.set_mode(kWork, Instant{0}), Status::kOk);
    std::int64_t now = 0;
    const auto step = [&](bool is_reporting) {
        now += 100;
        rig.report_as(Entity::kMiddle, Point::kLeftDone, now);
        if (is_reporting) {
            rig.report(Point::kLeft, now);
        }
        static_cast<void>(rig.step(now));
    };
    for (int cycle = 0; cycle < 10; ++cycle) {
        step(cycle % 3 == 0 && cycle < 9);
    }
    ASSERT_EQ(rig.get_status(), EntityStatus::kFailed);
    for (int change = 0; change < 5; ++change) {
        step(true);
        ASSERT_EQ(rig.sut.set_mode(kIdle, Instant{now}), Status::kOk);
        ASSERT_EQ(rig.sut.set_mode(kWork, Instant{now}), Status::kOk);
    }

    EXPECT_EQ(rig.get_status(), EntityStatus::kFailed);
}

TEST_F(ModeChangeTest, AcknowledgementForgetsTheWrongReferenceCyclesOfEachAlive) {
    verifies("SWR-SUP-027", Technique::kStateTransition);
    for (const Entity entity : kSwitched) {
        for (int cycle = 0; cycle < 4; ++cycle) {
            if (cycle % 2 == 0) {
                run_all_but(entity);
            }
            step();
        }
        ASSERT_EQ(get_violation(entity), Violation::kAlive) << "two wrong ones, and one is tolerated";
        ASSERT_EQ(rig_.sut.acknowledge(static_cast<EntityIndex>(entity)), Status::kOk);

        run_all_but(entity);
        step();
        step();
        EXPECT_EQ(get_violation(entity), Violation::kNone) << "one wrong one is tolerated again";
        set_mode(kIdle);
        set_mode(kWork);
    }
}

}  // namespace
}  // namespace mamori::safety
