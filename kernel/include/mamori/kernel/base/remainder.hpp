// SPDX-License-Identifier: Apache-2.0
/// @file
/// The remainder of a division of 64-bit numbers. A processor without such a division would call a function
/// of its compiler's library, which is larger than every other function of a small system.
///
/// @satisfies SWR-KRN-072      Design: docs/design/kernel.md#parts-that-a-table-does-not-use
#ifndef MAMORI_KERNEL_REMAINDER_HPP
#define MAMORI_KERNEL_REMAINDER_HPP

#include <cstdint>

namespace mamori::detail {

/// One subtraction per bit of the quotient. @param[in] divisor > 0 and at most 2^63 - 1.
constexpr std::uint64_t calc_remainder_bit_by_bit(std::uint64_t dividend, std::uint64_t divisor) noexcept {
    std::uint64_t remainder = 0U;
    for (int bit = 0; bit < 64; ++bit) {
        remainder = remainder * 2U + (dividend >> 63U);
        dividend *= 2U;
        if (remainder >= divisor) {
            remainder -= divisor;
        }
    }
    return remainder;
}

/// @param[in] dividend >= 0. @param[in] divisor > 0. @return dividend % divisor.
constexpr std::int64_t calc_remainder(std::int64_t dividend, std::int64_t divisor) noexcept {
    if constexpr (sizeof(void*) >= sizeof(std::int64_t)) {
        return dividend % divisor;
    } else {
        return static_cast<std::int64_t>(calc_remainder_bit_by_bit(static_cast<std::uint64_t>(dividend),
                                                                   static_cast<std::uint64_t>(divisor)));
    }
}

}  // namespace mamori::detail

#endif  // MAMORI_KERNEL_REMAINDER_HPP
