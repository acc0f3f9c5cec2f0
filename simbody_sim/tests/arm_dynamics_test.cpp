// SPDX-License-Identifier: Apache-2.0
// Goal: two independently written libraries give the same equations of motion for the shipped model.
// Method: seeded random states over the whole range of positions and speeds.
#include "mamori/simbody_sim/arm_dynamics.hpp"

#include "arm_test_support.hpp"
#include "mamori/simbody_sim/arm_multibody.hpp"

namespace mamori::sim {
namespace {

using namespace test;

constexpr int kStates = 500;

class ArmDynamicsTest : public ::testing::Test {
  protected:
    JointVector draw_positions() {
        JointVector q{};
        for (std::size_t i = 0U; i < kArmJointCount; ++i) {
            q[i] = numbers_.draw(model_.joints[i].position_min_rad, model_.joints[i].position_max_rad);
        }
        return q;
    }

    const ArmModel model_ = load_shipped_model();
    ArmMultibody simbody_{model_};
    ArmDynamics kdl_{model_};
    Numbers numbers_{20260101U};
};

TEST_F(ArmDynamicsTest, SimbodyAndKdlGiveTheSameMassMatrix) {
    verifies("SWR-SIM-003", Technique::kBackToBack);

    for (int state = 0; state < kStates; ++state) {
        const JointVector q = draw_positions();
        simbody_.evaluate(q, {});
        const JointMatrix expected = kdl_.calc_mass_matrix(q);
        for (std::size_t i = 0U; i < kArmJointCount; ++i) {
            ASSERT_LT(calc_distance(simbody_.get_mass_matrix()[i], expected[i]), 1.0e-12)
                << "state " << state;
        }
    }
}

TEST_F(ArmDynamicsTest, SimbodyAndKdlGiveTheSameGravityTorque) {
    verifies("SWR-SIM-003", Technique::kBackToBack);

    double largest = 0.0;
    for (int state = 0; state < kStates; ++state) {
        const JointVector q = draw_positions();
        simbody_.evaluate(q, {});
        ASSERT_LT(calc_distance(simbody_.get_bias_torque(), kdl_.calc_gravity_torque(q)), 1.0e-11)
            << "state " << state;
        largest = std::fmax(largest, std::fabs(simbody_.get_bias_torque()[1]));
    }
    EXPECT_GT(largest, 50.0);
    EXPECT_LT(largest, 100.0);
}

TEST_F(ArmDynamicsTest, SimbodyAndKdlGiveTheSameInverseDynamics) {
    verifies("SWR-SIM-003", Technique::kBackToBack);

    for (int state = 0; state < kStates; ++state) {
        const JointVector q = draw_positions();
        const JointVector u = numbers_.draw_vector(-6.0, 6.0);
        const JointVector acceleration = numbers_.draw_vector(-50.0, 50.0);
        simbody_.evaluate(q, u);
        JointVector torque = simbody_.get_bias_torque();
        for (std::size_t i = 0U; i < kArmJointCount; ++i) {
            for (std::size_t k = 0U; k < kArmJointCount; ++k) {
                torque[i] += simbody_.get_mass_matrix()[i][k] * acceleration[k];
            }
        }
        ASSERT_LT(calc_distance(torque, kdl_.calc_inverse_dynamics(q, u, acceleration)), 1.0e-10)
            << "state " << state;
    }
}

TEST_F(ArmDynamicsTest, ArmatureStandsOnTheDiagonal) {
    verifies("SWR-SIM-003");
    ArmModel heavier = model_;
    heavier.joints[4].rotor_inertia_kg_m2 *= 2.0;
    ArmMultibody changed(heavier);

    simbody_.evaluate(kBentPose, {});
    changed.evaluate(kBentPose, {});
    const double armature = calc_armature(model_.joints[4]);
    EXPECT_NEAR(armature, 50.0 * 50.0 * 1.2e-5, 1.0e-15);
    EXPECT_NEAR(changed.get_mass_matrix()[4][4] - simbody_.get_mass_matrix()[4][4], armature, 1.0e-14);
    EXPECT_EQ(changed.get_mass_matrix()[3][4], simbody_.get_mass_matrix()[3][4]);
}

}  // namespace
}  // namespace mamori::sim
