// SPDX-License-Identifier: Apache-2.0
#include "mamori/safety/reaction/brake_sequence.hpp"

namespace mamori::safety {

void BrakeSequence::tell_to_close(Instant now) noexcept {
    if (!is_told_) {
        is_told_ = true;
        told_at_ = now;
    }
}

bool BrakeSequence::have_bitten(Instant now) const noexcept {
    const bool is_time_over = calc_elapsed(told_at_, now) >= limits_.closes_within;
    return limits_.has_contacts ? are_closed_ && (have_reported_open_ || is_time_over) : is_time_over;
}

bool BrakeSequence::is_closing(Instant now) const noexcept {
    const Duration elapsed = calc_elapsed(told_at_, now);
    return is_told_ && !have_bitten(now) && elapsed >= Duration{0} && elapsed < limits_.closes_within;
}

bool BrakeSequence::confirm(SafeState state, bool is_standing, bool are_closed, Instant now) noexcept {
    are_closed_ = are_closed;
    have_reported_open_ = !are_closed || (is_told_ && have_reported_open_);
    if (state != SafeState::kProtectiveStopSs1) {
        return is_standing;
    }
    if (is_standing) {
        tell_to_close(now);  // goes on from here, also when the machine is pushed meanwhile
    }
    return is_standing && have_bitten(now);
}

StopOutputs BrakeSequence::apply(SafeState state, Instant now) noexcept {
    StopOutputs outputs = calc_stop_outputs(state);
    const bool is_ending = state == SafeState::kProtectiveStopSs1 && is_told_;
    if (is_ending || !outputs.brake_release) {
        outputs.brake_release = false;
        tell_to_close(now);
    } else {
        is_told_ = false;
    }
    // A reset leads from the hold to standby with nothing wrong: no reason to let the machine sag. Every
    // other state takes torque away at once.
    const bool was_held = before_ == SafeState::kStandstillHold || is_handing_over_;
    is_handing_over_ = state == SafeState::kStandby && was_held && is_closing(now);
    if (is_handing_over_) {
        outputs.torque_enable = true;
        outputs.stop_requested = true;
        outputs.hold_requested = true;
    }
    before_ = state;
    return outputs;
}

}  // namespace mamori::safety
