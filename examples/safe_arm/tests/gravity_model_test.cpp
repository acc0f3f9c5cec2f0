// SPDX-License-Identifier: Apache-2.0
// Goal: the torque that holds the arm is right in every pose. Method: comparison with two independent models
// of the simulated arm, Simbody and KDL, and with a calculation by hand.
#include "gravity_model.hpp"

#include <limits>
#include <random>

#include "mamori/simbody_sim/arm_dynamics.hpp"
#include "mamori/simbody_sim/arm_multibody.hpp"
#include "mamori/trace/verifies.hpp"

namespace safe_arm {
namespace {

using namespace mamori::verification;

TEST(GravityModelTest, TwoOtherModelsAgreeInRandomPoses) {
    verifies("SWR-SAF-040", Technique::kBackToBack);
    const mamori::sim::LoadedModel loaded = mamori::sim::load_arm_model(SAFE_ARM_MODEL_FILE);
    ASSERT_TRUE(loaded.model.has_value()) << loaded.error;
    mamori::sim::ArmMultibody simbody{*loaded.model};
    mamori::sim::ArmDynamics kdl{*loaded.model};
    std::mt19937_64 random{40U};
    std::uniform_real_distribution<double> share{-1.0, 1.0};
    for (int pose = 0; pose < 1000; ++pose) {
        JointVector position_rad{};
        for (std::size_t j = 0U; j < kArmJointCount; ++j) {
            const mamori::sim::JointModel& joint = loaded.model->joints[j];
            position_rad[j] =
                0.99 * share(random) * std::min(-joint.position_min_rad, joint.position_max_rad);
        }
        const JointVector torque_nm = calc_gravity_torque(position_rad);
        simbody.evaluate(position_rad, {});
        const JointVector of_kdl = kdl.calc_gravity_torque(position_rad);
        for (std::size_t j = 0U; j < kArmJointCount; ++j) {
            ASSERT_NEAR(torque_nm[j], simbody.get_bias_torque()[j], 1e-9) << pose << ' ' << j;
            ASSERT_NEAR(torque_nm[j], of_kdl[j], 1e-9) << pose << ' ' << j;
        }
    }
}

TEST(GravityModelTest, AnUprightArmNeedsAlmostNoTorque) {
    verifies("SWR-SAF-040", Technique::kBoundaryValues);
    const JointVector torque_nm = calc_gravity_torque({});
    for (const std::size_t j : {0U, 1U, 3U, 4U, 5U, 6U}) {
        EXPECT_NEAR(torque_nm[j], 0.0, 1e-12)
            << j << ": the wrist is 2.5 mm next to the axis of the arm, in x";
    }
}

TEST(GravityModelTest, APositionThatIsNoAngleCountsAsZero) {
    verifies("SWR-SAF-040", Technique::kErrorGuessing);
    JointVector position_rad{0.0, 0.5, 0.0, 0.4, 0.0, 0.3, 0.0};
    position_rad[3] = 0.0;
    const JointVector at_zero = calc_gravity_torque(position_rad);
    for (const double angle : {1.0000001e6, -1.0e9, std::numeric_limits<double>::quiet_NaN(),
                               std::numeric_limits<double>::infinity()}) {
        position_rad[3] = angle;
        EXPECT_EQ(calc_gravity_torque(position_rad), at_zero) << angle;
    }
}

}  // namespace
}  // namespace safe_arm
