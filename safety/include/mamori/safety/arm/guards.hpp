// SPDX-License-Identifier: Apache-2.0
/// @file
/// Guards of the arm: pure comparisons of measured values with limits. They name the joints that break a
/// limit in this cycle; debouncing and latching are the fault register's work.
///
/// @satisfies SWR-ARM-002, SWR-ARM-003, SWR-ARM-004, SWR-ARM-005, SWR-ARM-006, SWR-ARM-007, SWR-ARM-008
/// Design:   docs/design/supervision.md#guards
#ifndef MAMORI_SAFETY_ARM_GUARDS_HPP
#define MAMORI_SAFETY_ARM_GUARDS_HPP

#include <array>
#include <limits>

#include "mamori/kernel/base/time.hpp"
#include "mamori/safety/arm/arm_device.hpp"
#include "mamori/safety/arm/joint_set.hpp"
#include "mamori/safety/base/elapsed.hpp"

namespace mamori::safety {

/// Allowed positions of one joint, both ends included. Range: finite, min < max.
struct JointRange {
    double min_rad{0.0};
    double max_rad{0.0};
};

using JointRanges = std::array<JointRange, kArmJointCount>;

/// True when |value| <= limit, and both are finite; written so that not-a-number fails each comparison.
constexpr bool is_within(double value, double limit) noexcept {
    return value >= -limit && value <= limit && limit <= std::numeric_limits<double>::max();
}

/// True when every range is finite and not empty. For static_assert on a table, or once at start.
constexpr bool are_valid(const JointRanges& ranges) noexcept {
    for (const JointRange& range : ranges) {
        constexpr double kLargest = std::numeric_limits<double>::max();
        if (!(range.min_rad >= -kLargest && range.min_rad < range.max_rad && range.max_rad <= kLargest)) {
            return false;
        }
    }
    return true;
}

/// True when every limit is finite and > 0. For the limits of all guards below.
constexpr bool are_valid(const JointVector& limits) noexcept {
    for (const double limit : limits) {
        if (!(limit > 0.0 && limit <= std::numeric_limits<double>::max())) {
            return false;
        }
    }
    return true;
}

// In every guard a value or limit that is not a number, or is infinite, breaks the limit.

/// @return joints outside their range.
JointSet calc_position_violations(const JointVector& position_rad, const JointRanges& ranges) noexcept;

/// @return joints faster than allowed, in either direction.
JointSet calc_speed_violations(const JointVector& velocity_rad_s,
                               const JointVector& speed_rad_s_max) noexcept;

/// @return joints whose two encoder channels differ by more than allowed.
JointSet calc_discrepancies(const JointVector& channel_a_rad, const JointVector& channel_b_rad,
                            const JointVector& discrepancy_rad_max) noexcept;

/// Plausibility of a measurement.
/// @param[in] jump_rad_max largest movement between two samples that the drives can physically cause.
/// @return joints that moved further than that.
JointSet calc_jumps(const JointVector& position_rad, const JointVector& previous_rad,
                    const JointVector& jump_rad_max) noexcept;

/// @return joints that are further from their setpoint than allowed.
JointSet calc_following_errors(const JointVector& setpoint_rad, const JointVector& measured_rad,
                               const JointVector& error_rad_max) noexcept;

/// @return joints whose measured torque differs from the commanded one by more than allowed.
JointSet calc_torque_deviations(const JointVector& commanded_nm, const JointVector& measured_nm,
                                const JointVector& deviation_nm_max) noexcept;

/// @return true when a message stamped `stamp` is older than `age_max`, or comes from the future.
constexpr bool is_message_too_old(Instant stamp, Instant now, Duration age_max) noexcept {
    return is_over(stamp, now, age_max);
}

/// Decides whether the arm stands: all joints slower than their limit for some time without a break.
///
/// Thread safety: none; call step() once per cycle. Time: O(joints). Memory: no heap.
class StandstillDetector final {
  public:
    /// @param[in] speed_rad_s_max limit per joint, included; finite, > 0.
    /// @param[in] hold            time for which it must be kept, >= 0.
    constexpr StandstillDetector(const JointVector& speed_rad_s_max, Duration hold) noexcept
        : speed_rad_s_max_(speed_rad_s_max), hold_(hold) {
        MAMORI_REQUIRE(1, are_valid(speed_rad_s_max) && hold >= Duration{0});
    }

    /// @return true when every joint has kept its limit since `now` - hold or longer. A value that is not a
    ///         number, or a clock that ran backwards, begins the time anew.
    [[nodiscard]] bool step(const JointVector& velocity_rad_s, Instant now) noexcept;

    /// @return result of the last step(); false before the first.
    bool is_standing() const noexcept { return is_standing_; }

  private:
    JointVector speed_rad_s_max_;
    Duration hold_;
    Instant slow_since_{};
    Instant stepped_at_{};
    bool is_slow_{false};
    bool is_standing_{false};
};

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_ARM_GUARDS_HPP
