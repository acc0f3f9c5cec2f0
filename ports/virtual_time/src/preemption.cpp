// SPDX-License-Identifier: Apache-2.0
#include "mamori/ports/virtual_time/preemption.hpp"

#include <algorithm>

namespace mamori::ports::virtual_time {

Duration Preemption::calc_time(std::size_t window) const noexcept {
    const WindowRow& row = executive_.get_view().windows[window];
    Duration left = executive_.get_context(window).is_running() ? row.budget : Duration{0};
    const Duration budget = left;
    for (std::size_t i = row.first_component; i < row.first_component + row.component_count; ++i) {
        const Duration duration = clock_.get_duration(i);
        left = duration < left ? left - duration : Duration{0};
    }
    return budget - left;
}

Instant Preemption::calc_start(Instant at) noexcept {
    Instant start = at;
    while (next_.get_next().release <= start) {
        start = start + calc_time(next_.get_next().window);
        next_.advance();
    }
    return start;
}

StepEnd Preemption::run_step(Instant from, Duration duration, Instant deadline) noexcept {
    Duration left = duration < budget_left_ ? duration : budget_left_;
    Instant at = calc_start(from);
    for (Duration free = next_.get_next().release - at; free < left && at <= deadline;
         free = next_.get_next().release - at) {
        left = left - free;
        at = calc_start(at + free);
    }
    if (at > deadline || left > deadline - at) {
        return {std::max(deadline, from), false};
    }
    const bool is_in_budget = duration <= budget_left_;
    budget_left_ = is_in_budget ? budget_left_ - duration : Duration{0};
    return {at + left, is_in_budget};
}

}  // namespace mamori::ports::virtual_time
