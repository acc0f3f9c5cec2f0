// SPDX-License-Identifier: Apache-2.0
/// @file
/// How far the openings of two windows are apart at least, whatever their periods are. Not for users.
///
/// @satisfies SWR-KRN-018, SWR-KRN-025      Design: docs/design/kernel.md#system-table
/// Source:   J. Korst et al., "Periodic multiprocessor scheduling", PARLE 1991
#ifndef MAMORI_KERNEL_OPENING_DISTANCE_HPP
#define MAMORI_KERNEL_OPENING_DISTANCE_HPP

#include <cstdint>

#include "mamori/kernel/base/time.hpp"
#include "mamori/kernel/table/window_row.hpp"

namespace mamori::detail {

constexpr std::int64_t calc_gcd(std::int64_t a, std::int64_t b) noexcept {
    while (b != 0) {  // at most 92 steps: the numbers fall at least as fast as Fibonacci's
        const std::int64_t rest = a % b;
        a = b;
        b = rest;
    }
    return a;
}

/// What is left of `value`, in 0 .. divisor - 1.
constexpr std::int64_t calc_rest(std::int64_t value, std::int64_t divisor) noexcept {
    const std::int64_t rest = value % divisor;
    return rest < 0 ? rest + divisor : rest;
}

/// Smallest time from an opening of `from` to an opening of `to` that is not before it. Two strictly periodic
/// openings meet at every distance that is equal to their first one modulo the greatest common divisor of
/// their periods.
constexpr Duration calc_distance(const WindowRow& from, const WindowRow& to) noexcept {
    const std::int64_t divisor = calc_gcd(from.period.ns, to.period.ns);
    // Each by itself, since offsets that another rule refuses may be too far apart to be subtracted.
    const std::int64_t distance = calc_rest(to.offset.ns, divisor) - calc_rest(from.offset.ns, divisor);
    return {calc_rest(distance, divisor)};
}

}  // namespace mamori::detail

#endif  // MAMORI_KERNEL_OPENING_DISTANCE_HPP
