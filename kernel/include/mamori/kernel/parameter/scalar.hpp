// SPDX-License-Identifier: Apache-2.0
/// @file
/// An untyped number, bool or enumerator, for tables and tools that handle values of many types. The
/// conversion to a typed value is exact.
///
/// @satisfies SWR-PAR-002      Design: docs/design/parameters.md#values
#ifndef MAMORI_KERNEL_SCALAR_HPP
#define MAMORI_KERNEL_SCALAR_HPP

#include <cstdint>
#include <limits>
#include <type_traits>

#include "mamori/kernel/base/status.hpp"

namespace mamori {

/// An integer as sign and magnitude, so that it can represent both 64-bit types.
struct Whole {
    std::uint64_t magnitude{0U};
    bool is_negative{false};
};

/// An untyped value: a real number or an integer (bool: 0 or 1; enumerator: its number).
struct Scalar {
    double real{0.0};  ///< valid if is_real
    Whole whole{};     ///< valid if not is_real
    bool is_real{false};
};

namespace detail {

/// Underlying type of an enum; for any other type the type itself.
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

}  // namespace detail

/// True for the types that an element of a parameter can have.
template <typename S>
constexpr bool is_scalar() noexcept {
    using N = detail::Number<S>;
    return std::is_integral_v<N> || std::is_same_v<N, float> || std::is_same_v<N, double>;
}

/// Converts `value` to an untyped value, exactly.
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

/// Converts an integer to S (integer, bool or enum). @return kBadParameter if S cannot represent it.
template <typename S>
constexpr Result<S> from_whole(const Whole& whole) noexcept {
    using N = detail::Number<S>;
    using Limits = std::numeric_limits<N>;
    const auto max = static_cast<std::uint64_t>(Limits::max());
    if constexpr (std::is_signed_v<N>) {
        // The magnitude of the lowest value exceeds the maximum by one; the conversion avoids overflow.
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

/// Converts `scalar` to S. An integer is not converted to a real number, nor a real number to an integer.
/// @return the value; kBadParameter (S cannot represent exactly this value).
template <typename S>
constexpr Result<S> from_scalar(const Scalar& scalar) noexcept {
    static_assert(is_scalar<S>());
    if (scalar.is_real != std::is_floating_point_v<S>) {
        return Status::kBadParameter;
    }
    if constexpr (std::is_floating_point_v<S>) {
        constexpr auto kMax = static_cast<double>(std::numeric_limits<S>::max());
        // The negated comparison also rejects NaN. A cast of a value outside the range of S is undefined.
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

}  // namespace mamori

#endif  // MAMORI_KERNEL_SCALAR_HPP
