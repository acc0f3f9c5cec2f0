// SPDX-License-Identifier: Apache-2.0
/// @file
/// Writes the parts of a description to the rows of a table, for system(). Not for users.
///
/// @satisfies SWR-KRN-017, SWR-KRN-080      Design: docs/design/kernel.md#system-table
#ifndef MAMORI_KERNEL_SYSTEM_BUILDER_HPP
#define MAMORI_KERNEL_SYSTEM_BUILDER_HPP

#include <cstddef>

#include "mamori/kernel/component/component.hpp"
#include "mamori/kernel/component/context_plan.hpp"
#include "mamori/kernel/parameter/configuration_set.hpp"
#include "mamori/kernel/table/mode_table.hpp"
#include "mamori/kernel/table/modelled_time_row.hpp"
#include "mamori/kernel/table/system_table.hpp"

namespace mamori::detail {

/// Appends rows in the order in which parts are added.
template <typename Table>
struct TableBuilder {
    using Types = typename Table::Types;

    Table table{};
    ConfigurationBuilder<Types::Parameters::kSize, Types::kSets, Types::kAssignments, Types::kValues>
        configuration{};
    std::size_t parameter_count{0U};
    std::size_t mode_count{0U};
    std::size_t member_count{0U};
    std::size_t transition_count{0U};
    std::size_t connection_mode_count{0U};
    std::size_t window_count{0U};
    std::size_t component_count{0U};
    std::size_t port_count{0U};
    std::size_t connection_count{0U};
    std::size_t fault_count{0U};
    std::size_t reaction_count{0U};
    std::size_t modelled_time_count{0U};

    template <typename Part>
    constexpr void add_window(const Part& part) noexcept {
        WindowRow& row = table.windows[window_count];
        row = part.row;
        row.period = part.opens_once_per_frame ? table.frame : part.row.period;
        row.first_component = component_count;
        row.component_count = part.list.components.size();
        row.first_port = port_count;
        row.port_count = part.list.ports.size();
        row.first_parameter = parameter_count;
        row.parameter_count = part.list.parameters.declarations.size();
        parameter_count += row.parameter_count;
        configuration.add(part.list.parameters);
        row.has_outputs = false;
        std::size_t next_port = 0U;
        for (std::size_t i = 0U; i < row.component_count; ++i) {
            ComponentRow& component = table.component_rows[component_count];
            component.window = window_count;
            component.worst_case = part.list.worst_cases[i];
            component.first_port = port_count;
            component.port_count = part.list.port_counts[i];
            table.components[component_count] = part.list.components[i];
            for (std::size_t p = 0U; p < component.port_count; ++p) {
                table.ports[port_count] = part.list.ports[next_port++];
                table.ports[port_count].window = window_count;
                table.ports[port_count].component = component_count;
                row.has_outputs = row.has_outputs || table.ports[port_count].output != nullptr;
                if constexpr (!Types::kHasTraceHash) {
                    table.ports[port_count].hash_published = nullptr;
                }
                ++port_count;
            }
            ++component_count;
        }
        ++window_count;
    }
    template <typename Part>
    constexpr void add_connection(const Part& part) noexcept {
        for (const char* name : part.modes) {
            table.modes.connection_modes[connection_mode_count++] = {name, connection_count, kNoIndex};
        }
        table.connections[connection_count++] = part.row;
    }
    template <typename Part>
    constexpr void add_mode(const Part& part) noexcept {
        for (Component* member : part.members) {
            table.modes.members[member_count++] = {member, mode_count, kNoIndex};
        }
        table.modes.modes[mode_count++] = part.row;
    }
    constexpr void add(const ModeTransitionRow& row) noexcept {
        table.modes.transitions[transition_count++] = row;
    }
    constexpr void add(const FaultRow& row) noexcept { table.faults[fault_count++] = row; }
    constexpr void add(const ReactionRow& row) noexcept { table.reactions[reaction_count++] = row; }
    constexpr void add(const ModelledTimeRow& row) noexcept {
        table.modelled_times[modelled_time_count++] = row;
    }
    constexpr void add(AbortPolicy policy) noexcept { table.abort_policy = policy; }
};

/// Gives the background windows of each core an executive of their own. Call after the last window.
template <typename Table>
constexpr void resolve_background(Table& table) noexcept {
    std::size_t next = 0U;
    for (const WindowRow& row : table.windows) {
        next = row.core < next ? next : row.core + 1U;
    }
    for (std::size_t i = 0U; i < table.windows.size(); ++i) {
        WindowRow& row = table.windows[i];
        if (!is_background(row)) {
            continue;
        }
        row.background_of = row.core;
        row.execution_budget = row.budget;
        row.budget = row.length;
        row.core = next;
        for (std::size_t j = 0U; j < i; ++j) {
            if (table.windows[j].background_of == row.background_of) {
                row.core = table.windows[j].core;
                break;
            }
        }
        next = row.core == next ? next + 1U : next;
    }
}

}  // namespace mamori::detail

#endif  // MAMORI_KERNEL_SYSTEM_BUILDER_HPP
