// SPDX-License-Identifier: Apache-2.0
/// @file
/// Fills the derived fields of the mode rows: converts names to indices and determines the modes of each
/// component and connection. Not for users.
///
/// @satisfies SWR-MOD-001, SWR-KRN-098      Design: docs/design/modes.md#the-table
#ifndef MAMORI_KERNEL_MODE_BUILDER_HPP
#define MAMORI_KERNEL_MODE_BUILDER_HPP

#include <cstddef>

#include "mamori/kernel/table/index_of.hpp"
#include "mamori/kernel/table/mode_table.hpp"

namespace mamori::detail {

template <typename Table>
constexpr void resolve_names(Table& table) noexcept {
    for (SystemModeRow& mode : table.modes.modes) {
        mode.set = find_named(table.configuration.sets, mode.set_name);
    }
    for (ModeTransitionRow& transition : table.modes.transitions) {
        transition.source = find_named(table.modes.modes, transition.source_name);
        transition.target = find_named(table.modes.modes, transition.target_name);
    }
    for (ConnectionModeRow& row : table.modes.connection_modes) {
        row.mode = find_named(table.modes.modes, row.mode_name);
    }
}

template <typename Table>
constexpr void resolve_members(Table& table) noexcept {
    for (auto& component : table.component_rows) {
        component.modes = table.windows[component.window].is_system ? kEveryMode : 0U;
    }
    for (ModeMemberRow& member : table.modes.members) {
        for (std::size_t i = 0U; i < table.components.size(); ++i) {
            if (table.components[i] == member.component) {
                member.index = i;
                table.component_rows[i].modes |= to_mask(member.mode);
            }
        }
    }
}

/// A connection is active in the stated modes in which both of its components run.
template <typename Table>
constexpr void resolve_held_connections(Table& table) noexcept {
    for (std::size_t i = 0U; i < table.connections.size(); ++i) {
        auto& connection = table.connections[i];
        ModeMask only_in = 0U;
        for (const ConnectionModeRow& row : table.modes.connection_modes) {
            if (row.connection == i && row.mode != kNoIndex) {
                only_in |= to_mask(row.mode);
            }
        }
        ModeMask modes = only_in == 0U ? kEveryMode : only_in;
        if (connection.source_component != kNoIndex && connection.sink_component != kNoIndex) {
            modes &= table.component_rows[connection.source_component].modes &
                     table.component_rows[connection.sink_component].modes;
        }
        connection.idle_modes = ~modes;
    }
}

/// Precondition: the connections of the table are resolved. In a table without modes, all connections
/// are active in every mode.
template <typename Table>
constexpr void resolve_modes(Table& table) noexcept {
    resolve_names(table);
    if (!table.modes.modes.empty()) {
        resolve_members(table);
        resolve_held_connections(table);
    }
}

}  // namespace mamori::detail

#endif  // MAMORI_KERNEL_MODE_BUILDER_HPP
