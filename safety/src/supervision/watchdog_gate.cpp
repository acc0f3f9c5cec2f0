// SPDX-License-Identifier: Apache-2.0
#include "mamori/safety/supervision/watchdog_gate.hpp"

#include "mamori/safety/base/elapsed.hpp"
#include "mamori/safety/base/saturating_increment.hpp"

namespace mamori::safety {

WatchdogOutcome WatchdogGate::step(Instant now, GlobalStatus status, bool is_state_consistent) noexcept {
    is_closed_ = is_closed_ || (is_running_ && is_over(serviced_at_, now, window_.longest));
    if (!may_service_watchdog(status, is_state_consistent)) {
        saturating_increment(refusal_count_);
        return is_closed_ ? WatchdogOutcome::kClosed : WatchdogOutcome::kRefused;
    }
    if (is_closed_) {
        return WatchdogOutcome::kClosed;
    }
    if (is_running_ && calc_elapsed(serviced_at_, now) < window_.shortest) {
        return WatchdogOutcome::kHeldBack;
    }
    if (watchdog_.service(now) != Status::kOk) {
        return WatchdogOutcome::kFailed;
    }
    is_running_ = true;
    serviced_at_ = now;
    saturating_increment(service_count_);
    return WatchdogOutcome::kServiced;
}

}  // namespace mamori::safety
