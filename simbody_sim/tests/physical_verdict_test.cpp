// SPDX-License-Identifier: Apache-2.0
// Goal: the judge of the physics reports what happened, on both sides of each of its limits.
// Method: synthetic states, one per integration step, in which only the joint under test moves.
#include "mamori/simbody_sim/physical_verdict.hpp"

#include <limits>

#include "arm_test_support.hpp"

namespace mamori::sim {
namespace {

using namespace test;

class PhysicalVerdictTest : public ::testing::Test {
  protected:
    /// Feeds states of joint 3 until `until`; the first one lies one step after the last of the call before.
    void feed(Instant until, double position_rad, double speed_rad_s) {
        JointVector q{};
        JointVector u{};
        q[2] = position_rad;
        u[2] = speed_rad_s;
        while (now_ < until) {
            now_ = now_ + kPlantSubstep;
            sut_.on_substep(now_, q, u);
        }
    }
    static Instant at(Duration time) { return Instant{} + time; }

    const ArmModel model_ = load_shipped_model();
    PhysicalVerdict sut_{model_};
    Instant now_{};
};

TEST_F(PhysicalVerdictTest, NothingIsJudgedBeforeTheFirstStep) {
    verifies("SWR-SIM-014", Technique::kBoundaryValues);

    EXPECT_EQ(sut_.get_max_speed_rad_s(), JointVector{});
    EXPECT_EQ(sut_.get_min_position_margin_rad(), std::numeric_limits<double>::infinity());
    EXPECT_FALSE(sut_.get_standstill());
    EXPECT_EQ(sut_.get_hold_drift_rad(), 0.0);
    EXPECT_EQ(sut_.get_stop_travel_rad(), JointVector{});
    EXPECT_EQ(sut_.get_max_tracking_error_rad(), 0.0);
}

TEST_F(PhysicalVerdictTest, LargestSpeedOfEachJointIsKeptWithEitherSign) {
    verifies("SWR-SIM-014");

    feed(at(1_ms), 0.0, 0.5);
    feed(at(2_ms), 0.0, -0.75);
    feed(at(3_ms), 0.0, 0.25);
    EXPECT_EQ(sut_.get_max_speed_rad_s()[2], 0.75);
    EXPECT_EQ(sut_.get_max_speed_rad_s()[1], 0.0);
}

TEST_F(PhysicalVerdictTest, SmallestMarginIsKeptAndNegativeInsideAStop) {
    verifies("SWR-SIM-014", Technique::kBoundaryValues, Polarity::kViolation);

    feed(at(1_ms), model_.joints[2].position_max_rad - 0.25, 0.0);
    EXPECT_DOUBLE_EQ(sut_.get_min_position_margin_rad(), 0.25);
    feed(at(2_ms), model_.joints[2].position_min_rad - 0.125, 0.0);
    EXPECT_DOUBLE_EQ(sut_.get_min_position_margin_rad(), -0.125);
    feed(at(3_ms), 0.0, 0.0);
    EXPECT_DOUBLE_EQ(sut_.get_min_position_margin_rad(), -0.125);
}

TEST_F(PhysicalVerdictTest, StandstillIsTheFirstSlowInstantOnceItIsConfirmed) {
    verifies("SWR-SIM-014", Technique::kBoundaryValues);
    sut_.mark_stop();

    feed(at(10_ms), 0.0, 0.01);
    feed(at(60_ms), 0.0, 0.0099);
    EXPECT_FALSE(sut_.get_standstill()) << "one step short of 50 ms";
    feed(at(60_ms) + kPlantSubstep, 0.0, 0.0099);
    ASSERT_TRUE(sut_.get_standstill());
    EXPECT_EQ(*sut_.get_standstill(), at(10_ms) + kPlantSubstep);
}

TEST_F(PhysicalVerdictTest, AMovementWithinTheConfirmationStartsItAnew) {
    verifies("SWR-SIM-014", Technique::kStateTransition, Polarity::kViolation);
    sut_.mark_stop();

    feed(at(40_ms), 0.0, 0.0);
    feed(at(41_ms), 0.0, -0.02);
    feed(at(80_ms), 0.0, 0.0);
    EXPECT_FALSE(sut_.get_standstill());
    feed(at(100_ms), 0.0, 0.0);
    ASSERT_TRUE(sut_.get_standstill());
    EXPECT_EQ(*sut_.get_standstill(), at(41_ms) + kPlantSubstep);
}

TEST_F(PhysicalVerdictTest, ARestWithinTheMotionIsNoStandstill) {
    verifies("SWR-SIM-014", Technique::kStateTransition, Polarity::kViolation);

    feed(at(500_ms), 0.0, 0.0);
    EXPECT_FALSE(sut_.get_standstill());
    sut_.mark_stop();
    feed(at(600_ms), 0.0, 0.0);
    ASSERT_TRUE(sut_.get_standstill());
    EXPECT_EQ(*sut_.get_standstill(), at(500_ms) + kPlantSubstep);
}

TEST_F(PhysicalVerdictTest, DriftCountsFromTheStandstillOnAndForEver) {
    verifies("SWR-SIM-014", Technique::kRequirementsBased, Polarity::kViolation);
    sut_.mark_stop();

    feed(at(30_ms), 0.5, 0.0);
    feed(at(40_ms), 0.501, 0.0);
    feed(at(60_ms), 0.5, 0.0);
    ASSERT_TRUE(sut_.get_standstill());
    EXPECT_NEAR(sut_.get_hold_drift_rad(), 0.001, 1.0e-12)
        << "a slow creep inside the confirmation is drift, too";
    feed(at(70_ms), 0.3, 2.0);
    feed(at(200_ms), 0.5, 0.0);
    EXPECT_NEAR(sut_.get_hold_drift_rad(), 0.2, 1.0e-12);
    EXPECT_EQ(*sut_.get_standstill(), at(0_ms) + kPlantSubstep) << "the first standstill stays";
}

TEST_F(PhysicalVerdictTest, TravelIsTheLargestDistanceFromTheInjectionUntilStandstill) {
    verifies("SWR-SIM-014");
    feed(at(10_ms), 1.0, 0.5);
    EXPECT_EQ(sut_.get_stop_travel_rad()[2], 0.0);

    JointVector injected{};
    injected[2] = 0.5;
    sut_.mark_injection(injected);
    sut_.mark_stop();
    feed(at(20_ms), 0.75, 0.5);
    feed(at(80_ms), 0.625, 0.0);
    ASSERT_TRUE(sut_.get_standstill());
    feed(at(90_ms), 3.0, 0.0);
    EXPECT_EQ(sut_.get_stop_travel_rad()[2], 0.25);
    EXPECT_EQ(sut_.get_stop_travel_rad()[0], 0.0);
}

TEST_F(PhysicalVerdictTest, TrackingErrorIsTheLargestOfAllJudgedFrames) {
    verifies("SWR-SIM-014");
    JointVector reference{};

    reference[6] = -0.25;
    sut_.judge_tracking({}, reference);
    reference[6] = 0.125;
    sut_.judge_tracking({}, reference);
    EXPECT_EQ(sut_.get_max_tracking_error_rad(), 0.25);
}

TEST_F(PhysicalVerdictTest, ItSeesEachStepOfThePlant) {
    verifies("SWR-SIM-014", Technique::kInterface);
    ArmPlant plant(model_);
    plant.reset(kBentPose);
    plant.set_observer(&sut_);
    safety::ArmOutputs fall;
    fall.brake_release = true;
    fall.relay_close = true;

    ASSERT_EQ(plant.step(fall, 300_ms), Status::kOk);
    EXPECT_EQ(sut_.get_max_speed_rad_s()[1], std::abs(plant.velocities()[1]));
    EXPECT_GT(sut_.get_max_speed_rad_s()[1], 0.5);
}

}  // namespace
}  // namespace mamori::sim
