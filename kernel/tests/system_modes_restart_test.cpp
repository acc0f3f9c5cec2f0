// SPDX-License-Identifier: Apache-2.0
// Goal: requests that meet each other, a stop, a restart or a reset are served, kept or forgotten as
// declared, and each step falls into the one frame that all cores expect. Method: the robot of
// support/mode_system.hpp, frame by frame; SystemModes alone where no executive would bring it into the
// state.
#include <gtest/gtest.h>

#include "mamori/trace/verifies.hpp"
#include "support/mode_system.hpp"

namespace mamori {
namespace {

using namespace testing_support;
using namespace verification;
using Steps = std::vector<ModeObserver::Step>;

constexpr std::size_t kSlowSet = 0U;
constexpr std::size_t kFastSet = 1U;

class SystemModesRestartTest : public ::testing::Test {
  protected:
    void SetUp() override { ASSERT_TRUE(sut_.begin()); }
    ConfigurationAdmin& configuration() { return sut_.modes.get_configuration(); }
    double get_speed() const { return sut_.planner.speed.get(); }
    void go(Command command) {
        ASSERT_EQ(sut_.modes.request(command), Status::kOk);
        sut_.run_frames(8);
    }
    void take_set(std::size_t set) {
        ASSERT_EQ(configuration().activate_configuration_set(set), Status::kOk);
        sut_.run_frames(5);
    }
    /// A value that no set has, so that a set which is activated afterwards shows.
    void set_speed() {
        ASSERT_EQ(configuration().set_value(sut_.planner.speed, 1.5), Status::kOk);
        sut_.run_frames(1);
        ASSERT_EQ(get_speed(), 1.5);
    }
    void stop() {
        for (Executive* core : sut_.cores) {
            ASSERT_EQ(core->stop(), Status::kOk);
        }
    }

