// SPDX-License-Identifier: Apache-2.0
// Goal: the safe mode is reached whoever is missing and however long, and nothing that comes again after the
// frame numbers have wrapped is taken for what was there before. Method: the robot of support/mode_system.hpp
// with a core that is away, thousands of frames where numbers wrap.
#include <gtest/gtest.h>

#include "mamori/trace/verifies.hpp"
#include "support/mode_system.hpp"

namespace mamori {
namespace {

using namespace testing_support;
using namespace verification;

constexpr std::int64_t kFrameNumbers = 65536;  ///< that a plan can tell apart

class ModeRecoveryTest : public ::testing::Test {
  protected:
    void SetUp() override { ASSERT_TRUE(sut_.begin()); }
    void go_to_work() {
        ASSERT_EQ(sut_.modes.request(Command::kStart), Status::kOk);
        sut_.run_frames(8);
        ASSERT_EQ(sut_.modes.get_mode(), kWork);
    }

    Robot sut_;
};

TEST_F(ModeRecoveryTest, TheSafeModeIsReachedWithoutTheLead) {
    verifies("SWR-MOD-007", Technique::kFaultInjection, Polarity::kViolation);
    go_to_work();
    ASSERT_EQ(sut_.modes.request_safe_mode(), Status::kOk);
    for (int frame = 0; frame < 7; ++frame) {
        EXPECT_EQ(sut_.get_state(sut_.drive), LifecycleState::kActive) << frame;
        static_cast<void>(sut_.run_core(1U));
    }
    EXPECT_EQ(sut_.get_state(sut_.drive), LifecycleState::kInactive)
        << "six frames of patience, then its step";
    EXPECT_EQ(sut_.modes.get_step(), ModeStep::kSafe);
    EXPECT_EQ(sut_.get_state(sut_.guard), LifecycleState::kActive);
}

TEST_F(ModeRecoveryTest, TheLeadThatServesAFailureIsNotOvertaken) {
    verifies("SWR-MOD-006", Technique::kBoundaryValues);
    go_to_work();
    for (int i = 0; i < 2; ++i) {
        ASSERT_EQ(sut_.modes.request_safe_mode(), Status::kOk);
        sut_.run_frames(9);
        EXPECT_EQ(sut_.modes.get_mode(), kHalt);
    }
    EXPECT_EQ(sut_.observers[1].steps.size(), 3U) << "leave, enter, safe: once each";
}

TEST_F(ModeRecoveryTest, ACoreThatWasAwayForAnyTimeTakesTheSafeStepWhenItReturns) {
    verifies("SWR-MOD-006", Technique::kBoundaryValues, Polarity::kViolation);
    for (const std::int64_t away : {std::int64_t{1000}, kFrameNumbers / 2 + 4, kFrameNumbers - 8}) {
        Robot robot;
        ASSERT_TRUE(robot.begin());
        ASSERT_EQ(robot.modes.request(Command::kStart), Status::kOk);
        robot.run_frames(8);
        ASSERT_EQ(robot.modes.request_safe_mode(), Status::kOk);
        for (std::int64_t frame = 0; frame < away; ++frame) {
            static_cast<void>(robot.run_core(0U));
            robot.miss_frame(1U);
        }
        ASSERT_EQ(robot.get_state(robot.planner), LifecycleState::kInactive);
        const std::int64_t cycles = robot.drive.cycle_count;
        robot.run_frames(4);

        EXPECT_EQ(robot.drive.cycle_count, cycles) << away;
        EXPECT_EQ(robot.get_active(), "monitor guard ") << away;
        EXPECT_EQ(robot.modes.get_mode(), kHalt) << away;
    }
}

TEST_F(ModeRecoveryTest, TheSameSetIsTakenAgainWhenItsPlanHasTheSameWord) {
    verifies("SWR-MOD-008", Technique::kBoundaryValues, Polarity::kViolation);
    ConfigurationAdmin& configuration = sut_.modes.get_configuration();
    ASSERT_EQ(configuration.activate_configuration_set(0U), Status::kOk);
    sut_.run_frames(6);
    ASSERT_EQ(sut_.planner.speed.get(), 0.5);
    ASSERT_EQ(configuration.set_value(sut_.planner.speed, 1.5), Status::kOk);
    sut_.run_frames(kFrameNumbers - 6);
    ASSERT_EQ(sut_.planner.speed.get(), 1.5);
    ASSERT_EQ(configuration.activate_configuration_set(0U), Status::kOk);
    sut_.run_frames(6);

    EXPECT_EQ(sut_.planner.speed.get(), 0.5);
}

TEST_F(ModeRecoveryTest, ASafeModeThatIsAskedForWhileNothingRunsHoldsFromTheStart) {
    verifies("SWR-MOD-007", Technique::kStateTransition, Polarity::kViolation);
    go_to_work();
    for (Executive* core : sut_.cores) {
        ASSERT_EQ(core->stop(), Status::kOk);
    }
    ASSERT_EQ(sut_.modes.request_safe_mode(), Status::kOk);
    const std::int64_t cycles = sut_.drive.cycle_count;
    ASSERT_TRUE(sut_.start());

    EXPECT_EQ(sut_.get_active(), "monitor guard ");
    EXPECT_EQ(sut_.modes.get_mode(), kHalt);
    sut_.run_frames(3);
    EXPECT_EQ(sut_.drive.cycle_count, cycles);
}

/// One core; each mode has a set of its own.
TEST(SafeModeSetTest, TheSafeModeBringsItsOwnSetWhereverItIsEnteredFrom) {
    verifies("SWR-MOD-007", Technique::kFaultInjection, Polarity::kViolation);
    std::array<ModeHost, 1U> hosts;
    const TroublePlan plan{};
    Part guard{"guard", 1, hosts[0], plan};
    Part drive{"drive", 2, hosts[0], plan};
    const auto table = system(frame(1000_ns), window("w", 0_ns, 900_ns, budget(800_ns), run(guard, drive)),
                              configuration_set("fast", assign(guard.speed, 2.0)),
                              configuration_set("crawl", assign(guard.speed, 0.2)),
                              system_mode("work", runs(guard, drive), parameters("fast")),
                              safe_mode("halt", runs(guard), parameters("crawl")));
    SystemModes modes{make_view(table)};
    ExecutiveFor sut{table, modes};
    ASSERT_EQ(sut.initialize(), Status::kOk);
    ASSERT_EQ(sut.start(), Status::kOk);
    std::int64_t frame_number = 0;
    const auto run_frames = [&](int count) {
        for (int i = 0; i < count; ++i, ++frame_number) {
            hosts[0].now = Instant{frame_number * 1000};
            ASSERT_EQ(sut.run_window(0U, hosts[0].now, hosts[0]), WindowOutcome::kCompleted);
        }
    };
    run_frames(2);
    ASSERT_EQ(guard.speeds.back(), 2.0);

    ASSERT_EQ(modes.request_safe_mode(), Status::kOk);
    run_frames(8);
    EXPECT_EQ(modes.get_mode(), 1U);
    EXPECT_EQ(guard.speeds.back(), 0.2);

    ASSERT_EQ(sut.stop(), Status::kOk);
    ASSERT_EQ(sut.start(), Status::kOk);
    run_frames(1);
    EXPECT_EQ(guard.speeds.back(), 0.2) << "it is still the safe mode";
    ASSERT_EQ(sut.stop(), Status::kOk);
    ASSERT_EQ(modes.reset(), Status::kOk);
    ASSERT_EQ(sut.start(), Status::kOk);
    run_frames(1);
    EXPECT_EQ(guard.speeds.back(), 2.0);
}

TEST(ModePlanTest, WhatSeemsFurtherAheadThanAnybodyPlansIsOld) {
    verifies("SWR-MOD-006", Technique::kBoundaryValues);
    constexpr ModePlan kPlan{ModeStep::kSafe, 3U, 100};

    EXPECT_EQ(kPlan.calc_age(100 - ModePlan::kAheadMax), -ModePlan::kAheadMax);
    EXPECT_EQ(kPlan.calc_age(100), 0);
    EXPECT_EQ(kPlan.calc_age(100 + 32767), 32767);
    EXPECT_EQ(kPlan.calc_age(100 + 32768), 32767);
    EXPECT_EQ(kPlan.calc_age(100 + kFrameNumbers - ModePlan::kAheadMax - 1), 32767);
    EXPECT_EQ(kPlan.get_index(), 3U);
}

}  // namespace
}  // namespace mamori
