// SPDX-License-Identifier: Apache-2.0
/// @file
/// Writes the parts of a description into the rows of a table: what system() does. Not for users.
///
/// @satisfies SWR-KRN-017      Design: docs/design/kernel.md#system-table
#ifndef MAMORI_KERNEL_SYSTEM_BUILDER_HPP
#define MAMORI_KERNEL_SYSTEM_BUILDER_HPP

#include <array>
#include <cstddef>

#include "mamori/kernel/system_table.hpp"
#include "mamori/kernel/type_list.hpp"

namespace mamori::detail {

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
/// Eight at a time, so that a window of a thousand components stays within the compiler's template depth.
template <typename... As, typename... Bs, typename... Cs, typename... Ds, typename... Es, typename... Fs,
          typename... Gs, typename... Hs, typename... Rest>
struct Concat<TypeList<As...>, TypeList<Bs...>, TypeList<Cs...>, TypeList<Ds...>, TypeList<Es...>,
              TypeList<Fs...>, TypeList<Gs...>, TypeList<Hs...>, Rest...> {
    using Type =
        typename Concat<TypeList<As..., Bs..., Cs..., Ds..., Es..., Fs..., Gs..., Hs...>, Rest...>::Type;
};

/// What a part contributes to the table, in types: components, their ports, connections, faults, reactions.
template <typename ComponentList = TypeList<>, typename PortList = TypeList<>,
          typename FaultList = TypeList<>, std::size_t kWindowCountOfPart = 0U,
          std::size_t kConnectionCountOfPart = 0U, std::size_t kReactionCountOfPart = 0U>
struct PartTypes {
    using Components = ComponentList;
    using Ports = PortList;
    using Faults = FaultList;
    static constexpr std::size_t kWindows = kWindowCountOfPart;
    static constexpr std::size_t kConnections = kConnectionCountOfPart;
    static constexpr std::size_t kReactions = kReactionCountOfPart;
};

template <typename... Parts>
using JoinedTypes =
    PartTypes<typename Concat<typename Parts::Types::Components...>::Type,
              typename Concat<typename Parts::Types::Ports...>::Type,
              typename Concat<typename Parts::Types::Faults...>::Type, (Parts::Types::kWindows + ... + 0U),
              (Parts::Types::kConnections + ... + 0U), (Parts::Types::kReactions + ... + 0U)>;

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

/// Fills what follows from the rows: which windows and components a connection joins, and in which order.
template <typename Table>
constexpr void resolve_connections(Table& table) noexcept {
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
    }
}

/// Sorts the connections for the executive, which then looks at none but those it needs.
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

/// Appends rows in the order in which parts are added.
template <typename Table>
struct TableBuilder {
    Table table{};
    std::size_t window_count{0U};
    std::size_t component_count{0U};
    std::size_t port_count{0U};
    std::size_t connection_count{0U};
    std::size_t fault_count{0U};
    std::size_t reaction_count{0U};

    template <typename Part>
    constexpr void add_window(const Part& part) noexcept {
        WindowRow& row = table.windows[window_count];
        row = part.row;
        row.period = part.row.period == Duration{0} ? table.frame : part.row.period;
        row.first_component = component_count;
        row.component_count = part.list.components.size();
        row.first_port = port_count;
        row.port_count = part.list.ports.size();
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
                ++port_count;
            }
            ++component_count;
        }
        ++window_count;
    }
    constexpr void add(const ConnectionRow& row) noexcept { table.connections[connection_count++] = row; }
    constexpr void add(const FaultRow& row) noexcept { table.faults[fault_count++] = row; }
    constexpr void add(const ReactionRow& row) noexcept { table.reactions[reaction_count++] = row; }
    constexpr void add(AbortPolicy policy) noexcept { table.abort_policy = policy; }
};

}  // namespace mamori::detail

#endif  // MAMORI_KERNEL_SYSTEM_BUILDER_HPP