    Robot sut_;
};

TEST_F(SystemModesRestartTest, ASetAndAModeThatAreAskedForInOneFrameAreBothServed) {
    verifies("SWR-MOD-004", Technique::kErrorGuessing);
    ASSERT_EQ(configuration().activate_configuration_set(kSlowSet), Status::kOk);
    go(Command::kStart);
    EXPECT_EQ(sut_.modes.get_mode(), kWork);
    sut_.run_frames(5);

    EXPECT_EQ(sut_.modes.get_mode(), kWork);
    EXPECT_EQ(get_speed(), 0.5) << "the set waited for the end of the switch";
}

TEST_F(SystemModesRestartTest, AModeMayBeAskedForWhileASetIsUnderWay) {
    verifies("SWR-MOD-004", Technique::kStateTransition);
    ASSERT_EQ(configuration().activate_configuration_set(kSlowSet), Status::kOk);
    sut_.run_frames(1);
    ASSERT_EQ(sut_.modes.get_step(), ModeStep::kSet);

    EXPECT_EQ(sut_.modes.request(Command::kStart), Status::kOk);
    sut_.run_frames(12);
    EXPECT_EQ(sut_.modes.get_mode(), kWork);
}

TEST_F(SystemModesRestartTest, TheModeIsThatOfBeforeUntilTheLastStepIsOver) {
    verifies("SWR-MOD-005", Technique::kBoundaryValues);
    ASSERT_EQ(sut_.modes.request(Command::kStart), Status::kOk);  // leaves in frame 1, enters in frame 4
    for (std::int64_t frame = 0; frame < 6; ++frame) {
        sut_.run_frames(1);
        EXPECT_EQ(sut_.modes.get_mode(), kIdle) << frame;
    }
    sut_.run_frames(1);
    EXPECT_EQ(sut_.modes.get_mode(), kWork);
}

TEST_F(SystemModesRestartTest, AModeThatCouldNotBeEnteredIsNeverTheCurrentOne) {
    verifies("SWR-MOD-007", Technique::kFaultInjection, Polarity::kViolation);
    sut_.plan = {&sut_.planner, true, testing_support::Trouble::kRefusal};
    ASSERT_EQ(sut_.modes.request(Command::kStart), Status::kOk);
    for (std::int64_t frame = 0; frame < 9; ++frame) {
        sut_.run_frames(1);
        EXPECT_EQ(sut_.modes.get_mode(), kIdle) << frame;
    }
    sut_.run_frames(1);

    EXPECT_EQ(sut_.modes.get_mode(), kHalt);
    const Steps expected{
        {ModeStep::kLeave, kWork, 1}, {ModeStep::kEnter, kWork, 4}, {ModeStep::kSafe, kHalt, 7}};
    EXPECT_EQ(sut_.observers[0].steps, expected);
    EXPECT_EQ(sut_.observers[1].steps, expected);
}

TEST_F(SystemModesRestartTest, AllCoresTakeTheSafeModeInTheFrameAfterItIsAskedFor) {
    verifies("SWR-MOD-006", Technique::kBoundaryValues);
    sut_.run_frames(3);
    ASSERT_EQ(sut_.modes.request_safe_mode(), Status::kOk);  // seen in frame 3
    sut_.run_frames(6);

    const Steps expected{{ModeStep::kSafe, kHalt, 4}};
    EXPECT_EQ(sut_.observers[0].steps, expected);
    EXPECT_EQ(sut_.observers[1].steps, expected);
}

TEST_F(SystemModesRestartTest, AnotherCoreWaitsTwoStepsForALeadThatComesNoMore) {
    verifies("SWR-MOD-006", Technique::kBoundaryValues, Polarity::kViolation);
    ASSERT_EQ(sut_.modes.request(Command::kStart), Status::kOk);
    sut_.run_frames(2);  // both have left in frame 1, and would report it in frame 2
    while (sut_.frames[1] < 12) {
        const ModeStep wanted =
            sut_.frames[1] <= 1 + 2 * kModeStepFrames ? ModeStep::kLeave : ModeStep::kSafe;
        EXPECT_EQ(sut_.modes.get_step(), wanted) << sut_.frames[1];
        static_cast<void>(sut_.run_core(1U));
    }

    const Steps expected{{ModeStep::kLeave, kWork, 1}, {ModeStep::kSafe, kHalt, 8}};
    EXPECT_EQ(sut_.observers[1].steps, expected);
    EXPECT_EQ(sut_.modes.get_failure().cause, ModeFailureCause::kLate);
}

TEST_F(SystemModesRestartTest, NoSetIsTakenWhileAFailureIsLatched) {
    verifies("SWR-MOD-007", Technique::kStateTransition, Polarity::kViolation);
    ASSERT_EQ(sut_.modes.request_safe_mode(), Status::kOk);
    sut_.run_frames(9);
    ASSERT_EQ(sut_.modes.get_mode(), kHalt);
    const double before = get_speed();

    take_set(kFastSet);
    EXPECT_EQ(get_speed(), before);
    stop();
    ASSERT_EQ(sut_.modes.reset(), Status::kOk);
    ASSERT_TRUE(sut_.start());
    EXPECT_EQ(get_speed(), 2.0) << "the request waited for the next start";
}

TEST_F(SystemModesRestartTest, ASetBesideTheModesIsThereAgainAfterARestart) {
    verifies("SWR-MOD-008", Technique::kStateTransition);
    take_set(kFastSet);
    set_speed();
    stop();

    ASSERT_TRUE(sut_.start());
    EXPECT_EQ(get_speed(), 2.0);
}

TEST_F(SystemModesRestartTest, AModeWithASetOfItsOwnEndsTheSetThatWasTakenBeside) {
    verifies("SWR-MOD-008", Technique::kStateTransition);
    take_set(kSlowSet);
    go(Command::kStart);
    ASSERT_EQ(get_speed(), 2.0);
    set_speed();
    stop();

    ASSERT_TRUE(sut_.start());
    EXPECT_EQ(get_speed(), 2.0) << "that of the mode";
}

TEST_F(SystemModesRestartTest, AResetToAModeWithoutASetKeepsTheOneThatHolds) {
    verifies("SWR-MOD-008", Technique::kStateTransition);
    take_set(kFastSet);
    set_speed();
    stop();
    ASSERT_EQ(sut_.modes.reset(), Status::kOk);

    ASSERT_TRUE(sut_.start());
    EXPECT_EQ(get_speed(), 2.0);
}

TEST_F(SystemModesRestartTest, AStopOnTheWayToASafeModeWithoutASetKeepsTheOneThatHolds) {
    verifies("SWR-MOD-007", Technique::kStateTransition);
    take_set(kFastSet);
    set_speed();
    ASSERT_EQ(sut_.modes.request_safe_mode(), Status::kOk);
    stop();
    ASSERT_EQ(sut_.modes.get_mode(), kHalt);

    ASSERT_TRUE(sut_.start());
    EXPECT_EQ(get_speed(), 2.0);
}

/// Core 0 runs by itself at first; what core 1 has after its own start is what the system has.
class LateCoreTest : public ::testing::Test {
  protected:
    void SetUp() override {
        ASSERT_EQ(sut_.core_0.initialize(), Status::kOk);
        ASSERT_EQ(sut_.core_1.initialize(), Status::kOk);
        ASSERT_EQ(sut_.core_0.start(), Status::kOk);
    }
    void run_core_0(int count) {
        for (int i = 0; i < count; ++i) {
            static_cast<void>(sut_.run_core(0U));
        }
    }
    void go(Command command) {
        ASSERT_EQ(sut_.modes.request(command), Status::kOk);
        run_core_0(10);
    }
    void expect_same_speed_on_core_1(double speed) {
        ASSERT_EQ(sut_.modes.get_step(), ModeStep::kNone);
        ASSERT_EQ(sut_.planner.speed.get(), speed);
        ASSERT_EQ(sut_.core_1.start(), Status::kOk);
        EXPECT_EQ(sut_.drive.speed.get(), speed);
    }

