// SPDX-License-Identifier: Apache-2.0
/// @file
/// What a tool outside can see of a running system, row by row: cores, windows, components, ports. Plain
/// copies with names in them, so that whoever holds one needs nothing else of the kernel.
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

/// How far a core has come.
struct CoreSnapshot {
    Instant observed_at{};         ///< planned opening of the window that ran last
    std::uint64_t frame{0U};       ///< number of its frame: 0, 1, ...
    std::uint64_t trace_hash{0U};  ///< after it, as Executive::get_trace_hash() of that core
};

/// How a window keeps its time. Counts and worst cases are those since the introspection was attached.
struct WindowSnapshot {
    const char* name{""};             ///< static storage, as all names here
    std::size_t core{0U};             ///< that runs it, as WindowRow::core
    Instant observed_at{};            ///< planned opening that ran last
    std::uint64_t cycles{0U};         ///< openings that ended kCompleted or kOverrun
    std::uint64_t overruns{0U};       ///< of them, those that ended kOverrun
    std::uint64_t late_releases{0U};  ///< openings after their planned instant, while Running
    Duration worst_lateness{};        ///< longest time from the planned opening to the real one, >= 0
    Duration budget{};                ///< as in the table
    Duration last_used{};             ///< from the opening to the end of the last cycle
    Duration worst_used{};            ///< of all cycles
    WindowOutcome last_outcome{WindowOutcome::kStopped};
    /// Whose action hangs; kNoIndex: nobody's. While one hangs, the rows of this window's components and
    /// ports stay as they were.
    std::size_t hanging_component{kNoIndex};
};

/// How a component is.
struct ComponentSnapshot {
    const char* name{""};
    std::size_t window{kNoIndex};  ///< that runs it, place in the table
    Instant observed_at{};         ///< planned opening of its window that ran last
    LifecycleState state{LifecycleState::kCreated};
    ActionFailure last_failure{};
    std::uint64_t cycles{0U};  ///< first passes within the budget, while Active or in Error, since attached
    /// Longest first pass of those that came through Active and in time, measured while an observer
    /// has records; 0: never was.
    Duration worst_used{};
};

/// What a port holds.
struct PortSnapshot {
    const char* name{""};
    std::size_t component{kNoIndex};     ///< owner, place in the table
    bool is_input{false};                ///< else an output
    bool has_value{false};               ///< something was published, or has arrived
    Instant observed_at{};               ///< planned opening of its window that ran last
    Instant published_at{};              ///< of the value that it holds; without meaning before has_value
    std::uint32_t sequence{0U};          ///< outputs: publications so far (wraps at 2^32); inputs: 0
    PortStatus status{PortStatus::kOk};  ///< inputs: calc_status() at observed_at; outputs: get_status()
    QueueCounts queue{};                 ///< inputs that queue; else all 0

    /// Age of the value at observed_at; negative for what this window published at its close.
    constexpr Duration calc_age() const noexcept { return observed_at - published_at; }
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_INTROSPECTION_ROWS_HPP
