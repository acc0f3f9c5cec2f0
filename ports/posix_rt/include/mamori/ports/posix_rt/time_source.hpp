// SPDX-License-Identifier: Apache-2.0
/// @file
/// The clocks of Linux behind the time line of a system. They can be replaced, so that a clock that is fast
/// or slow, and a timer that does not fire, can be put into a running system.
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
    /// Nanoseconds since a zero of its own; never less than it was.
    virtual std::int64_t read_ns() const noexcept = 0;

  protected:
    ~ClockReading() = default;
};

/// A clock whose instants can be waited for.
class TimeSource : public ClockReading {
  public:
    /// Returns when read_ns() has reached `ns` or later, however often a signal comes in between.
    virtual void wait_until(std::int64_t ns) const noexcept = 0;
    /// For system calls that take an absolute time. @return what CLOCK_MONOTONIC shows when this clock shows
    /// `ns`.
    virtual std::int64_t to_monotonic(std::int64_t ns) const noexcept = 0;

  protected:
    ~TimeSource() = default;
};

/// CLOCK_MONOTONIC: no step of the wall clock moves it, but a time daemon may let it run faster or slower, by
/// up to a tenth (`adjtimex`).
const TimeSource& get_monotonic_clock() noexcept;

/// CLOCK_MONOTONIC_RAW: the same hardware, which no daemon adjusts. It can be read, not waited for.
const ClockReading& get_raw_clock() noexcept;

}  // namespace mamori::ports::posix_rt

#endif  // MAMORI_PORTS_POSIX_RT_TIME_SOURCE_HPP
