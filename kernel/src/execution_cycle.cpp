// SPDX-License-Identifier: Apache-2.0
// One cycle of an execution context, step by step. What the operations do: execution_context.cpp.
#include "action_scope.hpp"
#include "mamori/kernel/execution_context.hpp"
#include "mamori/kernel/external_trigger.hpp"

namespace mamori {

bool ExecutionContext::take_turn() noexcept {
    if (!is_running_) {
        return false;
    }
    if (plan_.trigger != nullptr) {
        return plan_.trigger->take();
    }
    if (windows_to_skip_ > 0) {
        --windows_to_skip_;
        return false;
    }
    windows_to_skip_ = divisor_ - 1;
    return true;
}

Status ExecutionContext::begin_cycle(Instant now) noexcept {
    if (!is_running_ || is_busy()) {
        return Status::kPreconditionNotMet;
    }
    is_in_cycle_.store(true, std::memory_order_relaxed);
    cycle_start_ = now;
    return Status::kOk;
}

void ExecutionContext::execute_range(std::size_t first, std::size_t count, AfterStep after) noexcept {
    MAMORI_REQUIRE(1, is_in_cycle());
    const Span<Component* const> range = participants_.subspan(first, count);
    const ContextHandle handle = make_handle(cycle_start_);
    ActionScope scope{*this, first};
    for (std::size_t i = 0U; i < count && is_in_cycle(); ++i) {
        scope.move_to(first + i);
        Component& component = *range.data()[i];
        if (component.get_state() != LifecycleState::kActive || component.notices_ != 0U) {
            execute_unusual(component, handle);
        } else {
            const Status answer = component.on_execute(handle);
            if (answer != Status::kOk) {
                judge(component, ComponentAction::kExecute, answer, handle);
            }
        }
        if (after.function != nullptr && is_in_cycle()) {
            after.function(after.argument, first + i);
        }
    }
}

void ExecutionContext::execute_unusual(Component& component, ContextHandle handle) noexcept {
    const LifecycleState state = component.get_state();
    if (state != LifecycleState::kCreated) {
        give_notices(component, handle);
    }
    switch (state) {
        case LifecycleState::kError:
            static_cast<void>(component.on_error(handle));
            return;
        case LifecycleState::kActive:
            // A notice may have led to Error; then this turn is over, as after a failed on_execute.
            if (component.get_state() == LifecycleState::kActive) {
                judge(component, ComponentAction::kExecute, component.on_execute(handle), handle);
            }
            return;
        case LifecycleState::kCreated:
        case LifecycleState::kInactive:
            return;
    }
    MAMORI_INVARIANT(2, false);  // only a corrupted state comes here
}

void ExecutionContext::give_notices(Component& component, ContextHandle handle) noexcept {
    const std::uint32_t notices = component.notices_;
    component.notices_ = 0U;
    if ((notices & Component::kRateNotice) != 0U) {
        judge(component, ComponentAction::kRateChanged, component.on_rate_changed(handle), handle);
    }
}

void ExecutionContext::judge(Component& component, ComponentAction action, Status answer,
                             ContextHandle handle) noexcept {
    note(component, action, answer, handle);
    if (answer != Status::kOk && component.get_state() == LifecycleState::kActive) {
        enter_error(component, handle);
    }
}

void ExecutionContext::update_range(std::size_t first, std::size_t count) noexcept {
    MAMORI_REQUIRE(3, is_in_cycle());
    const Span<Component* const> range = participants_.subspan(first, count);
    const ContextHandle handle = make_handle(cycle_start_);
    ActionScope scope{*this, first};
    for (std::size_t i = 0U; i < count && is_in_cycle(); ++i) {
        Component& component = *range.data()[i];
        if (component.get_state() != LifecycleState::kActive) {
            continue;
        }
        scope.move_to(first + i);
        const Status answer = component.on_state_update(handle);
        if (answer != Status::kOk) {
            judge(component, ComponentAction::kStateUpdate, answer, handle);
        }
    }
}

}  // namespace mamori
