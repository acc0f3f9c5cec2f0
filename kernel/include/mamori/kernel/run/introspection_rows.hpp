// SPDX-License-Identifier: Apache-2.0
/// @file
/// State of a running system as external tools see it, row by row: cores, windows, components, ports. Rows
/// are plain copies that include names, so that a reader needs no other part of the kernel.
///
/// @satisfies SWR-INS-001      Design: docs/design/kernel.md#introspection
#ifndef MAMORI_KERNEL_INTROSPECTION_ROWS_HPP
#define MAMORI_KERNEL_INTROSPECTION_ROWS_HPP

#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/time.hpp"
#include "mamori/kernel/component/action_failure.hpp"
#include "mamori/kernel/component/lifecycle.hpp"
#include "mamori/kernel/dataflow/data_port.hpp"
#include "mamori/kernel/run/executive.hpp"
#include "mamori/kernel/table/system_table.hpp"

namespace mamori {

/// Progress of a core.
struct CoreSnapshot {
    Instant observed_at{};    ///< planned start of the last window instance
    std::uint64_t frame{0U};  ///< number of its major frame: 0, 1, ...
    /// After that instance, as Executive::get_trace_hash() of the core; without trace_hash() in the table,
    /// the value of an empty TraceHash.
    std::uint64_t trace_hash{0U};
};

/// Timing of a window. Counts and maxima start when the introspection is attached.
struct WindowSnapshot {
    const char* name{""};             ///< static storage, as all names here
    std::size_t core{0U};             ///< core that runs it, as WindowRow::core
    Instant observed_at{};            ///< planned start of the last window instance
    std::uint64_t cycles{0U};         ///< window instances that ended kCompleted or kOverrun
    std::uint64_t overruns{0U};       ///< instances of `cycles` that ended kOverrun
    std::uint64_t late_releases{0U};  ///< instances that started after the planned start, while Running
    Duration worst_lateness{};        ///< maximum of actual minus planned start, >= 0
    Duration budget{};                ///< as in the table
    Duration last_used{};             ///< from the start to the end of the last counted instance
    Duration worst_used{};            ///< maximum over all counted instances
    WindowOutcome last_outcome{WindowOutcome::kStopped};
    /// Component whose action hangs; kNoIndex: none. While an action hangs, the rows of the components and
    /// ports of this window are not updated.
    std::size_t hanging_component{kNoIndex};
};

/// State of a component.
struct ComponentSnapshot {
    const char* name{""};
    std::size_t window{kNoIndex};  ///< index of the window that runs it
    Instant observed_at{};         ///< planned start of the last instance of its window
    LifecycleState state{LifecycleState::kCreated};
    ActionFailure last_failure{};
    std::uint64_t cycles{0U};  ///< first passes within the budget, while Active or in Error, since attached
    /// Longest first pass completed in time while Active, measured while an observer has records; 0: not
    /// measured.
    Duration worst_used{};
};

/// State of a port.
struct PortSnapshot {
    const char* name{""};
    std::size_t component{kNoIndex};     ///< index of the owner in the table
    bool is_input{false};                ///< false: an output
    bool has_value{false};               ///< a value was published or has arrived
    Instant observed_at{};               ///< planned start of the last instance of its window
    Instant published_at{};              ///< publication instant of the value; invalid unless has_value
    std::uint32_t sequence{0U};          ///< outputs: publications so far (wraps at 2^32); inputs: 0
    PortStatus status{PortStatus::kOk};  ///< inputs: calc_status() at observed_at; outputs: get_status()
    PortCounts counts{};                 ///< since construction

    /// Age of the value at observed_at [ns]; negative for a value that this window published at its end.
    constexpr Duration calc_age() const noexcept { return observed_at - published_at; }
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_INTROSPECTION_ROWS_HPP
