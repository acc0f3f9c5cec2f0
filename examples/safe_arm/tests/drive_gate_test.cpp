// SPDX-License-Identifier: Apache-2.0
// Goal: torque reaches the drives only in a frame in which the supervisor allows it. Method: one frame after
// the other.
#include "drive_gate.hpp"

#include <algorithm>
#include <limits>

#include "arm_limits.hpp"
#include "feed.hpp"
#include "gravity_model.hpp"
#include "mamori/trace/verifies.hpp"

namespace safe_arm {
namespace {

using mamori::Status;
using namespace mamori::verification;

class DriveGateTest : public ::testing::Test {
  protected:
    void allow(bool torque_enable) {
        StopCommand stop{};
        stop.torque_enable = torque_enable;
        stop.brake_release = true;
        feed(sut_.stop, stop);
    }
    void command(double torque_nm) {
        TorqueCommand command{};
        command.torque_nm.fill(torque_nm);
        feed(sut_.command, command);
    }
    /// One frame with this command. @return torque of the drives.
    const JointVector& run(const TorqueCommand& wanted) {
        feed(sut_.command, wanted);
        allow(true);
        EXPECT_EQ(sut_.on_execute({}), Status::kOk);
        return outputs_.torque_nm;
    }
    void expect_safe_outputs() const {
        EXPECT_FALSE(outputs_.torque_enable);
        EXPECT_FALSE(outputs_.brake_release);
        EXPECT_EQ(outputs_.torque_nm, JointVector{});
    }

