// SPDX-License-Identifier: Apache-2.0
/// @file
/// Compares the rates of two clocks. If one clock is fast, slow or stopped, the difference of their readings
/// grows.
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
    /// Maximum time between the readings of the two clocks, in either direction; >= 0.
    Duration uncertainty{};
};

/// Reads both clocks: the reference before and after the watched clock, up to three times. Returns the pair
/// with the smallest uncertainty.
ClockPair read_pair(const FrameClock& watched, const ClockReading& reference) noexcept;

/// Permitted deviation of the clocks.
struct RateLimits {
    /// Time of one comparison, > 0. Then the comparison restarts, so that small differences do not accumulate
    /// over a day.
    Duration span{};
    /// Permitted difference of the rates [1e-6], > 0. A greater difference during a complete span is found.
    std::int64_t limit_ppm{0};
};

enum class Rate : std::uint8_t {
    kSound,  ///< no deviation shown; a large uncertainty can hide one
    kFast,   ///< the watched clock is ahead by more than a span at the limit permits
    kSlow    ///< the watched clock is behind by more than that
};

/// A deviation above the limit for two spans is found by the end of the second span, a larger deviation
/// earlier. The uncertainty of the readings counts in favour of the watched clock.
///
/// Thread safety: none. Time: O(1). Memory: 48 bytes.
class RateCheck final {
  public:
    constexpr explicit RateCheck(const RateLimits& limits) noexcept : limits_(limits) {}

    /// Evaluates one reading. The first reading after the construction, after restart() and after a verdict
    /// other than kSound only begins a span.
    Rate look(const ClockPair& pair) noexcept;
    void restart() noexcept;
    /// Complete spans without a finding since then.
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
