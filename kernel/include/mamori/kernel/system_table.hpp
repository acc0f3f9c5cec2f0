// SPDX-License-Identifier: Apache-2.0
/// @file
/// Rows of a system table: what the compiler checks and the executive runs. Users write `mamori::system(...)`
/// (system.hpp) and never fill rows by hand.
///
/// @satisfies SWR-KRN-017      Design: docs/design/kernel.md#system-table
#ifndef MAMORI_KERNEL_SYSTEM_TABLE_HPP
#define MAMORI_KERNEL_SYSTEM_TABLE_HPP

#include <array>
#include <cstddef>
#include <limits>
#include <type_traits>

#include "mamori/kernel/component.hpp"
#include "mamori/kernel/data_port.hpp"
#include "mamori/kernel/span.hpp"
#include "mamori/kernel/time.hpp"

namespace mamori {

/// Index that no row has.
inline constexpr std::size_t kNoIndex = std::numeric_limits<std::size_t>::max();

struct WindowRow {
    const char* name{nullptr};
    Duration offset{};  ///< from the start of the frame
    Duration length{};
    Duration budget{};  ///< from the opening of the window; never beyond its close
    std::size_t first_component{0U};
    std::size_t component_count{0U};
};

/// Either `input` or `output` is set.
struct PortRow {
    Component* owner{nullptr};
    InPortBase* input{nullptr};
    OutPortBase* output{nullptr};
    bool is_mandatory{false};
    std::size_t window{kNoIndex};
    std::size_t component{kNoIndex};  ///< its owner's place in the table
};

struct ConnectionRow {
    OutPortBase* source{nullptr};
    InPortBase* sink{nullptr};
    void (*latch)(OutPortBase&, InPortBase&) noexcept {nullptr};
    void (*hand_on)(OutPortBase&, InPortBase&, Instant) noexcept {nullptr};
    std::size_t source_window{kNoIndex};
    std::size_t sink_window{kNoIndex};
    std::size_t source_component{kNoIndex};
    /// Source and sink run in one window, the source first: the value is handed on within the window.
    bool is_forward_in_window{false};
};

template <std::size_t kWindows, std::size_t kComponents, std::size_t kPorts, std::size_t kConnections>
struct SystemTable {
    Duration frame{};
    std::array<WindowRow, kWindows> windows{};
    std::array<Component*, kComponents> components{};
    std::array<PortRow, kPorts> ports{};
    std::array<ConnectionRow, kConnections> connections{};

    static constexpr std::size_t kWindowCount = kWindows;
    static constexpr std::size_t kComponentCount = kComponents;
};

/// The same rows without their sizes in the type; refers to the table, which must outlive it.
struct SystemView {
    Duration frame{};
    Span<const WindowRow> windows{};
    Span<Component* const> components{};
    Span<const PortRow> ports{};
    Span<const ConnectionRow> connections{};
};

template <std::size_t kW, std::size_t kC, std::size_t kP, std::size_t kN>
constexpr SystemView make_view(const SystemTable<kW, kC, kP, kN>& table) noexcept {
    return {table.frame, table.windows, table.components, table.ports, table.connections};
}

namespace detail {

template <typename C, typename = void>
struct PortCount {
    static constexpr std::size_t kValue = 0U;
};
template <typename C>
struct PortCount<C, std::void_t<typename C::Ports>> {
    static constexpr std::size_t kValue = C::Ports::kCount;
};

/// Fills what follows from the rows: which windows a connection joins, and in which order.
template <typename Table>
constexpr void resolve_connections(Table& table) noexcept {
    for (ConnectionRow& connection : table.connections) {
        std::size_t sink_component = kNoIndex;
        for (const PortRow& port : table.ports) {
            if (port.output != nullptr && port.output == connection.source) {
                connection.source_window = port.window;
                connection.source_component = port.component;
            }
            if (port.input != nullptr && port.input == connection.sink) {
                connection.sink_window = port.window;
                sink_component = port.component;
            }
        }
        connection.is_forward_in_window = connection.source_window != kNoIndex &&
                                          connection.source_window == connection.sink_window &&
                                          connection.source_component < sink_component;
    }
}

}  // namespace detail

/// Ports that component type C declares.
template <typename C>
constexpr std::size_t port_count() noexcept {
    return detail::PortCount<C>::kValue;
}

}  // namespace mamori

#endif  // MAMORI_KERNEL_SYSTEM_TABLE_HPP
