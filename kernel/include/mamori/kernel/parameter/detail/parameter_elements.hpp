// SPDX-License-Identifier: Apache-2.0
/// @file
/// Uniform element access for scalar parameters and arrays. Not for users.
///
/// @satisfies SWR-PAR-003      Design: docs/design/parameters.md#parameters
#ifndef MAMORI_KERNEL_PARAMETER_ELEMENTS_HPP
#define MAMORI_KERNEL_PARAMETER_ELEMENTS_HPP

#include <array>
#include <cstddef>

namespace mamori::detail {

/// Uniform element access for a scalar and for an array.
template <typename T>
struct Elements {
    using Element = T;
    static constexpr std::size_t kCount = 1U;
    static constexpr T get(const T& value, std::size_t) noexcept { return value; }
    static constexpr void set(T& value, std::size_t, T element) noexcept { value = element; }
};
template <typename S, std::size_t N>
struct Elements<std::array<S, N>> {
    using Element = S;
    static constexpr std::size_t kCount = N;
    static constexpr const S& get(const std::array<S, N>& value, std::size_t i) noexcept { return value[i]; }
    static constexpr void set(std::array<S, N>& value, std::size_t i, S element) noexcept {
        value[i] = element;
    }
};

}  // namespace mamori::detail

#endif  // MAMORI_KERNEL_PARAMETER_ELEMENTS_HPP
