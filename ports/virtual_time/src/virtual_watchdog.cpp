// SPDX-License-Identifier: Apache-2.0
#include "mamori/ports/virtual_time/virtual_watchdog.hpp"

#include "mamori/safety/base/elapsed.hpp"

namespace mamori::ports::virtual_time {

Status VirtualWatchdog::service(Instant now) noexcept {
    check(now);
    if (has_expired_) {
        return Status::kError;
    }
    is_started_ = true;
    serviced_at_ = now;
    return Status::kOk;
}

void VirtualWatchdog::check(Instant now) noexcept {
    // If the clock ran backwards, the elapsed time is unknown, so the relay opens.
    if (is_started_ && safety::is_over(serviced_at_, now, timeout_)) {
        has_expired_ = true;
    }
}

}  // namespace mamori::ports::virtual_time
