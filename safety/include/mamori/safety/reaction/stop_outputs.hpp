// SPDX-License-Identifier: Apache-2.0
/// @file
/// What each state of the safe-state machine commands: torque, brakes and the kind of stop.
///
/// @satisfies SWR-FSM-009      Design: docs/design/safe_state.md#outputs
#ifndef MAMORI_SAFETY_STOP_OUTPUTS_HPP
#define MAMORI_SAFETY_STOP_OUTPUTS_HPP

#include <array>
#include <cstddef>

#include "mamori/safety/reaction/safe_state.hpp"

namespace mamori::safety {

/// Commands to drives, brakes and controller. Default: torque off, brakes closed.
struct StopOutputs {
    bool torque_enable{false};   ///< false = safe torque off (STO)
    bool brake_release{false};   ///< false = all brakes close (SBC)
    bool stop_requested{false};  ///< the controller shall bring the machine to a stop, or not leave it
    bool hold_requested{false};  ///< the controller shall hold the position (SOS)
};

constexpr bool operator==(const StopOutputs& a, const StopOutputs& b) noexcept {
    return a.torque_enable == b.torque_enable && a.brake_release == b.brake_release &&
           a.stop_requested == b.stop_requested && a.hold_requested == b.hold_requested;
}

/// One row per state, in their order.
inline constexpr std::array<StopOutputs, kSafeStateCount> kStopOutputs{{
    // torque, brakes open, stop, hold
    {false, false, false, false},  // kSelfTest
    {false, false, false, false},  // kStandby
    {true, true, false, false},    // kOperational
    {true, true, false, false},    // kDegraded
    {true, true, true, false},     // kProtectiveStopSs2
    {true, true, true, false},     // kProtectiveStopSs1
    {true, true, true, true},      // kStandstillHold
    {false, false, false, false},  // kSafe
    {false, false, false, false},  // kLockedOut
    {true, false, true, true},     // kLockedHold
}};

/// @return the commands of `state`; torque off and brakes closed for a corrupted one.
constexpr StopOutputs calc_stop_outputs(SafeState state) noexcept {
    return is_valid(state) ? kStopOutputs[static_cast<std::size_t>(state) - 1U] : StopOutputs{};
}

namespace detail {

/// An open brake without torque lets the arm fall, torque against a closed brake wears it. Brakes that failed
/// are still told to close.
constexpr bool do_torque_and_brakes_agree(const std::array<StopOutputs, kSafeStateCount>& outputs) noexcept {
    for (std::size_t i = 0U; i < outputs.size(); ++i) {
        const bool have_brakes_failed = static_cast<SafeState>(i + 1U) == SafeState::kLockedHold;
        if (outputs[i].torque_enable != (outputs[i].brake_release || have_brakes_failed)) {
            return false;
        }
    }
    return true;
}

/// A controller that follows the stop only must not move a held machine.
constexpr bool is_hold_a_stop(const std::array<StopOutputs, kSafeStateCount>& outputs) noexcept {
    for (const StopOutputs& row : outputs) {
        if (row.hold_requested && !row.stop_requested) {
            return false;
        }
    }
    return true;
}

static_assert(do_torque_and_brakes_agree(kStopOutputs),
              "brakes are open exactly while torque is on and they have not failed");
static_assert(is_hold_a_stop(kStopOutputs), "a hold is a stop that lasts");

}  // namespace detail

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_STOP_OUTPUTS_HPP
