// SPDX-License-Identifier: Apache-2.0
/// @file
/// Parts of compiler messages: a message shows a template of namespace rules with the faulty element as its
/// arguments. A name is spelled letter by letter. Not for users.
///
/// @satisfies SWR-KRN-018, SWR-KRN-060, SWR-KRN-062      Design: docs/design/kernel.md#system-table
#ifndef MAMORI_KERNEL_COMPILER_MESSAGE_HPP
#define MAMORI_KERNEL_COMPILER_MESSAGE_HPP

#include <cstddef>
#include <utility>

namespace mamori {

/// A name, letter by letter, since C++17 has no strings as template arguments.
template <char... kLetters>
struct Name {};

namespace rules {

/// Always false, but evaluated only at instantiation.
template <typename>
inline constexpr bool kKept = false;
/// A row that is identified by its number only.
template <std::size_t kIndex>
struct Row {};

/// Instantiated for a pointer in `Ports<...>` or `Parameters<...>` of component type C that is wrong.
template <typename C, auto kMember>
struct ListNamesMembersOfItsComponent {
    static_assert(kKept<ListNamesMembersOfItsComponent>,
                  "Ports<...> names members that are ports, and Parameters<...> names members that are "
                  "parameters, of the component that has the list");
};

}  // namespace rules

namespace detail {

/// A name that is missing is spelled as an empty one.
constexpr std::size_t calc_length(const char* text) noexcept {
    std::size_t length = 0U;
    while (text != nullptr && text[length] != '\0') {  // ends at the terminator of the string
        ++length;
    }
    return length;
}

template <const auto& kTable, typename Of, std::size_t kIndex, std::size_t... kLetters>
Name<Of::get(kTable, kIndex)[kLetters]...> spell(std::index_sequence<kLetters...>) noexcept;
/// Name at `Of::get(kTable, kIndex)`.
template <const auto& kTable, typename Of, std::size_t kIndex>
using NameOf =
    decltype(spell<kTable, Of, kIndex>(std::make_index_sequence<calc_length(Of::get(kTable, kIndex))>{}));

}  // namespace detail

}  // namespace mamori

#endif  // MAMORI_KERNEL_COMPILER_MESSAGE_HPP
