// SPDX-License-Identifier: Apache-2.0
// Goal: the controller is the formula it says, and makes the simulated arm follow a motion through its
// encoders.
#include "mamori/simbody_sim/computed_torque_controller.hpp"

#include "arm_test_support.hpp"
#include "mamori/simbody_sim/arm_multibody.hpp"

namespace mamori::sim {
namespace {

using namespace test;

TEST(ComputedTorqueControllerTest, TorqueIsMassTimesWantedAccelerationPlusBiasOfTheOtherLibrary) {
    verifies("SWR-SIM-013", Technique::kBackToBack);
    const ArmModel model = load_shipped_model();
    ArmMultibody simbody(model);
    const TrackingGains gains{90.0, 11.0};
    ComputedTorqueController sut(model, gains);
    Numbers numbers(3U);

    for (int state = 0; state < 100; ++state) {
        const JointVector q = numbers.draw_vector(-1.6, 1.6);
        const JointVector qd = numbers.draw_vector(-2.0, 2.0);
        const JointVector q_ref = numbers.draw_vector(-1.6, 1.6);
        const JointVector qd_ref = numbers.draw_vector(-2.0, 2.0);
        const JointVector qdd_ref = numbers.draw_vector(-5.0, 5.0);
        simbody.evaluate(q, qd);
        JointVector expected = simbody.get_bias_torque();
        for (std::size_t i = 0U; i < kArmJointCount; ++i) {
            for (std::size_t k = 0U; k < kArmJointCount; ++k) {
                const double wanted =
                    qdd_ref[k] + gains.kp_per_s2 * (q_ref[k] - q[k]) + gains.kd_per_s * (qd_ref[k] - qd[k]);
                expected[i] += simbody.get_mass_matrix()[i][k] * wanted;
            }
        }
        ASSERT_LT(calc_distance(sut.calc_torque(q_ref, qd_ref, qdd_ref, q, qd), expected), 1.0e-9);
    }
}

TEST(ComputedTorqueControllerTest, ArmFollowsASineThroughItsEncoders) {
    verifies("SWR-SIM-013");
    const ArmModel model = load_shipped_model();
    ArmPlant plant(model);
    ComputedTorqueController sut(model);
    plant.reset(kBentPose);
    constexpr double kPeriod_s = 1.0e-3;
    constexpr double kAmplitude_rad = 0.2;

    JointVector before = kBentPose;
    double worst = 0.0;
    for (int frame = 0; frame < 3000; ++frame) {
        // The arm rests until the brakes are open, then swings up and down; the speed starts from zero.
        const double t = kPeriod_s * std::fmax(0.0, frame - 100.0);
        JointVector q_ref = kBentPose;
        JointVector qd_ref{};
        JointVector qdd_ref{};
        JointVector q{};
        JointVector qd{};
        for (std::size_t i = 0U; i < kArmJointCount; ++i) {
            const double w = 1.0 + 0.2 * static_cast<double>(i);
            q_ref[i] += kAmplitude_rad * (1.0 - std::cos(w * t));
            qd_ref[i] = kAmplitude_rad * w * std::sin(w * t);
            qdd_ref[i] = kAmplitude_rad * w * w * std::cos(w * t);
            q[i] = plant.sample().encoder_a_counts[i] / model.joints[i].encoder_a_counts_per_rad;
            qd[i] = (q[i] - before[i]) / kPeriod_s;
        }
        worst = std::fmax(worst, calc_distance(plant.positions(), q_ref));
        before = q;
        ASSERT_EQ(plant.step(command(sut.calc_torque(q_ref, qd_ref, qdd_ref, q, qd)), 1_ms), Status::kOk);
    }
    RecordProperty("worst_error_rad", std::to_string(worst));
    EXPECT_GT(calc_distance(plant.positions(), kBentPose), 0.1) << "the arm must have moved";
    EXPECT_LT(worst, 0.01);
}

}  // namespace
}  // namespace mamori::sim
