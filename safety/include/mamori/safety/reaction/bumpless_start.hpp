// SPDX-License-Identifier: Apache-2.0
/// @file
/// Motion begins where the machine stands: the first setpoint under torque is the measured position, and a
/// start is refused while the setpoint that would follow is more than one encoder step away from it.
///
/// @satisfies SWR-FSM-030, SWR-FSM-031      Design: docs/design/safe_state.md#bumpless-start
#ifndef MAMORI_SAFETY_BUMPLESS_START_HPP
#define MAMORI_SAFETY_BUMPLESS_START_HPP

#include <array>
#include <cstddef>
#include <limits>

#include "mamori/kernel/base/span.hpp"

namespace mamori::safety {

/// For SafeStateInputs::start_permitted.
/// @param[in] setpoint     of each axis, in any unit.
/// @param[in] measured     position of each axis, in the same units.
/// @param[in] encoder_step the least change of position that the axis measures, in the same units, finite, >
/// 0.
/// @return true when there is an axis, all three have the same number of them, and each setpoint is at most
/// one
///         encoder step away. What is no number, or not finite, is not near; nor is anything to a step that
///         is not > 0.
/// Time: O(axes).
constexpr bool may_start_bumpless(Span<const double> setpoint, Span<const double> measured,
                                  Span<const double> encoder_step) noexcept {
    if (setpoint.empty() || setpoint.size() != measured.size() || setpoint.size() != encoder_step.size()) {
        return false;
    }
    for (std::size_t i = 0U; i < setpoint.size(); ++i) {
        const double jump = setpoint[i] - measured[i];
        const double step = encoder_step[i];
        // Written so that not-a-number fails each comparison; an infinite jump fails beside a finite step.
        const bool is_step = step > 0.0 && step <= std::numeric_limits<double>::max();
        if (!(is_step && jump >= -step && jump <= step)) {
            return false;
        }
    }
    return true;
}

/// Stands between the controller and the drives.
/// @tparam kAxes number of axes, > 0.
///
/// Thread safety: none; call from one execution context. Time: O(axes). Memory: one byte.
template <std::size_t kAxes>
class SetpointGate final {
    static_assert(kAxes > 0U, "a machine has an axis");

  public:
    using Axes = std::array<double, kAxes>;

    /// Call once per cycle.
    /// @param[in] has_torque torque is commanded in this cycle.
    /// @param[in] wanted     setpoints of the controller.
    /// @param[in] measured   positions of this cycle.
    /// @return setpoints for the drives: `measured` without torque and in the first cycle with it, then
    /// `wanted`.
    [[nodiscard]] constexpr Axes step(bool has_torque, const Axes& wanted, const Axes& measured) noexcept {
        const bool is_under_way = has_torque && had_torque_;
        had_torque_ = has_torque;
        return is_under_way ? wanted : measured;
    }

  private:
    bool had_torque_{false};
};

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_BUMPLESS_START_HPP
