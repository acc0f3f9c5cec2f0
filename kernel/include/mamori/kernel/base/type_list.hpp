// SPDX-License-Identifier: Apache-2.0
/// @file
/// A list of types for compile-time computation (fields of a payload, components of a table): concatenation
/// and selection of one type. Not for users.
///
/// @satisfies SWR-KRN-017      Design: docs/design/kernel.md#system-table
#ifndef MAMORI_KERNEL_TYPE_LIST_HPP
#define MAMORI_KERNEL_TYPE_LIST_HPP

#include <cstddef>
#include <type_traits>
#include <utility>

namespace mamori::detail {

template <typename... Ts>
struct TypeList {
    static constexpr std::size_t kSize = sizeof...(Ts);
};

/// `Concat<Lists...>::Type`: the types of all lists in order.
template <typename... Lists>
struct Concat;
template <>
struct Concat<> {
    using Type = TypeList<>;
};
template <typename... Ts>
struct Concat<TypeList<Ts...>> {
    using Type = TypeList<Ts...>;
};
template <typename... Ts, typename... Us, typename... Rest>
struct Concat<TypeList<Ts...>, TypeList<Us...>, Rest...> {
    using Type = typename Concat<TypeList<Ts..., Us...>, Rest...>::Type;
};

/// True when all types of a list are equal.
template <typename List>
inline constexpr bool kIsOfOneType = true;
template <typename First, typename... Rest>
inline constexpr bool kIsOfOneType<TypeList<First, Rest...>> = (std::is_same_v<First, Rest> && ...);

/// Joins eight lists per step, so that a window of 1000 components stays within the template depth limit.
template <typename... As, typename... Bs, typename... Cs, typename... Ds, typename... Es, typename... Fs,
          typename... Gs, typename... Hs, typename... Rest>
struct Concat<TypeList<As...>, TypeList<Bs...>, TypeList<Cs...>, TypeList<Ds...>, TypeList<Es...>,
              TypeList<Fs...>, TypeList<Gs...>, TypeList<Hs...>, Rest...> {
    using Type =
        typename Concat<TypeList<As..., Bs..., Cs..., Ds..., Es..., Fs..., Gs..., Hs...>, Rest...>::Type;
};

template <std::size_t kIndex, typename T>
struct Indexed {
    using Type = T;
};
template <typename Sequence, typename List>
struct IndexedList;
template <std::size_t... kIndices, typename... Ts>
struct IndexedList<std::index_sequence<kIndices...>, TypeList<Ts...>> : Indexed<kIndices, Ts>... {};

template <std::size_t kIndex, typename T>
Indexed<kIndex, T> pick(const Indexed<kIndex, T>*) noexcept;
/// Type at position `kIndex` of a list, 0 .. kSize - 1.
template <typename List, std::size_t kIndex>
using At = typename decltype(pick<kIndex>(
    static_cast<const IndexedList<std::make_index_sequence<List::kSize>, List>*>(nullptr)))::Type;

/// Number of types before position `kIndex` of a list that equal the one there.
template <typename List, std::size_t kIndex, std::size_t... kBefore>
constexpr std::size_t count_same_before(std::index_sequence<kBefore...>) noexcept {
    return ((std::is_same_v<At<List, kBefore>, At<List, kIndex>> ? 1U : 0U) + ... + 0U);
}

}  // namespace mamori::detail

#endif  // MAMORI_KERNEL_TYPE_LIST_HPP
