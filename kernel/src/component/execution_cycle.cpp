// SPDX-License-Identifier: Apache-2.0
// One cycle of an execution context, step by step. The other operations: execution_context.cpp.
#ifndef __clang__
// g++ would keep two indices of the unrolled loop, one on the stack: one more instruction per component. Not
// a command line option, because clang-tidy reads the options and rejects those that clang lacks.
#pragma GCC optimize("no-split-ivs-in-unroller")
#endif

#include "action_scope.hpp"
#include "mamori/kernel/component/detail/event_server.hpp"
#include "mamori/kernel/component/execution_context.hpp"
#include "mamori/kernel/component/external_trigger.hpp"
#include "mamori/kernel/component/multi_mode.hpp"

namespace mamori {

bool ExecutionContext::take_tick() noexcept {
    return plan_.trigger->take();
}

/// True when the steps `first` .. `end` - 1 may start. Work that was aborted before its start is rejected
/// here; outside a cycle, no other work exists.
bool ExecutionContext::admits_steps(std::size_t first, std::size_t end) const noexcept {
    const Phase phase = phase_.load(std::memory_order_acquire);
    MAMORI_REQUIRE(1, phase != Phase::kIdle);
    MAMORI_REQUIRE(4, first <= end && end <= participants_.size());
    return phase == Phase::kInCycle;
}

/// The loop is in this function, so that on_execute is only one call away from the platform host. One
/// instance per common observation, so that a step performs no check that its pass does not need.
template <ExecutionContext::StepObservation kObservation>
void ExecutionContext::run_first_pass(void* argument, std::size_t first, std::size_t end) noexcept {
    constexpr bool kIsObserved = kObservation != StepObservation::kNone;
    StepObserver* const observer = kIsObserved ? static_cast<StepObserver*>(argument) : nullptr;
    ExecutionContext& context = *(kIsObserved ? observer->context : static_cast<ExecutionContext*>(argument));
    if (!context.admits_steps(first, end)) {
        return;
    }
    Component* const* const participants = context.participants_.data();
    ExecutionRecord* const records = kIsObserved ? observer->records : nullptr;
    const ContextHandle handle = context.make_handle(context.cycle_start_);
    const ActionScope scope{context, first};
    // Eight call addresses: a branch predictor selects the target by the address of the call, and some
    // predictors cannot keep all components for one address (docs/design/kernel.md#execution-context). The
    // pragma has no effect with -Os.
#pragma GCC unroll 8
    for (std::size_t i = first; i < end; ++i) {
        context.move_to(i);
        Component& component = *participants[i];
        if (component.turn_ != 0U) {
            [[maybe_unused]] const bool was_active = context.execute_unusual(i);
            if (!context.is_in_cycle()) {
                return;  // aborted: the cycle of this step has ended
            }
            if constexpr (kIsObserved) {
                end_step(*observer, i, was_active);
            }
            continue;
        }
        const Status answer = component.on_execute(handle);
        // One comparison for both, because both are 0 in almost all steps.
        static_assert(Phase::kInCycle == Phase{} && Status::kOk == Status{});
        const Phase phase = context.phase_.load(std::memory_order_relaxed);
        if ((static_cast<unsigned>(phase) | static_cast<unsigned>(answer)) != 0U) {
            context.judge_execution(i, answer);
            if (!context.is_in_cycle()) {
                return;
            }
        }
        if constexpr (kObservation == StepObservation::kRecords) {
            static_cast<void>(observer->measure(records[i]));
        } else if constexpr (kIsObserved) {
            end_step(*observer, i, true);
        }
    }
}

ExecutionContext::Pass ExecutionContext::get_first_pass() noexcept {
    return &run_first_pass<StepObservation::kNone>;
}

ExecutionContext::Pass ExecutionContext::get_observed_pass(StepObservation observation) noexcept {
    return observation == StepObservation::kRecords ? &run_first_pass<StepObservation::kRecords>
                                                    : &run_first_pass<StepObservation::kAfterStep>;
}

/// Performs all observations that may be required after a step.
void ExecutionContext::end_step(StepObserver& observer, std::size_t position, bool was_active) noexcept {
    Duration used{-1};
    if (observer.records != nullptr && was_active) {
        used = observer.measure(observer.records[position]);
    } else if (observer.records != nullptr) {
        // A step in Error or Inactive does not indicate that the component is alive.
        observer.step_start = observer.host->get_step_end();
    }
    if (observer.after_step != nullptr) {
        observer.after_step(observer.argument, position, used);
    }
}

/// Invocation of a participant that is not on_execute alone. @return true when it was Active before.
bool ExecutionContext::execute_unusual(std::size_t position) noexcept {
    Component& component = *participants_[position];
    const ContextHandle handle = make_handle(cycle_start_);
    const bool is_data_flow = plan_.kind != ExecutionKind::kEventDriven;
    const LifecycleState state = component.get_state();
    switch (state) {
        case LifecycleState::kError:
            give_notices(component, handle);
            if (is_data_flow || component.machine_ != nullptr) {
                static_cast<void>(component.on_error(handle));
            }
            return false;
        case LifecycleState::kActive:
            give_notices(component, handle);
            // A notification may have led to Error. Then the invocation ends, as after a failed on_execute.
            if (component.get_state() != LifecycleState::kActive) {
                return true;
            }
            if (is_data_flow) {
                judge(component, ComponentAction::kExecute, component.on_execute(handle), handle);
            } else if (component.machine_ != nullptr) {
                component.machine_->serve(*this, component, handle);
            }
            return true;
        case LifecycleState::kInactive:
            give_notices(component, handle);
            return false;
        case LifecycleState::kCreated:
            return false;
    }
    MAMORI_INVARIANT(2, false);  // only a corrupted state gets here
    return false;
}

void ExecutionContext::judge_execution(std::size_t position, Status answer) noexcept {
    judge(*participants_[position], ComponentAction::kExecute, answer, make_handle(cycle_start_));
}

void ExecutionContext::give_notices(Component& component, ContextHandle handle) noexcept {
    const std::uint32_t notices = component.turn_;
    component.turn_ &= ~Component::kNotices;
    if ((notices & Component::kRateNotice) != 0U) {
        judge(component, ComponentAction::kRateChanged, component.on_rate_changed(handle), handle);
    }
    if ((notices & Component::kModeNotice) != 0U && component.mode_switch_->take_change()) {
        judge(component, ComponentAction::kModeChanged, component.on_mode_changed(handle), handle);
    }
}

Status ExecutionContext::tell_mode(Component& component, Instant now) noexcept {
    if (is_busy() || !component.is_alive() || !component.mode_switch_->take_change()) {
        // Busy or not alive: the next invocation reports the change. Otherwise, the mode was changed back.
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

void ExecutionContext::run_second_pass(void* argument, std::size_t first, std::size_t end) noexcept {
    ExecutionContext& context = *static_cast<ExecutionContext*>(argument);
    if (!context.admits_steps(first, end) || context.plan_.kind == ExecutionKind::kEventDriven) {
        return;
    }
    const ContextHandle handle = context.make_handle(context.cycle_start_);
    const ActionScope scope{context, first};
    for (std::size_t i = first; i < end && context.is_in_cycle(); ++i) {
        Component& component = *context.participants_.data()[i];
        if (component.get_state() != LifecycleState::kActive) {
            continue;
        }
        context.move_to(i);
        const Status answer = component.on_state_update(handle);
        if (answer != Status::kOk) {
            context.judge(component, ComponentAction::kStateUpdate, answer, handle);
        }
    }
}

}  // namespace mamori
