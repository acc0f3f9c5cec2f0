// SPDX-License-Identifier: Apache-2.0
/// @file
/// The time line of a system in real time: nanoseconds of the monotonic clock since an epoch that all its
/// cores share. A step of the wall clock changes nothing on it.
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

/// Sum that stays at the ends of the range: an instant that never comes must not look like one that has
/// passed.
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

/// Instant 0 is the epoch: frame n of every core begins n frames after it.
///
/// Thread safety: any thread. Time: one reading of CLOCK_MONOTONIC, or a sleep. Memory: two words.
class FrameClock final {
  public:
    /// @param[in] lead from now to the epoch, >= 0, held at the end of the source's range; gives the threads
    /// time to be ready for their first window. @param[in] source clock behind it, which must outlive it;
    /// another one than Linux's is for tests.
    static FrameClock starting_in(Duration lead, const TimeSource& source = get_monotonic_clock()) noexcept;
    /// The time line of another clock of this machine, in another process too. @param[in] epoch_ns as that
    /// one's get_epoch_ns(); both with Linux's own clock behind them.
    static FrameClock at_epoch(std::int64_t epoch_ns) noexcept { return {get_monotonic_clock(), epoch_ns}; }

    /// Reading of the clock behind it, CLOCK_MONOTONIC unless it was replaced, at instant 0 [ns].
    constexpr std::int64_t get_epoch_ns() const noexcept { return epoch_ns_; }

    Instant get_now() const noexcept;
    /// The same instant for a system call with an absolute time. One before the clock's own zero is that
    /// zero; one beyond the range of the clock is its last.
    timespec to_timespec(Instant instant) const noexcept;
    /// Returns at `instant` or later, however often a signal comes in between; at once when it has passed.
    void wait_until(Instant instant) const noexcept;

  private:
    constexpr FrameClock(const TimeSource& source, std::int64_t epoch_ns) noexcept
        : source_(&source), epoch_ns_(epoch_ns) {}

    const TimeSource* source_;
    std::int64_t epoch_ns_;  ///< of the source
};

}  // namespace mamori::ports::posix_rt

#endif  // MAMORI_PORTS_POSIX_RT_FRAME_CLOCK_HPP
