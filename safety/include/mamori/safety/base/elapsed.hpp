// SPDX-License-Identifier: Apache-2.0
/// @file
/// Time between two instants, for every time limit of the safety layer. It cannot overflow, and a clock that
/// ran backwards shows as a negative value, which no limit accepts.
///
/// @satisfies SWR-SUP-006      Design: docs/design/supervision.md#deadline-supervision
#ifndef MAMORI_SAFETY_ELAPSED_HPP
#define MAMORI_SAFETY_ELAPSED_HPP

#include <cstdint>
#include <limits>

#include "mamori/kernel/base/time.hpp"

namespace mamori::safety {

/// @param[in] start any instant, tick 0 included. @param[in] now any instant.
/// @return now - start, held at the ends of the 64-bit range; negative when `now` lies before `start`.
constexpr Duration calc_elapsed(Instant start, Instant now) noexcept {
    constexpr std::int64_t kLongest = std::numeric_limits<std::int64_t>::max();
    const bool is_forward = now >= start;
    const Instant early = is_forward ? start : now;
    const Instant late = is_forward ? now : start;
    // Unsigned arithmetic wraps by definition, and the true difference always fits into 64 bits without sign.
    const std::uint64_t distance = static_cast<std::uint64_t>(late.ns) - static_cast<std::uint64_t>(early.ns);
    const std::int64_t held =
        distance > static_cast<std::uint64_t>(kLongest) ? kLongest : static_cast<std::int64_t>(distance);
    return {is_forward ? held : -held};
}

/// True unless 0 <= now - start <= limit.
constexpr bool is_over(Instant start, Instant now, Duration limit) noexcept {
    const Duration elapsed = calc_elapsed(start, now);
    return elapsed < Duration{0} || elapsed > limit;
}

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_ELAPSED_HPP
