// SPDX-License-Identifier: Apache-2.0
#include "mamori/safety/reaction/safe_state_machine.hpp"

#include "mamori/safety/base/elapsed.hpp"

namespace mamori::safety {
namespace {

/// @return the stored state; one that is_valid() refuses when its two forms disagree.
SafeState read_stored(const ComplementStored<SafeState>& state) noexcept {
    static_assert(!is_valid(SafeState{}), "what is read of a corrupted value must be no state");
    return state.read().get_value();
}

}  // namespace

bool SafeStateMachine::is_consistent() const noexcept {
    return is_valid(read_stored(state_));
}

SafeState SafeStateMachine::get_state() const noexcept {
    const SafeState stored = read_stored(state_);
    return is_valid(stored) ? stored : SafeState::kLockedOut;
}

/// A stop is confirmed up to and including its bound; in the cycle of the bound it must be. The table lets
/// the two stops alone time out, so it is asked in no other state.
bool SafeStateMachine::is_stop_overdue(SafeState state, const SafeStateInputs& inputs) const noexcept {
    const bool is_ss2 = state == SafeState::kProtectiveStopSs2;
    const Duration bound = is_ss2 ? bounds_.ss2_within : bounds_.ss1_within;
    const bool is_at_bound = calc_elapsed(entered_at_, inputs.now) == bound;
    return is_over(entered_at_, inputs.now, bound) || (is_at_bound && !inputs.standstill);
}

bool SafeStateMachine::may_restart(const SafeStateInputs& inputs) const noexcept {
    return inputs.demand == Reaction::kNone && inputs.faults_cleared;
}

bool SafeStateMachine::is_raised(SafeStateEvent event, SafeState state, const SafeStateInputs& inputs,
                                 Edges edges) const noexcept {
    switch (event) {
        case SafeStateEvent::kLockOut:
            return inputs.lock_out;
        case SafeStateEvent::kSelfTestFailed:
            return inputs.self_test >= SelfTestStatus::kFailed;  // so is a corrupted status
        case SafeStateEvent::kDemandSto:
            return inputs.demand >= Reaction::kSto;  // a corrupted demand is the severest
        case SafeStateEvent::kDemandSs1:
            // Whoever leaves the place that he should hold is stopped again, with more authority.
            return inputs.demand == Reaction::kSs1 ||
                   (state == SafeState::kStandstillHold && !inputs.standstill);
        case SafeStateEvent::kBrakesFailed:
            return inputs.brakes_failed;
        case SafeStateEvent::kStopTimeout:
            return is_stop_overdue(state, inputs);
        case SafeStateEvent::kDemandSs2:
            return inputs.demand == Reaction::kSs2;
        case SafeStateEvent::kStandstillConfirmed:
            return inputs.standstill;
        case SafeStateEvent::kDegrade:
            return inputs.demand == Reaction::kDegrade;
        case SafeStateEvent::kReset:
            return edges.has_reset_risen && may_restart(inputs) && inputs.standstill;
        case SafeStateEvent::kRestore:
            return edges.has_reset_risen && may_restart(inputs);
        case SafeStateEvent::kSelfTestPassed:
            return has_test_run_ && inputs.self_test == SelfTestStatus::kPassed;
        case SafeStateEvent::kStart:
            return edges.has_start_risen && may_restart(inputs) && inputs.standstill &&
                   inputs.start_permitted;
    }
    MAMORI_INVARIANT(2, false);
    return true;
}

void SafeStateMachine::enter(SafeState state, Instant now) noexcept {
    state_.set(state);
    entered_at_ = now;
    has_test_run_ = false;
}

SafeState SafeStateMachine::step(const SafeStateInputs& inputs) noexcept {
    if (!has_stepped_) {
        has_stepped_ = true;
        entered_at_ = inputs.now;
    }
    // The levels are followed in every state, so that a push in the wrong state is not kept for a later one.
    const Edges edges{start_edge_.step(inputs.start_button), reset_edge_.step(inputs.reset_button)};
    has_test_run_ = has_test_run_ || inputs.self_test == SelfTestStatus::kRunning;
    const SafeState state = read_stored(state_);
    if (!is_valid(state)) {
        enter(SafeState::kLockedOut, inputs.now);
        return SafeState::kLockedOut;
    }
    for (std::size_t i = 0U; i < kSafeStateEventCount; ++i) {
        const auto event = static_cast<SafeStateEvent>(i);
        const SafeState next = calc_next_state(state, event);
        if (next != state && is_raised(event, state, inputs, edges)) {
            enter(next, inputs.now);
            break;
        }
    }
    MAMORI_ENSURE(3, is_consistent());
    return get_state();
}

}  // namespace mamori::safety
