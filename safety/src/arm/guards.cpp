// SPDX-License-Identifier: Apache-2.0
#include "mamori/safety/arm/guards.hpp"

namespace mamori::safety {
namespace {

/// Joints at which two values are further apart than their limit.
JointSet calc_far_apart(const JointVector& a, const JointVector& b, const JointVector& limits) noexcept {
    JointSet joints;
    for (std::size_t i = 0U; i < kArmJointCount; ++i) {
        if (!is_within(a[i] - b[i], limits[i])) {
            joints.insert(i);
        }
    }
    return joints;
}

}  // namespace

JointSet calc_position_violations(const JointVector& position_rad, const JointRanges& ranges) noexcept {
    JointSet joints;
    constexpr double kLargest = std::numeric_limits<double>::max();
    for (std::size_t i = 0U; i < kArmJointCount; ++i) {
        const double position = position_rad[i];
        const JointRange& range = ranges[i];
        const bool is_finite =
            is_within(position, kLargest) && range.min_rad >= -kLargest && range.max_rad <= kLargest;
        if (!(is_finite && position >= range.min_rad && position <= range.max_rad)) {
            joints.insert(i);
        }
    }
    return joints;
}

JointSet calc_speed_violations(const JointVector& velocity_rad_s,
                               const JointVector& speed_rad_s_max) noexcept {
    return calc_far_apart(velocity_rad_s, JointVector{}, speed_rad_s_max);
}

JointSet calc_discrepancies(const JointVector& channel_a_rad, const JointVector& channel_b_rad,
                            const JointVector& discrepancy_rad_max) noexcept {
    return calc_far_apart(channel_a_rad, channel_b_rad, discrepancy_rad_max);
}

JointSet calc_jumps(const JointVector& position_rad, const JointVector& previous_rad,
                    const JointVector& jump_rad_max) noexcept {
    return calc_far_apart(position_rad, previous_rad, jump_rad_max);
}

JointSet calc_following_errors(const JointVector& setpoint_rad, const JointVector& measured_rad,
                               const JointVector& error_rad_max) noexcept {
    return calc_far_apart(setpoint_rad, measured_rad, error_rad_max);
}

JointSet calc_torque_deviations(const JointVector& commanded_nm, const JointVector& measured_nm,
                                const JointVector& deviation_nm_max) noexcept {
    return calc_far_apart(commanded_nm, measured_nm, deviation_nm_max);
}

bool StandstillDetector::step(const JointVector& velocity_rad_s, Instant now) noexcept {
    const bool is_slow = calc_speed_violations(velocity_rad_s, speed_rad_s_max_).is_empty();
    const bool has_begun = is_slow && (!is_slow_ || now < stepped_at_);
    if (has_begun) {
        slow_since_ = now;
    }
    stepped_at_ = now;
    is_slow_ = is_slow;
    is_standing_ = is_slow && calc_elapsed(slow_since_, now) >= hold_;
    return is_standing_;
}

}  // namespace mamori::safety
