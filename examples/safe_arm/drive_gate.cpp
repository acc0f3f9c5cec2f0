// SPDX-License-Identifier: Apache-2.0
#include "drive_gate.hpp"

#include <cmath>

#include "arm_limits.hpp"
#include "gravity_model.hpp"
#include "mamori/safety/arm/guards.hpp"

namespace safe_arm {
namespace {

/// The torque nearest to the wanted one that is at most `distance_nm` away from `center_nm`. What is not a
/// number becomes `center_nm`.
double hold_near(double center_nm, double wanted_nm, double distance_nm) noexcept {
    if (mamori::safety::is_within(wanted_nm - center_nm, distance_nm)) {
        return wanted_nm;
    }
    if (wanted_nm > center_nm) {
        return center_nm + distance_nm;
    }
    return wanted_nm < center_nm ? center_nm - distance_nm : center_nm;
}

/// Torque that the drive of a joint can give at this speed [N m]. More would be a torque deviation.
double calc_available(std::size_t joint, double torque_nm, double speed_rad_s) noexcept {
    const double share = std::fabs(speed_rad_s) / kNoLoadSpeedRadS[joint];
    if (!(torque_nm * speed_rad_s > 0.0)) {
        return kTorqueLimitNm[joint];
    }
    return share < 1.0 ? kTorqueLimitNm[joint] * (1.0 - share) : 0.0;
}

}  // namespace

using mamori::ContextHandle;
using mamori::Status;

Status DriveGate::on_execute(ContextHandle context) noexcept {
    DriveCommand result{};
    // The supervisor decides in every frame. A decision of an earlier frame is no decision, and one that a
    // gate cut off in that frame had no chance to use is still "new" in the next.
    const bool is_of_this_frame = stop.is_new() && stop.calc_age(context.now) < kFrame;
    if (is_of_this_frame) {
        const StopCommand& decision = stop.read();
        result.relay_close = decision.relay_close;
        result.torque_enable = decision.torque_enable;
        result.brake_release = decision.torque_enable && decision.brake_release;
        result.source = decision.torque_source;
        result.gravity_nm = calc_gravity_torque(arm_state.read().position_rad);
        result.torque_nm = calc_torque(decision, result.gravity_nm);
        result.stop_setpoint_rad = stop_loop_.get_setpoint();
    } else {
        stop_loop_.release();
    }
    outputs_.torque_nm = result.torque_nm;
    outputs_.torque_enable = result.torque_enable;
    outputs_.brake_release = result.brake_release;
    outputs_.relay_close = result.relay_close;
    drive.write(result);
    return Status::kOk;
}

JointVector DriveGate::calc_torque(const StopCommand& decision, const JointVector& gravity_nm) noexcept {
    JointVector wanted_nm{};
    const JointState& measured = arm_state.read();
    if (!decision.torque_enable || decision.torque_source != TorqueSource::kStopLoop) {
        stop_loop_.release();
    }
    if (!decision.torque_enable) {
        return wanted_nm;
    }
    switch (decision.torque_source) {
        case TorqueSource::kController:
            wanted_nm = limit_controller(command.read().torque_nm, gravity_nm);
            break;
        case TorqueSource::kStopLoop:
            wanted_nm = stop_loop_.step(measured, gravity_nm);
            break;
        case TorqueSource::kCarry:
            wanted_nm = gravity_nm;
            break;
        case TorqueSource::kBrakeTest:
            wanted_nm = scale(kTorqueLimitNm, decision.brake_test_share, 0.0);
            break;
    }
    for (std::size_t j = 0U; j < kArmJointCount; ++j) {
        wanted_nm[j] =
            hold_near(0.0, wanted_nm[j], calc_available(j, wanted_nm[j], measured.velocity_rad_s[j]));
    }
    return wanted_nm;
}

/// First the rate, then the distance from the torque that holds the arm: the last torque is a limited one, so
/// both are kept.
JointVector DriveGate::limit_controller(const JointVector& wanted_nm,
                                        const JointVector& gravity_nm) const noexcept {
    JointVector result = gravity_nm;
    for (std::size_t j = 0U; j < kArmJointCount; ++j) {
        const double near_last = hold_near(outputs_.torque_nm[j], wanted_nm[j], kControllerStepNm[j]);
        result[j] = hold_near(result[j], near_last, kControllerShareNm[j]);
    }
    return result;
}

Status DriveGate::on_deactivated(ContextHandle) noexcept {
    stop_loop_.release();
    outputs_ = {};
    return Status::kOk;
}

Status DriveGate::on_aborting(ContextHandle) noexcept {
    stop_loop_.release();
    outputs_ = {};
    return Status::kOk;
}

}  // namespace safe_arm
