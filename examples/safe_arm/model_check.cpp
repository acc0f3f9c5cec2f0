// SPDX-License-Identifier: Apache-2.0
#include "model_check.hpp"

#include <algorithm>
#include <cmath>

#include "arm_limits.hpp"
#include "gravity_model.hpp"
#include "mamori/simbody_sim/arm_dynamics.hpp"

namespace safe_arm {
namespace {

std::string refuse(const mamori::sim::JointModel& joint, const char* figure, double value,
                   const char* relation, double limit) {
    return "joint " + joint.name + ": " + figure + " " + std::to_string(value) + " must be " + relation +
           " " + std::to_string(limit) + ": change the model, or the safe limits in arm_limits.hpp";
}

/// Poses in which each mass and length has an effect.
constexpr std::array<JointVector, 3U> kPoses{{{0.0, 0.5, 0.3, 0.9, -0.4, 0.8, 0.2},
                                              {0.0, -1.2, 1.1, 0.4, 1.3, -0.9, 0.7},
                                              {0.0, 1.5, -0.6, -1.4, 0.5, 1.2, -1.1}}};

std::string check_gravity(const mamori::sim::ArmModel& model) {
    mamori::sim::ArmDynamics dynamics{model};
    for (const JointVector& pose : kPoses) {
        const JointVector torque_nm = dynamics.calc_gravity_torque(pose);
        for (std::size_t j = 0U; j < kArmJointCount; ++j) {
            const double wanted_nm = calc_gravity_torque(pose)[j];
            if (!mamori::safety::is_within(torque_nm[j] - wanted_nm, kGravityDifferenceNm)) {
                return "joint " + model.joints[j].name + ": torque against gravity " +
                       std::to_string(torque_nm[j]) + " N m must be " + std::to_string(wanted_nm) +
                       " within " + std::to_string(kGravityDifferenceNm) +
                       ": change masses and lengths in the model, or in gravity_model.cpp";
            }
        }
    }
    return {};
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
        if (!(joint.speed_limit_rad_s >= kNoLoadSpeedRadS[j])) {
            return refuse(joint, "speed_limit_rad_s", joint.speed_limit_rad_s, "at least",
                          kNoLoadSpeedRadS[j]);
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
    return check_gravity(model);
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
