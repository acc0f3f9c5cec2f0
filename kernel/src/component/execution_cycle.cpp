// SPDX-License-Identifier: Apache-2.0
// One cycle of an execution context, step by step. What the operations do: execution_context.cpp.
#include "action_scope.hpp"
#include "mamori/kernel/component/execution_context.hpp"
#include "mamori/kernel/component/external_trigger.hpp"
#include "mamori/kernel/component/multi_mode.hpp"

namespace mamori {

bool ExecutionContext::take_tick() noexcept {
    return plan_.trigger->take();
}

/// Whether a range may begin. Work that was abandoned before it began finds out here; outside of a cycle
/// nobody else has any.
bool ExecutionContext::admits_steps() const noexcept {
    const Phase phase = phase_.load(std::memory_order_acquire);
    MAMORI_REQUIRE(1, phase != Phase::kIdle);
    return phase == Phase::kInCycle;
}

/// The turns of a range. `after(position)` comes after each usual one that was not abandoned, in place of
/// follow() and while the context still counts as acting.
template <typename After>
void ExecutionContext::run_turns(std::size_t first, std::size_t count, Follower* follower,
                                 After after) noexcept {
    Component* const* const participants = participants_.data();
    const ContextHandle handle = make_handle(cycle_start_);
    const ActionScope scope{*this, first};
    // Eight places to call from: a processor foresees the callee by the place, and one place for all
    // components is more than some can keep (docs/design/kernel.md#execution-context). Nothing changes for
    // -Os.
#pragma GCC unroll 8
    for (std::size_t i = first; i < first + count; ++i) {
        move_to(i);
        Component& component = *participants[i];
        if (component.turn_ != 0U) {
            const bool was_active = execute_unusual(i);
            if (!is_in_cycle()) {
                return;  // abandoned: the cycle that this turn belonged to is over
            }
            follow(follower, i, was_active);
            continue;
        }
        const Status answer = component.on_execute(handle);
        // One question for both, since each is 0 in all but a few turns.
        static_assert(Phase::kInCycle == Phase{} && Status::kOk == Status{});
        const Phase phase = phase_.load(std::memory_order_relaxed);
        if ((static_cast<unsigned>(phase) | static_cast<unsigned>(answer)) != 0U) {
            judge_execution(i, answer);
            if (!is_in_cycle()) {
                return;
            }
        }
        after(i);
    }
}

void ExecutionContext::execute_range(std::size_t first, std::size_t count, Follower* follower) noexcept {
    if (!admits_steps()) {
        return;
    }
    MAMORI_REQUIRE(4, first <= participants_.size() && count <= participants_.size() - first);
    // One loop for each way that is common, so that no turn asks for what its range does not need.
    if (follower == nullptr) {
        run_turns(first, count, nullptr, [](std::size_t) noexcept {});
    } else if (follower->after_step == nullptr) {
        run_turns(first, count, follower,
                  [follower, records = follower->records](std::size_t position) noexcept {
                      static_cast<void>(follower->measure(records[position]));
                  });
    } else {
        run_turns(first, count, follower,
                  [follower](std::size_t position) noexcept { follow(follower, position, true); });
    }
}

/// All that may come after a turn.
void ExecutionContext::follow(Follower* follower, std::size_t position, bool was_active) noexcept {
    if (follower == nullptr) {
        return;
    }
    Duration used{-1};
    if (follower->records != nullptr && was_active) {
        used = follower->measure(follower->records[position]);
    } else if (follower->records != nullptr) {
        // A turn in Error or Inactive does nothing for anybody: no sign of life.
        follower->step_start = follower->host->get_step_end();
    }
    if (follower->after_step != nullptr) {
        follower->after_step(follower->argument, position, used);
    }
}

/// The turn of a participant that does anything but on_execute alone. @return whether it was Active.
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
            // A notice may have led to Error; then this turn is over, as after a failed on_execute.
            if (component.get_state() != LifecycleState::kActive) {
                return true;
            }
            if (is_data_flow) {
                judge(component, ComponentAction::kExecute, component.on_execute(handle), handle);
            } else if (component.machine_ != nullptr) {
                serve_events(component, handle);
            }
            return true;
        case LifecycleState::kInactive:
            give_notices(component, handle);
            return false;
        case LifecycleState::kCreated:
            return false;
    }
    MAMORI_INVARIANT(2, false);  // only a corrupted state comes here
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
    if (!admits_steps() || plan_.kind == ExecutionKind::kEventDriven) {
        return;
    }
    const Span<Component* const> range = participants_.subspan(first, count);
    const ContextHandle handle = make_handle(cycle_start_);
    const ActionScope scope{*this, first};
    for (std::size_t i = 0U; i < count && is_in_cycle(); ++i) {
        Component& component = *range.data()[i];
        if (component.get_state() != LifecycleState::kActive) {
            continue;
        }
        move_to(first + i);
        const Status answer = component.on_state_update(handle);
        if (answer != Status::kOk) {
            judge(component, ComponentAction::kStateUpdate, answer, handle);
        }
    }
}

}  // namespace mamori
