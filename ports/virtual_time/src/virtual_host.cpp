// SPDX-License-Identifier: Apache-2.0
#include "mamori/ports/virtual_time/virtual_host.hpp"

#include "mamori/kernel/base/assert.hpp"

namespace mamori::ports::virtual_time {

StepEnd VirtualHost::run_step(Duration duration, Instant deadline) const noexcept {
    if (processor_ != nullptr) {
        return processor_->run_step(now_, duration, deadline);
    }
    // Written without the sum, which could overflow.
    const bool is_in_time = duration != kNever && duration <= deadline - now_;
    const Instant aborted = deadline > now_ ? deadline : now_;
    return {is_in_time ? now_ + duration : aborted, is_in_time};
}

std::size_t VirtualHost::run_within(const Work& work, Instant deadline) noexcept {
    for (std::size_t i = 0U; i < work.count; ++i) {
        const std::size_t component = work.component + i;
        const Duration duration = work.pass != Pass::kStateUpdate ? get_duration(component) : Duration{0};
        MAMORI_REQUIRE(2, duration >= Duration{0});
        const StepEnd end = run_step(duration, deadline);
        step_end_ = end.is_in_time ? end.at : end.at + Duration{1};
        if (duration != kNever) {
            work.run(work.argument, work.first + i, work.first + i + 1U);
        }
        if (work.pass != Pass::kAction) {
            advance_to(end.at);
        }
        if (!end.is_in_time) {
            return i;
        }
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
