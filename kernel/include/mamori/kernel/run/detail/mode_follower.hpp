// SPDX-License-Identifier: Apache-2.0
/// @file
/// Part of an executive that executes on its core the step that SystemModes agreed on: parameters,
/// connections and components of a mode, per window at its first start in the major frame. Not for users.
///
/// @satisfies SWR-MOD-005, SWR-MOD-008, SWR-MOD-009
/// Design:   docs/design/kernel.md#parts-of-the-executive, docs/design/modes.md#the-switch
#ifndef MAMORI_KERNEL_MODE_FOLLOWER_HPP
#define MAMORI_KERNEL_MODE_FOLLOWER_HPP

#include <cstddef>

#include "mamori/kernel/run/detail/core_state.hpp"
#include "mamori/kernel/run/detail/data_flow.hpp"
#include "mamori/kernel/run/detail/mode_execution.hpp"
#include "mamori/kernel/run/system_modes.hpp"

namespace mamori::detail {

/// Thread safety: as Executive.
/// Time:          O(components + connections + parameters) of the window; at a major frame boundary
///                O(windows) and the stopped windows. Nothing blocks beyond actions and platform host.
/// Memory:        the plan that this core follows; refers to SystemModes.
class ModeFollower final {
  public:
    /// @param[in] modes of all cores; nullptr: the table has neither modes nor configuration sets.
    constexpr ModeFollower(const CoreState& core, SystemModes* modes) noexcept
        : data_flow_(core), modes_(modes), execution_(modes) {}
    ModeFollower(const ModeFollower&) = delete;
    ModeFollower& operator=(const ModeFollower&) = delete;

    DataFlow& get_data_flow() noexcept { return data_flow_; }
    const DataFlow& get_data_flow() const noexcept { return data_flow_; }
    CoreState& get_core() noexcept { return data_flow_.get_core(); }

    /// Checks every value of every set and gives the parameters of the core their first values.
    /// @return kOk; kPreconditionNotMet (SystemModes is missing); kBadParameter (SystemModes is that of
    ///         another table or has no room for this core, or a value is rejected).
    Status initialize() noexcept { return is_used() ? execution_->initialize_core(*this) : judge_absence(); }
    /// Gives the parameters of the core their values and takes part in mode switches from now on.
    /// @return kOk; kPreconditionNotMet (other cores are switching modes); kBadParameter (a value is
    ///         rejected).
    Status join() noexcept { return is_used() ? execution_->join_core(*this) : Status::kOk; }
    /// Takes part in mode switches no longer, if the core took part.
    void leave() noexcept {
        if (has_joined_) {
            execution_->leave_core(*this);
        }
    }
    bool has_joined() const noexcept { return has_joined_; }
    /// The current mode; two modes between leaving one and entering the other; 0: no modes.
    ModeMask get_held_modes() const noexcept { return held_modes_; }

    /// Reports the end of the last plan and takes the next one. Call at the start of each major frame after
    /// join().
    void begin_frame() noexcept { execution_->begin_core_frame(*this); }

    /// @name In each window instance of a running context, if is_used(): open_window() before the cycle,
    /// close_window() after it.
    /// @{
    bool is_used() const noexcept { return modes_ != nullptr; }
    /// At the first start of the window in a major frame, gives it the parameters and connections of the
    /// plan. Then deactivates the components that leave. Each is called once, regardless of its result.
    /// @return the component that exhausted the budget; kNoIndex: none.
    std::size_t open_window(WindowState& state, Instant deadline, WindowHost& host) noexcept {
        return execution_->open_window(*this, state, deadline, host);
    }
    /// Activates the components that enter; none after a failure. @return as open_window().
    std::size_t close_window(WindowState& state, Instant deadline, WindowHost& host) noexcept {
        return execution_->close_window(*this, state, deadline, host);
    }
    /// End of the last mode step. The cycle of its window begins there.
    Instant get_last_step_end() const noexcept { return last_step_end_; }
    /// @}

  private:
    friend class mamori::SystemModes;

    Status judge_absence() const noexcept;
    Status initialize_parameters() noexcept;
    Status join_switches() noexcept;
    void take_next_plan() noexcept;
    void cross_boundary(WindowState& state) noexcept;
    std::size_t leave_components(WindowState& state, Instant deadline, WindowHost& host) noexcept;
    std::size_t enter_components(WindowState& state, Instant deadline, WindowHost& host) noexcept;
    bool check_set(std::size_t set) noexcept;
    Status prepare_parameters() noexcept;
    void take_plan(ModePlan plan, bool is_late) noexcept;
    bool take_set(std::size_t set) noexcept;
    void forget_set() noexcept;
    void report_plan() noexcept;
    void fail_step(ModeFailureCause cause, std::size_t component) noexcept;
    void cross_stopped_windows() noexcept;
    void prepare_window(WindowState& state) noexcept;
    bool run_step(WindowState& state, std::size_t position, Instant deadline, WindowHost& host) noexcept;
    static void activate_steps(void* argument, std::size_t first, std::size_t end) noexcept;
    static void deactivate_steps(void* argument, std::size_t first, std::size_t end) noexcept;

    DataFlow data_flow_;
    Instant last_step_end_{};
    SystemModes* modes_;
    ModeExecution* execution_;  ///< the same object, as far as this part needs it
    ModePlan plan_{};           ///< taken last
    ModeMask held_modes_{0U};
    ModeStep step_{ModeStep::kNone};  ///< of the plan; kNone: this core has nothing to execute
    bool is_plan_open_{false};        ///< the plan was taken and its end was not reported
    bool has_step_failed_{false};
    bool has_joined_{false};
};

}  // namespace mamori::detail

#endif  // MAMORI_KERNEL_MODE_FOLLOWER_HPP
