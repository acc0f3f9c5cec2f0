// SPDX-License-Identifier: Apache-2.0
/// @file
/// Counts how often an option is specified for one part of a description: a second one would silently replace
/// the first. Not for users.
///
/// @satisfies SWR-KRN-018      Design: docs/design/kernel.md#system-table
#ifndef MAMORI_KERNEL_OPTION_WORDS_HPP
#define MAMORI_KERNEL_OPTION_WORDS_HPP

#include <cstddef>
#include <type_traits>

namespace mamori::detail {

/// Identifies an option independent of its number of values.
template <typename Option>
struct WordOf {
    using Type = Option;
};
template <template <std::size_t> class Option, std::size_t kCount>
struct WordOf<Option<kCount>> {
    using Type = Option<0U>;
};

/// Number of `Options` that are the same option as `Option`.
template <typename Option, typename... Options>
inline constexpr std::size_t kTimesSaid =
    (std::size_t{std::is_same_v<typename WordOf<Option>::Type, typename WordOf<Options>::Type>} + ... + 0U);

template <typename... Options>
inline constexpr bool kIsEachSaidOnce = ((kTimesSaid<Options, Options...> == 1U) && ...);

}  // namespace mamori::detail

#endif  // MAMORI_KERNEL_OPTION_WORDS_HPP
