// SPDX-License-Identifier: Apache-2.0
/// @file
/// Options of a window: its budget, period, core, class, partition, stack and trigger. Each option is defined
/// next to the function that writes it to the row.
///
/// @satisfies SWR-KRN-017, SWR-KRN-080, SWR-KRN-094      Design: docs/design/kernel.md#system-table
#ifndef MAMORI_KERNEL_WINDOW_OPTION_HPP
#define MAMORI_KERNEL_WINDOW_OPTION_HPP

#include <cstddef>
#include <cstdint>
#include <limits>

#include "mamori/kernel/base/time.hpp"
#include "mamori/kernel/component/context_plan.hpp"
#include "mamori/kernel/table/window_row.hpp"

namespace mamori {

/// Made by budget().
struct Budget {
    Duration limit;
};
/// Maximum execution time of all components of a window together, measured from the window start.
/// @param[in] limit > 0, at most the length of the window.
constexpr Budget budget(Duration limit) noexcept {
    return {limit};
}

/// Made by every().
struct Every {
    Duration period;
};
/// Starts the window every `period`; without it: once per major frame.
/// @param[in] period > 0; divides the major frame without remainder.
constexpr Every every(Duration period) noexcept {
    return {period};
}

/// Made by core().
struct Core {
    std::size_t index;
};
/// Processor core that runs the window; without it: core 0. Cores share the major frame and its start.
/// @param[in] index 0, 1, ...; in a system with modes or configuration sets below kModeCoreMax.
constexpr Core core(std::size_t index) noexcept {
    return {index};
}

/// Made by background().
struct Background {};
/// The window may overlap ordinary windows of its core, which preempt it; background windows of one core are
/// disjoint. Its budget(...) is processor time, and its window end is its deadline. Values pass between both
/// classes through a Crossing or a queue, as between cores.
constexpr Background background() noexcept {
    return {};
}

/// Made by partition().
struct Partition {
    const char* name;
};
/// Memory partition of the components of the window; without it, all share one partition. Values leave it
/// only through a Crossing or a queue. @param[in] name static storage.
constexpr Partition partition(const char* name) noexcept {
    return {name};
}

/// Made by stack().
struct Stack {
    std::size_t size;
};
/// Stack of the components of the window, for a port that gives the window a stack of its own. Without it:
/// the default of the port.
/// @param[in] size [byte] for its components; the port adds what a thread needs itself. A multiple of 1 KiB,
///                 1 KiB .. kStackKibMax KiB (Rule::kStackOutOfRange).
constexpr Stack stack(std::size_t size) noexcept {
    return {size};
}

inline namespace literals {
constexpr std::size_t operator""_KiB(unsigned long long value) noexcept {
    return static_cast<std::size_t>(value) * 1024U;
}
}  // namespace literals

/// Made by triggered_by().
struct TriggeredBy {
    ExternalTrigger& trigger;
};
/// The ticks of `trigger` release the cycles of the window, at most one per window instance (kind OTHER).
/// @param[in] trigger must outlive the table; releases one window (Rule::kTriggerUsedTwice).
constexpr TriggeredBy triggered_by(ExternalTrigger& trigger) noexcept {
    return {trigger};
}

/// Made by event_driven().
struct EventDriven {
    std::size_t events_per_cycle;
};
/// The window processes the events of its state machines (kind EVENT_DRIVEN).
/// @param[in] events_per_cycle maximum for each state machine in one window instance, 1 .. 65535.
constexpr EventDriven event_driven(std::size_t events_per_cycle) noexcept {
    return {events_per_cycle};
}

namespace detail {

constexpr void apply(WindowRow& row, Budget option) noexcept {
    row.budget = option.limit;
}
constexpr void apply(WindowRow& row, Every option) noexcept {
    row.period = option.period;
}
constexpr void apply(WindowRow& row, Core option) noexcept {
    row.core = option.index;
}
/// system() completes the row.
constexpr void apply(WindowRow& row, Background) noexcept {
    row.background_of = 0U;
}
constexpr void apply(WindowRow& row, Partition option) noexcept {
    row.partition = option.name;
}
/// A size out of range becomes one that the table check rejects.
constexpr void apply(WindowRow& row, Stack option) noexcept {
    const std::size_t kib = option.size / 1024U;
    const bool is_in_range = option.size % 1024U == 0U && kib >= 1U && kib <= kStackKibMax;
    row.stack_kib = static_cast<std::uint16_t>(is_in_range ? kib : kStackKibMax + 1U);
}
constexpr void apply(WindowRow& row, TriggeredBy option) noexcept {
    row.kind = ExecutionKind::kOther;
    row.trigger = &option.trigger;
}
constexpr void apply(WindowRow& row, EventDriven option) noexcept {
    row.kind = ExecutionKind::kEventDriven;
    // A number out of range becomes 0, which the table check rejects.
    const bool is_in_range = option.events_per_cycle <= std::numeric_limits<std::uint16_t>::max();
    row.events_per_cycle = static_cast<std::uint16_t>(is_in_range ? option.events_per_cycle : 0U);
}

}  // namespace detail

}  // namespace mamori

#endif  // MAMORI_KERNEL_WINDOW_OPTION_HPP
