// SPDX-License-Identifier: Apache-2.0
/// @file
/// One number, bool or enumerator without its type, for tables and tools that hold values of many types. Its
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

/// An integer as sign and magnitude, so that both 64-bit types fit.
struct Whole {
    std::uint64_t magnitude{0U};
    bool is_negative{false};
};

/// A value without its type: a real number or an integer (bool is 0 or 1, an enumerator its number).
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

}  // namespace mamori

#endif  // MAMORI_KERNEL_SCALAR_HPP
