// SPDX-License-Identifier: Apache-2.0
#include "mamori/kernel/assert.hpp"

#include <atomic>

namespace mamori {
namespace {

std::atomic<AssertionHandler> g_handler{nullptr};

}  // namespace

void set_assertion_handler(AssertionHandler handler) noexcept {
    g_handler.store(handler, std::memory_order_release);
}

namespace detail {

void fail_assertion(const char* file, std::uint32_t id, std::uint32_t line) noexcept {
    // Taken out before it is called: a check that fails inside the handler halts instead of calling it again.
    const AssertionHandler handler = g_handler.exchange(nullptr, std::memory_order_acq_rel);
    if (handler != nullptr) {
        handler(AssertionRecord{file, id, line});
    }
    // A halt that no debugger switch can turn into a no-op: the watchdog is no longer served from here on.
    __builtin_trap();
}

}  // namespace detail
}  // namespace mamori
