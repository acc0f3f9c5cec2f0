// SPDX-License-Identifier: Apache-2.0
#include "mamori/ports/virtual_time/virtual_host.hpp"

#include "mamori/kernel/assert.hpp"

namespace mamori::ports::virtual_time {

bool VirtualHost::run_within(std::size_t component, Work work, Instant deadline) noexcept {
    const bool is_modelled = work.pass == Pass::kExecute && component < durations_.size();
    const Duration duration = is_modelled ? durations_[component] : Duration{0};
    MAMORI_REQUIRE(2, duration >= Duration{0});
    if (duration != kNever) {
        work.function(work.argument);
    }
    // Written without the sum, which could overflow.
    if (duration == kNever || duration > deadline - now_) {
        advance_to(deadline > now_ ? deadline : now_);
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
