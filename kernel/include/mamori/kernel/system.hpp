// SPDX-License-Identifier: Apache-2.0
/// @file
/// The static description of a system: one frame, its windows with their components, and the connections
/// between ports. It is a constant of the program; `MAMORI_CHECK` makes the compiler refuse a table that
/// could not work.
///
///     inline constexpr auto kSystem = mamori::system(
///         mamori::frame(1_ms),
///         mamori::window("sense", 0_us, 200_us, mamori::budget(150_us), mamori::run(encoder, monitor)),
///         mamori::connect(encoder.joints, monitor.joints));
///     MAMORI_CHECK(kSystem);
///
/// @satisfies SWR-KRN-017, SWR-KRN-018      Design: docs/design/kernel.md#system-table
#ifndef MAMORI_KERNEL_SYSTEM_HPP
#define MAMORI_KERNEL_SYSTEM_HPP

#include <array>
#include <cstddef>
#include <type_traits>

#include "mamori/kernel/component.hpp"
#include "mamori/kernel/data_port.hpp"
#include "mamori/kernel/system_check.hpp"
#include "mamori/kernel/system_table.hpp"

namespace mamori {

/// Ports of a component, as pointers to its members; a component without the alias has no ports:
///     using Ports = mamori::Ports<&Monitor::joints, &Monitor::verdict>;
template <auto... kMembers>
struct Ports {
    static constexpr std::size_t kCount = sizeof...(kMembers);
};

struct Frame {
    Duration length;
};
struct Budget {
    Duration limit;
};
/// One window: opens `offset` after the frame began, closes `length` later.
template <typename... Cs>
struct Window {
    const char* name;
    Duration offset;
    Duration length;
    Duration budget;
    std::array<Component*, sizeof...(Cs)> components;
    std::array<PortRow, (port_count<Cs>() + ... + 0U)> ports;
};
struct Connection {
    ConnectionRow row;
};

/// @param[in] length > 0.
constexpr Frame frame(Duration length) noexcept {
    return {length};
}
/// Execution time that all components of a window may use together, counted from its opening.
constexpr Budget budget(Duration limit) noexcept {
    return {limit};
}

namespace detail {

template <typename C, typename Port>
constexpr PortRow make_port_row(C& component, Port& port) noexcept {
    PortRow row{};
    row.owner = &component;
    if constexpr (std::is_base_of_v<OutPortBase, Port>) {
        row.output = &port;
    } else {
        static_assert(std::is_base_of_v<InPortBase, Port>, "Ports<...> names members that are ports");
        row.input = &port;
        row.is_mandatory = Port::kIsMandatory;
    }
    return row;
}

template <typename C, std::size_t N, auto... kMembers>
constexpr void append_ports(C& component, std::array<PortRow, N>& rows, std::size_t& next,
                            Ports<kMembers...>) noexcept {
    ((rows[next++] = make_port_row(component, component.*kMembers)), ...);
}

template <typename C, std::size_t N>
constexpr void append_ports_of(C& component, std::array<PortRow, N>& rows, std::size_t& next) noexcept {
    if constexpr (port_count<C>() > 0U) {
        append_ports(component, rows, next, typename C::Ports{});
    } else {
        static_cast<void>(component);
        static_cast<void>(rows);
        static_cast<void>(next);
    }
}

template <typename Source, typename Sink>
void latch(OutPortBase& source, InPortBase& sink) noexcept {
    static_cast<Sink&>(sink).latch(static_cast<Source&>(source));
}
template <typename Source, typename Sink>
void hand_on(OutPortBase& source, InPortBase& sink, Instant now) noexcept {
    static_cast<Sink&>(sink).hand_on(static_cast<Source&>(source), now);
}

}  // namespace detail

/// The components of one window in execution order; they form one periodic execution context.
template <typename... Cs>
struct RunList {
    std::array<Component*, sizeof...(Cs)> components;
    std::array<PortRow, (port_count<Cs>() + ... + 0U)> ports;
};
template <typename... Cs>
constexpr RunList<Cs...> run(Cs&... components) noexcept {
    static_assert(sizeof...(Cs) > 0U, "a window runs at least one component");
    RunList<Cs...> list{{{&components...}}, {}};
    std::size_t next = 0U;
    (detail::append_ports_of(components, list.ports, next), ...);
    return list;
}

template <typename... Cs>
constexpr Window<Cs...> window(const char* name, Duration offset, Duration length, Budget limit,
                               const RunList<Cs...>& list) noexcept {
    return {name, offset, length, limit.limit, list.components, list.ports};
}

/// Feeds `sink` from `source`; their payload types must be the same.
template <typename T, typename U, Need kNeed>
constexpr Connection connect(OutPort<T>& source, InPort<U, kNeed>& sink) noexcept {
    static_assert(std::is_same_v<T, U>, "connect() joins ports of one payload type");
    ConnectionRow row{};
    row.source = &source;
    row.sink = &sink;
    if constexpr (std::is_same_v<T, U>) {
        row.latch = &detail::latch<OutPort<T>, InPort<T, kNeed>>;
        row.hand_on = &detail::hand_on<OutPort<T>, InPort<T, kNeed>>;
    }
    return {row};
}

namespace detail {

template <typename Part>
struct PartSize {
    static constexpr std::size_t kWindows = 0U;
    static constexpr std::size_t kComponents = 0U;
    static constexpr std::size_t kPorts = 0U;
    static constexpr std::size_t kConnections = 0U;
};
template <typename... Cs>
struct PartSize<Window<Cs...>> {
    static constexpr std::size_t kWindows = 1U;
    static constexpr std::size_t kComponents = sizeof...(Cs);
    static constexpr std::size_t kPorts = (port_count<Cs>() + ... + 0U);
    static constexpr std::size_t kConnections = 0U;
};
template <>
struct PartSize<Connection> {
    static constexpr std::size_t kWindows = 0U;
    static constexpr std::size_t kComponents = 0U;
    static constexpr std::size_t kPorts = 0U;
    static constexpr std::size_t kConnections = 1U;
};

/// Writes the parts of a description into the rows of a table, in the order they are given.
template <typename Table>
struct TableBuilder {
    Table table{};
    std::size_t window_count{0U};
    std::size_t component_count{0U};
    std::size_t port_count{0U};
    std::size_t connection_count{0U};

