// SPDX-License-Identifier: Apache-2.0
#include "mamori/kernel/execution_context.hpp"

#include "mamori/kernel/external_trigger.hpp"

namespace mamori {
namespace {

/// Moves a component along a transition that the table allows.
constexpr LifecycleState calc_target(LifecycleState state, LifecycleEvent event) noexcept {
    const LifecycleTransition transition = get_transition(state, event);
    MAMORI_REQUIRE(1, transition.admission == Status::kOk);
    return transition.target;
}

/// What ContextPlan says about its own fields.
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
        if (alternative <= plan.period || alternative.ns % plan.period.ns != 0) {
            return false;
        }
    }
    return true;
}

}  // namespace

/// Marks that an action of one participant is being called, for as long as it lives.
class ExecutionContext::ActionScope final {
  public:
    ActionScope(ExecutionContext& context, std::size_t position) noexcept : context_(context) {
        move_to(position);
    }
    ~ActionScope() { context_.acting_position_.store(kNoPosition, std::memory_order_release); }
    ActionScope(const ActionScope&) = delete;
    ActionScope& operator=(const ActionScope&) = delete;

    void move_to(std::size_t position) noexcept {
        context_.acting_position_.store(position, std::memory_order_relaxed);
    }

  private:
    ExecutionContext& context_;
};

bool ExecutionContext::is_busy() const noexcept {
    return is_in_cycle() || acting_position_.load(std::memory_order_acquire) != kNoPosition;
}

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
            // Covers one that is named twice: its first place has been taken.
            release_participants(participants.subspan(0U, i));
            return Status::kBadParameter;
        }
        participants[i]->context_ = this;
        participants[i]->position_ = i;
    }
    id_ = id;
    plan_ = plan;
    participants_ = participants;
    return Status::kOk;
}

