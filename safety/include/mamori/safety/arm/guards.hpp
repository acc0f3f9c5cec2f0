// SPDX-License-Identifier: Apache-2.0
/// @file
/// Guards of a machine with 1 .. kAxisMax axes: pure comparisons of measured values with limits. They name
/// the axes that break a limit in this cycle; debouncing and latching are the fault register's work. Units
/// are those of the axis: rad and N m for a joint, m and N for a slide.
///
/// @satisfies SWR-ARM-002, SWR-ARM-003, SWR-ARM-004, SWR-ARM-005, SWR-ARM-006, SWR-ARM-007, SWR-ARM-008
/// @satisfies SWR-ARM-009
/// Design:   docs/design/supervision.md#guards
#ifndef MAMORI_SAFETY_GUARDS_HPP
#define MAMORI_SAFETY_GUARDS_HPP

#include <array>
#include <cstddef>
#include <limits>

#include "mamori/kernel/base/assert.hpp"
#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/time.hpp"
#include "mamori/safety/arm/axis_set.hpp"
#include "mamori/safety/base/elapsed.hpp"

namespace mamori::safety {

/// Allowed positions of one axis, both ends included. Range: finite, min < max.
struct AxisRange {
    double min{0.0};
    double max{0.0};
};

/// One value per axis, 1 .. kAxisMax of them.
using AxisValues = Span<const double>;

/// True when |value| <= limit, and both are finite; written so that not-a-number fails each comparison.
constexpr bool is_within(double value, double limit) noexcept {
    return value >= -limit && value <= limit && limit <= std::numeric_limits<double>::max();
}

/// True when the number of axes is 1 .. kAxisMax and every range is finite and not empty. For static_assert
/// on a table, or once at start.
constexpr bool are_valid(Span<const AxisRange> ranges) noexcept {
    for (const AxisRange& range : ranges) {
        constexpr double kLargest = std::numeric_limits<double>::max();
        if (!(range.min >= -kLargest && range.min < range.max && range.max <= kLargest)) {
            return false;
        }
    }
    return !ranges.empty() && ranges.size() <= kAxisMax;
}

/// True when the number of axes is 1 .. kAxisMax and every limit is finite and > 0. For the limits of all
/// guards below.
constexpr bool are_valid(AxisValues limits) noexcept {
    for (const double limit : limits) {
        if (!(limit > 0.0 && limit <= std::numeric_limits<double>::max())) {
            return false;
        }
    }
    return !limits.empty() && limits.size() <= kAxisMax;
}

// In every guard a value or limit that is not a number, or is infinite, breaks the limit. All arguments of a
// guard have the same number of axes, at most kAxisMax; another number is a contract violation.

/// @return axes outside their range.
AxisSet calc_position_violations(AxisValues position, Span<const AxisRange> ranges) noexcept;

/// @return axes faster than allowed, in either direction.
AxisSet calc_speed_violations(AxisValues velocity, AxisValues speed_max) noexcept;

/// @return axes whose two encoder channels differ by more than allowed.
AxisSet calc_discrepancies(AxisValues channel_a, AxisValues channel_b, AxisValues discrepancy_max) noexcept;

/// Plausibility of a measurement.
/// @param[in] jump_max largest movement between two samples that the drives can physically cause.
/// @return axes that moved further than that.
AxisSet calc_jumps(AxisValues position, AxisValues previous, AxisValues jump_max) noexcept;

/// @return axes that are further from their setpoint than allowed.
AxisSet calc_following_errors(AxisValues setpoint, AxisValues measured, AxisValues error_max) noexcept;

/// @return axes whose measured torque or force differs from the commanded one by more than allowed.
AxisSet calc_torque_deviations(AxisValues commanded, AxisValues measured, AxisValues deviation_max) noexcept;

/// @return true when a message stamped `stamp` is older than `age_max`, or comes from the future.
constexpr bool is_message_too_old(Instant stamp, Instant now, Duration age_max) noexcept {
    return is_over(stamp, now, age_max);
}

/// Decides whether the machine stands: all axes slower than their limit for some time without a break.
///
/// Thread safety: none; call step() once per cycle. Time: O(axes). Memory: no heap.
class StandstillDetector final {
  public:
    /// @param[in] speed_max limit per axis, included; finite, > 0. @param[in] hold time for which it must be
    ///                      kept, >= 0.
    constexpr StandstillDetector(AxisValues speed_max, Duration hold) noexcept
        : axis_count_(speed_max.size()), hold_(hold) {
        MAMORI_REQUIRE(1, are_valid(speed_max) && hold >= Duration{0});
        for (std::size_t i = 0U; i < axis_count_; ++i) {
            speed_max_[i] = speed_max[i];
        }
    }

    /// @return true when every axis has kept its limit since `now` - hold or longer. A value that is not a
    ///         number, or a clock that ran backwards, begins the time anew.
    [[nodiscard]] bool step(AxisValues velocity, Instant now) noexcept;

    /// @return result of the last step(); false before the first.
    bool is_standing() const noexcept { return is_standing_; }

  private:
    std::array<double, kAxisMax> speed_max_{};
    std::size_t axis_count_;
    Duration hold_;
    Instant slow_since_{};
    Instant stepped_at_{};
    bool is_slow_{false};
    bool is_standing_{false};
};

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_GUARDS_HPP
