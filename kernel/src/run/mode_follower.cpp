// SPDX-License-Identifier: Apache-2.0
#include "mamori/kernel/run/detail/mode_follower.hpp"

namespace mamori::detail {

/// Whether every value of a set satisfies its constraint. The observer receives the first that does not.
bool ModeFollower::check_set(std::size_t set) noexcept {
    const CoreState& core = get_core();
    const ConfigurationFinding finding = modes_->get_configuration().judge_set(set);
    const bool is_accepted = finding.rule == ConfigurationRule::kNone;
    if (!is_accepted && core.observer != nullptr) {
        core.observer->on_configuration_refused(finding, core.release);
    }
    return is_accepted;
}

Status ModeFollower::initialize_parameters() noexcept {
    const CoreState& core = get_core();
    const SystemView& view = core.view;
    if (!modes_->is_of(view) || core.core >= kModeCoreMax) {
        return Status::kBadParameter;
    }
    // The compiler cannot check the values of a component that has no default constructor.
    for (std::size_t set = 0U; set < view.configuration.sets.size(); ++set) {
        if (!check_set(set)) {
            return Status::kBadParameter;
        }
    }
    return prepare_parameters();
}

/// This core has not joined, so none of its components is in an action and all its parameters can change at
/// once.
Status ModeFollower::prepare_parameters() noexcept {
    const CoreState& core = get_core();
    ConfigurationAdmin& configuration = modes_->get_configuration();
    const Result<std::size_t> prepared = modes_->prepare();
    const std::size_t set = prepared.has_value() ? prepared.get_value() : kNoConfigurationSet;
    for (const WindowRow& row : core.view.windows) {
        const Span<const ParameterRow> parameters =
            core.view.configuration.parameters.subspan(row.first_parameter, row.parameter_count);
        if (row.core != core.core) {
            continue;
        }
        if (set != kNoConfigurationSet) {
            configuration.activate_set(set, parameters);
        }
        ConfigurationAdmin::commit(parameters);
    }
    return prepared.get_status();
}

Status ModeFollower::join_switches() noexcept {
    const CoreState& core = get_core();
    Status result = prepare_parameters();
    if (result == Status::kOk) {
        result = modes_->join(core.core);
    }
    if (result != Status::kOk) {
        return result;
    }
    has_joined_ = true;
    plan_ = {};
    step_ = ModeStep::kNone;
    is_plan_open_ = false;
    held_modes_ = core.view.modes.modes.empty() ? 0U : to_mask(modes_->get_mode());
    for (WindowState& state : core.windows) {
        state.held_modes = held_modes_;
        state.prepared = {};
        state.done = {};
        state.next_leaving = 0U;
        state.set = kNoIndex;
    }
    return Status::kOk;
}

void ModeFollower::fail_step(ModeFailureCause cause, std::size_t component) noexcept {
    const CoreState& core = get_core();
    const ModeFailure failure{cause, plan_.get_step(), component};
    has_step_failed_ = true;
    static_cast<void>(modes_->fail(failure));
    if (core.observer != nullptr) {
        core.observer->on_mode_failure(failure, core.release);
    }
}

/// Reports to the other cores how the plan ended on this core, after each window had its major frame.
void ModeFollower::report_plan() noexcept {
    const CoreState& core = get_core();
    for (std::size_t w = 0U; w < core.view.windows.size(); ++w) {
        const WindowState& state = core.windows[w];
        if (!core.is_own(w) || state.done.get_word() == plan_.get_word()) {
            continue;
        }
        const Result<std::size_t> hanging = state.context.get_acting_position();
        if (plan_.get_step() == ModeStep::kSafe) {
            // A window that hangs or is stopped runs nothing more. Every other window must have completed.
            if (state.context.is_running() && !hanging.has_value()) {
                return;
            }
        } else if (!has_step_failed_) {
            const std::size_t position = hanging.has_value() ? hanging.get_value() : 0U;
            fail_step(ModeFailureCause::kNoTurn, core.view.windows[w].first_component + position);
        }
    }
    is_plan_open_ = false;
    modes_->finish(core.core, plan_);
}

void ModeFollower::take_next_plan() noexcept {
    const CoreState& core = get_core();
    const std::int64_t frame = core.frame_start.ns / core.view.frame.ns;
    if (is_plan_open_) {
        cross_stopped_windows();  // includes windows that were stopped before they ran
        report_plan();
    }
    const ModePlan plan = modes_->begin_frame(core.core, frame);
    const std::int32_t age = plan.calc_age(frame);
    if (plan.get_step() != ModeStep::kNone && plan.get_word() != plan_.get_word() && age >= 0) {
        take_plan(plan, age > 0);
    }
    cross_stopped_windows();
    if (plan.get_step() == ModeStep::kNone && plan_.get_step() == ModeStep::kSet) {
        forget_set();
    }
}

/// The same set can be requested again, also in a major frame in which its plan would have the same word.
void ModeFollower::forget_set() noexcept {
    plan_ = {};
    step_ = ModeStep::kNone;
    for (WindowState& state : get_core().windows) {
        state.prepared = {};
        state.done = {};
    }
    modes_->finish(get_core().core, plan_);
}

/// Each window activates the set at its next boundary, however late that is if its work hangs.
/// @return false if the set is rejected; then no value of it becomes active.
bool ModeFollower::take_set(std::size_t set) noexcept {
    if (set == kNoIndex) {
        return true;
    }
    if (!check_set(set)) {
        return false;
    }
    for (WindowState& state : get_core().windows) {
        state.set = set;
    }
    return true;
}

void ModeFollower::take_plan(ModePlan plan, bool is_late) noexcept {
    const CoreState& core = get_core();
    const std::size_t index = plan.get_index();
    plan_ = plan;
    step_ = plan.get_step();
    is_plan_open_ = true;
    has_step_failed_ = false;
    if (core.observer != nullptr) {
        core.observer->on_mode_step(step_, index, core.release);
    }
    if (is_late) {
        fail_step(ModeFailureCause::kLate, kNoIndex);
    }
    switch (step_) {
        case ModeStep::kSet:
            // A rejected set changes nothing, so the mode remains.
            static_cast<void>(take_set(index));
            return;
        case ModeStep::kLeave:
            held_modes_ |= has_step_failed_ ? 0U : to_mask(index);
            return;
        case ModeStep::kEnter:
            if (!has_step_failed_ && !take_set(core.view.modes.modes[index].set)) {
                fail_step(ModeFailureCause::kParameters, kNoIndex);
            }
            held_modes_ = has_step_failed_ ? held_modes_ : to_mask(index);
            return;
        case ModeStep::kSafe:
            // A switch to the safe mode is never abandoned.
            static_cast<void>(take_set(core.view.modes.modes[index].set));
            held_modes_ = to_mask(index);
            return;
        case ModeStep::kNone:
            break;
    }
    MAMORI_INVARIANT(1, false);  // reached by a corrupted plan only
}

/// At that instant, no component of the window is in an action, and no other code reads its parameters and
/// inputs.
void ModeFollower::cross_boundary(WindowState& state) noexcept {
    const CoreState& core = get_core();
    if (state.crossed_at != core.frame_start) {
        state.crossed_at = core.frame_start;
        prepare_window(state);
    }
}

/// A stopped window does not start, and no component of it is in an action. Its boundary is the start of the
/// major frame.
void ModeFollower::cross_stopped_windows() noexcept {
    CoreState& core = get_core();
    for (std::size_t w = 0U; w < core.view.windows.size(); ++w) {
        if (core.is_own(w) && !core.windows[w].context.is_running()) {
            prepare_window(core.windows[w]);
        }
    }
}

/// Gives a window the parameters and connections of the plan.
void ModeFollower::prepare_window(WindowState& state) noexcept {
    const CoreState& core = get_core();
    const WindowRow& row = core.view.windows[state.get_window()];
    const Span<const ParameterRow> parameters =
        core.view.configuration.parameters.subspan(row.first_parameter, row.parameter_count);
    if (state.set != kNoIndex) {
        modes_->get_configuration().activate_set(state.set, parameters);
        state.set = kNoIndex;
    }
    if (state.prepared.get_word() != plan_.get_word()) {
        state.prepared = plan_;
        state.next_leaving = 0U;
        data_flow_.restart_inputs(state, held_modes_);
        if (step_ == ModeStep::kSet) {
            state.done = plan_;
        }
    }
    ConfigurationAdmin::commit(parameters);
}

void ModeFollower::activate_steps(void* argument, std::size_t first, std::size_t end) noexcept {
    WindowState& state = *static_cast<WindowState*>(argument);
    const SystemView& view = state.core->view;
    for (std::size_t i = first; i < end; ++i) {
        const Component& component = *view.components[view.windows[state.get_window()].first_component + i];
        static_cast<void>(state.context.activate_component(component, state.release));
    }
}

void ModeFollower::deactivate_steps(void* argument, std::size_t first, std::size_t end) noexcept {
    WindowState& state = *static_cast<WindowState*>(argument);
    const SystemView& view = state.core->view;
    for (std::size_t i = first; i < end; ++i) {
        const Component& component = *view.components[view.windows[state.get_window()].first_component + i];
        static_cast<void>(state.context.deactivate_component(component, state.release));
    }
}

/// Deactivates or activates one component under the budget of its window.
/// @return false if the budget was exhausted.
bool ModeFollower::run_step(WindowState& state, std::size_t position, Instant deadline,
                            WindowHost& host) noexcept {
    const CoreState& core = get_core();
    const std::size_t index = core.view.windows[state.get_window()].first_component + position;
    const auto step = step_ == ModeStep::kEnter ? &activate_steps : &deactivate_steps;
    if (host.run_within({step, &state, state.get_window(), index, position, 1U, WindowHost::Pass::kModeStep},
                        deadline) == 0U) {
        fail_step(ModeFailureCause::kOverrun, index);
        return false;
    }
    last_step_end_ = host.get_now();
    // A component that leaves has had no other action since its window started.
    const ActionFailure& answer = core.view.components[index]->get_last_failure();
    const bool is_refused = step_ == ModeStep::kEnter
                                ? state.context.get_state_at(position) != LifecycleState::kActive
                                : answer.status != Status::kOk && answer.at == core.release;
    if (is_refused) {
        fail_step(ModeFailureCause::kRefused, index);
    }
    return true;
}

std::size_t ModeFollower::leave_components(WindowState& state, Instant deadline, WindowHost& host) noexcept {
    const CoreState& core = get_core();
    if (step_ != ModeStep::kLeave && step_ != ModeStep::kSafe) {
        return kNoIndex;
    }
    const WindowRow& row = core.view.windows[state.get_window()];
    const ModeMask target = to_mask(plan_.get_index());
    for (std::size_t position = state.next_leaving; position < row.component_count; ++position) {
        state.next_leaving = position + 1U;
        const std::size_t index = row.first_component + position;
        const bool stays = (core.view.component_rows[index].modes & target) != 0U;
        if (stays || state.context.get_state_at(position) != LifecycleState::kActive) {
            continue;
        }
        if (!run_step(state, position, deadline, host)) {
            return index;
        }
        data_flow_.discard_outputs_of(index);
    }
    state.done = plan_;
    return kNoIndex;
}

std::size_t ModeFollower::enter_components(WindowState& state, Instant deadline, WindowHost& host) noexcept {
    const CoreState& core = get_core();
    if (step_ != ModeStep::kEnter || state.done.get_word() == plan_.get_word()) {
        return kNoIndex;
    }
    const WindowRow& row = core.view.windows[state.get_window()];
    const ModeMask target = to_mask(plan_.get_index());
    for (std::size_t i = 0U; i < row.component_count && !has_step_failed_; ++i) {
        const std::size_t index = row.first_component + i;
        const bool enters = (core.view.component_rows[index].modes & target) != 0U;
        if (enters && state.context.get_state_at(i) != LifecycleState::kActive &&
            !run_step(state, i, deadline, host)) {
            return index;
        }
    }
    state.done = plan_;
    return kNoIndex;
}

}  // namespace mamori::detail

namespace mamori {

using detail::ModeFollower;
using detail::WindowState;

Status SystemModes::initialize_core(ModeFollower& follower) noexcept {
    return follower.initialize_parameters();
}

Status SystemModes::join_core(ModeFollower& follower) noexcept {
    return follower.join_switches();
}

void SystemModes::leave_core(ModeFollower& follower) noexcept {
    follower.has_joined_ = false;
    leave(follower.get_core().core);
}

void SystemModes::begin_core_frame(ModeFollower& follower) noexcept {
    follower.take_next_plan();
}

std::size_t SystemModes::open_window(ModeFollower& follower, WindowState& state, Instant deadline,
                                     WindowHost& host) noexcept {
    follower.cross_boundary(state);
    return follower.leave_components(state, deadline, host);
}

std::size_t SystemModes::close_window(ModeFollower& follower, WindowState& state, Instant deadline,
                                      WindowHost& host) noexcept {
    return follower.enter_components(state, deadline, host);
}

}  // namespace mamori
