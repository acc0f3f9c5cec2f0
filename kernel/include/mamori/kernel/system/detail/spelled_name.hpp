// SPDX-License-Identifier: Apache-2.0
/// @file
/// Locations of the names of a table, which compiler messages show. Not for users.
///
/// @satisfies SWR-KRN-018      Design: docs/design/kernel.md#system-table
#ifndef MAMORI_KERNEL_SPELLED_NAME_HPP
#define MAMORI_KERNEL_SPELLED_NAME_HPP

#include <cstddef>

#include "mamori/kernel/base/compiler_message.hpp"

namespace mamori::detail {

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
struct OfSet {
    template <typename Table>
    static constexpr const char* get(const Table& table, std::size_t i) noexcept {
        return table.configuration.sets[i].name;
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

template <const auto& kTable, std::size_t kWindow>
using WindowName = NameOf<kTable, OfWindow, kWindow>;
template <const auto& kTable, std::size_t kMode>
using ModeName = NameOf<kTable, OfMode, kMode>;

}  // namespace mamori::detail

#endif  // MAMORI_KERNEL_SPELLED_NAME_HPP
