// SPDX-License-Identifier: Apache-2.0
/// @file
/// The real number of type float or double that lies nearest to a decimal one, ties to even: what the
/// compiler makes of the same digits in a program text. Exact arithmetic on a fixed number of words; no
/// rounding step but the last.
///
/// @satisfies SWR-PAR-002      Design: docs/design/parameters.md#numbers
/// Source:   IEEE 754-2008, 5.12 (conversion between external character sequences and binary formats)
#ifndef MAMORI_KERNEL_DECIMAL_ROUNDING_HPP
#define MAMORI_KERNEL_DECIMAL_ROUNDING_HPP

#include <cstdint>
#include <limits>

#include "mamori/kernel/base/status.hpp"
#include "mamori/kernel/parameter/detail/big_natural.hpp"
#include "mamori/kernel/parameter/detail/decimal.hpp"

namespace mamori {

namespace detail {

/// `mantissa` * 2^`exponent`, exactly. Every intermediate product is representable, since the result is.
template <typename Real>
constexpr Real scale(std::uint64_t mantissa, std::int32_t exponent) noexcept {
    Real result = static_cast<Real>(mantissa);
    for (std::int32_t e = exponent; e < 0; ++e) {
        result *= Real{0.5};
    }
    for (std::int32_t e = exponent; e > 0; --e) {
        result *= Real{2};
    }
    return result;
}

}  // namespace detail

/// Nearest value of `Real` (float or double); a tie goes to the even one. Time: at most 455 steps over 48
/// words, and 1100 multiplications.
/// @return kBadParameter when the nearest one is infinite, or zero although the number is not.
template <typename Real>
constexpr Result<Real> to_real(const Decimal& number) noexcept {
    static_assert(std::numeric_limits<Real>::is_iec559 && std::numeric_limits<Real>::digits <= 53);
    constexpr std::int32_t kPrecision = std::numeric_limits<Real>::digits;
    constexpr std::int32_t kSmallestUnit = std::numeric_limits<Real>::min_exponent - kPrecision;
    if (number.digits == 0U) {
        return number.is_negative ? -Real{0} : Real{0};
    }
    // 2^64 * 10^-400 rounds to zero, and 10^310 to infinity, in either type.
    if (number.exponent < -400 || number.exponent > 310) {
        return Status::kBadParameter;
    }
    detail::BigNatural numerator{number.digits};
    detail::BigNatural denominator{1U};
    (number.exponent < 0 ? denominator : numerator)
        .multiply_by_power_of_ten(number.exponent < 0 ? -number.exponent : number.exponent);

    // A unit that leaves one or two bits below the mantissa, and one below the smallest number of all.
    const std::int32_t magnitude = numerator.calc_bit_length() - denominator.calc_bit_length();
    const std::int32_t wanted_unit = magnitude - kPrecision - 1;
    const std::int32_t unit = wanted_unit < kSmallestUnit - 1 ? kSmallestUnit - 1 : wanted_unit;
    (unit < 0 ? numerator : denominator).shift_left(unit < 0 ? -unit : unit);
    std::uint64_t mantissa = detail::divide(numerator, denominator, kPrecision + 2);

    const std::uint32_t dropped = mantissa >> (kPrecision + 1) != 0U ? 2U : 1U;
    const std::uint64_t half = std::uint64_t{1} << (dropped - 1U);
    const std::uint64_t rest = mantissa & (2U * half - 1U);
    mantissa >>= dropped;
    const bool is_tie = rest == half && numerator.is_zero();
    if (is_tie ? (mantissa & 1U) != 0U : rest >= half) {
        ++mantissa;
    }
    const std::int32_t exponent = unit + static_cast<std::int32_t>(dropped);
    const std::int32_t length = detail::BigNatural{mantissa}.calc_bit_length();
    if (mantissa == 0U || length + exponent > std::numeric_limits<Real>::max_exponent) {
        return Status::kBadParameter;
    }
    const Real result = detail::scale<Real>(mantissa, exponent);
    return number.is_negative ? -result : result;
}

}  // namespace mamori

#endif  // MAMORI_KERNEL_DECIMAL_ROUNDING_HPP
