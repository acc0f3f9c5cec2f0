// SPDX-License-Identifier: Apache-2.0
/// @file
/// The word rate(...) of a window: how often its components run, and how much slower they may be told to.
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

/// Made by rate(); the first is the declared one.
template <std::size_t kCount>
struct Rates {
    std::array<Rate, kCount> values;
};
/// Declares the rate of the window, which must be that of its openings, and up to four slower ones between
/// which ExecutionContext::set_rate() may choose; each must divide the first without rest.
/// @param[in] first  > 0. @param[in] slower 2e-10 .. 1e9 Hz; rounded to periods of whole nanoseconds.
template <typename... Alternatives>
constexpr Rates<1U + sizeof...(Alternatives)> rate(Rate first, Alternatives... slower) noexcept {
    static_assert(sizeof...(Alternatives) <= kAlternativeRateMax,
                  "a window declares at most four slower rates");
    return {{{first, slower...}}};
}

namespace detail {

/// Period whose rate is `value`, to the nearest nanosecond; 0 for a rate that is no positive number.
constexpr Duration to_period(Rate value) noexcept {
    // NOLINTNEXTLINE(bugprone-incorrect-roundings): the quotient is 1 or more, and <cmath> is not listed
    return value.hz > 0.0 && value.hz <= 1.0e9 ? Duration{static_cast<std::int64_t>(1.0e9 / value.hz + 0.5)}
                                               : Duration{0};
}

template <std::size_t kCount>
constexpr void apply(WindowRow& row, const Rates<kCount>& option) noexcept {
    row.has_rate = true;
    row.rate_hz = option.values[0].hz;
    row.alternative_count = kCount - 1U;
    for (std::size_t i = 1U; i < kCount; ++i) {
        row.alternative_periods[i - 1U] = to_period(option.values[i]);
    }
}

}  // namespace detail

}  // namespace mamori

#endif  // MAMORI_KERNEL_WINDOW_RATE_HPP