    template <typename... Cs>
    constexpr void add(const Window<Cs...>& part) noexcept {
        WindowRow& row = table.windows[window_count];
        row.name = part.name;
        row.offset = part.offset;
        row.length = part.length;
        row.budget = part.budget;
        row.first_component = component_count;
        row.component_count = part.components.size();
        for (const PortRow& port : part.ports) {
            table.ports[port_count] = port;
            table.ports[port_count].window = window_count;
            for (std::size_t i = 0U; i < part.components.size(); ++i) {
                if (part.components[i] == port.owner) {
                    table.ports[port_count].component = component_count + i;
                }
            }
            ++port_count;
        }
        for (Component* component : part.components) {
            table.components[component_count] = component;
            ++component_count;
        }
        ++window_count;
    }
    constexpr void add(const Connection& part) noexcept {
        table.connections[connection_count] = part.row;
        ++connection_count;
    }
};

}  // namespace detail

/// Builds the table from a frame, windows and connections.
template <typename... Parts>
constexpr auto system(Frame frame_part, const Parts&... parts) noexcept {
    using Table = SystemTable<
        (detail::PartSize<Parts>::kWindows + ... + 0U), (detail::PartSize<Parts>::kComponents + ... + 0U),
        (detail::PartSize<Parts>::kPorts + ... + 0U), (detail::PartSize<Parts>::kConnections + ... + 0U)>;
    detail::TableBuilder<Table> builder{};
    builder.table.frame = frame_part.length;
    (builder.add(parts), ...);
    detail::resolve_connections(builder.table);
    return builder.table;
}

}  // namespace mamori

#endif  // MAMORI_KERNEL_SYSTEM_HPP
