// SPDX-License-Identifier: Apache-2.0
/// @file
/// Natural numbers of many words, with as much arithmetic as the exact conversion of decimal numbers needs.
/// Not for users.
///
/// @satisfies SWR-PAR-002      Design: docs/design/parameters.md#numbers
#ifndef MAMORI_KERNEL_BIG_NATURAL_HPP
#define MAMORI_KERNEL_BIG_NATURAL_HPP

#include <array>
#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/assert.hpp"

namespace mamori::detail {

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

}  // namespace mamori::detail

#endif  // MAMORI_KERNEL_BIG_NATURAL_HPP
