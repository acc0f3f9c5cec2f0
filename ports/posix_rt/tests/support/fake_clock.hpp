// SPDX-License-Identifier: Apache-2.0
/// @file
/// A clock that is stopped until a test advances it, and a clock whose waits a test can block.
#ifndef MAMORI_PORTS_POSIX_RT_TESTS_FAKE_CLOCK_HPP
#define MAMORI_PORTS_POSIX_RT_TESTS_FAKE_CLOCK_HPP

#include <atomic>
#include <cstdint>
#include <thread>

#include "mamori/ports/posix_rt/time_source.hpp"

namespace mamori::ports::posix_rt {

class FakeClock final : public TimeSource {
  public:
    explicit FakeClock(std::int64_t ns) noexcept : now_ns(ns) {}
    std::int64_t read_ns() const noexcept override { return now_ns; }
    void wait_until(std::int64_t ns) const noexcept override { slept_until_ns = ns; }
    std::int64_t to_monotonic(std::int64_t ns) const noexcept override { return ns + monotonic_offset_ns; }

    std::int64_t now_ns;
    std::int64_t monotonic_offset_ns{0};
    mutable std::int64_t slept_until_ns{0};
};

/// The Linux clock with timers that can fail: while `is_stuck`, no sleep and no deadline of a system call
/// ends.
class StuckClock final : public TimeSource {
  public:
    std::int64_t read_ns() const noexcept override { return get_monotonic_clock().read_ns(); }
    void wait_until(std::int64_t ns) const noexcept override {
        while (is_stuck.load()) {
            std::this_thread::yield();
        }
        get_monotonic_clock().wait_until(ns);
    }
    std::int64_t to_monotonic(std::int64_t ns) const noexcept override {
        constexpr std::int64_t kHour = 3'600'000'000'000;
        return is_stuck.load() ? ns + kHour : ns;
    }

    std::atomic<bool> is_stuck{false};
};

}  // namespace mamori::ports::posix_rt

#endif  // MAMORI_PORTS_POSIX_RT_TESTS_FAKE_CLOCK_HPP
