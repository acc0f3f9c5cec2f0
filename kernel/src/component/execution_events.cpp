// SPDX-License-Identifier: Apache-2.0
// Event processing of a state machine in an event-driven context, and what the machine demands of it.
#include "mamori/kernel/component/detail/fsm_machine.hpp"
#include "mamori/kernel/component/execution_context.hpp"
#include "mamori/kernel/component/fsm_check.hpp"

namespace mamori {

void FsmMachine::serve(ExecutionContext& context, Component& component, ContextHandle handle) noexcept {
    context.serve_events(*this, component, handle);
}

/// A profile names components of the same context, and elements of the table.
Status FsmMachine::check_for(const ExecutionContext& context) const noexcept {
    if (check(table_).rule != FsmRule::kNone) {
        return Status::kBadParameter;
    }
    for (const FsmBehavior& behavior : profile_) {
        const std::size_t count =
            behavior.id.kind == FsmElement::Kind::kState ? table_.states.size() : table_.transitions.size();
        if (behavior.action_component == nullptr || !context.find(*behavior.action_component).has_value() ||
            behavior.id.index >= count) {
            return Status::kBadParameter;
        }
    }
    return Status::kOk;
}

void ExecutionContext::serve_events(FsmMachine& machine, Component& component,
                                    ContextHandle handle) noexcept {
    if (machine.step_.phase != FsmStep::Phase::kNone) {
        // An earlier cycle was aborted between two states: the machine is in neither of them.
        judge(component, ComponentAction::kAction, Status::kError, handle);
        return;
    }
    for (std::size_t served = 0U; served < plan_.events_per_cycle; ++served) {
        move_to(component.position_);
        // An action may have moved the machine itself to Error; then the waiting events remain queued.
        if (component.get_state() != LifecycleState::kActive) {
            return;
        }
        const Result<FsmEvent> event = machine.queue_.take();
        if (!event.has_value()) {
            return;
        }
        const FsmTransition* const transition = machine.choose_transition(event.get_value());
        if (transition == nullptr) {
            continue;
        }
        machine.step_.phase = FsmStep::Phase::kExit;
        act(machine, {FsmElement::Kind::kState, transition->source}, handle);
        machine.step_.phase = FsmStep::Phase::kTransition;
        act(machine, {FsmElement::Kind::kTransition, machine.step_.transition}, handle);
        machine.step_.phase = FsmStep::Phase::kEntry;
        machine.state_ = transition->target;
        act(machine, {FsmElement::Kind::kState, transition->target}, handle);
        if (!is_in_cycle()) {
            return;
        }
        machine.step_.phase = FsmStep::Phase::kNone;
    }
}

void ExecutionContext::act(const FsmMachine& machine, FsmElement element, ContextHandle handle) noexcept {
    for (const FsmBehavior& behavior : machine.profile_) {
        if (behavior.id.kind != element.kind || behavior.id.index != element.index || !is_in_cycle()) {
            continue;
        }
        Component& participant = *behavior.action_component;
        move_to(participant.position_);
        if (participant.is_alive()) {
            give_notices(participant, handle);
        }
        if (participant.get_state() == LifecycleState::kActive) {
            judge(participant, ComponentAction::kAction, participant.on_action(handle), handle);
        } else if (participant.get_state() == LifecycleState::kError) {
            static_cast<void>(participant.on_error(handle));
        }
    }
}

}  // namespace mamori
