// SPDX-License-Identifier: Apache-2.0
#include "model_check.hpp"

#include <algorithm>
#include <cmath>

#include "arm_limits.hpp"

namespace safe_arm {
namespace {

std::string refuse(const mamori::sim::JointModel& joint, const char* figure, double value,
                   const char* relation, double limit) {
    return "joint " + joint.name + ": " + figure + " " + std::to_string(value) + " must be " + relation +
           " " + std::to_string(limit) + ": change the model, or the safe limits in arm_limits.hpp";
}

/// Largest speed of the flange at the reduced speed of each joint, in any pose [m/s]: the links beyond a
/// joint are its longest lever, less the part of the next one along its axis.
double calc_flange_speed(const mamori::sim::ArmModel& model) {
    double speed = 0.0;
    double beyond_m = 0.0;
    for (std::size_t j = kArmJointCount - 1U; j-- > 0U;) {
        const mamori::sim::Vector3& axis = model.joints[j].axis;
        const mamori::sim::Vector3& offset = model.joints[j + 1U].offset_m;
        const double length = std::hypot(offset[0], offset[1], offset[2]);
        const double along = axis[0] * offset[0] + axis[1] * offset[1] + axis[2] * offset[2];
        speed +=
            kReducedSpeedRadS[j] * (std::sqrt(std::max(length * length - along * along, 0.0)) + beyond_m);
        beyond_m += length;
    }
    return speed;
}

}  // namespace

std::string check_model(const mamori::sim::ArmModel& model) {
    for (std::size_t j = 0U; j < kArmJointCount; ++j) {
        const mamori::sim::JointModel& joint = model.joints[j];
        if (!(joint.speed_limit_rad_s > kSafeSpeedRadS[j])) {
            return refuse(joint, "speed_limit_rad_s", joint.speed_limit_rad_s, "above the safe speed",
                          kSafeSpeedRadS[j]);
        }
        if (!(joint.speed_limit_rad_s * kFrameS < kMaxStepRad[j])) {
            return refuse(joint, "speed_limit_rad_s", joint.speed_limit_rad_s, "below the plausible speed",
                          kMaxStepRad[j] / kFrameS);
        }
        const double range = std::min(-joint.position_min_rad, joint.position_max_rad);
        if (!(range > kSafePositionRad[j])) {
            return refuse(joint, "position range", range, "wider than the safe range", kSafePositionRad[j]);
        }
        const double closing_s = to_seconds(joint.brake.closing_delay + model.sto_delay + kFrame);
        if (!(closing_s < to_seconds(kStopTime))) {
            return refuse(joint, "closing of the brake [s]", closing_s, "shorter than the stopping time",
                          to_seconds(kStopTime));
        }
        if (joint.torque_limit_nm != kTorqueLimitNm[j]) {
            return refuse(joint, "torque_limit_nm", joint.torque_limit_nm, "equal to", kTorqueLimitNm[j]);
        }
        const double coarse_step =
            1.0 / std::min(joint.encoder_a_counts_per_rad, joint.encoder_b_counts_per_rad);
        if (!(coarse_step < kDiscrepancyRad / 4.0)) {
            return refuse(joint, "coarser encoder step", coarse_step,
                          "below a quarter of the channel tolerance", kDiscrepancyRad / 4.0);
        }
    }
    if (!(calc_flange_speed(model) < kFlangeSpeedMax)) {
        return refuse(model.joints.back(), "speed of the flange at reduced speed [m/s]",
                      calc_flange_speed(model), "below", kFlangeSpeedMax);
    }
    return {};
}

EncoderScale get_encoder_scale(const mamori::sim::ArmModel& model) {
    EncoderScale scale{};
    for (std::size_t j = 0U; j < kArmJointCount; ++j) {
        scale.a_counts_per_rad[j] = model.joints[j].encoder_a_counts_per_rad;
        scale.b_counts_per_rad[j] = model.joints[j].encoder_b_counts_per_rad;
    }
    return scale;
}

}  // namespace safe_arm
