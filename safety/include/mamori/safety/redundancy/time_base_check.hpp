// SPDX-License-Identifier: Apache-2.0
/// @file
/// Cross-check of two channels that run the same schedule: each holds the cycle counter and the clock of the
/// other one against its own.
///
/// @satisfies SWR-RED-010      Design: docs/design/redundancy.md#sequence-and-time-base
/// Source:   IEC 61508-7:2010 A.9 (temporal and logical monitoring)
#ifndef MAMORI_SAFETY_REDUNDANCY_TIME_BASE_CHECK_HPP
#define MAMORI_SAFETY_REDUNDANCY_TIME_BASE_CHECK_HPP

#include <cstdint>

#include "mamori/kernel/base/assert.hpp"
#include "mamori/kernel/base/status.hpp"
#include "mamori/kernel/base/time.hpp"
#include "mamori/safety/redundancy/clock_ratio.hpp"

namespace mamori::safety {

/// Where a channel is in its schedule.
struct ChannelTime {
    std::uint32_t cycle{0U};  ///< number of the cycle; wraps
    Instant now{};            ///< by the clock of the channel
};

/// How far two channels may be apart.
struct TimeBaseLimits {
    std::uint32_t cycles_apart_max{0U};  ///< included: 0 .. 2^30
    ClockRatioLimits clocks{};
};

/// What is wrong with two channels; the first finding is kept until it is acknowledged.
enum class TimeBaseFinding : std::uint8_t {
    kNone,
    kSteppedBack,  ///< a cycle counter did not go on, but back
    kCyclesApart,  ///< the cycle counters are further apart than allowed
    kClocksApart,  ///< the clocks are, or one ran backwards
};

/// Compares the sequence and the time base of two channels.
///
/// Thread safety: none; call step() once per cycle. Time: O(1), nothing blocks. Memory: no heap.
class TimeBaseCheck final {
  public:
    explicit constexpr TimeBaseCheck(const TimeBaseLimits& limits) noexcept
        : clocks_(limits.clocks), cycles_apart_max_(limits.cycles_apart_max) {
        MAMORI_REQUIRE(1, limits.cycles_apart_max <= (1U << 30U));
    }

    /// A channel that stands still is found by its counter as soon as the other one is too far ahead.
    TimeBaseFinding step(const ChannelTime& own, const ChannelTime& other) noexcept;

    /// Begins anew after a finding. Only for a deliberate act of a person.
    /// @return kOk; kPreconditionNotMet (there is none).
    Status acknowledge() noexcept;

    constexpr TimeBaseFinding get_finding() const noexcept { return finding_; }

  private:
    ClockRatio clocks_;
    std::uint32_t cycles_apart_max_;
    std::uint32_t own_cycle_{0U};
    std::uint32_t other_cycle_{0U};
    TimeBaseFinding finding_{TimeBaseFinding::kNone};
    bool has_begun_{false};
};

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_REDUNDANCY_TIME_BASE_CHECK_HPP
