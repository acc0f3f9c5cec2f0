// SPDX-License-Identifier: Apache-2.0
#include "mamori/ports/posix_rt/crash_place.hpp"

#include <atomic>

namespace mamori::ports::posix_rt {
namespace {

constexpr std::uint32_t kWindowShift = 16U;
constexpr std::uint32_t kNothing = 0xFFFF'FFFFU;

/// One atomic variable, so that a signal handler never reads the window of one step and the component of
/// another. The TLS model avoids an allocation at the first use in a thread, which is not async-signal-safe.
[[gnu::tls_model("initial-exec")]] thread_local std::atomic<std::uint32_t> place{kNothing};

std::uint32_t to_half(std::size_t number) noexcept {
    return static_cast<std::uint32_t>(number < CrashPlace::kWatchdog ? number : CrashPlace::kNone);
}

}  // namespace

void set_crash_place(std::size_t window, std::size_t component) noexcept {
    place.store((to_half(window) << kWindowShift) | to_half(component), std::memory_order_relaxed);
}

void clear_crash_place() noexcept {
    place.store(kNothing, std::memory_order_relaxed);
}

void set_crash_place_of_watchdog() noexcept {
    place.store((to_half(CrashPlace::kNone) << kWindowShift) | CrashPlace::kWatchdog,
                std::memory_order_relaxed);
}

CrashPlace get_crash_place() noexcept {
    const std::uint32_t both = place.load(std::memory_order_relaxed);
    return {static_cast<std::uint16_t>(both >> kWindowShift), static_cast<std::uint16_t>(both & 0xFFFFU)};
}

}  // namespace mamori::ports::posix_rt
