// SPDX-License-Identifier: Apache-2.0
#include "mamori/ports/posix_rt/time_source.hpp"

#include <time.h>

#include <cerrno>

#include "mamori/kernel/base/assert.hpp"

namespace mamori::ports::posix_rt {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

std::int64_t read(clockid_t clock) noexcept {
    timespec now{};
    // The call cannot fail: every Linux has this clock, and the address is valid.
    MAMORI_ENSURE(1, clock_gettime(clock, &now) == 0);
    return static_cast<std::int64_t>(now.tv_sec) * kSecond + now.tv_nsec;
}

class MonotonicClock final : public TimeSource {
  public:
    std::int64_t read_ns() const noexcept override { return read(CLOCK_MONOTONIC); }
    void wait_until(std::int64_t ns) const noexcept override {
        const timespec at{static_cast<time_t>(ns / kSecond), static_cast<long>(ns % kSecond)};
        int result = EINTR;
        while (result == EINTR) {
            result = clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &at, nullptr);
        }
        MAMORI_ENSURE(2, result == 0);
    }
    std::int64_t to_monotonic(std::int64_t ns) const noexcept override { return ns; }
};

class RawClock final : public ClockReading {
  public:
    std::int64_t read_ns() const noexcept override { return read(CLOCK_MONOTONIC_RAW); }
};

constexpr MonotonicClock kMonotonic;
constexpr RawClock kRaw;

}  // namespace

const TimeSource& get_monotonic_clock() noexcept {
    return kMonotonic;
}

const ClockReading& get_raw_clock() noexcept {
    return kRaw;
}

}  // namespace mamori::ports::posix_rt
