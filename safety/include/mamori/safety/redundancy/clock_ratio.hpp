// SPDX-License-Identifier: Apache-2.0
/// @file
/// Compares the rates of two clocks over windows of time: a clock that is fast, slow, frozen, or runs
/// backwards against another one that does not share its cause.
///
/// @satisfies SWR-RED-011      Design: docs/design/redundancy.md#sequence-and-time-base
/// Source:   IEC 61508-7:2010 A.9 (temporal and logical monitoring)
#ifndef MAMORI_SAFETY_REDUNDANCY_CLOCK_RATIO_HPP
#define MAMORI_SAFETY_REDUNDANCY_CLOCK_RATIO_HPP

#include <cstdint>

#include "mamori/kernel/base/assert.hpp"
#include "mamori/kernel/base/status.hpp"
#include "mamori/kernel/base/time.hpp"

namespace mamori::safety {

/// How far two clocks may differ.
struct ClockRatioLimits {
    Duration window{0};              ///< over which the rates are compared, > 0
    std::uint32_t deviation_ppm{0};  ///< of the reference, included: 1 .. 999999 [ppm]
};

/// True when the limits are inside their range.
constexpr bool is_valid(const ClockRatioLimits& limits) noexcept {
    return limits.window > Duration{0} && limits.deviation_ppm >= 1U && limits.deviation_ppm < 1000000U;
}

/// Judgement about two clocks; ordered, the worst is the largest.
enum class ClockVerdict : std::uint8_t {
    kGood,       ///< in the last whole window
    kMeasuring,  ///< no window is over yet
    kViolated,   ///< kept until acknowledged
};

/// Ratio of two clocks.
///
/// Thread safety: none; call step() once per cycle. Time: O(1), nothing blocks. Memory: no heap.
class ClockRatio final {
  public:
    explicit constexpr ClockRatio(const ClockRatioLimits& limits) noexcept : limits_(limits) {
        MAMORI_REQUIRE(1, is_valid(limits));
    }

    /// A window is over, and judged, in the step in which it is over by either clock, so a frozen one is
    /// found by the other. Windows follow one another: a deviation is found by the end of the second one.
    /// @param[in] reference, checked readings of one moment; the time between the two readings counts as
    ///            deviation, so choose the window long against it.
    ClockVerdict step(Instant reference, Instant checked) noexcept;

    /// Begins anew after a violation. Only for a deliberate act of a person.
    /// @return kOk; kPreconditionNotMet (nothing is violated).
    Status acknowledge() noexcept;

    constexpr ClockVerdict get_verdict() const noexcept { return verdict_; }

  private:
    struct Readings {
        Instant reference{};
        Instant checked{};
    };
    ClockVerdict judge(const Readings& now) const noexcept;

    ClockRatioLimits limits_;
    Readings begun_{};
    Readings last_{};
    ClockVerdict verdict_{ClockVerdict::kMeasuring};
    bool has_begun_{false};
};

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_REDUNDANCY_CLOCK_RATIO_HPP
