// SPDX-License-Identifier: Apache-2.0
/// @file
/// Observation of one executive: execution records of each component, and calls for rare events. Supervision
/// uses it, so that it does not depend on the cooperation of the supervised code.
///
/// @satisfies SWR-KRN-030, SWR-KRN-031, SWR-KRN-055, SWR-MOD-005      Design:
/// docs/design/kernel.md#observation
#ifndef MAMORI_KERNEL_EXECUTION_OBSERVER_HPP
#define MAMORI_KERNEL_EXECUTION_OBSERVER_HPP

#include <cstddef>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/time.hpp"
#include "mamori/kernel/component/execution_record.hpp"
#include "mamori/kernel/parameter/configuration_table.hpp"
#include "mamori/kernel/run/mode_step.hpp"

namespace mamori {

/// Observer of one executive. Indices are positions in the system table (components, windows, ports). `now`
/// is the time of the platform host in on_budget_overrun and on_late_release. In the other calls it is the
/// planned start of the current or last window instance (zero before the first one).
///
/// Calling context: the context that runs the windows, except on_budget_overrun, which the guard of a port
///                  may call from its own context. Implementations must not block and must be O(1).
///                  Operations on the executive are rejected during a call.
class ExecutionObserver {
  public:
    /// Storage in which the executive records the execution of component i, in element i; empty: no
    /// measurement. An execution is measured from the window start or the end of the previous invocation.
    Span<ExecutionRecord> get_records() const noexcept { return records_; }

    /// Window `window` exhausted its budget while `component` was running: in either pass, in a mode switch
    /// or in a late stop. Or the window could not start because earlier work of `component` still hangs. The
    /// outputs of the window are not published.
    virtual void on_budget_overrun(std::size_t window, std::size_t component, Instant now) noexcept = 0;
    /// Window `window` started `lateness` (> 0) after its planned start; called before its components run.
    virtual void on_late_release(std::size_t window, Duration lateness, Instant now) noexcept = 0;
    /// Values of output `port` were lost: their window was discarded, or a queue that the output writes to or
    /// a QueueOutPort was full. At most one call per port and major frame; PortCounts of the port and of the
    /// inputs that it feeds contain the numbers.
    virtual void on_values_lost(std::size_t port, Instant now) noexcept {
        static_cast<void>(port);
        static_cast<void>(now);
    }
    /// This core starts a step of a mode switch. @param[in] index mode, or configuration set of kSet.
    virtual void on_mode_step(ModeStep step, std::size_t index, Instant now) noexcept {
        static_cast<void>(step);
        static_cast<void>(index);
        static_cast<void>(now);
    }
    /// A step of a mode switch failed on this core; a system with modes switches to its safe mode.
    virtual void on_mode_failure(const ModeFailure& failure, Instant now) noexcept {
        static_cast<void>(failure);
        static_cast<void>(now);
    }
    /// A configuration set was rejected; no value of it is activated. initialize() checks every set of the
    /// table, so a later rejection at a major frame boundary indicates corrupted memory.
    virtual void on_configuration_refused(const ConfigurationFinding& finding, Instant now) noexcept {
        static_cast<void>(finding);
        static_cast<void>(now);
    }

  protected:
    /// @param[in] records at least one per component of the system table, or none; must outlive the observer.
    constexpr explicit ExecutionObserver(Span<ExecutionRecord> records = {}) noexcept : records_(records) {}
    ~ExecutionObserver() = default;

  private:
    Span<ExecutionRecord> records_;
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_EXECUTION_OBSERVER_HPP