    Robot sut_;
};

TEST_F(LateCoreTest, ItGetsTheSetOfAModeThatWasLeftForOneWithoutASet) {
    verifies("SWR-MOD-008", Technique::kStateTransition);
    go(Command::kStart);
    go(Command::kStop);
    ASSERT_EQ(sut_.modes.get_mode(), kIdle);

    expect_same_speed_on_core_1(2.0);
}

TEST_F(LateCoreTest, ItGetsTheSetOfAModeThatCouldNotBeEntered) {
    verifies("SWR-MOD-008", Technique::kFaultInjection, Polarity::kViolation);
    sut_.plan = {&sut_.planner, true, testing_support::Trouble::kRefusal};
    go(Command::kStart);
    ASSERT_EQ(sut_.modes.get_mode(), kHalt);

    expect_same_speed_on_core_1(2.0);
}

TEST_F(LateCoreTest, ItGetsASetThatWasUnderWayWhenTheSafeModeWasAskedFor) {
    verifies("SWR-MOD-008", Technique::kErrorGuessing, Polarity::kViolation);
    ASSERT_EQ(sut_.modes.get_configuration().activate_configuration_set(kSlowSet), Status::kOk);
    run_core_0(1);
    ASSERT_EQ(sut_.modes.request_safe_mode(), Status::kOk);
    run_core_0(10);
    ASSERT_EQ(sut_.modes.get_mode(), kHalt);

    expect_same_speed_on_core_1(0.5);
}

TEST_F(LateCoreTest, ItGetsTheSetBeforeOneThatWasRefused) {
    verifies("SWR-MOD-008", Technique::kFaultInjection, Polarity::kViolation);
    go(Command::kTeach);
    ASSERT_EQ(sut_.planner.speed.get(), 0.5);
    sut_.table.configuration.values[2] = to_scalar(99.0);  // memory is corrupted: of "fast"
    go(Command::kStart);
    ASSERT_EQ(sut_.modes.get_mode(), kHalt);

    expect_same_speed_on_core_1(0.5);
}

TEST_F(SystemModesRestartTest, ARequestDoesNotOutliveAStop) {
    verifies("SWR-MOD-004", Technique::kStateTransition, Polarity::kViolation);
    ASSERT_EQ(sut_.modes.request(Command::kTeach), Status::kOk);
    stop();
    ASSERT_TRUE(sut_.start());
    sut_.run_frames(9);

    EXPECT_EQ(sut_.modes.get_mode(), kIdle);
    EXPECT_EQ(sut_.modes.request(Command::kStart), Status::kOk);
}

TEST_F(SystemModesRestartTest, ARequestDoesNotOutliveAReset) {
    verifies("SWR-MOD-004", Technique::kStateTransition, Polarity::kViolation);
    stop();
    ASSERT_EQ(sut_.modes.request(Command::kTeach), Status::kOk) << "for the next start";
    ASSERT_EQ(sut_.modes.reset(), Status::kOk);
    ASSERT_TRUE(sut_.start());
    sut_.run_frames(9);

    EXPECT_EQ(sut_.modes.get_mode(), kIdle);
}

TEST(SystemModesAloneTest, ThereIsNoFailureAtFirst) {
    verifies("SWR-MOD-007", Technique::kInterface);
    const Robot robot;
    const ModeFailure failure = robot.modes.get_failure();

    EXPECT_EQ(failure.cause, ModeFailureCause::kNone);
    EXPECT_EQ(failure.step, ModeStep::kNone);
    EXPECT_EQ(failure.component, kNoIndex);
}

TEST(SystemModesAloneTest, TheFirstFailureIsKeptAndSaysSo) {
    verifies("SWR-MOD-007", Technique::kInterface, Polarity::kViolation);
    Robot robot;

    EXPECT_TRUE(robot.modes.fail({ModeFailureCause::kOverrun, ModeStep::kLeave, 2U}));
    EXPECT_FALSE(robot.modes.fail({ModeFailureCause::kRefused, ModeStep::kEnter, 3U}));
    EXPECT_EQ(robot.modes.get_failure().cause, ModeFailureCause::kOverrun);
    EXPECT_EQ(robot.modes.get_failure().component, 2U);
}

TEST(SystemModesAloneTest, ACoreThatHasNotJoinedDoesNotEndASwitch) {
    verifies("SWR-MOD-006", Technique::kInterface, Polarity::kViolation);
    Robot robot;
    ASSERT_EQ(robot.modes.join(0U), Status::kOk);
    ASSERT_EQ(robot.modes.request(Command::kStart), Status::kOk);
    ASSERT_EQ(robot.modes.begin_frame(0U, 0).get_step(), ModeStep::kLeave);

    robot.modes.leave(1U);
    EXPECT_EQ(robot.modes.get_failure().cause, ModeFailureCause::kNone);
    EXPECT_EQ(robot.modes.get_step(), ModeStep::kLeave);
}

TEST(SystemModesAloneTest, WhatACoreReportedBeforeARestartDoesNotCountAfterIt) {
    verifies("SWR-MOD-006", Technique::kErrorGuessing, Polarity::kViolation);
    Robot robot;
    // The same set at the same frame makes the same plan, word by word.
    const auto agree = [&robot] {
        EXPECT_EQ(robot.modes.join(0U), Status::kOk);
        EXPECT_EQ(robot.modes.join(1U), Status::kOk);
        EXPECT_EQ(robot.modes.get_configuration().activate_configuration_set(kSlowSet), Status::kOk);
        return robot.modes.begin_frame(0U, 0);
    };
    const ModePlan first = agree();
    robot.modes.finish(0U, first);
    robot.modes.finish(1U, first);
    ASSERT_EQ(robot.modes.begin_frame(0U, 3).get_step(), ModeStep::kNone);
    ASSERT_EQ(robot.modes.get_failure().cause, ModeFailureCause::kNone);
    robot.modes.leave(0U);
    robot.modes.leave(1U);

    const ModePlan second = agree();
    ASSERT_EQ(second.get_word(), first.get_word());
    robot.modes.finish(0U, second);
    EXPECT_EQ(robot.modes.begin_frame(0U, 3).get_step(), ModeStep::kSafe) << "core 1 has not reported";
    EXPECT_EQ(robot.modes.get_failure().cause, ModeFailureCause::kLate);
}

}  // namespace
}  // namespace mamori
