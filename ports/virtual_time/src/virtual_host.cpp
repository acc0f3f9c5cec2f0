// SPDX-License-Identifier: Apache-2.0
#include "mamori/ports/virtual_time/virtual_host.hpp"

#include "mamori/kernel/base/assert.hpp"

namespace mamori::ports::virtual_time {

std::size_t VirtualHost::run_within(const Work& work, Instant deadline) noexcept {
    const bool takes_time = work.pass != Pass::kAction;
    for (std::size_t i = 0U; i < work.count; ++i) {
        const std::size_t component = work.component + i;
        const bool is_modelled = work.pass != Pass::kStateUpdate && component < durations_.size();
        const Duration duration = is_modelled ? durations_[component] : Duration{0};
        MAMORI_REQUIRE(2, duration >= Duration{0});
        // Written without the sum, which could overflow.
        const bool is_in_time = duration != kNever && duration <= deadline - now_;
        const Instant cut_off = deadline > now_ ? deadline : now_;
        step_end_ = is_in_time ? now_ + duration : cut_off + Duration{1};
        if (duration != kNever) {
            work.run(work.argument, work.first + i, work.first + i + 1U);
        }
        if (!is_in_time) {
            advance_to(takes_time ? cut_off : now_);
            return i;
        }
        now_ = takes_time ? step_end_ : now_;
    }
    return work.count;
}

void VirtualHost::advance_to(Instant instant) noexcept {
    MAMORI_REQUIRE(1, instant >= now_);
    now_ = instant;
}

Status VirtualHost::set_duration(const Component& component, Duration duration) noexcept {
    return set_duration(find_component(components_, &component), duration);
}

Status VirtualHost::set_duration(std::size_t component, Duration duration) noexcept {
    if (component >= durations_.size() || duration < Duration{0}) {
        return Status::kBadParameter;
    }
    durations_[component] = duration;
    return Status::kOk;
}

}  // namespace mamori::ports::virtual_time
