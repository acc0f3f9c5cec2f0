// SPDX-License-Identifier: Apache-2.0
/// @file
/// The clocks of Linux in the form that the self tests and the checks of assumptions require.
///
///     ReadingSource reference{get_raw_clock()};
///     TickSource tick{clock};  // the FrameClock of the runners
///     safety::TickSourceCheck check{reference, tick, {100_ms, 1000U}};
///
/// @satisfies SWR-SLF-021      Design: docs/design/assumptions.md#linux
#ifndef MAMORI_PORTS_POSIX_RT_CLOCK_SOURCES_HPP
#define MAMORI_PORTS_POSIX_RT_CLOCK_SOURCES_HPP

#include "mamori/kernel/base/time.hpp"
#include "mamori/ports/posix_rt/frame_clock.hpp"
#include "mamori/ports/posix_rt/time_source.hpp"
#include "mamori/safety/self_test/clock_check.hpp"

namespace mamori::ports::posix_rt {

/// A clock of this computer; as reference, usually get_raw_clock(). CLOCK_MONOTONIC and CLOCK_MONOTONIC_RAW
/// come from one oscillator. Their ratio shows errors of software, for example a time daemon that adjusts the
/// rate, or a stopped clock. To detect a wrong oscillator, use a clock of another device as reference.
///
/// Thread safety: any thread. Time: one reading. Memory: a reference, whose object must outlive it.
class ReadingSource final : public safety::ClockSource {
  public:
    explicit constexpr ReadingSource(const ClockReading& clock) noexcept : clock_(clock) {}
    Instant read() noexcept override { return Instant{clock_.read_ns()}; }

  private:
    const ClockReading& clock_;
};

/// The time line of the window starts and budgets.
///
/// Thread safety: any thread. Time: one reading. Memory: a reference, whose object must outlive it.
class TickSource final : public safety::ClockSource {
  public:
    explicit constexpr TickSource(const FrameClock& clock) noexcept : clock_(clock) {}
    Instant read() noexcept override { return clock_.get_now(); }

  private:
    const FrameClock& clock_;
};

}  // namespace mamori::ports::posix_rt

#endif  // MAMORI_PORTS_POSIX_RT_CLOCK_SOURCES_HPP
