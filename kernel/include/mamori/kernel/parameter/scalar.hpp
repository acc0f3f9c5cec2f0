// SPDX-License-Identifier: Apache-2.0
/// @file
/// One number, bool or enumerator without its type, for tables and tools that hold values of many types; and
/// the ways from text and from such a number to a typed value, which never round or wrap unseen.
///
/// @satisfies SWR-PAR-002      Design: docs/design/parameters.md#numbers
#ifndef MAMORI_KERNEL_SCALAR_HPP
#define MAMORI_KERNEL_SCALAR_HPP

#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>
#include <utility>

#include "mamori/kernel/base/status.hpp"
#include "mamori/kernel/base/text_cursor.hpp"
#include "mamori/kernel/parameter/decimal_rounding.hpp"

namespace mamori {

/// A value without its type: a real number, or a whole one (bool is 0 or 1, an enumerator its number).
struct Scalar {
    double real{0.0};  ///< when is_real
    Whole whole{};     ///< else
    bool is_real{false};
};

namespace detail {

/// Number type behind an enum; any other type is its own.
template <typename S, bool kIsEnum = std::is_enum_v<S>>
struct NumberOf {
    using Type = S;
};
template <typename S>
struct NumberOf<S, true> {
    using Type = std::underlying_type_t<S>;
};
template <typename S>
using Number = typename NumberOf<S>::Type;

/// Has the enum a `get_name(E)` that gives its enumerators' names, as Status and LifecycleState have?
template <typename S, typename = void>
struct HasNames : std::false_type {};
template <typename S>
struct HasNames<S, std::void_t<decltype(get_name(std::declval<S>()))>>
    : std::is_convertible<decltype(get_name(std::declval<S>())), const char*> {};

/// Enumerators 0 .. 63 can be written by name; 64 must not be one.
inline constexpr std::uint32_t kNamedEnumerators = 64U;

}  // namespace detail

/// True for the types that a scalar parameter can have.
template <typename S>
constexpr bool is_scalar() noexcept {
    using N = detail::Number<S>;
    return std::is_integral_v<N> || std::is_same_v<N, float> || std::is_same_v<N, double>;
}

/// `value` without its type, exactly.
template <typename S>
constexpr Scalar to_scalar(S value) noexcept {
    static_assert(is_scalar<S>());
    using N = detail::Number<S>;
    const auto number = static_cast<N>(value);
    Scalar scalar{};
    if constexpr (std::is_floating_point_v<N>) {
        scalar.real = static_cast<double>(number);
        scalar.is_real = true;
    } else if constexpr (std::is_signed_v<N>) {
        scalar.whole.is_negative = number < 0;
        const auto bits = static_cast<std::uint64_t>(static_cast<std::int64_t>(number));
        scalar.whole.magnitude = number < 0 ? 0U - bits : bits;
    } else {
        scalar.whole.magnitude = static_cast<std::uint64_t>(number);
    }
    return scalar;
}

/// The whole number as an S (integer, bool or enum). @return kBadParameter when S has no such value.
template <typename S>
constexpr Result<S> from_whole(const Whole& whole) noexcept {
    using N = detail::Number<S>;
    using Limits = std::numeric_limits<N>;
    const auto max = static_cast<std::uint64_t>(Limits::max());
    if constexpr (std::is_signed_v<N>) {
        // The lowest value has a magnitude that is greater by one; it is formed without leaving the type.
        if (whole.is_negative && whole.magnitude != 0U) {
            return whole.magnitude > max + 1U
                       ? Result<S>{Status::kBadParameter}
                       : static_cast<S>(-static_cast<std::int64_t>(whole.magnitude - 1U) - 1);
        }
    }
    const bool is_below = whole.is_negative && whole.magnitude != 0U;
    if (is_below || whole.magnitude > max) {
        return Status::kBadParameter;
    }
    return static_cast<S>(static_cast<N>(whole.magnitude));
}

/// The typed value of `scalar`. A whole number does not become a real one, nor the other way round.
/// @return kBadParameter when S does not have exactly this value.
template <typename S>
constexpr Result<S> from_scalar(const Scalar& scalar) noexcept {
    static_assert(is_scalar<S>());
    if (scalar.is_real != std::is_floating_point_v<S>) {
        return Status::kBadParameter;
    }
    if constexpr (std::is_floating_point_v<S>) {
        constexpr auto kMax = static_cast<double>(std::numeric_limits<S>::max());
        // Written so that a NaN is refused too. A cast beyond the range of S would not be defined.
        if (!(scalar.real >= -kMax && scalar.real <= kMax)) {
            return Status::kBadParameter;
        }
        const auto value = static_cast<S>(scalar.real);
        const bool is_exact =
            !(static_cast<double>(value) < scalar.real) && !(static_cast<double>(value) > scalar.real);
        return is_exact ? Result<S>{value} : Status::kBadParameter;
    } else {
        return from_whole<S>(scalar.whole);
    }
}

/// The decimal number as an S: the nearest real one, or exactly this whole one.
/// @return kBadParameter when S has no such value (overflow, underflow, a fraction, a sign).
template <typename S>
constexpr Result<S> from_decimal(const Decimal& decimal) noexcept {
    static_assert(is_scalar<S>());
    if constexpr (std::is_floating_point_v<S>) {
        return to_real<S>(decimal);
    } else {
        const Result<Whole> whole = to_whole(decimal);
        return whole.has_value() ? from_whole<S>(whole.get_value()) : Result<S>{whole.get_status()};
    }
}

/// The value that is called `name`: `true` and `false` of bool, an enumerator by its get_name(). Of an
/// enumeration with names the enumerators 0 .. 63 are found, and 64 must not be one: what get_name() says of
/// it is taken for what it says of no enumerator. O(64 names).
/// @return kBadParameter (S has no value of this name); kUnsupported (the values of S have no names).
template <typename S>
constexpr Result<S> from_name(Text name) noexcept {
    if constexpr (std::is_same_v<S, bool>) {
        const bool is_true = name == make_text("true");
        return is_true || name == make_text("false") ? Result<S>{is_true} : Status::kBadParameter;
    } else if constexpr (std::is_enum_v<S> && detail::HasNames<S>::value) {
        // What get_name() answers for a value that is no enumerator is not a name.
        if (make_text(get_name(static_cast<S>(detail::kNamedEnumerators))) == name) {
            return Status::kBadParameter;
        }
        for (std::uint32_t i = 0U; i < detail::kNamedEnumerators; ++i) {
            const auto candidate = static_cast<S>(i);
            if (make_text(get_name(candidate)) == name) {
                return candidate;
            }
        }
        return Status::kBadParameter;
    } else {
        static_cast<void>(name);
        return Status::kUnsupported;
    }
}

/// Takes a number, or a name where S has names.
/// @return the value; kBadParameter (nothing of S stands here); kUnsupported (too many digits). `cursor` then
///         stands somewhere in the offending word.
template <typename S>
constexpr Result<S> take_value(TextCursor& cursor) noexcept {
    TextCursor ahead = cursor;
    const Text word = ahead.take_word();
    const Result<S> named = word.empty() ? Result<S>{Status::kUnsupported} : from_name<S>(word);
    if (named.has_value()) {
        cursor = ahead;
        return named;
    }
    const Result<Decimal> decimal = take_decimal(cursor);
    return decimal.has_value() ? from_decimal<S>(decimal.get_value()) : Result<S>{decimal.get_status()};
}

}  // namespace mamori

#endif  // MAMORI_KERNEL_SCALAR_HPP
