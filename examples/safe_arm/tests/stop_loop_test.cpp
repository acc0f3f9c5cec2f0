// SPDX-License-Identifier: Apache-2.0
// Goal: a stop is a ramp from the measured speed to rest, and a hold stays at its place. Method: an arm of
// known inertia that follows the torque, and arms that do not.
#include "stop_loop.hpp"

#include <cmath>

#include "arm_limits.hpp"
#include "gravity_model.hpp"
#include "mamori/trace/verifies.hpp"

namespace safe_arm {
namespace {

using namespace mamori::verification;

constexpr double kInertia = 4.0;

JointVector step(StopLoop& sut, const JointState& state) {
    return sut.step(state, calc_gravity_torque(state.position_rad));
}

TEST(StopLoopTest, AMovingArmIsBroughtToRestOnItsRamp) {
    verifies("SWR-SAF-025");
    StopLoop sut;
    JointState state{};
    state.velocity_rad_s.fill(0.0);
    state.velocity_rad_s[1] = 0.5;
    double before = 0.5;
    for (int frame = 0; frame < 500; ++frame) {
        const double torque_nm = step(sut, state)[1] - calc_gravity_torque(state.position_rad)[1];
        state.velocity_rad_s[1] += torque_nm / kInertia * kFrameS;
        state.position_rad[1] += state.velocity_rad_s[1] * kFrameS;
        ASSERT_LT(std::fabs(state.position_rad[1] - sut.get_setpoint()[1]), 0.5 * kStopDeviationRad) << frame;
        ASSERT_LT(state.velocity_rad_s[1], before + 0.02) << frame;
        before = state.velocity_rad_s[1];
    }
    EXPECT_NEAR(sut.get_setpoint()[1], 0.5 * kStopRampS / 3.0, 1e-3) << "a speed that ends as a parabola";
    EXPECT_NEAR(state.velocity_rad_s[1], 0.0, 1e-3);
    EXPECT_NEAR(state.position_rad[1], sut.get_setpoint()[1], 1e-3);
    EXPECT_EQ(sut.get_setpoint()[0], 0.0);
}

TEST(StopLoopTest, AHoldCarriesTheArmAndPushesBack) {
    verifies("SWR-SAF-025", Technique::kEquivalenceClasses);
    StopLoop sut;
    JointState state{};
    state.position_rad[1] = 0.4;
    state.position_rad[3] = 1.0;
    EXPECT_EQ(step(sut, state), calc_gravity_torque(state.position_rad));
    state.position_rad[3] = 1.001;
    const double carried_nm = calc_gravity_torque(state.position_rad)[3];
    EXPECT_NEAR(step(sut, state)[3], carried_nm - 0.001 * kStopStiffness[3], 1e-9);
    state.velocity_rad_s[3] = 0.1;
    EXPECT_NEAR(step(sut, state)[3], carried_nm - 0.001 * kStopStiffness[3] - 0.1 * kStopDamping[3], 1e-9);
}

TEST(StopLoopTest, AReleaseEndsTheHold) {
    verifies("SWR-SAF-025", Technique::kStateTransition, Polarity::kViolation);
    StopLoop sut;
    static_cast<void>(step(sut, {}));
    sut.release();
    JointState state{};
    state.position_rad[0] = 2.0;
    EXPECT_NEAR(step(sut, state)[0], 0.0, 1e-12) << "a new place; gravity does not turn the base";
    EXPECT_EQ(sut.get_setpoint()[0], 2.0);
}

}  // namespace
}  // namespace safe_arm
