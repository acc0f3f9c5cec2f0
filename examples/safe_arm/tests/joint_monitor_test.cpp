// SPDX-License-Identifier: Apache-2.0
// Goal: each physical deviation is reported, and nothing is reported of a sound arm. Method: one frame after
// the other with readings, messages and drive commands made here; both sides of each limit.
#include <algorithm>
#include <cmath>

#include <limits>

#include "joint_monitor_fixture.hpp"

namespace safe_arm {
namespace {

using mamori::Duration;
using mamori::Instant;
using mamori::Status;
using namespace mamori::verification;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST_F(JointMonitorTest, SoundArmGivesNoFaultAndItsPosition) {
    verifies("SWR-SAF-007");

    step();
    const JointState state = move(1U, 0.5, 20);

    EXPECT_EQ(state.faults, 0U);
    EXPECT_NEAR(state.position_rad[1], 0.01, 1e-12);
    EXPECT_NEAR(state.velocity_rad_s[1], 0.5, 1e-9);
    EXPECT_FALSE(state.is_standing);
}

TEST_F(JointMonitorTest, ChannelThatJumpsIsDistrustedAndTheOtherOneCounts) {
    verifies("SWR-SAF-005", Technique::kFaultInjection, Polarity::kViolation);
    step();

    reading_.position_a_rad[3] = 0.7;
    EXPECT_EQ(step().faults, to_bit(ArmFault::kEncoderImplausible));
    reading_.position_b_rad[3] = 0.001;
    const JointState state = step();
    EXPECT_DOUBLE_EQ(state.position_rad[3], 0.001);
    EXPECT_EQ(state.faults, to_bit(ArmFault::kEncoderImplausible));
}

TEST_F(JointMonitorTest, ChangeOfTheTrustedChannelIsNoMovement) {
    verifies("SWR-SAF-005", Technique::kBoundaryValues);
    const double mounting_rad = kDiscrepancyRad * kInside;
    reading_.position_b_rad[0] = mounting_rad;
    step();

    reading_.position_a_rad[0] = 0.7;
    command_.setpoint_rad[0] = mounting_rad;
    for (int i = 0; i < 8; ++i) {
        const JointState state = step();
        EXPECT_EQ(state.faults, to_bit(ArmFault::kEncoderImplausible)) << i;
        EXPECT_NEAR(state.velocity_rad_s[0], 0.0, 1e-12);
    }
}

TEST_F(JointMonitorTest, DistrustLastsUntilAResetWithoutTorque) {
    verifies("SWR-SAF-005", Technique::kFaultInjection, Polarity::kViolation);
    step();
    reading_.position_a_rad[3] = 0.7;
    step();
    reading_.position_a_rad[3] = 0.0;
    EXPECT_EQ(step().faults, to_bit(ArmFault::kEncoderImplausible)) << "comes back by itself";
    reading_.reset_button = true;
    EXPECT_EQ(step().faults, to_bit(ArmFault::kEncoderImplausible)) << "reset while torque is on";

    reading_.reset_button = false;
    drive_ = {};
    reading_.torque_enabled = false;
    reading_.brakes_open = false;
    reading_.brakes_closed = true;
    EXPECT_EQ(step().faults, to_bit(ArmFault::kEncoderImplausible));
    reading_.reset_button = true;
    EXPECT_EQ(step().faults, 0U);
}

TEST_F(JointMonitorTest, ChannelThatIsStillWrongAfterTheResetIsReportedInEachFrame) {
    verifies("SWR-SAF-005", Technique::kFaultInjection, Polarity::kViolation);
    drive_ = {};
    step();
    reading_.position_a_rad[3] = 0.7;
    step();

    reading_.reset_button = true;
    for (int i = 0; i < 10; ++i) {
        EXPECT_NE(step().faults, 0U) << i;
    }
}

TEST_F(JointMonitorTest, StepThatTheJointCanMakeIsTrusted) {
    verifies("SWR-SAF-005", Technique::kBoundaryValues);
    step();

    place(0U, kMaxStepRad[0] * kInside);
    EXPECT_EQ(step().faults & to_bit(ArmFault::kEncoderImplausible), 0U);
    reading_.position_a_rad[0] += kMaxStepRad[0] * kOutside;
    EXPECT_NE(step().faults & to_bit(ArmFault::kEncoderImplausible), 0U);
}

TEST_F(JointMonitorTest, NumberThatIsNoneIsImplausible) {
    verifies("SWR-SAF-005", Technique::kErrorGuessing, Polarity::kViolation);
    step();

    reading_.position_a_rad[2] = kNan;
    reading_.position_b_rad[2] = kNan;
    const JointState state = step();
    EXPECT_EQ(state.faults, to_bit(ArmFault::kEncoderDiscrepancy));
    EXPECT_EQ(state.position_rad[2], 0.0);
}

TEST_F(JointMonitorTest, ChannelsThatDisagreeAreReportedBeyondTheTolerance) {
    verifies("SWR-SAF-006", Technique::kBoundaryValues, Polarity::kViolation);
    reading_.position_b_rad[4] = kDiscrepancyRad * kInside;
    EXPECT_EQ(step().faults, 0U);

    reading_.position_b_rad[4] = kDiscrepancyRad * kOutside;
    EXPECT_EQ(step().faults, to_bit(ArmFault::kEncoderDiscrepancy));
    reading_.position_b_rad[4] = -kDiscrepancyRad * kOutside;
    EXPECT_EQ(step().faults, to_bit(ArmFault::kEncoderDiscrepancy));
}

TEST_F(JointMonitorTest, FrozenChannelNeverTakesTheTrustOfTheSoundOne) {
    verifies("SWR-SAF-006", Technique::kBoundaryValues, Polarity::kViolation);
    for (std::size_t joint = 0U; joint < kArmJointCount; ++joint) {
        for (int share = 1; share <= 20; ++share) {
            ASSERT_EQ(sut_.on_activated({0, now_}), Status::kOk);
            reading_.position_a_rad = {};
            reading_.position_b_rad = {};
            command_.setpoint_rad = {};
            step();
            const double step_rad = kSafeSpeedRadS[joint] * kFrameS * share / 20.0;
            std::uint32_t differing_frames = 0U;
            while (differing_frames < kDiscrepancyFrames) {
                reading_.position_b_rad[joint] += step_rad;
                const std::uint32_t faults = step().faults;
                ASSERT_EQ(faults & to_bit(ArmFault::kEncoderImplausible), 0U) << joint << ' ' << share;
                differing_frames += (faults & to_bit(ArmFault::kEncoderDiscrepancy)) != 0U ? 1U : 0U;
            }
        }
    }
}

TEST_F(JointMonitorTest, BothChannelsStuckAreReportedWhenTheSetpointTravels) {
    verifies("SWR-SAF-006", Technique::kFaultInjection, Polarity::kViolation);
    step();

    command_.setpoint_rad[5] = kStuckTravelRad * kInside;
    EXPECT_EQ(step().faults, 0U);
    command_.setpoint_rad[5] = kStuckTravelRad * kOutside;
    EXPECT_EQ(step().faults, to_bit(ArmFault::kEncoderStuck));
}

TEST_F(JointMonitorTest, OneMovingCountEndsTheSuspicionOfBeingStuck) {
    verifies("SWR-SAF-006");
    step();

    for (int i = 0; i < 20; ++i) {
        command_.setpoint_rad[5] += 0.5 * kStuckTravelRad;
        reading_.position_b_rad[5] += 1.0e-5;
        EXPECT_EQ(step().faults & to_bit(ArmFault::kEncoderStuck), 0U);
    }
}

TEST_F(JointMonitorTest, SpeedBeyondTheLimitIsReportedInBothDirections) {
    verifies("SWR-SAF-007", Technique::kBoundaryValues, Polarity::kViolation);
    step();

    EXPECT_EQ(move(0U, kSafeSpeedRadS[0] * kInside, 8).faults, 0U);
    EXPECT_EQ(move(0U, kSafeSpeedRadS[0] * kOutside, 8).faults, to_bit(ArmFault::kOverspeed));
    EXPECT_EQ(move(0U, -kSafeSpeedRadS[0] * kOutside, 8).faults, to_bit(ArmFault::kOverspeed));
}

TEST_F(JointMonitorTest, AJointThatWillBeTooFastIsReportedBeforeItIs) {
    verifies("SWR-SAF-043", Technique::kBoundaryValues, Polarity::kViolation);
    constexpr double kAcceleration = 20.0;
    const double added_rad_s = kSpeedPrediction * kAcceleration * 4.0 * kFrameS;
    for (const double sign : {1.0, -1.0}) {
        ASSERT_EQ(sut_.on_activated({0, now_}), Status::kOk);
        place(0U, 0.0);
        move(0U, 0.0, 5);
        double speed_rad_s = sign * 0.5;
        move(0U, speed_rad_s, 10);
        JointState state{};
        while (state.faults == 0U && std::fabs(speed_rad_s) < 1.0) {
            speed_rad_s += sign * kAcceleration * kFrameS;
            state = move(0U, speed_rad_s, 1);
        }
        EXPECT_EQ(state.faults, to_bit(ArmFault::kOverspeed));
        EXPECT_NEAR(std::fabs(state.velocity_rad_s[0]), kSafeSpeedRadS[0] - added_rad_s,
                    kAcceleration * kFrameS);
    }
}

TEST_F(JointMonitorTest, AJointThatIsTooFastIsReportedWhileItBrakes) {
    verifies("SWR-SAF-007", Technique::kBoundaryValues, Polarity::kViolation);
    double speed_rad_s = 1.1;
    move(0U, speed_rad_s, 10);
    for (JointState state = move(0U, speed_rad_s, 1); state.velocity_rad_s[0] > kSafeSpeedRadS[0];
         state = move(0U, speed_rad_s, 1)) {
        EXPECT_EQ(state.faults, to_bit(ArmFault::kOverspeed));
        speed_rad_s -= 0.03;
    }
}

TEST_F(JointMonitorTest, PositionOutsideTheSafeRangeIsReportedOnBothSides) {
    verifies("SWR-SAF-007", Technique::kBoundaryValues, Polarity::kViolation);
    place(1U, kSafePositionRad[1] * kInside);
    EXPECT_EQ(step().faults, 0U);

    for (const double side : {1.0, -1.0}) {
        ASSERT_EQ(sut_.on_activated({0, now_}), Status::kOk);
        place(1U, side * kSafePositionRad[1] * kOutside);
        EXPECT_EQ(step().faults, to_bit(ArmFault::kPositionLimit));
    }
}

TEST_F(JointMonitorTest, JointThatCannotBeStoppedInsideItsRangeIsReported) {
    verifies("SWR-SAF-007", Technique::kBoundaryValues, Polarity::kViolation);
    constexpr double kSpeedRadS = 0.8;
    const double margin_rad = kSpeedRadS * mamori::to_seconds(kStopTime);
    for (const double side : {1.0, -1.0}) {
        ASSERT_EQ(sut_.on_activated({0, now_}), Status::kOk);
        place(1U, side * (kSafePositionRad[1] - margin_rad - 10.5 * kSpeedRadS * kFrameS));
        step();
        EXPECT_EQ(move(1U, side * kSpeedRadS, 10).faults, 0U);
        EXPECT_EQ(move(1U, side * kSpeedRadS, 1).faults, to_bit(ArmFault::kPositionLimit));
    }
}

TEST_F(JointMonitorTest, FollowingErrorCountsOnlyWhileTorqueIsOn) {
    verifies("SWR-SAF-007", Technique::kBoundaryValues, Polarity::kViolation);
    reading_.position_a_rad[0] = 1.0e-5;
    step();
    command_.setpoint_rad[0] = kFollowingErrorRad * kOutside + 1.0e-5;
    reading_.position_a_rad[0] = 0.0;
    EXPECT_NE(step().faults & to_bit(ArmFault::kFollowingError), 0U);

    drive_.torque_enable = false;
    drive_.brake_release = false;
    reading_.brakes_closed = true;
    reading_.brakes_open = false;
    EXPECT_EQ(step().faults, 0U);
}

TEST_F(JointMonitorTest, TorqueThatWasNotCommandedIsReported) {
    verifies("SWR-SAF-007", Technique::kBoundaryValues, Polarity::kViolation);
    drive_.torque_nm[6] = 5.0;
    reading_.measured_torque_nm[6] = 5.0 + kTorqueDeviationShare * kTorqueLimitNm[6] * kInside;
    EXPECT_EQ(step().faults, 0U);

    reading_.measured_torque_nm[6] = 5.0 + kTorqueDeviationShare * kTorqueLimitNm[6] * kOutside;
    EXPECT_EQ(step().faults, to_bit(ArmFault::kTorqueDeviation));
    reading_.measured_torque_nm[6] = kNan;
    EXPECT_EQ(step().faults, to_bit(ArmFault::kTorqueDeviation));
}

TEST_F(JointMonitorTest, TorqueFeedbackMayStayAwayOnlyForItsTime) {
    verifies("SWR-SAF-007", Technique::kBoundaryValues, Polarity::kViolation);
    reading_.torque_enabled = false;
    const auto tolerated = kTorqueFeedbackTime.ns / kFrame.ns;
    for (std::int64_t i = 0; i < tolerated; ++i) {
        ASSERT_EQ(step().faults, 0U) << i;
    }

    EXPECT_EQ(step().faults, to_bit(ArmFault::kTorqueDeviation));
    drive_.torque_enable = false;
    EXPECT_EQ(step().faults & to_bit(ArmFault::kTorqueDeviation), 0U);
}

TEST_F(JointMonitorTest, SoundSupplyAndObedientBrakesGiveNoFault) {
    verifies("SWR-SAF-008");

    for (int i = 0; i < 200; ++i) {
        EXPECT_EQ(step().faults, 0U);
    }
}

TEST_F(JointMonitorTest, LostSupplyIsReportedAtOnce) {
    verifies("SWR-SAF-008", Technique::kFaultInjection, Polarity::kViolation);
    step();

    reading_.power_good = false;
    EXPECT_EQ(step().faults, to_bit(ArmFault::kPowerLost));
}

TEST_F(JointMonitorTest, BrakeFeedbackMayContradictOnlyForItsTime) {
    verifies("SWR-SAF-008", Technique::kBoundaryValues, Polarity::kViolation);
    reading_.brakes_closed = true;
    reading_.brakes_open = false;
    const auto tolerated = kBrakeFeedbackTime.ns / kFrame.ns;
    for (std::int64_t i = 0; i < tolerated; ++i) {
        ASSERT_EQ(step().faults, 0U) << i;
    }

    EXPECT_EQ(step().faults, to_bit(ArmFault::kBrakeFault));
    reading_.brakes_closed = false;
    reading_.brakes_open = true;
    EXPECT_EQ(step().faults, 0U);
}

TEST_F(JointMonitorTest, TheTimeOfAContradictionBeginsAgainWithTheActivation) {
    verifies("SWR-SAF-008", Technique::kErrorGuessing);
    reading_.brakes_closed = true;
    reading_.brakes_open = false;
    const auto tolerated = kBrakeFeedbackTime.ns / kFrame.ns;
    for (int start = 0; start < 2; ++start) {
        ASSERT_EQ(sut_.on_activated({0, now_}), Status::kOk);
        for (std::int64_t i = 0; i < tolerated; ++i) {
            ASSERT_EQ(step().faults, 0U) << start << " " << i;
        }
    }
}

TEST_F(JointMonitorTest, OneBrakeThatSticksContradictsBothCommands) {
    verifies("SWR-SAF-008", Technique::kFaultInjection, Polarity::kViolation);
    reading_.brakes_closed = false;
    reading_.brakes_open = false;
    for (const bool is_release : {true, false}) {
        drive_.brake_release = is_release;
        ASSERT_EQ(sut_.on_activated({0, now_}), Status::kOk);
        JointState state{};
        for (std::int64_t i = 0; i <= kBrakeFeedbackTime.ns / kFrame.ns; ++i) {
            state = step();
        }
        EXPECT_EQ(state.faults, to_bit(ArmFault::kBrakeFault)) << is_release;
    }
}

TEST_F(JointMonitorTest, StandstillNeedsTheWholeConfirmationTime) {
    verifies("SWR-SAF-007", Technique::kBoundaryValues);
    step();
    move(2U, 0.5, 5);
    const auto needed = kStandstillTime.ns / kFrame.ns;

    // Four frames pass until the mean speed has forgotten the movement.
    for (std::int64_t i = 0; i < needed + 2; ++i) {
        ASSERT_FALSE(step().is_standing) << i;
    }
    step();
    EXPECT_TRUE(step().is_standing);
}

TEST_F(JointMonitorTest, AnArmThatLeavesItsStopIsReportedAndTheControllerIsNotJudged) {
    verifies("SWR-SAF-029", Technique::kBoundaryValues, Polarity::kViolation);
    drive_.source = TorqueSource::kStopLoop;
    step();
    command_.setpoint_rad[1] = 1.0;
    for (const double sign : {1.0, -1.0}) {
        drive_.stop_setpoint_rad[1] = sign * kStopDeviationRad * kInside;
        EXPECT_EQ(step().faults, 0U);
        drive_.stop_setpoint_rad[1] = sign * kStopDeviationRad * kOutside;
        EXPECT_EQ(step().faults, to_bit(ArmFault::kStopNotFollowed));
    }
    drive_.torque_enable = false;
    reading_.torque_enabled = false;
    EXPECT_EQ(step().faults, 0U);
}

TEST_F(JointMonitorTest, AnArmOnItsStopIsNoFault) {
    verifies("SWR-SAF-029");
    drive_.source = TorqueSource::kStopLoop;
    for (int i = 0; i < 100; ++i) {
        EXPECT_EQ(step().faults, 0U);
    }
}

TEST_F(JointMonitorTest, EachJointHasItsReducedSpeedInAllModesButAutomatic) {
    verifies("SWR-SAF-037", Technique::kBoundaryValues, Polarity::kViolation);
    for (std::size_t joint = 0U; joint < kArmJointCount; ++joint) {
        for (const OperatingMode mode :
             {OperatingMode::kReducedSpeed, OperatingMode::kHoldToRun, OperatingMode::kSwitchFailed}) {
            reading_.mode = mode;
            EXPECT_EQ(move(joint, kReducedSpeedRadS[joint] * kInside, 10).faults, 0U) << joint;
            EXPECT_EQ(move(joint, kReducedSpeedRadS[joint] * kOutside, 10).faults,
                      to_bit(ArmFault::kOverspeed));
        }
        reading_.mode = OperatingMode::kAutomatic;
        EXPECT_EQ(move(joint, kReducedSpeedRadS[joint] * kOutside, 10).faults, 0U) << joint;
    }
}

TEST_F(JointMonitorTest, AStopFromAutomaticMayBeginFasterThanTheReducedSpeed) {
    verifies("SWR-SAF-037");
    reading_.mode = OperatingMode::kReducedSpeed;
    drive_.source = TorqueSource::kStopLoop;
    for (int i = 1; i <= 200; ++i) {
        drive_.stop_setpoint_rad[1] = reading_.position_a_rad[1];
        ASSERT_EQ(move(1U, std::min(0.5, 0.005 * i), 1).faults, 0U) << i;
    }
}

TEST_F(JointMonitorTest, ABrakeTestIsJudgedByNoSetpoint) {
    verifies("SWR-SAF-029", Technique::kEquivalenceClasses);
    drive_.source = TorqueSource::kBrakeTest;
    drive_.stop_setpoint_rad[1] = 1.0;
    command_.setpoint_rad[1] = 1.0;
    EXPECT_EQ(step().faults, 0U);
}

TEST_F(JointMonitorTest, ARelayMayContradictOnlyForItsTime) {
    verifies("SWR-SAF-008", Technique::kBoundaryValues, Polarity::kViolation);
    drive_.relay_close = true;
    step();
    for (std::int64_t i = 1; i < kPathTime.ns / kFrame.ns; ++i) {
        ASSERT_EQ(step().faults, 0U) << i;
    }
    EXPECT_EQ(step().faults, to_bit(ArmFault::kPowerLost));
    reading_.relay_closed = true;
    EXPECT_EQ(step().faults, 0U);
    drive_.relay_close = false;
    reading_.relay_closed = false;
    for (int i = 0; i < 50; ++i) {
        ASSERT_EQ(step().faults, 0U) << i;
    }
}

}  // namespace
}  // namespace safe_arm
