// SPDX-License-Identifier: Apache-2.0
#include "mamori/kernel/base/assert.hpp"

#include <atomic>

namespace mamori {
namespace {

std::atomic<AssertionHandler> g_handler{nullptr};
std::atomic<AssertionGate> g_gate{nullptr};
std::atomic<bool> g_has_handler{false};       ///< stays true when a failure has taken the handler out
std::atomic<std::uint32_t> g_is_handled{0U};  ///< 1 once the handler has returned

/// A halt of this context would end the handler's, too. The read-modify-write makes each look take about as
/// long on every processor, and the compiler may not leave it out.
void wait_for_handler() noexcept {
    for (std::uint32_t look = 0U; look < kFailureLooks; ++look) {
        if (g_is_handled.fetch_or(0U, std::memory_order_acq_rel) != 0U) {
            return;
        }
    }
}

}  // namespace

void set_assertion_handler(AssertionHandler handler) noexcept {
    g_has_handler.store(handler != nullptr, std::memory_order_relaxed);
    g_handler.store(handler, std::memory_order_release);
}

void set_assertion_gate(AssertionGate gate) noexcept {
    g_gate.store(gate, std::memory_order_release);
}

namespace detail {

void fail_assertion(const char* file, std::uint32_t id, std::uint32_t line) noexcept {
    const AssertionRecord record{file, id, line};
    const AssertionGate gate = g_gate.load(std::memory_order_acquire);
    if (gate != nullptr) {
        gate(record);
    }
    // Taken out before it is called: a check that fails inside the handler does not call it again.
    const AssertionHandler handler = g_handler.exchange(nullptr, std::memory_order_acq_rel);
    if (handler != nullptr) {
        handler(record);
        g_is_handled.store(1U, std::memory_order_release);
    } else if (gate == nullptr && g_has_handler.load(std::memory_order_relaxed)) {
        wait_for_handler();
    }
    // A halt that no debugger switch can turn into a no-op: the watchdog is no longer served from here on.
    __builtin_trap();
}

}  // namespace detail
}  // namespace mamori
