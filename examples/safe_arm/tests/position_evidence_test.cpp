// SPDX-License-Identifier: Apache-2.0
// Goal: a movement that the encoders or the clock do not show is reported, and nothing is reported of a sound
// arm. Method: readings made here; both sides of each limit.
#include "joint_monitor_fixture.hpp"

namespace safe_arm {
namespace {

using mamori::Instant;
using mamori::Status;
using namespace mamori::verification;

constexpr std::uint32_t kDoubtful = to_bit(ArmFault::kPositionDoubtful);
constexpr std::uint32_t kDeviation = to_bit(ArmFault::kClockDeviation);

class PositionEvidenceTest : public JointMonitorTest {
  protected:
    /// Lets the clock of the drives run at `rate` for `frames` frames. @return the last state.
    JointState run_clock(double rate, int frames) {
        JointState last{};
        for (int i = 0; i < frames; ++i) {
            drive_clock_ns_ += rate * static_cast<double>(kFrame.ns);
            reading_.drive_clock_ns = static_cast<std::int64_t>(drive_clock_ns_);
            last = step();
        }
        return last;
    }
    /// Mean torque difference of a joint that stands after `frames` frames with this torque.
    std::uint32_t push(std::size_t joint, double torque_nm, int frames) {
        reading_.measured_torque_nm[joint] = torque_nm;
        drive_.torque_nm[joint] = torque_nm;
        std::uint32_t faults = 0U;
        for (int i = 0; i < frames; ++i) {
            faults |= step().faults;
        }
        return faults;
    }