    mamori::safety::ArmOutputs outputs_{};
    DriveGate sut_{outputs_};
};

TEST_F(DriveGateTest, AllowedTorqueReachesTheDrives) {
    verifies("SWR-SAF-009");
    allow(true);
    command(0.2);

    ASSERT_EQ(sut_.on_execute({}), Status::kOk);
    EXPECT_TRUE(outputs_.torque_enable);
    EXPECT_TRUE(outputs_.brake_release);
    EXPECT_EQ(outputs_.torque_nm[6], 0.2);
    EXPECT_EQ(take(sut_.drive).torque_nm[6], 0.2);
}

TEST_F(DriveGateTest, PermissionOfAnEarlierFrameCountsForNothing) {
    verifies("SWR-SAF-009", Technique::kFaultInjection, Polarity::kViolation);
    allow(true);
    command(0.2);
    ASSERT_EQ(sut_.on_execute({}), Status::kOk);

    sut_.stop.mark_read();
    ASSERT_EQ(sut_.on_execute({}), Status::kOk);
    expect_safe_outputs();
    EXPECT_FALSE(take(sut_.drive).torque_enable);
}

TEST_F(DriveGateTest, PermissionThatWaitedForAGateCutOffIsNoneInTheNextFrame) {
    verifies("SWR-SAF-009", Technique::kFaultInjection, Polarity::kViolation);
    allow(true);  // given at 0, and never marked read: the window of the gate overran
    command(0.2);

    ASSERT_EQ(sut_.on_execute({0, mamori::Instant{kFrame.ns - 1}}), Status::kOk);
    EXPECT_TRUE(outputs_.torque_enable);
    ASSERT_EQ(sut_.on_execute({0, mamori::Instant{kFrame.ns}}), Status::kOk);
    expect_safe_outputs();
}

TEST_F(DriveGateTest, NoPermissionMeansSafeOutputsWhateverIsCommanded) {
    verifies("SWR-SAF-009", Technique::kFaultInjection, Polarity::kViolation);
    command(0.2);
    ASSERT_EQ(sut_.on_execute({}), Status::kOk);
    expect_safe_outputs();

    allow(false);
    ASSERT_EQ(sut_.on_execute({}), Status::kOk);
    expect_safe_outputs();
}

TEST_F(DriveGateTest, TheControllerChangesTorqueStepByStep) {
    verifies("SWR-SAF-042", Technique::kBoundaryValues, Polarity::kViolation);
    JointVector before{};
    for (const double sign : {1.0, -1.0, -1.0}) {
        for (std::size_t j = 0U; j < kArmJointCount; ++j) {
            const double step_nm = kControllerStepNm[j];
            TorqueCommand wanted{};
            wanted.torque_nm = before;
            wanted.torque_nm[j] += sign * 1.0001 * step_nm;
            EXPECT_NEAR(run(wanted)[j], before[j] + sign * step_nm, 1e-12) << j;
            before = outputs_.torque_nm;
            wanted.torque_nm[j] = before[j] - sign * 0.9999 * step_nm;
            EXPECT_EQ(run(wanted)[j], wanted.torque_nm[j]) << j;
            before = outputs_.torque_nm;
        }
    }
}

TEST_F(DriveGateTest, TheControllerStaysNearTheTorqueThatHoldsTheArm) {
    verifies("SWR-SAF-042", Technique::kBoundaryValues, Polarity::kViolation);
    JointState state{};
    state.position_rad = {0.3, 0.9, -0.4, 0.8, 0.2, 0.5, 0.0};
    feed(sut_.arm_state, state);
    const JointVector carried_nm = calc_gravity_torque(state.position_rad);
    for (const double sign : {1.0, -1.0}) {
        TorqueCommand wanted{};
        for (std::size_t j = 0U; j < kArmJointCount; ++j) {
            wanted.torque_nm[j] = carried_nm[j] + sign * 1.001 * kControllerShareNm[j];
        }
        for (int frame = 0; frame < 200; ++frame) {
            static_cast<void>(run(wanted));
        }
        for (std::size_t j = 0U; j < kArmJointCount; ++j) {
            EXPECT_NEAR(outputs_.torque_nm[j], carried_nm[j] + sign * kControllerShareNm[j], 1e-9) << j;
            wanted.torque_nm[j] = carried_nm[j] + sign * 0.999 * kControllerShareNm[j];
        }
        EXPECT_EQ(run(wanted), wanted.torque_nm);
    }
}

TEST_F(DriveGateTest, WhatIsNoNumberLeavesTheTorqueAndInfinityMovesItByAStep) {
    verifies("SWR-SAF-042", Technique::kFaultInjection, Polarity::kViolation);
    TorqueCommand wanted{};
    wanted.torque_nm.fill(0.25);
    static_cast<void>(run(wanted));
    wanted.torque_nm = {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                        -std::numeric_limits<double>::infinity()};
    const JointVector torque_nm = run(wanted);
    EXPECT_EQ(torque_nm[0], 0.25);
    EXPECT_EQ(torque_nm[1], 0.25 + kControllerStepNm[1]);
    EXPECT_EQ(torque_nm[2], 0.25 - kControllerStepNm[2]);
}

TEST_F(DriveGateTest, AMovingJointGetsTheTorqueThatItsDriveCanGive) {
    verifies("SWR-SAF-009", Technique::kBoundaryValues, Polarity::kViolation);
    StopCommand stop{};
    stop.torque_enable = true;
    stop.torque_source = TorqueSource::kBrakeTest;
    for (const double share : {0.0, 0.25, 1.0, 1.5}) {
        for (const double sign : {1.0, -1.0}) {
            JointState state{};
            state.velocity_rad_s[3] = sign * share * kNoLoadSpeedRadS[3];
            feed(sut_.arm_state, state);
            stop.brake_test_share = sign;
            feed(sut_.stop, stop);
            ASSERT_EQ(sut_.on_execute({}), Status::kOk);
            EXPECT_NEAR(outputs_.torque_nm[3], sign * kTorqueLimitNm[3] * std::max(0.0, 1.0 - share), 1e-9);
            stop.brake_test_share = -sign;
            feed(sut_.stop, stop);
            ASSERT_EQ(sut_.on_execute({}), Status::kOk);
            EXPECT_EQ(outputs_.torque_nm[3], -sign * kTorqueLimitNm[3]) << "against the motion";
        }
    }
}

TEST_F(DriveGateTest, RunningGateKeepsWritingWhatIsAllowed) {
    verifies("SWR-SAF-010");
    for (int i = 0; i < 3; ++i) {
        allow(true);
        command(1.0 + i);
        ASSERT_EQ(sut_.on_execute({}), Status::kOk);
        EXPECT_EQ(outputs_.torque_nm[0], 1.0 + i);
    }
}

TEST_F(DriveGateTest, DeactivatedOrAbortedGateLeavesSafeOutputs) {
    verifies("SWR-SAF-010", Technique::kStateTransition, Polarity::kViolation);
    for (const bool is_aborted : {false, true}) {
        allow(true);
        command(0.2);
        ASSERT_EQ(sut_.on_execute({}), Status::kOk);
        ASSERT_TRUE(outputs_.torque_enable);

        ASSERT_EQ(is_aborted ? sut_.on_aborting({}) : sut_.on_deactivated({}), Status::kOk);
        expect_safe_outputs();
    }
}

TEST_F(DriveGateTest, TheStopLoopReplacesTheTorqueOfTheController) {
    verifies("SWR-SAF-025");
    allow(true);
    command(0.2);
    ASSERT_EQ(sut_.on_execute({}), Status::kOk);
    StopCommand stop{};
    stop.torque_enable = true;
    stop.torque_source = TorqueSource::kStopLoop;
    JointState state{};
    state.position_rad[1] = 0.7;
    feed(sut_.arm_state, state);
    feed(sut_.stop, stop);
    command(-14.0);

    ASSERT_EQ(sut_.on_execute({}), Status::kOk);
    EXPECT_EQ(outputs_.torque_nm[1], calc_gravity_torque(state.position_rad)[1])
        << "no torque of the controller";
    EXPECT_EQ(take(sut_.drive).source, TorqueSource::kStopLoop);
    EXPECT_EQ(take(sut_.drive).stop_setpoint_rad[1], 0.7);
    EXPECT_FALSE(outputs_.brake_release);
    state.position_rad[1] = 0.9;
    feed(sut_.arm_state, state);
    feed(sut_.stop, stop);
    ASSERT_EQ(sut_.on_execute({}), Status::kOk);
    EXPECT_EQ(outputs_.torque_nm[1], -kTorqueLimitNm[1]) << "limited";
}

TEST_F(DriveGateTest, AStopThatEndsIsForgotten) {
    verifies("SWR-SAF-025", Technique::kStateTransition, Polarity::kViolation);
    StopCommand stop{};
    stop.torque_enable = true;
    stop.torque_source = TorqueSource::kStopLoop;
    for (const bool is_silent : {false, true}) {
        feed(sut_.arm_state, JointState{});
        feed(sut_.stop, stop);
        ASSERT_EQ(sut_.on_execute({}), Status::kOk);
        if (is_silent) {
            sut_.stop.mark_read();
        } else {
            allow(false);
        }
        ASSERT_EQ(sut_.on_execute({}), Status::kOk);
        expect_safe_outputs();
        JointState moved{};
        moved.position_rad[0] = 1.0;
        feed(sut_.arm_state, moved);
        feed(sut_.stop, stop);
        ASSERT_EQ(sut_.on_execute({}), Status::kOk);
        EXPECT_NEAR(outputs_.torque_nm[0], 0.0, 1e-12) << "held at the new place";
    }
}

TEST_F(DriveGateTest, TheArmIsCarriedAtItsLastPositionWhileTheBrakesClose) {
    verifies("SWR-SAF-051");
    StopCommand stop{};
    stop.torque_enable = true;
    stop.brake_release = false;
    stop.torque_source = TorqueSource::kCarry;
    JointState state{};
    state.position_rad = {0.0, 0.6, 0.0, 0.9, 0.0, 0.4, 0.0};
    state.velocity_rad_s[1] = -0.5;
    command(0.2);
    feed(sut_.arm_state, state);
    feed(sut_.stop, stop);

    ASSERT_EQ(sut_.on_execute({}), Status::kOk);
    EXPECT_EQ(outputs_.torque_nm, calc_gravity_torque(state.position_rad));
    EXPECT_EQ(take(sut_.drive).gravity_nm, calc_gravity_torque(state.position_rad));
}

TEST_F(DriveGateTest, ABrakeTestPushesWithItsShareAgainstClosedBrakes) {
    verifies("SWR-SAF-027");
    StopCommand stop{};
    stop.torque_enable = true;
    stop.torque_source = TorqueSource::kBrakeTest;
    stop.brake_test_share = -0.5;
    command(0.2);
    feed(sut_.stop, stop);

    ASSERT_EQ(sut_.on_execute({}), Status::kOk);
    EXPECT_EQ(outputs_.torque_nm[1], -116.0);
    EXPECT_EQ(outputs_.torque_nm[6], -7.25);
    EXPECT_FALSE(outputs_.brake_release);
}

TEST_F(DriveGateTest, TheRelayFollowsTheDecisionAndOpensWithoutOne) {
    verifies("SWR-SAF-010", Technique::kEquivalenceClasses, Polarity::kViolation);
    StopCommand stop{};
    stop.relay_close = true;
    feed(sut_.stop, stop);
    ASSERT_EQ(sut_.on_execute({}), Status::kOk);
    EXPECT_TRUE(outputs_.relay_close);
    EXPECT_TRUE(take(sut_.drive).relay_close);
    EXPECT_FALSE(outputs_.torque_enable);

    sut_.stop.mark_read();
    ASSERT_EQ(sut_.on_execute({}), Status::kOk);
    EXPECT_FALSE(outputs_.relay_close);
    EXPECT_FALSE(take(sut_.drive).relay_close);
}

}  // namespace
}  // namespace safe_arm
