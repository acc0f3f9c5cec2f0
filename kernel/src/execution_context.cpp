// SPDX-License-Identifier: Apache-2.0
#include "mamori/kernel/execution_context.hpp"

namespace mamori {
namespace {

/// Moves a component along a transition that the table allows.
constexpr LifecycleState calc_target(LifecycleState state, LifecycleEvent event) noexcept {
    const LifecycleTransition transition = get_transition(state, event);
    MAMORI_REQUIRE(1, transition.admission == Status::kOk);
    return transition.target;
}

}  // namespace

/// Marks that an action of one participant is being called, for as long as it lives.
class ExecutionContext::ActionScope final {
  public:
    ActionScope(ExecutionContext& context, std::size_t position) noexcept : context_(context) {
        context_.acting_position_ = position;
        context_.is_in_action_.store(true, std::memory_order_release);
    }
    ~ActionScope() { context_.is_in_action_.store(false, std::memory_order_release); }
    ActionScope(const ActionScope&) = delete;
    ActionScope& operator=(const ActionScope&) = delete;

  private:
    ExecutionContext& context_;
};

bool ExecutionContext::is_busy() const noexcept {
    return is_in_cycle_ || is_in_action_.load(std::memory_order_acquire);
}

Status ExecutionContext::attach(std::int32_t id, Span<Component* const> participants,
                                Duration period) noexcept {
    if (id_ >= 0) {
        return Status::kPreconditionNotMet;
    }
    if (id < 0 || period <= Duration{0} || participants.empty()) {
        return Status::kBadParameter;
    }
    for (std::size_t i = 0U; i < participants.size(); ++i) {
        if (participants[i] == nullptr || participants[i]->is_participating_) {
            return Status::kBadParameter;
        }
        for (std::size_t j = 0U; j < i; ++j) {
            if (participants[i] == participants[j]) {
                return Status::kBadParameter;
            }
        }
    }
    for (Component* component : participants) {
        component->is_participating_ = true;
    }
    id_ = id;
    period_ = period;
    participants_ = participants;
    return Status::kOk;
}

Status ExecutionContext::detach() noexcept {
    if (id_ < 0 || is_running_ || is_busy()) {
        return Status::kPreconditionNotMet;
    }
    for (const Component* component : participants_) {
        if (component->state_ == LifecycleState::kActive) {
            return Status::kPreconditionNotMet;
        }
    }
    for (Component* component : participants_) {
        component->is_participating_ = false;
        if (component->state_ == LifecycleState::kError) {
            component->state_ = LifecycleState::kInactive;
        }
    }
    participants_ = {};
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
    has_refusal_ = false;
    for (std::size_t i = 0U; i < participants_.size(); ++i) {
        const ActionScope scope{*this, i};
        const Status result = participants_[i]->on_startup(make_handle(now));
        if (result != Status::kOk) {
            for (std::size_t started = 0U; started < i; ++started) {
                // The refusal is what the caller must hear; a second failure would only hide it.
                static_cast<void>(participants_[started]->on_shutdown(make_handle(now)));
            }
            refusing_position_ = i;
            has_refusal_ = true;
            return result;
        }
    }
    is_running_ = true;
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
    for (std::size_t i = 0U; i < participants_.size(); ++i) {
        if (participants_[i] == &component) {
            return i;
        }
    }
    return Status::kBadParameter;
}

Result<std::size_t> ExecutionContext::admit(const Component& component, LifecycleEvent event) const noexcept {
    const Result<std::size_t> index = find(component);
    if (!index.has_value()) {
        return index;
    }
    if (is_busy()) {
        return Status::kPreconditionNotMet;
    }
    const Status admission = get_transition(component.state_, event).admission;
    return admission == Status::kOk ? index : Result<std::size_t>{admission};
}

void ExecutionContext::enter_error(Component& component, Instant now) noexcept {
    component.state_ = calc_target(component.state_, LifecycleEvent::kFail);
    // on_aborting cannot make matters worse: the component is in Error whatever it answers.
    static_cast<void>(component.on_aborting(make_handle(now)));
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
        participant.state_ = calc_target(participant.state_, LifecycleEvent::kActivate);
    } else {
        enter_error(participant, now);
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
    participant.state_ = calc_target(participant.state_, LifecycleEvent::kDeactivate);
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
        participant.state_ = calc_target(participant.state_, LifecycleEvent::kReset);
    }
    return result;
}

Result<LifecycleState> ExecutionContext::get_component_state(const Component& component) const noexcept {
    if (!find(component).has_value() || !component.is_alive()) {
        return Status::kBadParameter;
    }
    return component.state_;
}

double ExecutionContext::get_rate() const noexcept {
    return id_ < 0 ? -1.0 : 1.0e9 / static_cast<double>(period_.ns);
}

Status ExecutionContext::set_rate(double rate_hz) noexcept {
    // Written so that a rate that is not a number is refused too.
    if (!(rate_hz > 0.0)) {
        return Status::kBadParameter;
    }
    return Status::kUnsupported;
}

Result<std::size_t> ExecutionContext::get_acting_position() const noexcept {
    if (!is_in_action_.load(std::memory_order_acquire)) {
        return Status::kPreconditionNotMet;
    }
    return acting_position_;
}

Result<std::size_t> ExecutionContext::get_refusing_position() const noexcept {
    if (!has_refusal_) {
        return Status::kPreconditionNotMet;
    }
    return refusing_position_;
}

Status ExecutionContext::begin_cycle(Instant now) noexcept {
    if (!is_running_ || is_busy()) {
        return Status::kPreconditionNotMet;
    }
    is_in_cycle_ = true;
    cycle_start_ = now;
    return Status::kOk;
}

void ExecutionContext::execute(std::size_t index) noexcept {
    MAMORI_REQUIRE(2, is_in_cycle_);
    Component& component = *participants_[index];
    const Instant now = cycle_start_;
    const ActionScope scope{*this, index};
    switch (component.state_) {
        case LifecycleState::kError:
            static_cast<void>(component.on_error(make_handle(now)));
            return;
        case LifecycleState::kActive:
            if (component.on_execute(make_handle(now)) != Status::kOk) {
                enter_error(component, now);
            }
            return;
        case LifecycleState::kCreated:
        case LifecycleState::kInactive:
            return;
    }
    MAMORI_INVARIANT(3, false);  // only a corrupted state comes here
}

void ExecutionContext::update_state(std::size_t index) noexcept {
    MAMORI_REQUIRE(4, is_in_cycle_);
    Component& component = *participants_[index];
    if (component.state_ != LifecycleState::kActive) {
        return;
    }
    const Instant now = cycle_start_;
    const ActionScope scope{*this, index};
    if (component.on_state_update(make_handle(now)) != Status::kOk) {
        enter_error(component, now);
    }
}

void ExecutionContext::end_cycle() noexcept {
    is_in_cycle_ = false;
}

}  // namespace mamori
