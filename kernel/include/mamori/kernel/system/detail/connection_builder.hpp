// SPDX-License-Identifier: Apache-2.0
/// @file
/// Fills the derived fields of the connection rows: what each connection joins, and the order in which the
/// executive processes them. Not for users.
///
/// @satisfies SWR-KRN-017      Design: docs/design/kernel.md#system-table
#ifndef MAMORI_KERNEL_CONNECTION_BUILDER_HPP
#define MAMORI_KERNEL_CONNECTION_BUILDER_HPP

#include <array>
#include <cstddef>

#include "mamori/kernel/table/connection_row.hpp"
#include "mamori/kernel/table/table_index.hpp"
#include "mamori/kernel/table/window_row.hpp"

namespace mamori::detail {

/// Indices 0 .. n - 1 in the order of their keys; equal keys keep their order.
template <std::size_t N, typename Key>
constexpr std::array<std::size_t, N> sort_by(const Key& key) noexcept {
    std::array<std::size_t, N> order{};
    for (std::size_t i = 0U; i < N; ++i) {
        std::size_t place = i;
        for (; place > 0U && key(order[place - 1U]) > key(i); --place) {
            order[place] = order[place - 1U];
        }
        order[place] = i;
    }
    return order;
}

/// Fills the windows and components that a connection joins, and whether it is forward within a window or
/// feeds a queue or a crossing.
template <typename Table>
constexpr void resolve_connections(Table& table) noexcept {
    for (WindowRow& window : table.windows) {
        window.has_deliveries = false;
    }
    for (ConnectionRow& connection : table.connections) {
        for (const PortRow& port : table.ports) {
            if (port.output != nullptr && port.output == connection.source) {
                connection.source_window = port.window;
                connection.source_component = port.component;
            }
            if (port.input != nullptr && port.input == connection.sink) {
                connection.sink_window = port.window;
                connection.sink_component = port.component;
            }
        }
        connection.is_forward_in_window = connection.source_window != kNoIndex &&
                                          connection.source_window == connection.sink_window &&
                                          connection.source_component < connection.sink_component;
        if (connection.is_forward_in_window) {
            table.windows[connection.sink_window].has_hand_on = true;
        }
        if (connection.source_window != kNoIndex && connection.operations.may_leave_core) {
            table.windows[connection.source_window].has_deliveries = true;
        }
    }
}

/// Sorts the connections, so that the executive accesses only those that it needs.
template <typename Table>
constexpr void sort_connections(Table& table) noexcept {
    constexpr std::size_t kCount = std::tuple_size_v<decltype(table.connections)>;
    table.latch_order = sort_by<kCount>([&table](std::size_t i) { return table.connections[i].sink_window; });
    table.outgoing_order =
        sort_by<kCount>([&table](std::size_t i) { return table.connections[i].source_component; });
    for (std::size_t i = 0U; i < kCount; ++i) {
        const std::size_t window = table.connections[table.latch_order[i]].sink_window;
        if (window != kNoIndex) {
            WindowRow& row = table.windows[window];
            row.first_latch = row.latch_count == 0U ? i : row.first_latch;
            ++row.latch_count;
        }
        const std::size_t component = table.connections[table.outgoing_order[i]].source_component;
        if (component != kNoIndex) {
            ComponentRow& row = table.component_rows[component];
            row.first_outgoing = row.outgoing_count == 0U ? i : row.first_outgoing;
            ++row.outgoing_count;
        }
    }
}

}  // namespace mamori::detail

#endif  // MAMORI_KERNEL_CONNECTION_BUILDER_HPP
