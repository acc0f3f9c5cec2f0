// SPDX-License-Identifier: Apache-2.0
#include "drive_gate.hpp"

#include "arm_limits.hpp"
#include "mamori/safety/arm/guards.hpp"

namespace safe_arm {
namespace {

/// Torque inside +-limit; anything that is not a number becomes no torque.
double saturate(double torque_nm, double limit_nm) noexcept {
    if (mamori::safety::is_within(torque_nm, limit_nm)) {
        return torque_nm;
    }
    if (torque_nm > limit_nm) {
        return limit_nm;
    }
    return torque_nm < -limit_nm ? -limit_nm : 0.0;
}

}  // namespace

using mamori::ContextHandle;
using mamori::Status;

Status DriveGate::on_execute(ContextHandle context) noexcept {
    DriveCommand result{};
    // The supervisor decides in every frame. A decision of an earlier frame is no decision, and one that a
    // gate cut off in that frame had no chance to use is still "new" in the next.
    const bool is_of_this_frame = stop.is_new() && stop.calc_age(context.now) < kFrame;
    if (is_of_this_frame && stop.read().torque_enable) {
        result.torque_enable = true;
        result.brake_release = stop.read().brake_release;
        for (std::size_t j = 0U; j < kArmJointCount; ++j) {
            result.torque_nm[j] = saturate(command.read().torque_nm[j], kTorqueLimitNm[j]);
        }
    }
    outputs_.torque_nm = result.torque_nm;
    outputs_.torque_enable = result.torque_enable;
    outputs_.brake_release = result.brake_release;
    drive.write(result);
    return Status::kOk;
}

Status DriveGate::on_deactivated(ContextHandle) noexcept {
    outputs_ = {};
    return Status::kOk;
}

Status DriveGate::on_aborting(ContextHandle) noexcept {
    outputs_ = {};
    return Status::kOk;
}

}  // namespace safe_arm
