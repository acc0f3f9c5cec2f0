// SPDX-License-Identifier: Apache-2.0
#include "mamori/safety/arm/guards.hpp"

namespace mamori::safety {
namespace {

/// Axes at which two values are further apart than their limit.
AxisSet calc_far_apart(AxisValues a, AxisValues b, AxisValues limits) noexcept {
    MAMORI_REQUIRE(2, a.size() <= kAxisMax && a.size() == b.size() && a.size() == limits.size());
    AxisSet axes;
    for (std::size_t i = 0U; i < a.size(); ++i) {
        if (!is_within(a[i] - b[i], limits[i])) {
            axes.insert(i);
        }
    }
    return axes;
}

}  // namespace

AxisSet calc_position_violations(AxisValues position, Span<const AxisRange> ranges) noexcept {
    MAMORI_REQUIRE(3, position.size() <= kAxisMax && position.size() == ranges.size());
    AxisSet axes;
    constexpr double kLargest = std::numeric_limits<double>::max();
    for (std::size_t i = 0U; i < position.size(); ++i) {
        const double value = position[i];
        const AxisRange& range = ranges[i];
        const bool is_finite = is_within(value, kLargest) && range.min >= -kLargest && range.max <= kLargest;
        if (!(is_finite && value >= range.min && value <= range.max)) {
            axes.insert(i);
        }
    }
    return axes;
}

AxisSet calc_speed_violations(AxisValues velocity, AxisValues speed_max) noexcept {
    constexpr std::array<double, kAxisMax> kZero{};
    MAMORI_REQUIRE(4, velocity.size() <= kAxisMax);
    return calc_far_apart(velocity, {kZero.data(), velocity.size()}, speed_max);
}

AxisSet calc_discrepancies(AxisValues channel_a, AxisValues channel_b, AxisValues discrepancy_max) noexcept {
    return calc_far_apart(channel_a, channel_b, discrepancy_max);
}

AxisSet calc_jumps(AxisValues position, AxisValues previous, AxisValues jump_max) noexcept {
    return calc_far_apart(position, previous, jump_max);
}

AxisSet calc_following_errors(AxisValues setpoint, AxisValues measured, AxisValues error_max) noexcept {
    return calc_far_apart(setpoint, measured, error_max);
}

AxisSet calc_torque_deviations(AxisValues commanded, AxisValues measured, AxisValues deviation_max) noexcept {
    return calc_far_apart(commanded, measured, deviation_max);
}

bool StandstillDetector::step(AxisValues velocity, Instant now) noexcept {
    const bool is_slow = calc_speed_violations(velocity, {speed_max_.data(), axis_count_}).is_empty();
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
