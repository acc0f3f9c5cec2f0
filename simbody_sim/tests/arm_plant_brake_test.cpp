// SPDX-License-Identifier: Apache-2.0
// Goal: a brake holds what it can hold, slips above it, and stops a falling arm.
// Method: joint 2 carries the weight of the bent arm; its brake is scaled against that load.
#include "arm_test_support.hpp"
#include "mamori/simbody_sim/computed_torque_controller.hpp"

namespace mamori::sim {
namespace {

using namespace test;

/// Brake of joint 2 as a multiple of the torque with which gravity loads it in the bent pose.
ArmModel make_model_with_brake(double load_factor) {
    ArmModel model = load_shipped_model();
    ComputedTorqueController controller(model);
    model.joints[1].brake.torque_nm = load_factor * std::abs(controller.calc_gravity_torque(kBentPose)[1]);
    return model;
}

TEST(ArmPlantBrakeTest, BrakeHoldsOneAndAHalfTimesItsLoadWithoutCreep) {
    verifies("SWR-SIM-007");
    ArmPlant sut(make_model_with_brake(1.5));
    sut.reset(kBentPose);

    ASSERT_EQ(sut.step({}, 500_ms), Status::kOk);
    const JointVector held = sut.positions();
    EXPECT_LT(calc_distance(held, kBentPose), 5.0e-3);
    ASSERT_EQ(sut.step({}, 2_s), Status::kOk);
    EXPECT_LT(calc_distance(sut.positions(), held), 1.0e-6);
}

TEST(ArmPlantBrakeTest, BrakeSlipsUnderFiveTimesItsTorque) {
    verifies("SWR-SIM-007", Technique::kFaultInjection);
    ArmPlant sut(make_model_with_brake(0.2));
    sut.reset(kBentPose);

    ASSERT_EQ(sut.step({}, 500_ms), Status::kOk);
    EXPECT_GT(sut.positions()[1] - kBentPose[1], 0.3);
}

TEST(ArmPlantBrakeTest, BrakeSlipsJustBelowItsLoadAndHoldsJustAboveIt) {
    verifies("SWR-SIM-007", Technique::kBoundaryValues);
    ArmPlant above(make_model_with_brake(1.05));
    ArmPlant below(make_model_with_brake(0.95));
    above.reset(kBentPose);
    below.reset(kBentPose);

    ASSERT_EQ(above.step({}, 2_s), Status::kOk);
    ASSERT_EQ(below.step({}, 2_s), Status::kOk);
    EXPECT_LT(calc_distance(above.velocities(), {}), 1.0e-4);
    EXPECT_LT(calc_distance(above.positions(), kBentPose), 0.02);
    EXPECT_GT(below.positions()[1] - kBentPose[1], 0.1);
}

TEST(ArmPlantBrakeTest, CreepingBrakeYieldsToItsLoadWithItsSpeed) {
    verifies("SWR-SIM-007", Technique::kFaultInjection);
    ArmPlant sut(make_model_with_brake(2.0));
    sut.reset(kBentPose);
    ASSERT_EQ(sut.step({}, 500_ms), Status::kOk);
    const double begin_rad = sut.positions()[1];
    sut.faults().brake_creep_rad_s[1] = 0.02;

    ASSERT_EQ(sut.step({}, 1_s), Status::kOk);
    EXPECT_NEAR(sut.positions()[1] - begin_rad, 0.02, 0.001);
}

TEST(ArmPlantBrakeTest, FadedBrakeSlips) {
    verifies("SWR-SIM-007", Technique::kFaultInjection);
    ArmPlant sut(make_model_with_brake(2.0));
    sut.reset(kBentPose);
    ASSERT_EQ(sut.step({}, 200_ms), Status::kOk);
    ASSERT_LT(calc_distance(sut.positions(), kBentPose), 5.0e-3);

    sut.faults().brake_fade[1] = 0.9;
    ASSERT_EQ(sut.step({}, 500_ms), Status::kOk);
    EXPECT_GT(sut.positions()[1] - kBentPose[1], 0.3);
}

TEST(ArmPlantBrakeTest, ABrakeThatSlippedHoldsWhereItCaughtTheJoint) {
    verifies("SWR-SIM-007", Technique::kStateTransition);
    ArmPlant sut(make_model_with_brake(3.0));
    sut.reset(kBentPose);
    sut.faults().brake_fade[1] = 0.9;
    ASSERT_EQ(sut.step({}, 400_ms), Status::kOk);
    ASSERT_GT(sut.positions()[1] - kBentPose[1], 0.1);

    const double recovered_at = sut.positions()[1];
    sut.faults().brake_fade[1] = 0.0;
    ASSERT_EQ(sut.step({}, 2_s), Status::kOk);
    EXPECT_GT(sut.positions()[1], recovered_at) << "friction takes speed, it does not pull back";
    EXPECT_LT(calc_distance(sut.velocities(), {}), 1.0e-3);
}

TEST(ArmPlantBrakeTest, LostBrakeLetsTheJointFall) {
    verifies("SWR-SIM-007", Technique::kBoundaryValues);
    ArmPlant sut(load_shipped_model());
    sut.reset(kBentPose);

    sut.faults().brake_fade[1] = 1.0;
    ASSERT_EQ(sut.step({}, 300_ms), Status::kOk);
    EXPECT_GT(sut.positions()[1] - kBentPose[1], 0.2);
}

TEST(ArmPlantBrakeTest, BrakesOpenAndCloseAfterTheirDelays) {
    verifies("SWR-SIM-007", Technique::kBoundaryValues);
    const ArmModel model = load_shipped_model();
    ComputedTorqueController controller(model);
    const safety::ArmOutputs hold = command(controller.calc_gravity_torque(kBentPose));
    const BrakeModel& brake = model.joints[1].brake;
    ArmPlant sut(model);
    sut.reset(kBentPose);

    EXPECT_TRUE(sut.sample().brake_closed[1]);
    ASSERT_EQ(sut.step(hold, brake.opening_delay), Status::kOk);
    EXPECT_TRUE(sut.sample().brake_closed[1]);
    ASSERT_EQ(sut.step(hold, kPlantSubstep), Status::kOk);
    EXPECT_FALSE(sut.sample().brake_closed[1]);

    safety::ArmOutputs close = hold;
    close.brake_release = false;
    ASSERT_EQ(sut.step(close, brake.closing_delay), Status::kOk);
    EXPECT_FALSE(sut.sample().brake_closed[1]);
    ASSERT_EQ(sut.step(close, kPlantSubstep), Status::kOk);
    EXPECT_TRUE(sut.sample().brake_closed[1]);
}

TEST(ArmPlantBrakeTest, PowerLossInMotionTravelsLittleAndEndsHeld) {
    verifies("SWR-SIM-007", Technique::kFaultInjection);
    const ArmModel model = load_shipped_model();
    ComputedTorqueController controller(model);
    ArmPlant sut(model);
    sut.reset(kBentPose);
    JointVector target = kBentPose;
    JointVector speed{};
    for (int frame = 0; frame < 500; ++frame) {
        speed.fill(frame < 100 ? 0.0 : 0.4);
        for (std::size_t i = 0U; i < kArmJointCount; ++i) {
            target[i] += 1.0e-3 * speed[i];
        }
        const JointVector torque =
            controller.calc_torque(target, speed, {}, sut.positions(), sut.velocities());
        ASSERT_EQ(sut.step(command(torque), 1_ms), Status::kOk);
    }
    ASSERT_GT(sut.velocities()[1], 0.35);

    const JointVector lost_at = sut.positions();
    sut.faults().power_lost = true;
    double travel = 0.0;
    for (int frame = 0; frame < 1000; ++frame) {
        ASSERT_EQ(sut.step(command({}), 1_ms), Status::kOk);
        travel = std::fmax(travel, calc_distance(sut.positions(), lost_at));
    }
    RecordProperty("travel_rad", std::to_string(travel));
    EXPECT_GT(travel, 0.4 * 0.03) << "the brakes need their delay";
    EXPECT_LT(travel, 0.1);
    EXPECT_LT(calc_distance(sut.velocities(), {}), 1.0e-3);
}

TEST(ArmPlantBrakeTest, ABrakeThatIsStuckOpenStaysOpenOnceItIsOpenAndSaysSo) {
    verifies("SWR-SIM-012", Technique::kFaultInjection);
    const ArmModel model = load_shipped_model();
    ComputedTorqueController controller(model);
    const safety::ArmOutputs hold = command(controller.calc_gravity_torque(kBentPose));
    ArmPlant sut(model);
    sut.reset(kBentPose);
    sut.faults().brake_stuck_open[1] = true;
    ASSERT_EQ(sut.step({}, 100_ms), Status::kOk);
    EXPECT_TRUE(sut.sample().brake_closed[1]) << "a closed brake stays closed";
    ASSERT_EQ(sut.step(hold, 100_ms), Status::kOk);

    safety::ArmOutputs close = hold;
    close.brake_release = false;
    ASSERT_EQ(sut.step(close, 200_ms), Status::kOk);
    EXPECT_FALSE(sut.sample().brake_closed[1]);
    EXPECT_TRUE(sut.sample().brake_closed[0]);
    EXPECT_LT(calc_distance(sut.positions(), kBentPose), 1e-3) << "torque holds the joint";
}

}  // namespace
}  // namespace mamori::sim
