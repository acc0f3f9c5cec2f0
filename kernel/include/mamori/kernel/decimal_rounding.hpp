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

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "mamori/kernel/assert.hpp"
#include "mamori/kernel/decimal.hpp"
#include "mamori/kernel/status.hpp"

namespace mamori {
namespace detail {

/// Natural number of at most 1536 bits. What does not fit is an own bug: the bounds of to_real() keep every
/// number below 1450 bits.
class BigNatural final {
  public:
    constexpr explicit BigNatural(std::uint64_t value) noexcept {
        words_[0] = static_cast<std::uint32_t>(value);
        words_[1] = static_cast<std::uint32_t>(value >> 32U);
        size_ = words_[1] != 0U ? 2U : (words_[0] != 0U ? 1U : 0U);
    }

    constexpr bool is_zero() const noexcept { return size_ == 0U; }

    constexpr std::int32_t calc_bit_length() const noexcept {
        if (size_ == 0U) {
            return 0;
        }
        std::int32_t bits = static_cast<std::int32_t>(size_ - 1U) * 32;
        for (std::uint32_t top = words_[size_ - 1U]; top != 0U; top >>= 1U) {
            ++bits;
        }
        return bits;
    }

    /// @param[in] exponent 0 .. 400
    constexpr void multiply_by_power_of_ten(std::int32_t exponent) noexcept {
        for (std::int32_t i = 0; i < exponent; ++i) {
            std::uint64_t carry = 0U;
            for (std::size_t w = 0U; w < size_; ++w) {
                carry += std::uint64_t{words_[w]} * 10U;
                words_[w] = static_cast<std::uint32_t>(carry);
                carry >>= 32U;
            }
            push(static_cast<std::uint32_t>(carry));
        }
    }

    /// Multiplies by 2^count. @param[in] count >= 0
    constexpr void shift_left(std::int32_t count) noexcept {
        const auto words = static_cast<std::size_t>(count / 32);
        const std::int32_t bits = count % 32;
        MAMORI_REQUIRE(1, size_ + words <= kWords);
        for (std::size_t w = size_; words > 0U && w-- > 0U;) {
            words_[w + words] = words_[w];
            words_[w] = 0U;
        }
        size_ = size_ == 0U ? 0U : size_ + words;
        std::uint64_t carry = 0U;
        for (std::size_t w = words; w < size_; ++w) {
            carry |= std::uint64_t{words_[w]} << static_cast<std::uint32_t>(bits);
            words_[w] = static_cast<std::uint32_t>(carry);
            carry >>= 32U;
        }
        push(static_cast<std::uint32_t>(carry));
    }

    constexpr bool is_less_than(const BigNatural& other) const noexcept {
        if (size_ != other.size_) {
            return size_ < other.size_;
        }
        for (std::size_t w = size_; w-- > 0U;) {
            if (words_[w] != other.words_[w]) {
                return words_[w] < other.words_[w];
            }
        }
        return false;
    }

    /// Subtracts what is not greater.
    constexpr void subtract(const BigNatural& other) noexcept {
        std::uint64_t borrow = 0U;
        for (std::size_t w = 0U; w < size_; ++w) {
            const std::uint64_t difference = std::uint64_t{words_[w]} - other.words_[w] - borrow;
            words_[w] = static_cast<std::uint32_t>(difference);
            borrow = (difference >> 32U) & 1U;
        }
        while (size_ > 0U && words_[size_ - 1U] == 0U) {
            --size_;
        }
    }

  private:
    static constexpr std::size_t kWords = 48U;

    constexpr void push(std::uint32_t word) noexcept {
        if (word != 0U) {
            MAMORI_REQUIRE(2, size_ < kWords);
            words_[size_] = word;
            ++size_;
        }
    }

    std::array<std::uint32_t, kWords> words_{};  ///< lowest first; zero from size_ on
    std::size_t size_{0U};
};

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

/// Divides: the quotient must be below 2^`bits`. The remainder stays in `numerator`, scaled.
constexpr std::uint64_t divide(BigNatural& numerator, BigNatural& denominator, std::int32_t bits) noexcept {
    denominator.shift_left(bits);
    std::uint64_t quotient = 0U;
    for (std::int32_t i = 0; i < bits; ++i) {
        quotient <<= 1U;
        numerator.shift_left(1);
        if (!numerator.is_less_than(denominator)) {
            numerator.subtract(denominator);
            quotient |= 1U;
        }
    }
    return quotient;
}

}  // namespace detail

/// Nearest value of `Real` (float or double); a tie goes to the even one.
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
