// SPDX-License-Identifier: Apache-2.0
// Event processing of a state machine in an event-driven context.
#include "mamori/kernel/component/detail/fsm_machine.hpp"
#include "mamori/kernel/component/execution_context.hpp"

namespace mamori {

void ExecutionContext::serve_events(Component& component, ContextHandle handle) noexcept {
    FsmMachine& machine = *component.machine_;
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
