// SPDX-License-Identifier: Apache-2.0
/// @file
/// Runs the table of safe_state.hpp: turns the inputs of one cycle into at most one event, the most urgent
/// first, bounds each stop in time, and keeps the state so that corruption of it ends in the locked-out
/// state.
///
/// @satisfies SWR-FSM-004, SWR-FSM-005, SWR-FSM-006, SWR-FSM-007, SWR-FSM-008
/// Design:   docs/design/safe_state.md#escalation
#ifndef MAMORI_SAFETY_SAFE_STATE_MACHINE_HPP
#define MAMORI_SAFETY_SAFE_STATE_MACHINE_HPP

#include "mamori/kernel/base/assert.hpp"
#include "mamori/kernel/base/time.hpp"
#include "mamori/safety/base/rising_edge.hpp"
#include "mamori/safety/base/self_test_status.hpp"
#include "mamori/safety/reaction/reaction_table.hpp"
#include "mamori/safety/reaction/safe_state.hpp"
#include "mamori/safety/redundancy/complement_stored.hpp"

namespace mamori::safety {

/// Longest time from the begin of a stop to its confirmation, both > 0.
struct StopBounds {
    Duration ss2_within{0};  ///< then the stop becomes an SS1
    Duration ss1_within{0};  ///< then torque is cut
};

/// Everything that one cycle of the machine looks at. The defaults permit nothing.
struct SafeStateInputs {
    Instant now{};
    Reaction demand{Reaction::kSto};  ///< worst reaction of the latched faults; a level
    SelfTestStatus self_test{SelfTestStatus::kRunning};
    bool start_button{false};    ///< level; the machine finds the edge
    bool reset_button{false};    ///< level; the machine finds the edge
    bool standstill{false};      ///< the machine stands, as measured
    bool faults_cleared{false};  ///< no fault is latched
    bool lock_out{false};        ///< a stop proved useless, for example torque that cannot be switched off
    bool brakes_failed{
        false};  ///< in an SS1: the machine stands, its brakes do not close, torque can hold it
    bool start_permitted{false};  ///< the start is bumpless: the setpoint equals the measured position
};

/// Safe-state machine. Begins in kSelfTest.
///
/// Thread safety: none; call every member from the same execution context.
/// Time:          O(1), nothing blocks. Memory: no heap.
class SafeStateMachine final {
  public:
    explicit constexpr SafeStateMachine(StopBounds bounds) noexcept : bounds_(bounds) {
        MAMORI_REQUIRE(1, bounds.ss2_within > Duration{0} && bounds.ss1_within > Duration{0});
    }

    /// Advances by one cycle and at most one transition.
    /// @param[in] inputs of this cycle. A demand that is no Reaction counts as kSto; `now` before the entry
    ///                   into the state counts as a stop that was not confirmed in time.
    ///                   A self test status that is none counts as kFailed.
    ///                   In kSelfTest a pass counts once kRunning was seen in this visit, so that an old
    ///                   result lets nobody through.
    /// @return the new state.
    SafeState step(const SafeStateInputs& inputs) noexcept;

    /// @return the state; kLockedOut when its two stored forms disagree or name no state.
    SafeState get_state() const noexcept;

    /// @return when the state was entered; the first cycle for the first state.
    Instant get_entered_at() const noexcept { return entered_at_; }

    /// @return true while the stored state and its complement agree on one of the states.
    bool is_consistent() const noexcept;

  private:
    struct Edges {
        bool has_start_risen;
        bool has_reset_risen;
    };

    bool is_raised(SafeStateEvent event, SafeState state, const SafeStateInputs& inputs,
                   Edges edges) const noexcept;
    bool is_stop_overdue(SafeState state, const SafeStateInputs& inputs) const noexcept;
    bool may_restart(const SafeStateInputs& inputs) const noexcept;
    void enter(SafeState state, Instant now) noexcept;

    StopBounds bounds_;
    Instant entered_at_{};
    ComplementStored<SafeState> state_{SafeState::kSelfTest};
    RisingEdge start_edge_{};
    RisingEdge reset_edge_{};
    bool has_stepped_{false};
    bool has_test_run_{false};
};

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_SAFE_STATE_MACHINE_HPP
