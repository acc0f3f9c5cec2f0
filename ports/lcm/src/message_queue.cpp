// SPDX-License-Identifier: Apache-2.0
#include "mamori/ports/lcm/message_queue.hpp"

#include <limits>

namespace mamori::ports::lcm {

void MessageInbox::count(Counter& counter) noexcept {
    const std::uint32_t value = counter.load(std::memory_order_relaxed);
    if (value != std::numeric_limits<std::uint32_t>::max()) {
        counter.store(value + 1U, std::memory_order_relaxed);
    }
}

void MessageInbox::put(Span<const std::byte> message) noexcept {
    if (message.size() >= kFingerprintSize && detail::read_fingerprint(message) != limits_.fingerprint) {
        count(foreign_);
    } else if (message.size() < limits_.size_min) {
        count(truncated_);
    } else if (message.size() > limits_.size_max) {
        count(oversized_);
    } else {
        store(message);
        count(accepted_);
    }
}

ReceptionCounts MessageInbox::get_counts() const noexcept {
    return {accepted_.load(std::memory_order_relaxed),  foreign_.load(std::memory_order_relaxed),
            truncated_.load(std::memory_order_relaxed), oversized_.load(std::memory_order_relaxed),
            damaged_.load(std::memory_order_relaxed),   get_overwritten_count()};
}

}  // namespace mamori::ports::lcm
