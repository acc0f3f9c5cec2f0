// SPDX-License-Identifier: Apache-2.0
/// @file
/// Brakes need time to bite. At the end of a stop that is not urgent, torque holds the machine until they do;
/// where torque is to go at once, it goes, and the brakes close as fast as they can.
///
/// @satisfies SWR-FSM-026, SWR-FSM-027, SWR-FSM-028, SWR-FSM-029, SWR-FSM-034, SWR-FSM-035
/// @satisfies SWR-FSM-036
/// Design:   docs/design/safe_state.md#brakes-with-delay
/// Source:   IEC 61800-5-2 (SBC, SS1, STO)
#ifndef MAMORI_SAFETY_BRAKE_SEQUENCE_HPP
#define MAMORI_SAFETY_BRAKE_SEQUENCE_HPP

#include "mamori/kernel/base/assert.hpp"
#include "mamori/kernel/base/time.hpp"
#include "mamori/safety/base/elapsed.hpp"
#include "mamori/safety/reaction/safe_state_machine.hpp"
#include "mamori/safety/reaction/stop_outputs.hpp"

namespace mamori::safety {

/// How the brakes of a machine behave, all of them taken as one.
struct BrakeLimits {
    Duration closes_within{0};  ///< longest time from the command to the bite, > 0
    bool has_contacts{false};   ///< the brakes report that they are closed
};

/// True when an SS1 has time for its brakes. For static_assert on the constants of an application: with a
/// bound that is no longer than the closing, each SS1 ends by its bound, and the machine sags.
constexpr bool have_brakes_time(StopBounds bounds, BrakeLimits brakes) noexcept {
    return brakes.closes_within < bounds.ss1_within;
}

/// Stands between the safe-state machine and the outputs. In each cycle: confirm() before
/// SafeStateMachine::step(), apply() after it.
///
/// Thread safety: none; call every member from the same execution context.
/// Time:          O(1), nothing blocks. Memory: no heap.
class BrakeSequence final {
  public:
    explicit constexpr BrakeSequence(BrakeLimits limits) noexcept : limits_(limits) {
        MAMORI_REQUIRE(1, limits.closes_within > Duration{0});
    }

    /// What SafeStateInputs::standstill shall be: in an SS1 the machine must stand and the brakes must have
    /// bitten, in each other state it must stand.
    /// @param[in] state       of the machine, before its step.
    /// @param[in] is_standing as measured.
    /// @param[in] are_closed  contacts of all brakes; without meaning when there are none. Contacts that have
    ///                        reported closed since before the command may be stuck: then the closing time
    ///                        must also have elapsed.
    /// @param[in] now         of this cycle. Before the command to close, nothing has bitten.
    [[nodiscard]] bool confirm(SafeState state, bool is_standing, bool are_closed, Instant now) noexcept;

    /// @param[in] state of the machine, after its step.
    /// @param[in] now   of this cycle.
    /// @return calc_stop_outputs(state), except that the brakes close in an SS1 from the first standstill on,
    ///         and that torque holds on in the standby that follows a hold, until the brakes have bitten,
    ///         for less than `closes_within` after the command.
    [[nodiscard]] StopOutputs apply(SafeState state, Instant now) noexcept;

    /// @return true while the brakes have been told to close and their contacts have not said so in the last
    ///         confirm(). False without contacts.
    [[nodiscard]] bool is_waiting() const noexcept {
        return is_told_ && limits_.has_contacts && !are_closed_;
    }

    /// @return true while the brakes have been told to close and may not hold yet: they have not bitten, see
    ///         confirm(), and `closes_within` has not elapsed since the command. False when `now` is before
    ///         it.
    [[nodiscard]] bool is_closing(Instant now) const noexcept;

    /// @return true when the brakes were told to close more than `closes_within` ago, or later than `now`,
    ///         and their contacts did not say so in the last confirm(). False without contacts.
    [[nodiscard]] bool is_overdue(Instant now) const noexcept {
        return is_waiting() && is_over(told_at_, now, limits_.closes_within);
    }

  private:
    void tell_to_close(Instant now) noexcept;
    bool have_bitten(Instant now) const noexcept;

    BrakeLimits limits_;
    Instant told_at_{};
    SafeState before_{SafeState::kSelfTest};
    bool is_told_{false};
    bool are_closed_{false};
    bool have_reported_open_{false};  ///< the contacts, in the cycle of the command or after it
    bool is_handing_over_{false};
};

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_BRAKE_SEQUENCE_HPP
