// SPDX-License-Identifier: Apache-2.0
// Goal: the plant moves as mechanics demands: energy, agreement with another integrator on another library,
// end stops.
#include <algorithm>
#include <limits>

#include "arm_test_support.hpp"
#include "mamori/simbody_sim/arm_dynamics.hpp"
#include "mamori/simbody_sim/computed_torque_controller.hpp"

namespace mamori::sim {
namespace {

using namespace test;

/// Released arm without friction and end stops.
ArmModel make_free_model() {
    ArmModel model = load_shipped_model();
    for (JointModel& joint : model.joints) {
        joint.viscous_friction_nm_s_rad = 0.0;
        joint.brake.opening_delay = {};
        joint.position_min_rad = -1000.0;
        joint.position_max_rad = 1000.0;
    }
    return model;
}

safety::ArmOutputs release_only() {
    safety::ArmOutputs outputs;
    outputs.brake_release = true;
    outputs.relay_close = true;
    return outputs;
}

/// Acceleration of the free arm from KDL, by Gaussian elimination.
JointVector calc_free_acceleration(ArmDynamics& dynamics, const JointVector& q, const JointVector& u) {
    JointMatrix a = dynamics.calc_mass_matrix(q);
    JointVector x = dynamics.calc_inverse_dynamics(q, u, {});
    for (std::size_t i = 0U; i < kArmJointCount; ++i) {
        x[i] = -x[i];
    }
    for (std::size_t i = 0U; i < kArmJointCount; ++i) {
        for (std::size_t row = i + 1U; row < kArmJointCount; ++row) {
            const double factor = a[row][i] / a[i][i];
            for (std::size_t k = i; k < kArmJointCount; ++k) {
                a[row][k] -= factor * a[i][k];
            }
            x[row] -= factor * x[i];
        }
    }
    for (std::size_t i = kArmJointCount; i-- > 0U;) {
        for (std::size_t k = i + 1U; k < kArmJointCount; ++k) {
            x[i] -= a[i][k] * x[k];
        }
        x[i] /= a[i][i];
    }
    return x;
}

JointVector add(const JointVector& a, double factor, const JointVector& b) {
    JointVector sum{};
    for (std::size_t i = 0U; i < kArmJointCount; ++i) {
        sum[i] = a[i] + factor * b[i];
    }
    return sum;
}

/// One step of the classical Runge-Kutta method.
void step_reference(ArmDynamics& dynamics, double h, JointVector& q, JointVector& u) {
    const JointVector a1 = calc_free_acceleration(dynamics, q, u);
    const JointVector u2 = add(u, 0.5 * h, a1);
    const JointVector a2 = calc_free_acceleration(dynamics, add(q, 0.5 * h, u), u2);
    const JointVector u3 = add(u, 0.5 * h, a2);
    const JointVector a3 = calc_free_acceleration(dynamics, add(q, 0.5 * h, u2), u3);
    const JointVector u4 = add(u, h, a3);
    const JointVector a4 = calc_free_acceleration(dynamics, add(q, h, u3), u4);
    q = add(add(add(add(q, h / 6.0, u), h / 3.0, u2), h / 3.0, u3), h / 6.0, u4);
    u = add(add(add(add(u, h / 6.0, a1), h / 3.0, a2), h / 3.0, a3), h / 6.0, a4);
}

TEST(ArmPlantMotionTest, FreeSwingKeepsItsEnergy) {
    verifies("SWR-SIM-004");
    const ArmModel model = make_free_model();
    ArmPlant sut(model);
    sut.reset(kBentPose);
    const double start = sut.calc_energy_j();

    double worst = 0.0;
    double fastest = 0.0;
    for (int frame = 0; frame < 2000; ++frame) {
        ASSERT_EQ(sut.step(release_only(), 1_ms), Status::kOk);
        worst = std::max(worst, std::abs(sut.calc_energy_j() - start));
        fastest = std::max(fastest, std::abs(sut.velocities()[1]));
    }
    RecordProperty("worst_energy_error_j", std::to_string(worst));
    EXPECT_GT(fastest, 2.0) << "the arm must have swung";
    EXPECT_LT(worst, 0.4);
}

TEST(ArmPlantMotionTest, FreeSwingAgreesWithRungeKuttaOnTheOtherLibrary) {
    verifies("SWR-SIM-004", Technique::kBackToBack);
    const ArmModel model = make_free_model();
    ArmPlant sut(model);
    sut.reset(kBentPose);
    ArmDynamics dynamics(model);
    JointVector q = kBentPose;
    JointVector u{};

    for (int frame = 0; frame < 500; ++frame) {
        ASSERT_EQ(sut.step(release_only(), 1_ms), Status::kOk);
        step_reference(dynamics, 1.0e-3, q, u);
    }
    EXPECT_GT(calc_distance(q, kBentPose), 0.5) << "the arm must have moved";
    RecordProperty("position_error_rad", std::to_string(calc_distance(sut.positions(), q)));
    EXPECT_LT(calc_distance(sut.positions(), q), 2.0e-3);
}

TEST(ArmPlantMotionTest, FrictionOnlyTakesEnergy) {
    verifies("SWR-SIM-004");
    ArmModel model = make_free_model();
    for (std::size_t i = 0U; i < kArmJointCount; ++i) {
        model.joints[i].viscous_friction_nm_s_rad = load_shipped_model().joints[i].viscous_friction_nm_s_rad;
    }
    ArmPlant sut(model);
    sut.reset(kBentPose);

    const double start = sut.calc_energy_j();
    double before = start;
    for (int interval = 0; interval < 20; ++interval) {
        ASSERT_EQ(sut.step(release_only(), 100_ms), Status::kOk);
        const double now = sut.calc_energy_j();
        EXPECT_LT(now, before);
        before = now;
    }
    EXPECT_LT(before, start - 10.0);
}

TEST(ArmPlantMotionTest, ArmatureSlowsTheFall) {
    verifies("SWR-SIM-004");
    ArmModel heavier = make_free_model();
    for (JointModel& joint : heavier.joints) {
        joint.rotor_inertia_kg_m2 *= 10.0;
    }
    ArmPlant light(make_free_model());
    ArmPlant heavy(heavier);
    light.reset(kBentPose);
    heavy.reset(kBentPose);

    ASSERT_EQ(light.step(release_only(), 200_ms), Status::kOk);
    ASSERT_EQ(heavy.step(release_only(), 200_ms), Status::kOk);
    EXPECT_LT(std::abs(heavy.velocities()[1]), 0.8 * std::abs(light.velocities()[1]));
}

TEST(ArmPlantMotionTest, GravityCompensationHoldsTheReleasedArm) {
    verifies("SWR-SIM-004", Technique::kBackToBack);
    const ArmModel model = load_shipped_model();
    ArmPlant sut(model);
    ComputedTorqueController controller(model);
    sut.reset(kBentPose);

    for (int frame = 0; frame < 1000; ++frame) {
        ASSERT_EQ(sut.step(command(controller.calc_gravity_torque(sut.positions())), 1_ms), Status::kOk);
    }
    EXPECT_FALSE(sut.sample().brake_closed[1]);
    EXPECT_LT(calc_distance(sut.positions(), kBentPose), 1.0e-6);
}

/// Drives joint 4 into a stop with half its torque while the other joints are held.
void drive_into_stop(double fraction, double& min_position, double& max_position, double& end_speed) {
    const ArmModel model = load_shipped_model();
    ArmPlant sut(model);
    ComputedTorqueController controller(model);
    JointVector target{};
    sut.reset(target);
    min_position = std::numeric_limits<double>::infinity();
    max_position = -min_position;
    for (int frame = 0; frame < 4000; ++frame) {
        target[3] = sut.positions()[3];
        JointVector torque = controller.calc_torque(target, {}, {}, sut.positions(), sut.velocities());
        torque[3] = fraction * model.joints[3].torque_limit_nm;
        ASSERT_EQ(sut.step(command(torque), 1_ms), Status::kOk);
        min_position = std::min(min_position, sut.positions()[3]);
        max_position = std::max(max_position, sut.positions()[3]);
    }
    end_speed = std::abs(sut.velocities()[3]);
}

TEST(ArmPlantMotionTest, EndStopsStopADrivenJointOnBothSides) {
    verifies("SWR-SIM-008", Technique::kBoundaryValues);
    const JointModel joint = load_shipped_model().joints[3];
    double min = 0.0;
    double max = 0.0;
    double speed = 1.0;

    drive_into_stop(0.5, min, max, speed);
    EXPECT_GT(max, joint.position_max_rad);
    EXPECT_LT(max, joint.position_max_rad + 0.1);
    EXPECT_LT(speed, 0.01);

    drive_into_stop(-0.5, min, max, speed);
    EXPECT_LT(min, joint.position_min_rad);
    EXPECT_GT(min, joint.position_min_rad - 0.1);
    EXPECT_LT(speed, 0.01);
}

TEST(ArmPlantMotionTest, ADurationThatIsNoWholeNumberOfStepsIsRefused) {
    verifies("SWR-SIM-010", Technique::kBoundaryValues);
    ArmPlant sut(load_shipped_model());

    EXPECT_EQ(sut.step({}, Duration{0}), Status::kBadParameter);
    EXPECT_EQ(sut.step({}, Duration{-250000}), Status::kBadParameter);
    EXPECT_EQ(sut.step({}, Duration{kPlantSubstep.ns - 1}), Status::kBadParameter);
    EXPECT_EQ(sut.step({}, Duration{kPlantSubstep.ns + 1}), Status::kBadParameter);
    EXPECT_EQ(sut.now(), Instant{});
    EXPECT_EQ(sut.step({}, kPlantSubstep), Status::kOk);
    EXPECT_EQ(sut.now(), Instant{} + kPlantSubstep);
}

}  // namespace
}  // namespace mamori::sim
