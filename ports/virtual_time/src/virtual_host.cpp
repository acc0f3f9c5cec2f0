// SPDX-License-Identifier: Apache-2.0
#include "mamori/ports/virtual_time/virtual_host.hpp"

#include "mamori/kernel/assert.hpp"

namespace mamori::ports::virtual_time {

bool VirtualHost::run_within(std::size_t component, Work work, Instant deadline) noexcept {
    const Duration duration = component < durations_.size() ? durations_[component] : Duration{0};
    if (duration == kNever) {
        advance_to(deadline);
        return false;
    }
    work.function(work.argument);
    if (now_ + duration > deadline) {
        advance_to(deadline);
        return false;
    }
    now_ = now_ + duration;
    return true;
}

void VirtualHost::advance_to(Instant instant) noexcept {
    MAMORI_REQUIRE(1, instant >= now_);
    now_ = instant;
}

Status VirtualHost::set_duration(std::size_t component, Duration duration) noexcept {
    if (component >= durations_.size() || duration < Duration{0}) {
        return Status::kBadParameter;
    }
    durations_[component] = duration;
    return Status::kOk;
}

}  // namespace mamori::ports::virtual_time
