// SPDX-License-Identifier: Apache-2.0
#include "mamori/kernel/component/execution_context.hpp"

#include "action_scope.hpp"
#include "context_start.hpp"
#include "mamori/kernel/base/remainder.hpp"
#include "mamori/kernel/component/detail/event_server.hpp"
#include "mamori/kernel/component/multi_mode.hpp"

namespace mamori {
namespace {

/// State after a transition that the table allows.
constexpr LifecycleState calc_target(LifecycleState state, LifecycleEvent event) noexcept {
    const LifecycleTransition transition = get_transition(state, event);
    MAMORI_REQUIRE(1, transition.admission == Status::kOk);
    return transition.target;
}

/// Checks the rules that ContextPlan specifies for its members.
bool is_sound(const ContextPlan& plan) noexcept {
    if (plan.period <= Duration{0} || plan.events_per_cycle == 0U) {
        return false;
    }
    const bool is_periodic = plan.kind == ExecutionKind::kPeriodic;
    if ((plan.kind == ExecutionKind::kOther) != (plan.trigger != nullptr) ||
        (!is_periodic && !plan.alternative_periods.empty())) {
        return false;
    }
    for (const Duration& alternative : plan.alternative_periods) {
        if (alternative <= plan.period || detail::calc_remainder(alternative.ns, plan.period.ns) != 0) {
            return false;
        }
    }
    return true;
}

/// Declared period within half a nanosecond of `period_ns`; 0 when there is none.
Duration find_period(const ContextPlan& plan, double period_ns) noexcept {
    const auto is_meant = [period_ns](Duration declared) noexcept {
        const double difference = period_ns - static_cast<double>(declared.ns);
        return difference < 0.5 && difference > -0.5;
    };
    if (is_meant(plan.period)) {
        return plan.period;
    }
    for (const Duration& alternative : plan.alternative_periods) {
        if (is_meant(alternative)) {
            return alternative;
        }
    }
    return Duration{0};
}

}  // namespace

Status ExecutionContext::attach(std::int32_t id, Span<Component* const> participants,
                                const ContextPlan& plan) noexcept {
    if (id_ >= 0) {
        return Status::kPreconditionNotMet;
    }
    if (id < 0 || participants.empty() || !is_sound(plan)) {
        return Status::kBadParameter;
    }
    for (std::size_t i = 0U; i < participants.size(); ++i) {
        if (participants[i] == nullptr || participants[i]->context_ != nullptr) {
            // Also detects a participant listed twice: its first entry has set context_.
            release_participants(participants.subspan(0U, i));
            return Status::kBadParameter;
        }
        participants[i]->context_ = this;
        participants[i]->position_ = i;
        participants[i]->turn_ |= plan.kind == ExecutionKind::kEventDriven ? Component::kServesEvents : 0U;
    }
    const Status verdict = judge_machines(participants, plan.kind);
    if (verdict != Status::kOk) {
        release_participants(participants);
        return verdict;
    }
    for (Component* component : participants) {
        if (component->machine_ != nullptr) {
            component->machine_->set_context_id(id);
        }
    }
    id_ = id;
    plan_ = plan;
    period_ = plan.period;
    pending_divisor_ = 1;
    divisor_ = 1;
    participants_ = participants;
    return Status::kOk;
}

Status ExecutionContext::judge_machines(Span<Component* const> participants,
                                        ExecutionKind kind) const noexcept {
    for (Component* component : participants) {
        const EventServer* const machine = component->machine_;
        if (machine == nullptr) {
            continue;
        }
        const Status verdict =
            kind == ExecutionKind::kEventDriven ? machine->check_for(*this) : Status::kPreconditionNotMet;
        if (verdict != Status::kOk) {
            return verdict;
        }
    }
    return Status::kOk;
}

void ExecutionContext::release_participants(Span<Component* const> participants) noexcept {
    for (Component* component : participants) {
        component->context_ = nullptr;
        if (component->machine_ != nullptr) {
            component->machine_->set_context_id(-1);
        }
        component->turn_ &= Component::kNotActive;
        if (component->mode_switch_ != nullptr) {
            // Without a context, the change is not reported.
            static_cast<void>(component->mode_switch_->take_change());
        }
        if (component->get_state() == LifecycleState::kError) {
            component->set_state(LifecycleState::kInactive);
        }
    }
}

Status ExecutionContext::detach() noexcept {
    if (id_ < 0 || is_running_ || is_busy()) {
        return Status::kPreconditionNotMet;
    }
    for (const Component* component : participants_) {
        if (component->get_state() == LifecycleState::kActive) {
            return Status::kPreconditionNotMet;
        }
    }
    release_participants(participants_);
    participants_ = {};
    plan_ = {};
    period_ = {};
    pending_divisor_ = 1;
    divisor_ = 1;
    id_ = -1;
    return Status::kOk;
}

Status ExecutionContext::start(Instant now) noexcept {
    return start_by(now);
}

Status ExecutionContext::stop(Instant now) noexcept {
    return stop_by(now);
}

/// Calls on_startup or on_shutdown.
Status ExecutionContext::act(ComponentAction action, std::size_t position, Instant now) noexcept {
    Component& component = *participants_[position];
    const ContextHandle handle = make_handle(now);
    const ActionScope scope{*this, position};
    const Status result =
        action == ComponentAction::kStartup ? component.on_startup(handle) : component.on_shutdown(handle);
    note(component, action, result, handle);
    return result;
}

Result<std::size_t> ExecutionContext::find(const Component& component) const noexcept {
    return component.context_ == this ? Result<std::size_t>{component.position_} : Status::kBadParameter;
}

Result<std::size_t> ExecutionContext::admit(const Component& component, LifecycleEvent event) const noexcept {
    const Result<std::size_t> index = find(component);
    if (!index.has_value()) {
        return index;
    }
    if (is_busy()) {
        return Status::kPreconditionNotMet;
    }
    const Status admission = get_transition(component.get_state(), event).admission;
    return admission == Status::kOk ? index : Result<std::size_t>{admission};
}

void ExecutionContext::note(Component& component, ComponentAction action, Status answer,
                            ContextHandle handle) noexcept {
    if (answer != Status::kOk) {
        component.last_failure_ = {handle.now, answer, action};
    }
}

void ExecutionContext::enter_error(Component& component, ContextHandle handle) noexcept {
    component.set_state(calc_target(component.get_state(), LifecycleEvent::kFail));
    // The results of both actions are ignored: the component is in Error anyway, and get_last_failure() must
    // return the cause.
    if (plan_.abort_policy == AbortPolicy::kOpenRtmCompat) {
        static_cast<void>(component.on_deactivated(handle));
    }
    static_cast<void>(component.on_aborting(handle));
}

Status ExecutionContext::activate_component(const Component& component, Instant now) noexcept {
    const Result<std::size_t> index = admit(component, LifecycleEvent::kActivate);
    if (!index.has_value()) {
        return index.get_status();
    }
    Component& participant = *participants_[index.get_value()];
    const ContextHandle handle = make_handle(now);
    const ActionScope scope{*this, index.get_value()};
    if (participant.machine_ != nullptr) {
        participant.machine_->restart();
    }
    const Status result = participant.on_activated(handle);
    note(participant, ComponentAction::kActivated, result, handle);
    if (result == Status::kOk) {
        participant.set_state(calc_target(participant.get_state(), LifecycleEvent::kActivate));
    } else {
        enter_error(participant, handle);
    }
    return result;
}

Status ExecutionContext::deactivate_component(const Component& component, Instant now) noexcept {
    const Result<std::size_t> index = admit(component, LifecycleEvent::kDeactivate);
    if (!index.has_value()) {
        return index.get_status();
    }
    Component& participant = *participants_[index.get_value()];
    const ContextHandle handle = make_handle(now);
    const ActionScope scope{*this, index.get_value()};
    participant.set_state(calc_target(participant.get_state(), LifecycleEvent::kDeactivate));
    const Status result = participant.on_deactivated(handle);
    note(participant, ComponentAction::kDeactivated, result, handle);
    return result;
}

Status ExecutionContext::reset_component(const Component& component, Instant now) noexcept {
    const Result<std::size_t> index = admit(component, LifecycleEvent::kReset);
    if (!index.has_value()) {
        return index.get_status();
    }
    Component& participant = *participants_[index.get_value()];
    const ContextHandle handle = make_handle(now);
    const ActionScope scope{*this, index.get_value()};
    const Status result = participant.on_reset(handle);
    note(participant, ComponentAction::kReset, result, handle);
    if (result == Status::kOk) {
        participant.set_state(calc_target(participant.get_state(), LifecycleEvent::kReset));
    }
    return result;
}

Result<LifecycleState> ExecutionContext::get_component_state(const Component& component) const noexcept {
    if (!find(component).has_value() || !component.is_alive()) {
        return Status::kBadParameter;
    }
    return component.get_state();
}

LifecycleState ExecutionContext::get_state_at(std::size_t position) const noexcept {
    return participants_[position]->get_state();
}

double ExecutionContext::get_rate() const noexcept {
    const bool has_rate = id_ >= 0 && plan_.kind == ExecutionKind::kPeriodic;
    return has_rate ? 1.0e9 / static_cast<double>(period_.ns) : -1.0;
}

Status ExecutionContext::set_rate(double rate_hz) noexcept {
    // This form also rejects a rate that is not a number.
    if (!(rate_hz > 0.0 && rate_hz <= std::numeric_limits<double>::max())) {
        return Status::kBadParameter;
    }
    if (id_ < 0 || plan_.kind != ExecutionKind::kPeriodic) {
        return Status::kUnsupported;
    }
    const Duration wished = find_period(plan_, 1.0e9 / rate_hz);
    if (wished == Duration{0}) {
        return Status::kUnsupported;
    }
    if (is_busy()) {
        return Status::kPreconditionNotMet;
    }
    pending_divisor_ = wished.ns / plan_.period.ns;
    return Status::kOk;
}

bool ExecutionContext::apply_pending_rate() noexcept {
    if (pending_divisor_ == divisor_ || is_busy()) {
        return false;
    }
    divisor_ = pending_divisor_;
    period_ = plan_.period * divisor_;
    windows_to_skip_ = 0;
    for (Component* component : participants_) {
        component->turn_ |= Component::kRateNotice;
    }
    return true;
}

Result<std::size_t> ExecutionContext::get_acting_position() const noexcept {
    const std::size_t position = acting_position_.load(std::memory_order_acquire);
    if (position != kNoPosition) {
        return position;
    }
    return phase_.load(std::memory_order_relaxed) == Phase::kAbandoned
               ? Result<std::size_t>{abandoned_position_}
               : Status::kPreconditionNotMet;
}

Result<std::size_t> ExecutionContext::get_refusing_position() const noexcept {
    return refusing_position_ == kNoPosition ? Status::kPreconditionNotMet
                                             : Result<std::size_t>{refusing_position_};
}

}  // namespace mamori
