// SPDX-License-Identifier: Apache-2.0
/// @file
/// Names of a table as types, letter by letter, so that a compiler message shows them. Not for users.
///
/// @satisfies SWR-KRN-018      Design: docs/design/kernel.md#system-table
#ifndef MAMORI_KERNEL_SPELLED_NAME_HPP
#define MAMORI_KERNEL_SPELLED_NAME_HPP

#include <cstddef>
#include <utility>

namespace mamori {

/// A name, letter by letter, since C++17 has no strings as template arguments.
template <char... kLetters>
struct Name {};

namespace detail {

/// A name that is missing is spelled as an empty one.
constexpr std::size_t calc_length(const char* text) noexcept {
    std::size_t length = 0U;
    while (text != nullptr && text[length] != '\0') {  // ends at the terminator of the string
        ++length;
    }
    return length;
}

// Locations of names in a table.
struct OfWindow {
    template <typename Table>
    static constexpr const char* get(const Table& table, std::size_t i) noexcept {
        return table.windows[i].name;
    }
};
struct OfMode {
    template <typename Table>
    static constexpr const char* get(const Table& table, std::size_t i) noexcept {
        return table.modes.modes[i].name;
    }
};
struct OfSetOfMode {
    template <typename Table>
    static constexpr const char* get(const Table& table, std::size_t i) noexcept {
        return table.modes.modes[i].set_name;
    }
};
struct OfSource {
    template <typename Table>
    static constexpr const char* get(const Table& table, std::size_t i) noexcept {
        return table.modes.transitions[i].source_name;
    }
};
struct OfTarget {
    template <typename Table>
    static constexpr const char* get(const Table& table, std::size_t i) noexcept {
        return table.modes.transitions[i].target_name;
    }
};
struct OfConnectionMode {
    template <typename Table>
    static constexpr const char* get(const Table& table, std::size_t i) noexcept {
        return table.modes.connection_modes[i].mode_name;
    }
};

template <const auto& kTable, typename Of, std::size_t kIndex, std::size_t... kLetters>
Name<Of::get(kTable, kIndex)[kLetters]...> spell(std::index_sequence<kLetters...>) noexcept;
template <const auto& kTable, typename Of, std::size_t kIndex>
using NameOf =
    decltype(spell<kTable, Of, kIndex>(std::make_index_sequence<calc_length(Of::get(kTable, kIndex))>{}));
template <const auto& kTable, std::size_t kWindow>
using WindowName = NameOf<kTable, OfWindow, kWindow>;
template <const auto& kTable, std::size_t kMode>
using ModeName = NameOf<kTable, OfMode, kMode>;

}  // namespace detail

}  // namespace mamori

#endif  // MAMORI_KERNEL_SPELLED_NAME_HPP
