// SPDX-License-Identifier: Apache-2.0
/// @file
/// What an executive tells its introspection. Virtual, so that an executive without introspection does not
/// link one. Not for users.
///
/// @satisfies SWR-KRN-071      Design: docs/design/kernel.md#parts-that-a-table-does-not-use
#ifndef MAMORI_KERNEL_EXECUTION_DISPLAY_HPP
#define MAMORI_KERNEL_EXECUTION_DISPLAY_HPP

#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/time.hpp"
#include "mamori/kernel/component/execution_context.hpp"
#include "mamori/kernel/component/window_host.hpp"
#include "mamori/kernel/run/window_outcome.hpp"

namespace mamori::detail {

struct CoreState;

/// For the executive of the core that owns the rows. An index outside the table is a contract violation.
class ExecutionDisplay {
  public:
    ExecutionDisplay(const ExecutionDisplay&) = delete;
    ExecutionDisplay& operator=(const ExecutionDisplay&) = delete;

    /// Shows each window of the core, after an operation of its executive. Precondition: the table violates
    /// no rule.
    virtual void show_windows(const CoreState& core, std::uint64_t trace_hash) noexcept = 0;
    /// Shows the end of a window instance. @param[in] release, start planned and measured. Precondition as
    /// above.
    virtual void show_window(std::size_t window, const ExecutionContext& context, Instant release,
                             Instant start, WindowOutcome outcome, const WindowHost& host,
                             std::uint64_t trace_hash) noexcept = 0;
    /// Counts a cycle for those of the first `finished_count` components of `window` that are Active or in
    /// Error: they completed their first pass within the budget.
    virtual void note_turns(std::size_t window, std::size_t finished_count,
                            const ExecutionContext& context) noexcept = 0;
    /// Records that the first pass of `component` took `used` [ns]. May also be called from an action that
    /// the platform host has aborted and that still counts as hanging.
    virtual void note_used(std::size_t component, Duration used) noexcept = 0;

  protected:
    constexpr ExecutionDisplay() noexcept = default;
    ~ExecutionDisplay() = default;
};

}  // namespace mamori::detail

#endif  // MAMORI_KERNEL_EXECUTION_DISPLAY_HPP
