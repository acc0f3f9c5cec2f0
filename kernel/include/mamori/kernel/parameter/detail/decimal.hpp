// SPDX-License-Identifier: Apache-2.0
/// @file
/// Decimal numbers as people write them, kept exactly: nothing is rounded before the type is known for which
/// the number is meant.
///
/// @satisfies SWR-PAR-002      Design: docs/design/parameters.md#numbers
#ifndef MAMORI_KERNEL_DECIMAL_HPP
#define MAMORI_KERNEL_DECIMAL_HPP

#include <cstdint>
#include <limits>

#include "mamori/kernel/base/status.hpp"
#include "mamori/kernel/base/text_cursor.hpp"

namespace mamori {

/// The number `digits` * 10^`exponent`, negated when `is_negative`. From take_decimal() the exponent lies
/// within +-200000; any other may be given.
struct Decimal {
    std::uint64_t digits{0U};
    std::int32_t exponent{0};
    bool is_negative{false};
};

/// A whole number as sign and magnitude, so that both 64-bit types fit.
struct Whole {
    std::uint64_t magnitude{0U};
    bool is_negative{false};
};

namespace detail {

/// Largest exponent that is told apart; beyond it every number is out of range, and zero stays zero.
inline constexpr std::int32_t kExponentLimit = 100000;

/// Collects digits as long as they fit 64 bits; further ones may only be zeros.
struct DigitCollector {
    Decimal number{};
    bool has_digit{false};
    bool is_full{false};
    bool has_lost_digit{false};

    constexpr void add(std::uint32_t digit, bool is_fraction) noexcept {
        constexpr std::uint64_t kMax = std::numeric_limits<std::uint64_t>::max();
        has_digit = true;
        is_full = is_full || number.digits > (kMax - digit) / 10U;
        if (!is_full) {
            number.digits = number.digits * 10U + digit;
            add_exponent(is_fraction ? -1 : 0);
        } else {
            has_lost_digit = has_lost_digit || digit != 0U;
            add_exponent(is_fraction ? 0 : 1);
        }
    }
    constexpr void add_exponent(std::int32_t step) noexcept {
        if (number.exponent + step >= -kExponentLimit && number.exponent + step <= kExponentLimit) {
            number.exponent += step;
        }
    }
};

/// Takes `e` or `E`, a sign and digits. @return false when there are no digits.
constexpr bool take_exponent(TextCursor& cursor, DigitCollector& collector) noexcept {
    if (!cursor.take('e') && !cursor.take('E')) {
        return true;
    }
    const bool is_negative = cursor.take('-');
    if (!is_negative) {
        static_cast<void>(cursor.take('+'));
    }
    if (!cursor.is_at_digit()) {
        return false;
    }
    std::int32_t exponent = 0;
    while (cursor.is_at_digit()) {
        const auto digit = static_cast<std::int32_t>(cursor.take_digit());
        exponent = exponent < kExponentLimit / 10 ? exponent * 10 + digit : kExponentLimit;
    }
    collector.number.exponent += is_negative ? -exponent : exponent;
    return true;
}

/// Takes the digits at `cursor`, as many as there are.
constexpr void take_digits(TextCursor& cursor, DigitCollector& collector, bool is_fraction) noexcept {
    while (cursor.is_at_digit()) {
        collector.add(cursor.take_digit(), is_fraction);
    }
}

}  // namespace detail

/// Takes a number from `cursor`: sign, digits with at most one point, exponent (`-12`, `.5`, `1e-3`).
/// O(length).
/// @return the number; kBadParameter (no number stands here); kUnsupported (more digits than fit 64 bits, 19
///         always do). On a refusal the cursor stands where the number ends to make sense.
constexpr Result<Decimal> take_decimal(TextCursor& cursor) noexcept {
    detail::DigitCollector collector{};
    collector.number.is_negative = cursor.take('-');
    if (!collector.number.is_negative) {
        static_cast<void>(cursor.take('+'));
    }
    detail::take_digits(cursor, collector, false);
    if (cursor.take('.')) {
        detail::take_digits(cursor, collector, true);
    }
    if (!collector.has_digit || !detail::take_exponent(cursor, collector)) {
        return Status::kBadParameter;
    }
    return collector.has_lost_digit ? Result<Decimal>{Status::kUnsupported} : collector.number;
}

/// The number as a whole one, in at most 20 steps.
/// @return kBadParameter when it has a fraction or its magnitude exceeds 64 bits.
constexpr Result<Whole> to_whole(const Decimal& number) noexcept {
    constexpr std::uint64_t kMax = std::numeric_limits<std::uint64_t>::max();
    std::uint64_t magnitude = number.digits;
    // Each step changes a magnitude that is not zero by a factor of ten: at most 20 steps.
    for (std::int32_t e = number.exponent; e < 0 && magnitude != 0U; ++e) {
        if (magnitude % 10U != 0U) {
            return Status::kBadParameter;
        }
        magnitude /= 10U;
    }
    for (std::int32_t e = number.exponent; e > 0 && magnitude != 0U; --e) {
        if (magnitude > kMax / 10U) {
            return Status::kBadParameter;
        }
        magnitude *= 10U;
    }
    return Whole{magnitude, number.is_negative && magnitude != 0U};
}

}  // namespace mamori

#endif  // MAMORI_KERNEL_DECIMAL_HPP
