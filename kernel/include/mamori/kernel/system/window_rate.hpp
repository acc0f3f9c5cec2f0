// SPDX-License-Identifier: Apache-2.0
/// @file
/// Option rate(...) of a window: the rate of its components, and slower rates that may be set at run time.
///
/// @satisfies SWR-KRN-017      Design: docs/design/kernel.md#system-table
#ifndef MAMORI_KERNEL_WINDOW_RATE_HPP
#define MAMORI_KERNEL_WINDOW_RATE_HPP

#include <array>
#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/time.hpp"
#include "mamori/kernel/table/window_row.hpp"

namespace mamori {

/// Cycles per second [Hz].
struct Rate {
    double hz;
};
inline namespace literals {
constexpr Rate operator""_hz(unsigned long long value) noexcept {
    return {static_cast<double>(value)};
}
constexpr Rate operator""_hz(long double value) noexcept {
    return {static_cast<double>(value)};
}
}  // namespace literals

/// Made by rate(); the first is the declared rate.
template <std::size_t kCount>
struct Rates {
    std::array<Rate, kCount> values;
};
/// Declares the rate of the window, which must equal the rate of its window starts, and up to four slower
/// rates for ExecutionContext::set_rate(). Each slower rate must divide the first without remainder.
/// @param[in] first > 0 Hz. @param[in] slower 2e-10 .. 1e9 Hz; rounded to periods of whole nanoseconds.
template <typename... Alternatives>
constexpr Rates<1U + sizeof...(Alternatives)> rate(Rate first, Alternatives... slower) noexcept {
    static_assert(sizeof...(Alternatives) <= kAlternativeRateMax,
                  "a window declares at most four slower rates");
    return {{{first, slower...}}};
}

namespace detail {

/// Period of rate `value`, rounded to the nearest nanosecond; 0 if the rate is not in (0, 1e9] Hz.
constexpr Duration to_period(Rate value) noexcept {
    // NOLINTNEXTLINE(bugprone-incorrect-roundings): the quotient is 1 or more, and <cmath> is not listed
    return value.hz > 0.0 && value.hz <= 1.0e9 ? Duration{static_cast<std::int64_t>(1.0e9 / value.hz + 0.5)}
                                               : Duration{0};
}

template <std::size_t kCount>
constexpr void apply(WindowRow& row, const Rates<kCount>& option) noexcept {
    row.has_rate = true;
    row.rate_hz = option.values[0].hz;
    row.alternative_count = static_cast<std::uint8_t>(kCount - 1U);
    for (std::size_t i = 1U; i < kCount; ++i) {
        row.alternative_periods[i - 1U] = to_period(option.values[i]);
    }
}

}  // namespace detail

}  // namespace mamori

#endif  // MAMORI_KERNEL_WINDOW_RATE_HPP
