// SPDX-License-Identifier: Apache-2.0
/// @file
/// Operations of a context whose actions an ActionCaller calls. Alone in its file: a program without a guard
/// does not link it.
///
/// @satisfies SWR-KRN-090, SWR-KRN-093      Design: docs/design/kernel.md#actions-outside-windows
#include "context_start.hpp"

namespace mamori {

Status ExecutionContext::start(Instant now, ActionCaller& caller) noexcept {
    return start_by(now, caller);
}

Status ExecutionContext::stop(Instant now, ActionCaller& caller) noexcept {
    return stop_by(now, caller);
}

Status ExecutionContext::activate_component(const Component& component, Instant now,
                                            ActionCaller& caller) noexcept {
    const Result<std::size_t> index = admit(component, LifecycleEvent::kActivate);
    return index.has_value() ? act(ComponentAction::kActivated, index.get_value(), now, caller)
                             : index.get_status();
}

Status ExecutionContext::deactivate_component(const Component& component, Instant now,
                                              ActionCaller& caller) noexcept {
    const Result<std::size_t> index = admit(component, LifecycleEvent::kDeactivate);
    return index.has_value() ? act(ComponentAction::kDeactivated, index.get_value(), now, caller)
                             : index.get_status();
}

/// Precondition: the context is idle.
Status ExecutionContext::act(ComponentAction action, std::size_t position, Instant now,
                             ActionCaller& caller) noexcept {
    action_ = action;
    cycle_start_ = now;
    const bool has_returned = caller.call(
        {&run_action, this, static_cast<std::size_t>(id_), position, position, 1U, WindowHost::Pass::kAction},
        action);
    return has_returned ? action_result_ : Status::kError;
}

/// As WindowHost::Work::run. An action that was aborted before its start is not called.
void ExecutionContext::run_action(void* argument, std::size_t position, std::size_t) noexcept {
    ExecutionContext& context = *static_cast<ExecutionContext*>(argument);
    if (context.is_busy()) {
        return;
    }
    const Component& component = *context.participants_[position];
    const Instant now = context.cycle_start_;
    const ComponentAction action = context.action_;
    if (action == ComponentAction::kActivated) {
        context.action_result_ = context.activate_component(component, now);
    } else if (action == ComponentAction::kDeactivated) {
        context.action_result_ = context.deactivate_component(component, now);
    } else {
        context.action_result_ = context.act(action, position, now);
    }
}

}  // namespace mamori
