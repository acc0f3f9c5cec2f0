// SPDX-License-Identifier: Apache-2.0
// How an executive carries out what SystemModes agreed on: parameters, connections and components of a mode,
// each window at its first opening in the frame. What it does otherwise: executive.cpp.
#include "mamori/kernel/run/executive.hpp"

namespace mamori {

/// Whether every value of a set satisfies its constraint; the observer hears of the first one that does not.
bool Executive::judge_set(std::size_t set) noexcept {
    const ConfigurationFinding finding = modes_->get_configuration().judge_set(set);
    const bool is_accepted = finding.rule == ConfigurationRule::kNone;
    if (!is_accepted && observer_ != nullptr) {
        observer_->on_configuration_refused(finding, last_release_);
    }
    return is_accepted;
}

/// No component is in an action, on no core that has joined: parameters may change all at once.
Status Executive::prepare_parameters() noexcept {
    if (modes_ == nullptr) {
        const bool is_needed = !view_.modes.modes.empty() || !view_.configuration.sets.empty();
        return is_needed ? Status::kPreconditionNotMet : Status::kOk;
    }
    if (!modes_->is_of(view_) || core_ >= kModeCoreMax) {
        return Status::kBadParameter;
    }
    // The compiler could not judge the values of a component that has no default constructor.
    for (std::size_t set = 0U; !is_initialized_ && set < view_.configuration.sets.size(); ++set) {
        if (!judge_set(set)) {
            return Status::kBadParameter;
        }
    }
    ConfigurationAdmin& configuration = modes_->get_configuration();
    const Result<std::size_t> prepared = modes_->prepare();
    const std::size_t set = prepared.has_value() ? prepared.get_value() : kNoConfigurationSet;
    for (const WindowRow& row : view_.windows) {
        const Span<const ParameterRow> parameters =
            view_.configuration.parameters.subspan(row.first_parameter, row.parameter_count);
        if (row.core != core_) {
            continue;
        }
        if (set != kNoConfigurationSet) {
            configuration.activate_set(set, parameters);
        }
        ConfigurationAdmin::commit(parameters);
    }
    return prepared.get_status();
}

Status Executive::join_modes() noexcept {
    if (modes_ == nullptr) {
        return Status::kOk;
    }
    Status result = prepare_parameters();
    if (result == Status::kOk) {
        result = modes_->join(core_);
    }
    if (result != Status::kOk) {
        return result;
    }
    has_joined_ = true;
    plan_ = {};
    step_ = ModeStep::kNone;
    is_plan_open_ = false;
    held_modes_ = view_.modes.modes.empty() ? 0U : to_mask(modes_->get_mode());
    for (detail::WindowState& state : windows_) {
        state.held_modes = held_modes_;
        state.prepared = {};
        state.done = {};
        state.next_leaving = 0U;
        state.set = kNoIndex;
    }
    return Status::kOk;
}

void Executive::fail_step(ModeFailureCause cause, std::size_t component) noexcept {
    const ModeFailure failure{cause, plan_.get_step(), component};
    has_step_failed_ = true;
    static_cast<void>(modes_->fail(failure));
    if (observer_ != nullptr) {
        observer_->on_mode_failure(failure, last_release_);
    }
}

/// Tells the other cores how the plan ended here, once each window has had its frame.
void Executive::report_plan() noexcept {
    for (std::size_t w = 0U; w < view_.windows.size(); ++w) {
        const detail::WindowState& state = windows_[w];
        if (!is_own(w) || state.done.get_word() == plan_.get_word()) {
            continue;
        }
        const Result<std::size_t> hanging = state.context.get_acting_position();
        if (plan_.get_step() == ModeStep::kSafe) {
            // What hangs or is stopped does nothing any more; everything else must have come through.
            if (state.context.is_running() && !hanging.has_value()) {
                return;
            }
        } else if (!has_step_failed_) {
            const std::size_t position = hanging.has_value() ? hanging.get_value() : 0U;
            fail_step(ModeFailureCause::kNoTurn, view_.windows[w].first_component + position);
        }
    }
    is_plan_open_ = false;
    modes_->finish(core_, plan_);
}

void Executive::begin_modes(std::int64_t frame) noexcept {
    if (is_plan_open_) {
        cross_stopped_windows();  // also those that were stopped before their turn
        report_plan();
    }
    const ModePlan plan = modes_->begin_frame(core_, frame);
    const std::int32_t age = plan.calc_age(frame);
    if (plan.get_step() != ModeStep::kNone && plan.get_word() != plan_.get_word() && age >= 0) {
        take_plan(plan, age > 0);
    }
    cross_stopped_windows();
    if (plan.get_step() == ModeStep::kNone && plan_.get_step() == ModeStep::kSet) {
        forget_set();
    }
}

/// A set can be asked for again: in the frame of which the plan would have the same word, too.
void Executive::forget_set() noexcept {
    plan_ = {};
    step_ = ModeStep::kNone;
    for (detail::WindowState& state : windows_) {
        state.prepared = {};
        state.done = {};
    }
    modes_->finish(core_, plan_);
}

/// Each window makes the set active at its next boundary, however long that takes when its work hangs.
/// @return false when the set is refused; then none of it becomes active.
bool Executive::take_set(std::size_t set) noexcept {
    if (set == kNoIndex) {
        return true;
    }
    if (!judge_set(set)) {
        return false;
    }
    for (detail::WindowState& state : windows_) {
        state.set = set;
    }
    return true;
}

void Executive::take_plan(ModePlan plan, bool is_late) noexcept {
    const std::size_t index = plan.get_index();
    plan_ = plan;
    step_ = plan.get_step();
    is_plan_open_ = true;
    has_step_failed_ = false;
    if (observer_ != nullptr) {
        observer_->on_mode_step(step_, index, last_release_);
    }
    if (is_late) {
        fail_step(ModeFailureCause::kLate, kNoIndex);
    }
    switch (step_) {
        case ModeStep::kSet:
            // A refused set changes nothing and is no reason to leave a mode.
            static_cast<void>(take_set(index));
            return;
        case ModeStep::kLeave:
            held_modes_ |= has_step_failed_ ? 0U : to_mask(index);
            return;
        case ModeStep::kEnter:
            if (!has_step_failed_ && !take_set(view_.modes.modes[index].set)) {
                fail_step(ModeFailureCause::kParameters, kNoIndex);
            }
            held_modes_ = has_step_failed_ ? held_modes_ : to_mask(index);
            return;
        case ModeStep::kSafe:
            // Going to the safe mode is never given up.
            static_cast<void>(take_set(view_.modes.modes[index].set));
            held_modes_ = to_mask(index);
            return;
        case ModeStep::kNone:
            break;
    }
    MAMORI_INVARIANT(1, false);  // only a corrupted plan comes here
}

/// An input whose connection ended or begins here has no value until one comes that belongs to the mode.
void Executive::restart_inputs(std::size_t window) noexcept {
    const WindowRow& row = view_.windows[window];
    detail::WindowState& state = windows_[window];
    const ModeMask before = state.held_modes;
    state.held_modes = held_modes_;
    const Span<const std::size_t> latched = view_.latch_order.subspan(row.first_latch, row.latch_count);
    // Those that end come first: on the way to the safe mode an input may lose one source and get another.
    for (const bool begins : {false, true}) {
        for (const std::size_t i : latched) {
            const ConnectionRow& connection = view_.connections[i];
            const bool was_held = is_held(connection, before);
            if (was_held != is_held(connection, state.held_modes) && was_held != begins) {
                connection.operations.restart(*connection.source, *connection.sink, frame_start_);
            }
        }
    }
}

/// What changes for a window at a frame boundary changes when it opens for the first time in the frame: its
/// components have come out of every action then, and nobody else looks at their parameters and inputs.
void Executive::cross_boundary(std::size_t window) noexcept {
    detail::WindowState& state = windows_[window];
    if (state.crossed_at != frame_start_) {
        state.crossed_at = frame_start_;
        prepare_window(window);
    }
}

/// A stopped window does not open. Nobody is in an action there, so the frame's beginning is its boundary.
void Executive::cross_stopped_windows() noexcept {
    for (std::size_t w = 0U; w < view_.windows.size(); ++w) {
        if (is_own(w) && !windows_[w].context.is_running()) {
            prepare_window(w);
        }
    }
}

/// Gives a window the parameters and connections of the plan that is taken.
void Executive::prepare_window(std::size_t window) noexcept {
    const WindowRow& row = view_.windows[window];
    detail::WindowState& state = windows_[window];
    const Span<const ParameterRow> parameters =
        view_.configuration.parameters.subspan(row.first_parameter, row.parameter_count);
    if (state.set != kNoIndex) {
        modes_->get_configuration().activate_set(state.set, parameters);
        state.set = kNoIndex;
    }
    if (state.prepared.get_word() != plan_.get_word()) {
        state.prepared = plan_;
        state.next_leaving = 0U;
        restart_inputs(window);
        if (step_ == ModeStep::kSet) {
            state.done = plan_;
        }
    }
    ConfigurationAdmin::commit(parameters);
}

void Executive::activate_steps(void* argument, std::size_t first, std::size_t end) noexcept {
    detail::WindowState& state = *static_cast<detail::WindowState*>(argument);
    const SystemView& view = state.executive->view_;
    for (std::size_t i = first; i < end; ++i) {
        const Component& component = *view.components[view.windows[state.window].first_component + i];
        static_cast<void>(state.context.activate_component(component, state.release));
    }
}

void Executive::deactivate_steps(void* argument, std::size_t first, std::size_t end) noexcept {
    detail::WindowState& state = *static_cast<detail::WindowState*>(argument);
    const SystemView& view = state.executive->view_;
    for (std::size_t i = first; i < end; ++i) {
        const Component& component = *view.components[view.windows[state.window].first_component + i];
        static_cast<void>(state.context.deactivate_component(component, state.release));
    }
}

/// Takes one component out of the mode before or into the next one, under the budget of its window.
/// @return false when the budget was used up.
bool Executive::take_step(std::size_t window, std::size_t position, Instant deadline,
                          WindowHost& host) noexcept {
    detail::WindowState& state = windows_[window];
    const std::size_t index = view_.windows[window].first_component + position;
    const auto step = step_ == ModeStep::kEnter ? &activate_steps : &deactivate_steps;
    if (host.run_within({step, &state, window, index, position, 1U, WindowHost::Pass::kModeStep}, deadline) ==
        0U) {
        fail_step(ModeFailureCause::kOverrun, index);
        return false;
    }
    last_step_end_ = host.get_now();
    // Nothing else was asked of a component that leaves since its window opened.
    const ActionFailure& answer = view_.components[index]->get_last_failure();
    const bool is_refused = step_ == ModeStep::kEnter
                                ? state.context.get_state_at(position) != LifecycleState::kActive
                                : answer.status != Status::kOk && answer.at == last_release_;
    if (is_refused) {
        fail_step(ModeFailureCause::kRefused, index);
    }
    return true;
}

/// Before the cycle: who leaves has no part in it. Each is asked once, whatever it answers.
/// @return the component that used the budget up; kNoIndex when none did.
std::size_t Executive::leave_components(std::size_t window, Instant deadline, WindowHost& host) noexcept {
    if (step_ != ModeStep::kLeave && step_ != ModeStep::kSafe) {
        return kNoIndex;
    }
    const WindowRow& row = view_.windows[window];
    detail::WindowState& state = windows_[window];
    const ModeMask target = to_mask(plan_.get_index());
    for (std::size_t position = state.next_leaving; position < row.component_count; ++position) {
        state.next_leaving = position + 1U;
        const std::size_t index = row.first_component + position;
        const bool stays = (view_.component_rows[index].modes & target) != 0U;
        if (stays || state.context.get_state_at(position) != LifecycleState::kActive) {
            continue;
        }
        if (!take_step(window, position, deadline, host)) {
            return index;
        }
        discard_outputs_of(index);
    }
    state.done = plan_;
    return kNoIndex;
}

/// After the cycle: who enters takes part from the next opening on. Nobody does after a failure.
/// @return as leave_components().
std::size_t Executive::enter_components(std::size_t window, Instant deadline, WindowHost& host) noexcept {
    if (step_ != ModeStep::kEnter || windows_[window].done.get_word() == plan_.get_word()) {
        return kNoIndex;
    }
    const WindowRow& row = view_.windows[window];
    detail::WindowState& state = windows_[window];
    const ModeMask target = to_mask(plan_.get_index());
    for (std::size_t i = 0U; i < row.component_count && !has_step_failed_; ++i) {
        const std::size_t index = row.first_component + i;
        const bool enters = (view_.component_rows[index].modes & target) != 0U;
        if (enters && state.context.get_state_at(i) != LifecycleState::kActive &&
            !take_step(window, i, deadline, host)) {
            return index;
        }
    }
    state.done = plan_;
    return kNoIndex;
}

}  // namespace mamori
