// SPDX-License-Identifier: Apache-2.0
// Operations of an executive under a guard. Alone in its file: a program without a guard does not link it.
#include "mamori/kernel/run/action_guard.hpp"

#include "mamori/kernel/run/executive.hpp"
#include "system_start.hpp"

namespace mamori {

namespace detail {
namespace {

Component& get_component(const WindowState& state, std::size_t position) noexcept {
    const SystemView& view = state.core->view;
    return *view.components[view.windows[state.get_window()].first_component + position];
}

// As WindowHost::Work::run. An action that was aborted before its start is not called.
void initialize_step(void* argument, std::size_t position, std::size_t) noexcept {
    WindowState& state = *static_cast<WindowState*>(argument);
    if (state.context.is_busy()) {
        return;
    }
    state.life_result = static_cast<std::uint8_t>(get_component(state, position).initialize());
}

void finalize_step(void* argument, std::size_t position, std::size_t) noexcept {
    WindowState& state = *static_cast<WindowState*>(argument);
    if (state.context.is_busy()) {
        return;
    }
    state.life_result = static_cast<std::uint8_t>(get_component(state, position).finalize());
}

Status change_life(const CoreState& core, std::size_t component, ComponentAction action,
                   ActionGuard& guard) noexcept {
    const std::size_t window = core.view.component_rows[component].window;
    const std::size_t position = component - core.view.windows[window].first_component;
    WindowState& state = core.windows[window];
    if (state.context.is_busy()) {
        return Status::kPreconditionNotMet;
    }
    const auto step = action == ComponentAction::kInitialize ? &initialize_step : &finalize_step;
    const bool has_returned =
        guard.call({step, &state, window, component, position, 1U, WindowHost::Pass::kAction}, action);
    return has_returned ? static_cast<Status>(state.life_result) : Status::kError;
}

}  // namespace

Status initialize_component(const CoreState& core, std::size_t component, ActionGuard& guard) noexcept {
    return change_life(core, component, ComponentAction::kInitialize, guard);
}

Status finalize_component(const CoreState& core, std::size_t component, ActionGuard& guard) noexcept {
    return change_life(core, component, ComponentAction::kFinalize, guard);
}

}  // namespace detail

bool ActionGuard::run(const WindowHost::Work& work, ComponentAction action) noexcept {
    WindowHost::Work step = work;
    step.component = core_->view.windows[work.window].first_component + work.first;
    if (host_.run_within(step, host_.get_now() + budget_) != 0U) {
        return true;
    }
    // Until it is readmitted, no further action of the window is called, even if the work has returned now.
    detail::WindowState& state = core_->windows[work.window];
    state.context.abandon(work.first);
    state.cut_by = &host_;
    on_action_overrun(step.component, action);
    if (core_->observer != nullptr) {
        core_->observer->on_budget_overrun(work.window, step.component, host_.get_now());
    }
    return false;
}

Status Executive::initialize(ActionGuard& guard) noexcept {
    if (is_busy_ || !life_.may_initialize()) {
        return Status::kPreconditionNotMet;
    }
    begin_operation(guard);
    const Status result = life_.initialize(guard);
    end_operation();
    return result;
}

Status Executive::start(ActionGuard& guard) noexcept {
    if (is_busy_ || !life_.may_start()) {
        return Status::kPreconditionNotMet;
    }
    begin_operation(guard);
    const Status result = life_.start(guard);
    end_operation();
    return result;
}

Status Executive::stop(ActionGuard& guard) noexcept {
    if (is_busy_ || !life_.may_stop()) {
        return Status::kPreconditionNotMet;
    }
    begin_operation(guard);
    const Status result = life_.stop(guard);
    end_operation();
    return result;
}

Status Executive::finalize(ActionGuard& guard) noexcept {
    if (is_busy_ || !life_.may_finalize()) {
        return Status::kPreconditionNotMet;
    }
    begin_operation(guard);
    const Status result = life_.finalize(guard);
    end_operation();
    return result;
}

void Executive::begin_operation(ActionGuard& guard) noexcept {
    is_busy_ = true;
    guard.attach(life_.get_core());
}

}  // namespace mamori
