// SPDX-License-Identifier: Apache-2.0
/// @file
/// The Linux clocks of the time line of a system. Tests can replace them to inject a fast or slow clock, or a
/// timer that does not expire.
///
/// @satisfies SWR-PRT-030      Design: docs/design/posix_rt.md#time-line
#ifndef MAMORI_PORTS_POSIX_RT_TIME_SOURCE_HPP
#define MAMORI_PORTS_POSIX_RT_TIME_SOURCE_HPP

#include <cstdint>

namespace mamori::ports::posix_rt {

/// A clock that can be read.
///
/// Thread safety: any thread. Implementations must not block.
class ClockReading {
  public:
    /// Nanoseconds since the zero of this clock; never decreases.
    virtual std::int64_t read_ns() const noexcept = 0;

  protected:
    ~ClockReading() = default;
};

/// A clock that supports waiting.
class TimeSource : public ClockReading {
  public:
    /// Returns when read_ns() has reached `ns` or later, also when signals interrupt the wait.
    virtual void wait_until(std::int64_t ns) const noexcept = 0;
    /// For system calls with an absolute time. @return value of CLOCK_MONOTONIC when this clock shows `ns`.
    virtual std::int64_t to_monotonic(std::int64_t ns) const noexcept = 0;

  protected:
    ~TimeSource() = default;
};

/// CLOCK_MONOTONIC: steps of the wall clock do not affect it, but a time daemon can change its rate by up to
/// 10 % (`adjtimex`).
const TimeSource& get_monotonic_clock() noexcept;

/// CLOCK_MONOTONIC_RAW: the same hardware, not adjusted by daemons. It supports reading only.
const ClockReading& get_raw_clock() noexcept;

}  // namespace mamori::ports::posix_rt

#endif  // MAMORI_PORTS_POSIX_RT_TIME_SOURCE_HPP
