// SPDX-License-Identifier: Apache-2.0
/// @file
/// A complete system table, which the compiler checks and the executive runs. Users write
/// `mamori::system(...)` (system.hpp). A tool that builds tables at run time fills rows and has them checked
/// (system_check.hpp).
///
/// @satisfies SWR-KRN-017      Design: docs/design/kernel.md#system-table
#ifndef MAMORI_KERNEL_SYSTEM_TABLE_HPP
#define MAMORI_KERNEL_SYSTEM_TABLE_HPP

#include <array>
#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/time.hpp"
#include "mamori/kernel/component/component.hpp"
#include "mamori/kernel/component/context_plan.hpp"
#include "mamori/kernel/parameter/configuration_table.hpp"
#include "mamori/kernel/table/connection_row.hpp"
#include "mamori/kernel/table/mode_table.hpp"
#include "mamori/kernel/table/window_row.hpp"

namespace mamori {

/// A declared fault, by its number in the enumeration of the application.
struct FaultRow {
    std::uint32_t fault{0U};
};
/// Reaction to a fault; numbers of the enumerations of the application.
struct ReactionRow {
    std::uint32_t fault{0U};
    std::uint32_t reaction{0U};
    Duration within{};           ///< from the confirmed fault to the start of the reaction, > 0
    ModeMask modes{kEveryMode};  ///< modes in which this is the reaction
};

/// Rows with their number in the type.
template <std::size_t kWindows, std::size_t kComponents, std::size_t kPorts, std::size_t kConnections,
          std::size_t kFaults = 0U, std::size_t kReactions = 0U,
          typename Configuration = ConfigurationTable<0U, 0U, 0U, 0U>,
          typename Modes = ModeTable<0U, 0U, 0U, 0U>>
struct SystemTable {
    Duration frame{};  ///< length of the major frame, > 0; common to all cores
    std::array<WindowRow, kWindows> windows{};
    std::array<Component*, kComponents> components{};
    std::array<ComponentRow, kComponents> component_rows{};
    std::array<PortRow, kPorts> ports{};  ///< in the order of their owners
    std::array<ConnectionRow, kConnections> connections{};
    std::array<std::size_t, kConnections> latch_order{};     ///< connections, sorted by sink window
    std::array<std::size_t, kConnections> outgoing_order{};  ///< connections, sorted by source component
    std::array<FaultRow, kFaults> faults{};
    std::array<ReactionRow, kReactions> reactions{};
    Configuration configuration{};  ///< parameters of all components, and their configuration sets
    Modes modes{};
    AbortPolicy abort_policy{AbortPolicy::kSpecOnly};
    Duration publication_margin{};  ///< between the end of a writer and its reader on another core, >= 0
    bool has_trace_hash{false};     ///< as trace_hash() requests

    static constexpr std::size_t kWindowCount = kWindows;
    static constexpr std::size_t kComponentCount = kComponents;
    static constexpr std::size_t kPortCount = kPorts;
    /// A SystemModes switches modes and configuration sets. Without it, no executive runs such a table.
    static constexpr bool kNeedsModes =
        std::tuple_size_v<decltype(Modes::modes)> + std::tuple_size_v<decltype(Configuration::sets)> != 0U;
};

/// The same rows without their number in the type; refers to the table, which must outlive the view.
struct SystemView {
    Duration frame{};
    Span<const WindowRow> windows{};
    Span<Component* const> components{};
    Span<const ComponentRow> component_rows{};
    Span<const PortRow> ports{};
    Span<const ConnectionRow> connections{};
    Span<const std::size_t> latch_order{};
    Span<const std::size_t> outgoing_order{};
    Span<const FaultRow> faults{};
    Span<const ReactionRow> reactions{};
    ConfigurationView configuration{};
    ModeView modes{};
    AbortPolicy abort_policy{AbortPolicy::kSpecOnly};
    Duration publication_margin{};
    bool has_trace_hash{false};
};

/// @param[in] table must outlive the view.
template <std::size_t kW, std::size_t kC, std::size_t kP, std::size_t kN, std::size_t kF, std::size_t kR,
          typename Configuration, typename Modes>
constexpr SystemView make_view(
    const SystemTable<kW, kC, kP, kN, kF, kR, Configuration, Modes>& table) noexcept {
    SystemView view{};
    view.frame = table.frame;
    view.windows = table.windows;
    view.components = table.components;
    view.component_rows = table.component_rows;
    view.ports = table.ports;
    view.connections = table.connections;
    view.latch_order = table.latch_order;
    view.outgoing_order = table.outgoing_order;
    view.faults = table.faults;
    view.reactions = table.reactions;
    view.configuration = make_view(table.configuration);
    view.modes = make_view(table.modes);
    view.abort_policy = table.abort_policy;
    view.publication_margin = table.publication_margin;
    view.has_trace_hash = table.has_trace_hash;
    return view;
}

}  // namespace mamori

#endif  // MAMORI_KERNEL_SYSTEM_TABLE_HPP
