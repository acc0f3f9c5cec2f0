// SPDX-License-Identifier: Apache-2.0
/// @file
/// What an executive tells about its own course: a record of the runs of each component, and a call for what
/// is rare. Supervision listens here, so that it does not depend on the help of the code it supervises.
///
/// @satisfies SWR-KRN-030, SWR-KRN-031, SWR-MOD-005      Design: docs/design/kernel.md#observation
#ifndef MAMORI_KERNEL_EXECUTION_OBSERVER_HPP
#define MAMORI_KERNEL_EXECUTION_OBSERVER_HPP

#include <cstddef>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/time.hpp"
#include "mamori/kernel/component/execution_record.hpp"
#include "mamori/kernel/parameter/configuration_table.hpp"
#include "mamori/kernel/run/mode_step.hpp"

namespace mamori {

/// Listener to one executive. Indices are positions in the system table (components, windows). `now` is the
/// host's time in on_budget_overrun and on_late_release, else the planned opening of the window that runs, or
/// ran last (zero before the first one).
///
/// Calling context: the context that runs the windows, except on_budget_overrun, which a port's guard may
/// call from its own context. Implementations must not block and must be O(1); operations on the executive
/// are refused while it calls.
class ExecutionObserver {
  public:
    /// Where the executive notes the runs of component i, element i; empty: nobody measures them. A run
    /// begins at the window's opening or the end of the turn before.
    Span<ExecutionRecord> get_records() const noexcept { return records_; }

    /// Window `window` used its budget up while `component` was running, in either pass, in a switch of modes
    /// or in a late stop, or could not begin because `component` still hangs from before; its outputs are not
    /// published.
    virtual void on_budget_overrun(std::size_t window, std::size_t component, Instant now) noexcept = 0;
    /// Window `window` opened `lateness` (> 0) after its place in the frame; called before its components
    /// run.
    virtual void on_late_release(std::size_t window, Duration lateness, Instant now) noexcept = 0;
    /// This core begins a step of a switch. @param[in] index mode, or configuration set of kSet.
    virtual void on_mode_step(ModeStep step, std::size_t index, Instant now) noexcept {
        static_cast<void>(step);
        static_cast<void>(index);
        static_cast<void>(now);
    }
    /// A step of a switch failed on this core; a system with modes goes to its safe mode.
    virtual void on_mode_failure(const ModeFailure& failure, Instant now) noexcept {
        static_cast<void>(failure);
        static_cast<void>(now);
    }
    /// A configuration set was refused: no value of it was switched. initialize() judges every set of the
    /// table, so a later refusal, at a frame boundary, shows that memory is corrupted.
    virtual void on_configuration_refused(const ConfigurationFinding& finding, Instant now) noexcept {
        static_cast<void>(finding);
        static_cast<void>(now);
    }

  protected:
    /// @param[in] records one per component of the system table or more, which must outlive the observer; or
    ///            none.
    constexpr explicit ExecutionObserver(Span<ExecutionRecord> records = {}) noexcept : records_(records) {}
    ~ExecutionObserver() = default;

  private:
    Span<ExecutionRecord> records_;
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_EXECUTION_OBSERVER_HPP
