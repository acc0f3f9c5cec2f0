// SPDX-License-Identifier: Apache-2.0
/// @file
/// Durations and instants: signed 64-bit nanoseconds in types that cannot be mixed.
/// No function here reads a clock. Callers pass the time; only ports read a real clock.
///
/// @satisfies SWR-KRN-004      Design: docs/design/kernel.md#time
#ifndef MAMORI_KERNEL_TIME_HPP
#define MAMORI_KERNEL_TIME_HPP

#include <cstdint>

namespace mamori {

/// Signed duration [ns]. Range: +-292 years; sums, differences and multiples do not check for overflow.
struct Duration {
    std::int64_t ns{0};

    friend constexpr Duration operator+(Duration a, Duration b) noexcept { return {a.ns + b.ns}; }
    friend constexpr Duration operator-(Duration a, Duration b) noexcept { return {a.ns - b.ns}; }
    friend constexpr Duration operator*(Duration a, std::int64_t factor) noexcept { return {a.ns * factor}; }
    friend constexpr bool operator==(Duration a, Duration b) noexcept { return a.ns == b.ns; }
    friend constexpr bool operator!=(Duration a, Duration b) noexcept { return a.ns != b.ns; }
    friend constexpr bool operator<(Duration a, Duration b) noexcept { return a.ns < b.ns; }
    friend constexpr bool operator<=(Duration a, Duration b) noexcept { return a.ns <= b.ns; }
    friend constexpr bool operator>(Duration a, Duration b) noexcept { return a.ns > b.ns; }
    friend constexpr bool operator>=(Duration a, Duration b) noexcept { return a.ns >= b.ns; }
};

/// Point on the monotonic time line of the port [ns]; 0 is the start of the port. Range and overflow as for
/// Duration.
struct Instant {
    std::int64_t ns{0};

    friend constexpr Instant operator+(Instant a, Duration b) noexcept { return {a.ns + b.ns}; }
    friend constexpr Instant operator-(Instant a, Duration b) noexcept { return {a.ns - b.ns}; }
    friend constexpr Duration operator-(Instant a, Instant b) noexcept { return {a.ns - b.ns}; }
    friend constexpr bool operator==(Instant a, Instant b) noexcept { return a.ns == b.ns; }
    friend constexpr bool operator!=(Instant a, Instant b) noexcept { return a.ns != b.ns; }
    friend constexpr bool operator<(Instant a, Instant b) noexcept { return a.ns < b.ns; }
    friend constexpr bool operator<=(Instant a, Instant b) noexcept { return a.ns <= b.ns; }
    friend constexpr bool operator>(Instant a, Instant b) noexcept { return a.ns > b.ns; }
    friend constexpr bool operator>=(Instant a, Instant b) noexcept { return a.ns >= b.ns; }
};

/// Duration [s] as a real number, for physics and reports; relative error below 2^-51.
constexpr double to_seconds(Duration duration) noexcept {
    return static_cast<double>(duration.ns) * 1.0e-9;
}

/// Duration literals such as 200_us. They do not check for values above 2^63 - 1 ns (292 years).
inline namespace literals {
constexpr Duration operator""_ns(unsigned long long value) noexcept {
    return {static_cast<std::int64_t>(value)};
}
constexpr Duration operator""_us(unsigned long long value) noexcept {
    return {static_cast<std::int64_t>(value) * 1000};
}
constexpr Duration operator""_ms(unsigned long long value) noexcept {
    return {static_cast<std::int64_t>(value) * 1000000};
}
constexpr Duration operator""_s(unsigned long long value) noexcept {
    return {static_cast<std::int64_t>(value) * 1000000000};
}
}  // namespace literals

}  // namespace mamori

#endif  // MAMORI_KERNEL_TIME_HPP
