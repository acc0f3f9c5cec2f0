// SPDX-License-Identifier: Apache-2.0
/// @file
/// Checks the consistency of the rows of a system table: the range of each window and component contains
/// exactly the rows that name it as their owner. Not for users.
///
/// @satisfies SWR-KRN-018, SWR-KRN-025      Design: docs/design/kernel.md#system-table
#ifndef MAMORI_KERNEL_RANGE_CHECK_HPP
#define MAMORI_KERNEL_RANGE_CHECK_HPP

#include <cstddef>

#include "mamori/kernel/table/detail/finding_list.hpp"
#include "mamori/kernel/table/system_table.hpp"
#include "mamori/kernel/table/table_index.hpp"

namespace mamori::detail {

/// Number of rows first .. first + count - 1 for which `is_own` returns true.
template <typename IsOwn>
constexpr std::size_t count_own(std::size_t first, std::size_t count, const IsOwn& is_own) noexcept {
    std::size_t own_count = 0U;
    for (std::size_t i = first; i < first + count; ++i) {
        own_count += is_own(i) ? 1U : 0U;
    }
    return own_count;
}

constexpr bool is_within(std::size_t index, std::size_t first, std::size_t count) noexcept {
    return index >= first && index - first < count;
}

/// Whether the window runs a component with this address.
constexpr bool has_component(const SystemView& view, const WindowRow& row, const Component* owner) noexcept {
    return count_own(row.first_component, row.component_count,
                     [&](std::size_t i) noexcept { return view.components[i] == owner; }) != 0U;
}

constexpr bool has_own_rows_only(const SystemView& view, std::size_t w) noexcept {
    const WindowRow& row = view.windows[w];
    const auto is_component = [&](std::size_t i) noexcept { return view.component_rows[i].window == w; };
    const auto is_port = [&](std::size_t i) noexcept { return view.ports[i].window == w; };
    const auto is_latch = [&](std::size_t place) noexcept {
        return view.connections[view.latch_order[place]].sink_window == w;
    };
    const auto is_parameter = [&](std::size_t i) noexcept {
        return has_component(view, row, view.configuration.parameters[i].owner);
    };
    return count_own(row.first_component, row.component_count, is_component) == row.component_count &&
           count_own(row.first_port, row.port_count, is_port) == row.port_count &&
           count_own(row.first_latch, row.latch_count, is_latch) == row.latch_count &&
           count_own(row.first_parameter, row.parameter_count, is_parameter) == row.parameter_count;
}

constexpr bool is_component_in_place(const SystemView& view, std::size_t i) noexcept {
    const ComponentRow& row = view.component_rows[i];
    const WindowRow& window = view.windows[row.window];
    const auto is_port = [&](std::size_t p) noexcept { return view.ports[p].component == i; };
    const auto is_outgoing = [&](std::size_t place) noexcept {
        return view.connections[view.outgoing_order[place]].source_component == i;
    };
    return is_within(i, window.first_component, window.component_count) &&
           count_own(row.first_port, row.port_count, is_port) == row.port_count &&
           count_own(row.first_outgoing, row.outgoing_count, is_outgoing) == row.outgoing_count;
}

constexpr bool is_port_in_place(const SystemView& view, std::size_t p) noexcept {
    const PortRow& port = view.ports[p];
    const ComponentRow& owner = view.component_rows[port.component];
    const WindowRow& window = view.windows[port.window];
    return port.owner == view.components[port.component] && port.window == owner.window &&
           is_within(p, owner.first_port, owner.port_count) &&
           is_within(p, window.first_port, window.port_count) &&
           (port.output == nullptr || window.has_outputs);
}

/// Whether the source is an output of the component that the row names, and this component lists the
/// connection exactly once.
constexpr bool is_source_in_place(const SystemView& view, std::size_t i) noexcept {
    const ConnectionRow& row = view.connections[i];
    if (row.source_component == kNoIndex) {
        return true;
    }
    const ComponentRow& owner = view.component_rows[row.source_component];
    const auto is_port = [&](std::size_t p) noexcept { return view.ports[p].output == row.source; };
    const auto is_place = [&](std::size_t place) noexcept { return view.outgoing_order[place] == i; };
    return row.source_window == owner.window &&
           (view.windows[row.source_window].has_deliveries || !row.operations.may_leave_core) &&
           count_own(owner.first_port, owner.port_count, is_port) == 1U &&
           count_own(owner.first_outgoing, owner.outgoing_count, is_place) == 1U;
}

/// Whether the same is true for the sink and the window that latches it.
constexpr bool is_sink_in_place(const SystemView& view, std::size_t i) noexcept {
    const ConnectionRow& row = view.connections[i];
    if (row.sink_component == kNoIndex) {
        return true;
    }
    const ComponentRow& owner = view.component_rows[row.sink_component];
    const WindowRow& window = view.windows[row.sink_window];
    const auto is_port = [&](std::size_t p) noexcept { return view.ports[p].input == row.sink; };
    const auto is_place = [&](std::size_t place) noexcept { return view.latch_order[place] == i; };
    return row.sink_window == owner.window && count_own(owner.first_port, owner.port_count, is_port) == 1U &&
           count_own(window.first_latch, window.latch_count, is_place) == 1U;
}

constexpr bool is_parameter_in_place(const SystemView& view, std::size_t i) noexcept {
    for (const WindowRow& window : view.windows) {
        if (is_within(i, window.first_parameter, window.parameter_count)) {
            return true;
        }
    }
    return false;
}

/// Precondition: each row of the table is valid on its own.
constexpr void check_ranges(const SystemView& view, FindingList& findings) noexcept {
    for (std::size_t i = 0U; i < view.windows.size(); ++i) {
        if (!has_own_rows_only(view, i)) {
            findings.add(Rule::kWindowRowInvalid, i);
        }
    }
    for (std::size_t i = 0U; i < view.components.size(); ++i) {
        if (!is_component_in_place(view, i)) {
            findings.add(Rule::kComponentRowInvalid, i);
        }
    }
    for (std::size_t i = 0U; i < view.ports.size(); ++i) {
        if (!is_port_in_place(view, i)) {
            findings.add(Rule::kPortRowInvalid, i);
        }
    }
    for (std::size_t i = 0U; i < view.connections.size(); ++i) {
        if (!is_source_in_place(view, i) || !is_sink_in_place(view, i)) {
            findings.add(Rule::kConnectionRowInvalid, i);
        }
    }
    for (std::size_t i = 0U; i < view.configuration.parameters.size(); ++i) {
        if (!is_parameter_in_place(view, i)) {
            findings.add(Rule::kParameterRowInvalid, i);
        }
    }
}

}  // namespace mamori::detail

#endif  // MAMORI_KERNEL_RANGE_CHECK_HPP
