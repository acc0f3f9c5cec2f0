// SPDX-License-Identifier: Apache-2.0
/// @file
/// Time-stamped basic types of RT-middleware, with bounds. Names, field order and wire form are those of
/// OpenRTM, so a port of such a type can exchange data with existing OpenRTM components and tools.
///
/// @satisfies SWR-CDR-005, SWR-CDR-006      Design: docs/design/data_flow.md#timed-types
/// Source:   OpenRTM-aist, BasicDataType.idl (module RTC); wide characters are left out on purpose
#ifndef MAMORI_KERNEL_TIMED_TYPES_HPP
#define MAMORI_KERNEL_TIMED_TYPES_HPP

#include <cstddef>
#include <cstdint>
#include <limits>

#include "mamori/kernel/base/status.hpp"
#include "mamori/kernel/base/time.hpp"
#include "mamori/kernel/payload/fields.hpp"

namespace mamori::rtc {

/// Time stamp. Sender and receiver agree on the zero point.
struct Time {
    std::uint32_t sec{0U};   ///< [s]
    std::uint32_t nsec{0U};  ///< [ns], 0 .. 999999999 by convention; no decoder checks the range
};

inline constexpr std::int64_t kNsPerS = 1'000'000'000;  ///< [ns/s]

/// @return the time stamp; kBadParameter when the instant is negative, or 2^32 s (136 years) or more.
constexpr Result<Time> calc_time(Instant instant) noexcept {
    if (instant.ns < 0 || instant.ns / kNsPerS > std::int64_t{std::numeric_limits<std::uint32_t>::max()}) {
        return Status::kBadParameter;
    }
    return Time{static_cast<std::uint32_t>(instant.ns / kNsPerS),
                static_cast<std::uint32_t>(instant.ns % kNsPerS)};
}
/// @return the instant, 0 s .. 2^32 s (exclusive); kBadParameter when nsec is 10^9 or more, which is
///         ambiguous.
constexpr Result<Instant> calc_instant(Time time) noexcept {
    if (time.nsec >= kNsPerS) {
        return Status::kBadParameter;
    }
    return Instant{std::int64_t{time.sec} * kNsPerS + std::int64_t{time.nsec}};
}

/// A value and its time stamp. Each IDL type `TimedX` is Timed<X>. The application defines the unit of the
/// value.
template <typename T>
struct Timed {
    Time tm{};
    T data{};
};

using TimedShort = Timed<std::int16_t>;
using TimedUShort = Timed<std::uint16_t>;
using TimedLong = Timed<std::int32_t>;
using TimedULong = Timed<std::uint32_t>;
using TimedFloat = Timed<float>;
using TimedDouble = Timed<double>;
using TimedChar = Timed<char>;
using TimedOctet = Timed<std::uint8_t>;
using TimedBoolean = Timed<bool>;
/// Same wire form as TimedShort, but a different type: ports of the two types cannot be connected.
struct TimedState {
    Time tm{};
    std::int16_t data{0};
};
template <std::size_t N>
using TimedString = Timed<BoundedString<N>>;

/// Up to N values of T and their time stamp.
template <typename T, std::size_t N>
using TimedSeq = Timed<BoundedSequence<T, N>>;
template <std::size_t N>
using TimedShortSeq = TimedSeq<std::int16_t, N>;
template <std::size_t N>
using TimedUShortSeq = TimedSeq<std::uint16_t, N>;
template <std::size_t N>
using TimedLongSeq = TimedSeq<std::int32_t, N>;
template <std::size_t N>
using TimedULongSeq = TimedSeq<std::uint32_t, N>;
template <std::size_t N>
using TimedFloatSeq = TimedSeq<float, N>;
template <std::size_t N>
using TimedDoubleSeq = TimedSeq<double, N>;
template <std::size_t N>
using TimedCharSeq = TimedSeq<char, N>;
template <std::size_t N>
using TimedOctetSeq = TimedSeq<std::uint8_t, N>;
template <std::size_t N>
using TimedBooleanSeq = TimedSeq<bool, N>;
/// Up to N strings of up to M characters each.
template <std::size_t N, std::size_t M>
using TimedStringSeq = TimedSeq<BoundedString<M>, N>;

}  // namespace mamori::rtc

MAMORI_FIELDS(mamori::rtc::Time, sec, nsec)
MAMORI_FIELDS(mamori::rtc::TimedState, tm, data)

/// Field list of every Timed<T>.
template <typename T>
struct mamori::Fields<mamori::rtc::Timed<T>> {
    static constexpr bool kDeclared = is_payload<T>();
    template <typename Self, typename Call>
    static constexpr decltype(auto) apply(Self& self, Call&& call) noexcept {
        return call(self.tm, self.data);
    }
};

#endif  // MAMORI_KERNEL_TIMED_TYPES_HPP
