// SPDX-License-Identifier: Apache-2.0
/// @file
/// Compares two clocks that should run alike: whoever of the two is fast, slow or stands still, their
/// distance grows.
///
/// @satisfies SWR-PRT-032      Design: docs/design/posix_rt.md#watch
#ifndef MAMORI_PORTS_POSIX_RT_RATE_CHECK_HPP
#define MAMORI_PORTS_POSIX_RT_RATE_CHECK_HPP

#include <cstdint>

#include "mamori/kernel/base/time.hpp"
#include "mamori/ports/posix_rt/frame_clock.hpp"
#include "mamori/ports/posix_rt/time_source.hpp"

namespace mamori::ports::posix_rt {

/// Two clocks, read at nearly the same time.
struct ClockPair {
    Instant watched{};
    std::int64_t reference_ns{0};
    /// The watched clock was read within so much of `reference_ns`, before or after it; >= 0.
    Duration uncertainty{};
};

/// Reads both: the reference before and after the watched clock, up to three times, and takes the narrowest.
ClockPair read_pair(const FrameClock& watched, const ClockReading& reference) noexcept;

/// How far the clocks may come apart.
struct RateLimits {
    /// Time over which they are compared, > 0; afterwards the comparison begins anew, so that small
    /// differences do not add up over a day.
    Duration span{};
    /// Difference of their rates [1e-6], > 0. Over a whole span a greater one is found.
    std::int64_t limit_ppm{0};
};

enum class Rate : std::uint8_t {
    kSound,  ///< as far as the readings tell: a wide uncertainty proves little
    kFast,   ///< the watched clock gained more on the reference than a span at the limit allows
    kSlow    ///< it lost more
};

/// A deviation that is greater than the limit for two spans is found by the end of the second one; the
/// greater it is, the sooner. What the readings leave uncertain counts for the clock.
///
/// Thread safety: none. Time: O(1). Memory: five words.
class RateCheck final {
  public:
    constexpr explicit RateCheck(const RateLimits& limits) noexcept : limits_(limits) {}

    /// Judges one reading. The first one after the construction, after restart() and after a verdict other
    /// than kSound only begins a span.
    Rate look(const ClockPair& pair) noexcept;
    void restart() noexcept;
    /// Whole spans without a finding since then.
    std::uint32_t get_sound_spans() const noexcept { return sound_spans_; }

  private:
    void begin(const ClockPair& pair) noexcept;

    RateLimits limits_;
    ClockPair begin_{};
    std::uint32_t sound_spans_{0U};
    bool has_begun_{false};
};

}  // namespace mamori::ports::posix_rt

#endif  // MAMORI_PORTS_POSIX_RT_RATE_CHECK_HPP
