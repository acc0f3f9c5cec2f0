// SPDX-License-Identifier: Apache-2.0
/// @file
/// Rows of a system table: what the compiler checks and the executive runs. Users write `mamori::system(...)`
/// (system.hpp); a tool that makes tables at run time fills rows and has them checked (system_check.hpp).
///
/// @satisfies SWR-KRN-017      Design: docs/design/kernel.md#system-table
#ifndef MAMORI_KERNEL_SYSTEM_TABLE_HPP
#define MAMORI_KERNEL_SYSTEM_TABLE_HPP

#include <array>
#include <cstddef>
#include <cstdint>

#include "mamori/kernel/component.hpp"
#include "mamori/kernel/configuration_table.hpp"
#include "mamori/kernel/connection.hpp"
#include "mamori/kernel/context_plan.hpp"
#include "mamori/kernel/data_port.hpp"
#include "mamori/kernel/mode_table.hpp"
#include "mamori/kernel/span.hpp"
#include "mamori/kernel/table_index.hpp"
#include "mamori/kernel/time.hpp"

namespace mamori {

/// Rates beside the first that one window can declare.
inline constexpr std::size_t kAlternativeRateMax = 4U;

/// One window: opens at `offset`, `offset + period`, ... of each frame; its components form one execution
/// context.
struct WindowRow {
    const char* name{nullptr};
    Duration offset{};    ///< first opening, from the start of the frame
    Duration length{};    ///< from opening to close
    Duration period{};    ///< between two openings; divides the frame
    Duration budget{};    ///< from the opening of the window; never beyond its close
    double rate_hz{0.0};  ///< declared cycles per second; 0: not declared
    std::array<Duration, kAlternativeRateMax> alternative_periods{};
    std::size_t alternative_count{0U};
    std::size_t core{0U};
    const char* partition{""};  ///< name; equal names are one partition
    std::size_t first_component{0U};
    std::size_t component_count{0U};
    std::size_t first_port{0U};  ///< of all its components, one after the other
    std::size_t port_count{0U};
    std::size_t first_latch{0U};  ///< connections into this window, places of `latch_order`
    std::size_t latch_count{0U};
    std::size_t first_parameter{0U};  ///< parameters of its components, rows of the configuration
    std::size_t parameter_count{0U};
    ExecutionKind kind{ExecutionKind::kPeriodic};
    ExternalTrigger* trigger{nullptr};  ///< whose ticks release the cycles of kind kOther
    std::size_t events_per_cycle{1U};   ///< bound of kind kEventDriven
    bool has_second_pass{true};         ///< a component of it overrides on_state_update
    bool has_hand_on{false};            ///< a connection of it is forward in the window
};

/// What the table knows of one component.
struct ComponentRow {
    std::size_t window{kNoIndex};
    Duration worst_case{};  ///< declared execution time of both passes; 0: not declared
    std::size_t first_port{0U};
    std::size_t port_count{0U};
    std::size_t first_outgoing{0U};  ///< connections from its outputs, places of `outgoing_order`
    std::size_t outgoing_count{0U};
    ModeMask modes{kEveryMode};  ///< in which it is Active
};

/// Either `input` or `output` is set.
struct PortRow {
    Component* owner{nullptr};
    InPortBase* input{nullptr};
    OutPortBase* output{nullptr};
    bool is_mandatory{false};
    std::size_t window{kNoIndex};
    std::size_t component{kNoIndex};  ///< its owner's place in the table
    /// What an input that queues has counted.
    QueueCounts (*count_queue)(const InPortBase&) noexcept {&count_no_queue};
};

struct ConnectionRow {
    OutPortBase* source{nullptr};
    InPortBase* sink{nullptr};
    CrossingBase* crossing{nullptr};  ///< storage of a connection that leaves its core or partition
    ConnectionOperations operations{};
    Duration age_max{kNoAgeLimit};
    std::size_t source_window{kNoIndex};
    std::size_t sink_window{kNoIndex};
    std::size_t source_component{kNoIndex};
    std::size_t sink_component{kNoIndex};
    /// Source and sink run in one window, the source first: the value is handed on within the window.
    bool is_forward_in_window{false};
    ModeMask modes{kEveryMode};  ///< in which it holds and both of its components run
};

/// A fault that the system declares, by its number in the application's enumeration.
struct FaultRow {
    std::uint32_t fault{0U};
};
/// What a fault leads to, by its number in the application's enumeration.
struct ReactionRow {
    std::uint32_t fault{0U};
    std::uint32_t reaction{0U};
    Duration within{};  ///< from the confirmed fault to the start of the reaction, > 0
};

/// Rows with their sizes in the type.
template <std::size_t kWindows, std::size_t kComponents, std::size_t kPorts, std::size_t kConnections,
          std::size_t kFaults = 0U, std::size_t kReactions = 0U,
          typename Configuration = ConfigurationTable<0U, 0U, 0U, 0U>,
          typename Modes = ModeTable<0U, 0U, 0U, 0U>>
struct SystemTable {
    Duration frame{};
    std::array<WindowRow, kWindows> windows{};
    std::array<Component*, kComponents> components{};
    std::array<ComponentRow, kComponents> component_rows{};
    std::array<PortRow, kPorts> ports{};  ///< in the order of their owners
    std::array<ConnectionRow, kConnections> connections{};
    std::array<std::size_t, kConnections> latch_order{};     ///< connections by window of their sink
    std::array<std::size_t, kConnections> outgoing_order{};  ///< connections by component of their source
    std::array<FaultRow, kFaults> faults{};
    std::array<ReactionRow, kReactions> reactions{};
    Configuration configuration{};  ///< parameters of all components, and the sets of their values
    Modes modes{};
    AbortPolicy abort_policy{AbortPolicy::kSpecOnly};

    static constexpr std::size_t kWindowCount = kWindows;
    static constexpr std::size_t kComponentCount = kComponents;
    static constexpr std::size_t kPortCount = kPorts;
};

/// The same rows without their sizes in the type; refers to the table, which must outlive it.
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
};

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
    return view;
}

}  // namespace mamori

#endif  // MAMORI_KERNEL_SYSTEM_TABLE_HPP
