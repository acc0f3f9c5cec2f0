// SPDX-License-Identifier: Apache-2.0
/// @file
/// The cheapest possible platform host, which calls the work and reads the clock. Benchmarks thus measure the
/// executive and not a port.
#ifndef MAMORI_VERIFICATION_BENCH_MINIMAL_HOST_HPP
#define MAMORI_VERIFICATION_BENCH_MINIMAL_HOST_HPP

#include <time.h>

#include <cstddef>

#include "mamori/kernel/component/window_host.hpp"

namespace mamori::verification::bench {

/// @return the monotonic clock of the system.
inline Instant read_clock() noexcept {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return Instant{static_cast<std::int64_t>(now.tv_sec) * 1'000'000'000 + now.tv_nsec};
}

/// A clock without cost: each reading is one nanosecond after the previous one.
class CountingClock {
  public:
    Instant read() const noexcept { return Instant{++now_ns_}; }

  private:
    mutable std::int64_t now_ns_{0};
};

/// The clock that a port on Linux reads.
class SystemClock {
  public:
    Instant read() const noexcept { return read_clock(); }
};

template <typename Clock>
class MinimalHost final : public WindowHost {
  public:
    Instant get_now() const noexcept override { return clock_.read(); }
    Instant get_step_end() const noexcept override { return clock_.read(); }

    std::size_t run_within(const Work& work, Instant) noexcept override {
        work.run(work.argument, work.first, work.first + work.count);
        return work.count;
    }
    bool has_returned(std::size_t) const noexcept override { return true; }

  private:
    Clock clock_;
};

}  // namespace mamori::verification::bench

#endif  // MAMORI_VERIFICATION_BENCH_MINIMAL_HOST_HPP
