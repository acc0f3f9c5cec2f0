// SPDX-License-Identifier: Apache-2.0
/// @file
/// Minimum distance between the window starts of two windows with any periods, and minimum age of a value
/// between them. Not for users.
///
/// @satisfies SWR-KRN-018, SWR-KRN-025, SWR-KRN-061      Design: docs/design/kernel.md#system-table
/// Source:   J. Korst et al., "Periodic multiprocessor scheduling", PARLE 1991
#ifndef MAMORI_KERNEL_OPENING_DISTANCE_HPP
#define MAMORI_KERNEL_OPENING_DISTANCE_HPP

#include <cstdint>

#include "mamori/kernel/base/time.hpp"
#include "mamori/kernel/table/window_row.hpp"

namespace mamori::detail {

constexpr std::int64_t calc_gcd(std::int64_t a, std::int64_t b) noexcept {
    while (b != 0) {  // at most 92 steps: decreases at least as fast as the Fibonacci numbers
        const std::int64_t rest = a % b;
        a = b;
        b = rest;
    }
    return a;
}

/// Remainder of `value`, 0 .. divisor - 1.
constexpr std::int64_t calc_rest(std::int64_t value, std::int64_t divisor) noexcept {
    const std::int64_t rest = value % divisor;
    return rest < 0 ? rest + divisor : rest;
}

/// Minimum time from a window start of `from` to a window start of `to` that is not earlier. Two strictly
/// periodic windows have all distances that are congruent to the first one modulo the greatest common divisor
/// of their periods.
constexpr Duration calc_distance(const WindowRow& from, const WindowRow& to) noexcept {
    const std::int64_t divisor = calc_gcd(from.period.ns, to.period.ns);
    // Each remainder separately: offsets that another rule rejects may overflow in a direct subtraction.
    const std::int64_t distance = calc_rest(to.offset.ns, divisor) - calc_rest(from.offset.ns, divisor);
    return {calc_rest(distance, divisor)};
}

/// Minimum time from a window end of `from` to a window start of `to` that is not earlier: the minimum age of
/// a value there.
constexpr Duration calc_age_min(const WindowRow& from, const WindowRow& to) noexcept {
    const std::int64_t divisor = calc_gcd(from.period.ns, to.period.ns);
    return {calc_rest(calc_distance(from, to).ns - calc_rest(from.length.ns, divisor), divisor)};
}

}  // namespace mamori::detail

#endif  // MAMORI_KERNEL_OPENING_DISTANCE_HPP
