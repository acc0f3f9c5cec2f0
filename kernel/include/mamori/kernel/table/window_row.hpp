// SPDX-License-Identifier: Apache-2.0
/// @file
/// Rows of a system table for the schedule: windows and their components.
///
/// @satisfies SWR-KRN-017, SWR-KRN-080, SWR-KRN-083, SWR-KRN-096      Design:
/// docs/design/kernel.md#system-table
#ifndef MAMORI_KERNEL_WINDOW_ROW_HPP
#define MAMORI_KERNEL_WINDOW_ROW_HPP

#include <array>
#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/time.hpp"
#include "mamori/kernel/component/context_plan.hpp"
#include "mamori/kernel/table/mode_mask.hpp"
#include "mamori/kernel/table/table_index.hpp"

namespace mamori {

/// Maximum number of rates of a window in addition to the first.
inline constexpr std::size_t kAlternativeRateMax = 4U;

/// Largest stack of a window [KiB].
inline constexpr std::uint16_t kStackKibMax = 65534U;

/// One window: starts at `offset`, `offset + period`, ... of each major frame. Its components form one
/// execution context.
struct WindowRow {
    const char* name{nullptr};  ///< static storage; unique
    /// Core of a background window; kNoIndex: an ordinary window. In a gap that 32-bit processors leave here.
    std::size_t background_of{kNoIndex};
    Duration offset{};  ///< first window start, from the start of the major frame, >= 0
    Duration length{};  ///< from window start to window end, > 0; offset + length <= period
    Duration period{};  ///< between two window starts, > 0; divides the major frame
    Duration budget{};  ///< from the actual start, > 0; ends at the latest at the planned end
    /// Processor time of a background window, > 0; its `budget` is its `length`. 0: an ordinary window.
    Duration execution_budget{};
    double rate_hz{0.0};  ///< declared cycles per second [Hz]; valid only if `has_rate`
    /// Periods of slower rates, each an integer multiple of `period`; the first `alternative_count` are
    /// valid.
    std::array<Duration, kAlternativeRateMax> alternative_periods{};
    /// Number of the executive that runs it. Ordinary windows: the processor core 0, 1, ...; background
    /// windows of a core have a number of their own after all cores.
    std::size_t core{0U};
    const char* partition{""};        ///< name; equal names denote the same partition
    std::size_t first_component{0U};  ///< its components, consecutive indices of the table
    std::size_t component_count{0U};
    std::size_t first_port{0U};  ///< ports of its components, consecutive indices
    std::size_t port_count{0U};
    std::size_t first_latch{0U};  ///< connections into this window, indices into `latch_order`
    std::size_t latch_count{0U};
    std::size_t first_parameter{0U};  ///< parameters of its components, rows of the configuration
    std::size_t parameter_count{0U};
    ExternalTrigger* trigger{nullptr};  ///< its ticks release the cycles of kind kOther
    ExecutionKind kind{ExecutionKind::kPeriodic};
    std::uint8_t alternative_count{0U};
    std::uint16_t events_per_cycle{1U};  ///< maximum per state machine for kind kEventDriven, >= 1
    std::uint16_t stack_kib{0U};  ///< stack of its components [KiB], 1 .. kStackKibMax; 0: not declared
    bool has_second_pass{true};   ///< one of its components overrides on_state_update
    bool has_outputs{true};       ///< one of its components has an output
    bool has_deliveries{true};    ///< one of its outputs feeds a queue or a crossing
    bool has_hand_on{false};      ///< one of its connections is forward in the window
    bool has_rate{false};         ///< `rate_hz` is declared
    bool is_system{false};        ///< runs a SystemFunction in all modes
};

/// Whether ordinary windows of its core preempt the window.
constexpr bool is_background(const WindowRow& row) noexcept {
    return row.background_of != kNoIndex;
}
/// Declared limit of the execution time of all components of the window together.
constexpr Duration get_declared_budget(const WindowRow& row) noexcept {
    return is_background(row) ? row.execution_budget : row.budget;
}

/// Row of one component.
struct ComponentRow {
    std::size_t window{kNoIndex};  ///< index of the window that runs it
    Duration worst_case{};         ///< declared execution time of both passes, >= 0; 0: not declared
    std::size_t first_port{0U};    ///< its ports, consecutive indices of the table
    std::size_t port_count{0U};
    std::size_t first_outgoing{0U};  ///< connections from its outputs, indices into `outgoing_order`
    std::size_t outgoing_count{0U};
    ModeMask modes{kEveryMode};  ///< modes in which it is Active
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_WINDOW_ROW_HPP
