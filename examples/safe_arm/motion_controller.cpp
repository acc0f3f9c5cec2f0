// SPDX-License-Identifier: Apache-2.0
#include "motion_controller.hpp"

#include "arm_limits.hpp"
#include "mamori/safety/arm/guards.hpp"
#include "mamori/simbody_sim/computed_torque_controller.hpp"

namespace safe_arm {
namespace {

/// The path is begun only from its first point [rad].
constexpr double kPathStartRad = 0.01;

}  // namespace

using mamori::ContextHandle;
using mamori::Instant;
using mamori::Status;
using mamori::safety::SafeState;

void MotionController::configure(const MotionTrack& track, mamori::sim::ComputedTorqueController& law,
                                 Instant motion_start) noexcept {
    track_ = &track;
    law_ = &law;
    motion_start_ = motion_start;
}

Status MotionController::on_activated(ContextHandle) noexcept {
    return track_ == nullptr || law_ == nullptr ? Status::kPreconditionNotMet : Status::kOk;
}

Status MotionController::on_execute(ContextHandle context) noexcept {
    const JointState& measured = state.read();
    if (!stop.read().torque_enable || stop.read().stop_requested) {
        // Bumpless: while the torque is not from here, the setpoint is where the arm is.
        hold_rad_ = measured.position_rad;
        is_on_path_ = false;
    } else {
        advance_path(context.now);
    }
    const PathPoint setpoint = calc_setpoint();
    TorqueCommand result{};
    result.sequence = sequence_++;
    result.sent_at_ns = context.now.ns;
    result.setpoint_rad = setpoint.position_rad;
    result.torque_nm =
        law_->calc_torque(setpoint.position_rad, setpoint.velocity_rad_s, setpoint.acceleration_rad_s2,
                          measured.position_rad, measured.velocity_rad_s);
    if (wrong_ != nullptr) {
        wrong_->corrupt(result, measured);
    }
    command.write(result);
    return Status::kOk;
}

void MotionController::advance_path(Instant now) noexcept {
    if (!is_on_path_ && now >= motion_start_ && stop.read().state == SafeState::kOperational) {
        const JointVector& first = track_->calc_point(0.0).position_rad;
        bool is_at_start = true;
        for (std::size_t j = 0U; j < kArmJointCount; ++j) {
            is_at_start = is_at_start && mamori::safety::is_within(first[j] - hold_rad_[j], kPathStartRad);
        }
        is_on_path_ = is_at_start;
        path_time_s_ = 0.0;
    }
    path_time_s_ += is_on_path_ ? kFrameS * get_path_rate() : 0.0;
}

double MotionController::get_path_rate() const noexcept {
    return stop.read().mode == OperatingMode::kAutomatic ? 1.0 : kReducedPathRate;
}

PathPoint MotionController::calc_setpoint() const noexcept {
    if (!is_on_path_) {
        return {hold_rad_, {}, {}};
    }
    PathPoint point = track_->calc_point(path_time_s_);
    const double rate = get_path_rate();
    point.velocity_rad_s = scale(point.velocity_rad_s, rate, 0.0);
    point.acceleration_rad_s2 = scale(point.acceleration_rad_s2, rate * rate, 0.0);
    return point;
}

}  // namespace safe_arm
