// SPDX-License-Identifier: Apache-2.0
// One cycle of an execution context, step by step. What the operations do: execution_context.cpp.
#include "action_scope.hpp"
#include "mamori/kernel/execution_context.hpp"
#include "mamori/kernel/external_trigger.hpp"
#include "mamori/kernel/introspection.hpp"
#include "mamori/kernel/multi_mode.hpp"

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

/// The turns of a range; `after(position, was_active)` comes after each that was not abandoned.
template <typename After>
void ExecutionContext::run_turns(std::size_t first, std::size_t count, const After& after) noexcept {
    const Span<Component* const> range = participants_.subspan(first, count);
    const ContextHandle handle = make_handle(cycle_start_);
    const bool is_data_flow = plan_.kind != ExecutionKind::kEventDriven;
    ActionScope scope{*this, first};
    for (std::size_t i = 0U; i < count && is_in_cycle(); ++i) {
        scope.move_to(first + i);
        Component& component = *range.data()[i];
        const bool was_active = component.get_state() == LifecycleState::kActive;
        if (was_active && component.notices_ == 0U && is_data_flow) {
            const Status answer = component.on_execute(handle);
            if (answer != Status::kOk) {
                judge(component, ComponentAction::kExecute, answer, handle);
            }
        } else {
            execute_unusual(component, handle, scope);
        }
        after(first + i, was_active);
    }
}

void ExecutionContext::execute_range(std::size_t first, std::size_t count, Follower* follower) noexcept {
    MAMORI_REQUIRE(1, is_in_cycle());
    if (follower == nullptr) {
        run_turns(first, count, [](std::size_t, bool) noexcept {});
        return;
    }
    run_turns(first, count, [this, follower](std::size_t position, bool was_active) noexcept {
        if (!is_in_cycle()) {
            return;  // abandoned: the cycle that this turn belonged to is over
        }
        if (follower->observer != nullptr) {
            const Instant started = follower->step_start;
            const Instant ended = follower->host->get_step_end();
            follower->step_start = ended;
            // Only on_execute is a sign of life: one in Error, or Inactive, gets its turn and does nothing
            // for anybody.
            if (was_active && ended <= follower->deadline) {
                follower->observer->on_component_executed(follower->first_component + position, started,
                                                          ended);
                if (follower->introspection != nullptr) {
                    follower->introspection->note_used(follower->first_component + position, ended - started);
                }
            }
        }
        if (follower->hand_on != nullptr) {
            follower->hand_on(follower->argument, position);
        }
    });
}

void ExecutionContext::execute_unusual(Component& component, ContextHandle handle,
                                       ActionScope& scope) noexcept {
    const bool is_data_flow = plan_.kind != ExecutionKind::kEventDriven;
    const LifecycleState state = component.get_state();
    switch (state) {
        case LifecycleState::kError:
            give_notices(component, handle);
            if (is_data_flow || component.machine_ != nullptr) {
                static_cast<void>(component.on_error(handle));
            }
            return;
        case LifecycleState::kActive:
            give_notices(component, handle);
            // A notice may have led to Error; then this turn is over, as after a failed on_execute.
            if (component.get_state() != LifecycleState::kActive) {
                return;
            }
            if (is_data_flow) {
                judge(component, ComponentAction::kExecute, component.on_execute(handle), handle);
            } else if (component.machine_ != nullptr) {
                serve_events(component, handle, scope);
            }
            return;
        case LifecycleState::kInactive:
            give_notices(component, handle);
            return;
        case LifecycleState::kCreated:
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
    if ((notices & Component::kModeNotice) != 0U && component.mode_switch_->take_change()) {
        judge(component, ComponentAction::kModeChanged, component.on_mode_changed(handle), handle);
    }
}

Status ExecutionContext::tell_mode(Component& component, Instant now) noexcept {
    if (is_busy() || !component.is_alive() || !component.mode_switch_->take_change()) {
        // Told in its next turn, which finds the notice; or changed back before anybody was told.
        return Status::kOk;
    }
    const ContextHandle handle = make_handle(now);
    const ActionScope scope{*this, component.position_};
    const Status answer = component.on_mode_changed(handle);
    judge(component, ComponentAction::kModeChanged, answer, handle);
    return answer;
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
    if (plan_.kind == ExecutionKind::kEventDriven) {
        return;
    }
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