    static constexpr int kWindow = static_cast<int>(kClockLimits.window.ns / kFrame.ns);
    /// After this time, a mean value has its end value.
    static constexpr int kSettled = 5000;
    double drive_clock_ns_{7.0e9};
};

TEST_F(PositionEvidenceTest, ClocksMayDifferByFivePercent) {
    verifies("SWR-SAF-046", Technique::kBoundaryValues);
    for (const double rate : {0.953, 1.0, 1.052}) {
        ASSERT_EQ(sut_.on_activated({0, now_}), Status::kOk);
        EXPECT_FALSE(run_clock(rate, kWindow - 10).is_clock_checked);
        const JointState state = run_clock(rate, 2 * kWindow);
        EXPECT_EQ(state.faults, 0U) << rate;
        EXPECT_TRUE(state.is_clock_checked) << rate;
    }
}

TEST_F(PositionEvidenceTest, AClockThatIsWrongIsReportedAfterTwoWindows) {
    verifies("SWR-SAF-046", Technique::kFaultInjection, Polarity::kViolation);
    for (const double rate : {0.0, 0.1, 0.947, 1.056, 2.0, 10.0}) {
        ASSERT_EQ(sut_.on_activated({0, now_}), Status::kOk);
        ASSERT_EQ(run_clock(1.0, kWindow + 50).faults, 0U);
        const JointState state = run_clock(rate, 2 * kWindow);
        EXPECT_EQ(state.faults, kDeviation) << rate;
        EXPECT_FALSE(state.is_clock_checked);
        EXPECT_EQ(run_clock(1.0, 5 * kWindow).faults, kDeviation) << "it does not go by itself";
    }
    reading_.reset_button = true;
    EXPECT_EQ(step().faults, kDeviation) << "reset while torque is on";
    reading_.reset_button = false;
    rest();
    step();
    reading_.reset_button = true;
    EXPECT_EQ(run_clock(1.0, 1).faults, 0U);
}

TEST_F(PositionEvidenceTest, AClockThatRunsBackwardsIsReportedAtOnce) {
    verifies("SWR-SAF-046", Technique::kErrorGuessing, Polarity::kViolation);
    run_clock(1.0, 10);
    EXPECT_EQ(run_clock(-1.0, 1).faults, kDeviation);
}

TEST_F(PositionEvidenceTest, AClockThatReturnsToZeroIsReported) {
    verifies("SWR-SAF-046", Technique::kErrorGuessing, Polarity::kViolation);
    ASSERT_EQ(run_clock(1.0, 2 * kWindow).faults, 0U);
    drive_clock_ns_ = 0.0;
    EXPECT_EQ(run_clock(0.0, 1).faults, kDeviation);
    EXPECT_EQ(run_clock(0.0, 10).faults, kDeviation) << "it stays";
}

TEST_F(PositionEvidenceTest, WithoutASampleOfTheDrivesNoClockIsChecked) {
    verifies("SWR-SAF-047", Technique::kErrorGuessing, Polarity::kViolation);
    for (int i = 0; i < 3 * kWindow; ++i) {
        const JointState state = step();
        ASSERT_EQ(state.faults, 0U);
        ASSERT_FALSE(state.is_clock_checked);
    }
}

TEST_F(PositionEvidenceTest, AReferenceSwitchMayDifferWithinItsTolerance) {
    verifies("SWR-SAF-048", Technique::kBoundaryValues);
    for (std::size_t joint = 0U; joint < kArmJointCount; ++joint) {
        for (const double side : {1.0, -1.0}) {
            ASSERT_EQ(sut_.on_activated({0, now_}), Status::kOk);
            place(joint, side * kReferenceRad * kInside);
            reading_.reference_closed[joint] = side < 0.0;
            EXPECT_EQ(step().faults, 0U) << joint;
            place(joint, 0.0);
        }
    }
}

TEST_F(PositionEvidenceTest, AReferenceSwitchThatContradictsIsReported) {
    verifies("SWR-SAF-048", Technique::kBoundaryValues, Polarity::kViolation);
    for (std::size_t joint = 0U; joint < kArmJointCount; ++joint) {
        for (const double side : {1.0, -1.0}) {
            ASSERT_EQ(sut_.on_activated({0, now_}), Status::kOk);
            place(joint, side * kReferenceRad * kOutside);
            EXPECT_EQ(step().faults, 0U) << joint;
            reading_.reference_closed[joint] = side < 0.0;
            EXPECT_EQ(step().faults, kDoubtful) << joint;
            place(joint, 0.0);
        }
    }
}

TEST_F(PositionEvidenceTest, EachJointMayDifferFromItsModelByItsLimit) {
    verifies("SWR-SAF-049", Technique::kBoundaryValues);
    for (std::size_t joint = 0U; joint < kArmJointCount; ++joint) {
        for (const double side : {1.0, -1.0}) {
            drive_.gravity_nm[joint] = 20.0;
            EXPECT_EQ(push(joint, 20.0 + side * kModelDifferenceNm[joint] * kInside, kSettled), 0U) << joint;
            EXPECT_EQ(push(joint, 20.0, kSettled), 0U);
            drive_.gravity_nm[joint] = 0.0;
            EXPECT_EQ(push(joint, 0.0, kSettled), 0U);
        }
    }
}

TEST_F(PositionEvidenceTest, AJointWhoseTorqueNeedsAnotherPositionIsReported) {
    verifies("SWR-SAF-049", Technique::kBoundaryValues, Polarity::kViolation);
    for (std::size_t joint = 0U; joint < kArmJointCount; ++joint) {
        for (const double side : {1.0, -1.0}) {
            EXPECT_EQ(push(joint, side * kModelDifferenceNm[joint] * 1.01, kSettled), kDoubtful) << joint;
            push(joint, 0.0, kSettled);
        }
    }
}

TEST_F(PositionEvidenceTest, AShortTorqueIsNoContradictionAndATwiceAsLargeOneIsFoundInItsTime) {
    verifies("SWR-SAF-049", Technique::kBoundaryValues);
    const double twice_nm = 2.0 * kModelDifferenceNm[3];
    const int half_ms = static_cast<int>(kModelTimeS / kFrameS * 0.693);  // ln 2
    EXPECT_EQ(push(3U, twice_nm, half_ms - 2), 0U);
    EXPECT_EQ(push(3U, twice_nm, 4), kDoubtful);
}

TEST_F(PositionEvidenceTest, FrictionAndOwnAccelerationNeedTheirTorque) {
    verifies("SWR-SAF-049");
    double speed_rad_s = 0.0;
    for (int i = 0; i < 1000; ++i) {
        const double acceleration = i < 400 ? 2.0 : -2.0;
        speed_rad_s = i < 800 ? speed_rad_s + acceleration * kFrameS : 0.0;
        const double torque_nm = i < 800 ? kInertiaRoot[0] * kInertiaRoot[0] * acceleration : 0.0;
        reading_.measured_torque_nm[0] = torque_nm + kFrictionNmSRad[0] * speed_rad_s;
        drive_.torque_nm[0] = reading_.measured_torque_nm[0];
        ASSERT_EQ(move(0U, speed_rad_s, 1).faults, 0U) << i;
    }
}

TEST_F(PositionEvidenceTest, ATorqueCountsUpToTwiceTheLimitOfItsDrive) {
    verifies("SWR-SAF-049", Technique::kBoundaryValues, Polarity::kViolation);
    EXPECT_EQ(push(1U, 2.0 * kTorqueLimitNm[1] * kOutside, 10), 0U) << "no drive has it";
    EXPECT_EQ(push(1U, 2.0 * kTorqueLimitNm[1] * kInside, 10), kDoubtful);
}

TEST_F(PositionEvidenceTest, ASpeedBeforeTheBrakesClosedHidesNoTorqueAfterwards) {
    verifies("SWR-SAF-049", Technique::kErrorGuessing, Polarity::kViolation);
    reading_.measured_torque_nm[0] = kFrictionNmSRad[0] * 0.5;
    drive_.torque_nm[0] = reading_.measured_torque_nm[0];
    for (int i = 0; i < 2000; ++i) {
        // From standstill without a jump: acceleration counts.
        ASSERT_EQ(move(0U, i < 1000 ? 0.0005 * i : 0.5, 1).faults & kDoubtful, 0U) << i;
    }
    drive_.brake_release = false;
    reading_.brakes_open = false;
    reading_.brakes_closed = true;
    push(0U, 0.0, 10);
    drive_.brake_release = true;
    reading_.brakes_open = true;
    reading_.brakes_closed = false;

    const int half_ms = static_cast<int>(kModelTimeS / kFrameS * 0.693);  // ln 2
    EXPECT_EQ(push(0U, 2.0 * kModelDifferenceNm[0], half_ms + 2), kDoubtful);
}

TEST_F(PositionEvidenceTest, AContactThatFlickersDoesNotClearTheMean) {
    verifies("SWR-SAF-049", Technique::kErrorGuessing, Polarity::kViolation);
    std::uint32_t faults = 0U;
    for (int i = 0; i < 20; ++i) {
        faults |= push(1U, 2.0 * kModelDifferenceNm[1], 100);
        reading_.brakes_open = !reading_.brakes_open;
        step();
        reading_.brakes_open = !reading_.brakes_open;
    }
    EXPECT_EQ(faults, kDoubtful);
}

TEST_F(PositionEvidenceTest, AHoldBehindFailedBrakesMayTakeAnyTorque) {
    verifies("SWR-SAF-049", Technique::kEquivalenceClasses);
    drive_.source = TorqueSource::kStopLoop;
    drive_.brake_release = false;
    EXPECT_EQ(push(1U, 60.0, kSettled) & kDoubtful, 0U) << "open brakes that were commanded to close";
}

TEST_F(PositionEvidenceTest, WithClosedBrakesTheTorqueShowsNoPosition) {
    verifies("SWR-SAF-049", Technique::kEquivalenceClasses);
    drive_.brake_release = false;
    drive_.source = TorqueSource::kBrakeTest;
    reading_.brakes_open = false;
    reading_.brakes_closed = true;
    EXPECT_EQ(push(1U, 100.0, kSettled), 0U);
    reading_.brakes_open = true;
    reading_.brakes_closed = false;
    drive_.brake_release = true;
    drive_.source = TorqueSource::kStopLoop;
    EXPECT_EQ(push(1U, 0.0, 10), 0U) << "the mean begins again";
}

TEST_F(PositionEvidenceTest, AnArmThatMovesWithoutTorqueIsReported) {
    verifies("SWR-SAF-034", Technique::kBoundaryValues, Polarity::kViolation);
    rest();
    for (const double direction : {1.0, -1.0}) {
        place(1U, 0.5);
        ASSERT_EQ(sut_.on_activated({0, now_}), Status::kOk);
        EXPECT_EQ(move(1U, 0.0, 200).faults, 0U);
        place(1U, 0.5 + direction * kRestTravelRad * kInside);
        move(1U, 0.0, 5);
        EXPECT_EQ(step().faults & to_bit(ArmFault::kMovementAtRest), 0U);
        place(1U, 0.5 + direction * kRestTravelRad * kOutside);
        EXPECT_EQ(step().faults & to_bit(ArmFault::kMovementAtRest), to_bit(ArmFault::kMovementAtRest));
    }
}

TEST_F(PositionEvidenceTest, ACreepThatIsSlowerThanStandstillIsReportedAtItsTravel) {
    verifies("SWR-SAF-034", Technique::kFaultInjection, Polarity::kViolation);
    step();
    rest();
    move(3U, 0.0, 150);
    const double begin_rad = reading_.position_a_rad[3];
    int frames = 0;
    while (move(3U, 0.9 * kStandstillRadS, 1).faults == 0U && frames < 1000) {
        ++frames;
    }
    EXPECT_NEAR(reading_.position_a_rad[3] - begin_rad, kRestTravelRad, 2.0 * kStandstillRadS * kFrameS);
}

TEST_F(PositionEvidenceTest, TheSagWhileTheBrakesEngageAndAMovementUnderTorqueAreNoMovementAtRest) {
    verifies("SWR-SAF-034");
    move(1U, 0.5, 100);
    rest();
    EXPECT_EQ(move(1U, 0.2, static_cast<int>(kBrakeFeedbackTime.ns / kFrame.ns)).faults, 0U);
    EXPECT_EQ(move(1U, 0.0, 1000).faults, 0U);
}

TEST_F(PositionEvidenceTest, TheRestBeginsWithTheFrameInWhichTheBrakesMustHold) {
    verifies("SWR-SAF-034", Technique::kBoundaryValues, Polarity::kViolation);
    const auto engaging = static_cast<int>(kBrakeFeedbackTime.ns / kFrame.ns);
    step();
    rest();
    move(6U, 0.0, engaging - 1);
    EXPECT_EQ(move(6U, 6.0, 1).faults, 0U);
    EXPECT_EQ(move(6U, 0.0, 50).faults, 0U);
    EXPECT_EQ(move(6U, 6.0, 1).faults, to_bit(ArmFault::kMovementAtRest));
}

TEST_F(PositionEvidenceTest, AResetBeginsTheRestAgain) {
    verifies("SWR-SAF-034", Technique::kStateTransition);
    rest();
    move(1U, 0.0, 150);
    EXPECT_EQ(move(1U, 0.2, 50).faults, to_bit(ArmFault::kMovementAtRest));
    EXPECT_EQ(move(1U, 0.0, 50).faults, to_bit(ArmFault::kMovementAtRest)) << "it does not go by itself";

    reading_.reset_button = true;
    EXPECT_EQ(step().faults, 0U);
    reading_.reset_button = false;
    EXPECT_EQ(move(1U, 0.0, 200).faults, 0U);
}

}  // namespace
}  // namespace safe_arm
