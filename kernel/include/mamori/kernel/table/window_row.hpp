// SPDX-License-Identifier: Apache-2.0
/// @file
/// Rows of a system table that say when something runs: windows and their components.
///
/// @satisfies SWR-KRN-017      Design: docs/design/kernel.md#system-table
#ifndef MAMORI_KERNEL_WINDOW_ROW_HPP
#define MAMORI_KERNEL_WINDOW_ROW_HPP

#include <array>
#include <cstddef>

#include "mamori/kernel/base/time.hpp"
#include "mamori/kernel/component/context_plan.hpp"
#include "mamori/kernel/table/mode_mask.hpp"
#include "mamori/kernel/table/table_index.hpp"

namespace mamori {

/// Rates beside the first that one window can declare.
inline constexpr std::size_t kAlternativeRateMax = 4U;

/// One window: opens at `offset`, `offset + period`, ... of each frame; its components form one execution
/// context.
struct WindowRow {
    const char* name{nullptr};  ///< static storage; unique
    Duration offset{};          ///< first opening, from the start of the frame, >= 0
    Duration length{};          ///< from opening to close, > 0; with the offset within the period
    Duration period{};          ///< between two openings, > 0; divides the frame
    Duration budget{};          ///< from the opening of the window, > 0; never beyond its close
    double rate_hz{0.0};        ///< declared cycles per second; only where `has_rate`
    /// Slower ones, each a whole multiple of `period`; as many as `alternative_count` says.
    std::array<Duration, kAlternativeRateMax> alternative_periods{};
    std::size_t alternative_count{0U};
    std::size_t core{0U};             ///< processor core that runs it: 0, 1, ...
    const char* partition{""};        ///< name; equal names are one partition
    std::size_t first_component{0U};  ///< its components, places of the table one after the other
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
    bool has_rate{false};               ///< `rate_hz` is declared
};

/// What the table knows of one component.
struct ComponentRow {
    std::size_t window{kNoIndex};  ///< that runs it
    Duration worst_case{};         ///< declared execution time of both passes, >= 0; 0: not declared
    std::size_t first_port{0U};    ///< its ports, places of the table one after the other
    std::size_t port_count{0U};
    std::size_t first_outgoing{0U};  ///< connections from its outputs, places of `outgoing_order`
    std::size_t outgoing_count{0U};
    ModeMask modes{kEveryMode};  ///< in which it is Active
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_WINDOW_ROW_HPP
