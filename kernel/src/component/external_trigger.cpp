// SPDX-License-Identifier: Apache-2.0
#include "mamori/kernel/component/external_trigger.hpp"

namespace mamori {
namespace {

/// Only the context writes these counters, so a load and a store suffice.
void add(std::atomic<std::uint32_t>& counter, std::uint32_t count) noexcept {
    counter.store(counter.load(std::memory_order_relaxed) + count, std::memory_order_relaxed);
}

}  // namespace

bool ExternalTrigger::take() noexcept {
    const std::uint32_t settled = settled_count_.load(std::memory_order_relaxed);
    const std::uint32_t backlog = arrived_count_.load(std::memory_order_acquire) - settled;
    const std::uint32_t overflow = backlog > backlog_limit_ ? backlog - backlog_limit_ : 0U;
    const bool is_due = backlog > overflow;
    add(overflow_count_, overflow);
    settled_count_.store(settled + overflow + (is_due ? 1U : 0U), std::memory_order_relaxed);
    return is_due;
}

void ExternalTrigger::ignore_waiting() noexcept {
    const std::uint32_t arrived = arrived_count_.load(std::memory_order_acquire);
    add(ignored_count_, arrived - settled_count_.load(std::memory_order_relaxed));
    settled_count_.store(arrived, std::memory_order_relaxed);
}

std::uint32_t ExternalTrigger::get_backlog() const noexcept {
    const std::uint32_t settled = settled_count_.load(std::memory_order_relaxed);
    return arrived_count_.load(std::memory_order_acquire) - settled;
}

}  // namespace mamori