void ExecutionContext::release_participants(Span<Component* const> participants) noexcept {
    for (Component* component : participants) {
        component->context_ = nullptr;
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
    id_ = -1;
    return Status::kOk;
}

Status ExecutionContext::start(Instant now) noexcept {
    if (id_ < 0 || is_running_ || is_busy()) {
        return Status::kPreconditionNotMet;
    }
    for (const Component* component : participants_) {
        if (!component->is_alive()) {
            return Status::kPreconditionNotMet;
        }
    }
    refusing_position_ = kNoPosition;
    for (std::size_t i = 0U; i < participants_.size(); ++i) {
        const ActionScope scope{*this, i};
        const Status result = participants_[i]->on_startup(make_handle(now));
        if (result != Status::kOk) {
            for (std::size_t started = 0U; started < i; ++started) {
                // The refusal is what the caller must hear; a second failure would only hide it.
                static_cast<void>(participants_[started]->on_shutdown(make_handle(now)));
            }
            refusing_position_ = i;
            return result;
        }
    }
    is_running_ = true;
    if (plan_.trigger != nullptr) {
        plan_.trigger->ignore_waiting();
    }
    return Status::kOk;
}

Status ExecutionContext::stop(Instant now) noexcept {
    if (!is_running_ || is_busy()) {
        return Status::kPreconditionNotMet;
    }
    is_running_ = false;
    Status first_failure = Status::kOk;
    for (std::size_t i = 0U; i < participants_.size(); ++i) {
        const ActionScope scope{*this, i};
        const Status result = participants_[i]->on_shutdown(make_handle(now));
        if (first_failure == Status::kOk) {
            first_failure = result;
        }
    }
    return first_failure;
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

void ExecutionContext::enter_error(Component& component, ContextHandle handle) noexcept {
    component.set_state(calc_target(component.get_state(), LifecycleEvent::kFail));
    // on_aborting cannot make matters worse: the component is in Error whatever it answers.
    static_cast<void>(component.on_aborting(handle));
}

Status ExecutionContext::activate_component(const Component& component, Instant now) noexcept {
    const Result<std::size_t> index = admit(component, LifecycleEvent::kActivate);
    if (!index.has_value()) {
        return index.get_status();
    }
    Component& participant = *participants_[index.get_value()];
    const ActionScope scope{*this, index.get_value()};
    const Status result = participant.on_activated(make_handle(now));
    if (result == Status::kOk) {
        participant.set_state(calc_target(participant.get_state(), LifecycleEvent::kActivate));
    } else {
        enter_error(participant, make_handle(now));
    }
    return result;
}

Status ExecutionContext::deactivate_component(const Component& component, Instant now) noexcept {
    const Result<std::size_t> index = admit(component, LifecycleEvent::kDeactivate);
    if (!index.has_value()) {
        return index.get_status();
    }
    Component& participant = *participants_[index.get_value()];
    const ActionScope scope{*this, index.get_value()};
    participant.set_state(calc_target(participant.get_state(), LifecycleEvent::kDeactivate));
    return participant.on_deactivated(make_handle(now));
}

Status ExecutionContext::reset_component(const Component& component, Instant now) noexcept {
    const Result<std::size_t> index = admit(component, LifecycleEvent::kReset);
    if (!index.has_value()) {
        return index.get_status();
    }
    Component& participant = *participants_[index.get_value()];
    const ActionScope scope{*this, index.get_value()};
    const Status result = participant.on_reset(make_handle(now));
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
    return has_rate ? 1.0e9 / static_cast<double>(plan_.period.ns) : -1.0;
}

Status ExecutionContext::set_rate(double rate_hz) noexcept {
    // Written so that a rate that is not a number is refused too.
    if (!(rate_hz > 0.0)) {
        return Status::kBadParameter;
    }
    return Status::kUnsupported;
}

Result<std::size_t> ExecutionContext::get_acting_position() const noexcept {
    const std::size_t position = acting_position_.load(std::memory_order_acquire);
    return position == kNoPosition ? Status::kPreconditionNotMet : Result<std::size_t>{position};
}

Result<std::size_t> ExecutionContext::get_refusing_position() const noexcept {
    return refusing_position_ == kNoPosition ? Status::kPreconditionNotMet
                                             : Result<std::size_t>{refusing_position_};
}

bool ExecutionContext::take_turn() noexcept {
    return is_running_ && (plan_.trigger == nullptr || plan_.trigger->take());
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
    MAMORI_REQUIRE(2, is_in_cycle());
    const Span<Component* const> range = participants_.subspan(first, count);
    const ContextHandle handle = make_handle(cycle_start_);
    ActionScope scope{*this, first};
    for (std::size_t i = 0U; i < count && is_in_cycle(); ++i) {
        scope.move_to(first + i);
        Component& component = *range.data()[i];
        if (component.get_state() != LifecycleState::kActive) {
            execute_unusual(component, handle);
        } else if (component.on_execute(handle) != Status::kOk) {
            enter_error(component, handle);
        }
        if (after.function != nullptr && is_in_cycle()) {
            after.function(after.argument, first + i);
        }
    }
}

void ExecutionContext::execute_unusual(Component& component, ContextHandle handle) noexcept {
    switch (component.get_state()) {
        case LifecycleState::kError:
            static_cast<void>(component.on_error(handle));
            return;
        case LifecycleState::kActive:
        case LifecycleState::kCreated:
        case LifecycleState::kInactive:
            return;
    }
    MAMORI_INVARIANT(3, false);  // only a corrupted state comes here
}

void ExecutionContext::update_range(std::size_t first, std::size_t count) noexcept {
    MAMORI_REQUIRE(4, is_in_cycle());
    const Span<Component* const> range = participants_.subspan(first, count);
    const ContextHandle handle = make_handle(cycle_start_);
    ActionScope scope{*this, first};
    for (std::size_t i = 0U; i < count && is_in_cycle(); ++i) {
        scope.move_to(first + i);
        Component& component = *range.data()[i];
        if (component.get_state() == LifecycleState::kActive &&
            component.on_state_update(handle) != Status::kOk) {
            enter_error(component, handle);
        }
    }
}

}  // namespace mamori
