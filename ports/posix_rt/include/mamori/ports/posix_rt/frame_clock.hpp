// SPDX-License-Identifier: Apache-2.0
/// @file
/// The time line of a real-time system: nanoseconds of the monotonic clock since an epoch that all cores
/// share. Steps of the wall clock do not affect it.
///
/// @satisfies SWR-PRT-001, SWR-PRT-044      Design: docs/design/posix_rt.md#time-line
#ifndef MAMORI_PORTS_POSIX_RT_FRAME_CLOCK_HPP
#define MAMORI_PORTS_POSIX_RT_FRAME_CLOCK_HPP

#include <time.h>

#include <cstdint>
#include <limits>

#include "mamori/kernel/base/time.hpp"
#include "mamori/ports/posix_rt/time_source.hpp"

namespace mamori::ports::posix_rt {

/// Saturating sum: an overflow must not turn an instant in the far future into one that has passed.
constexpr Instant add_saturating(Instant a, Duration b) noexcept {
    using Limits = std::numeric_limits<std::int64_t>;
    if (b.ns > 0 && a.ns > Limits::max() - b.ns) {
        return Instant{Limits::max()};
    }
    if (b.ns < 0 && a.ns < Limits::min() - b.ns) {
        return Instant{Limits::min()};
    }
    return a + b;
}

/// Instant 0 is the epoch. On each core, major frame n begins n major frames after it.
///
/// Thread safety: any thread. Time: one reading of CLOCK_MONOTONIC, or a sleep. Memory: two words.
class FrameClock final {
  public:
    /// @param[in] lead time from now to the epoch, >= 0, so that the threads are ready for their first
    /// window; the epoch saturates at the end of the range of the source.
    /// @param[in] source underlying clock, must outlive this object; clocks other than the Linux clock are
    ///            for tests.
    static FrameClock starting_in(Duration lead, const TimeSource& source = get_monotonic_clock()) noexcept;
    /// The time line of another clock of this computer, for example in another process.
    /// @param[in] epoch_ns get_epoch_ns() of that clock. Both clocks must use the Linux clock as their
    ///            source.
    static FrameClock at_epoch(std::int64_t epoch_ns) noexcept { return {get_monotonic_clock(), epoch_ns}; }

    /// Reading of the source at instant 0 [ns]. The source is CLOCK_MONOTONIC unless it was replaced.
    constexpr std::int64_t get_epoch_ns() const noexcept { return epoch_ns_; }

    Instant get_now() const noexcept;
    /// Converts an instant for a system call with an absolute time. The result saturates at zero and at the
    /// end of the range of the clock.
    timespec to_timespec(Instant instant) const noexcept;
    /// Returns at `instant` or later, also when signals interrupt the wait. Returns immediately if `instant`
    /// has passed.
    void wait_until(Instant instant) const noexcept;

  private:
    constexpr FrameClock(const TimeSource& source, std::int64_t epoch_ns) noexcept
        : source_(&source), epoch_ns_(epoch_ns) {}

    const TimeSource* source_;
    std::int64_t epoch_ns_;  ///< reading of the source
};

}  // namespace mamori::ports::posix_rt

#endif  // MAMORI_PORTS_POSIX_RT_FRAME_CLOCK_HPP
