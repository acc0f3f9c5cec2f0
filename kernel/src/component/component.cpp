// SPDX-License-Identifier: Apache-2.0
#include "mamori/kernel/component/component.hpp"

#include "mamori/kernel/component/execution_context.hpp"

namespace mamori {

Status Component::initialize() noexcept {
    const LifecycleTransition transition = get_transition(get_state(), LifecycleEvent::kInitialize);
    if (is_changing_ || transition.admission != Status::kOk) {
        return Status::kPreconditionNotMet;
    }
    is_changing_ = true;
    const Status result = on_initialize();
    is_changing_ = false;
    if (result == Status::kOk) {
        set_state(transition.target);
    }
    return result;
}

Status Component::finalize() noexcept {
    // Also rejects a call from on_initialize or on_finalize: there, the component is not alive.
    if (context_ != nullptr || !is_alive()) {
        return Status::kPreconditionNotMet;
    }
    return end_life();
}

Status Component::end_life() noexcept {
    set_state(LifecycleState::kCreated);
    is_changing_ = true;
    const Status result = on_finalize();
    is_changing_ = false;
    return result;
}

Status Component::exit(Instant now) noexcept {
    if (!is_alive() || (context_ != nullptr && context_->is_busy())) {
        return Status::kPreconditionNotMet;
    }
    Status first_failure = Status::kOk;
    if (get_state() == LifecycleState::kActive) {
        first_failure = context_->deactivate_component(*this, now);
    }
    const Status result = end_life();
    return first_failure == Status::kOk ? result : first_failure;
}

ExecutionContext* Component::get_context(ContextHandle handle) const noexcept {
    return context_ != nullptr && context_->get_id() == handle.id ? context_ : nullptr;
}

Result<ContextHandle> Component::get_context_handle(const ExecutionContext& context) const noexcept {
    if (context_ != &context) {
        return Status::kBadParameter;
    }
    return ContextHandle{context.get_id(), Instant{}};
}

}  // namespace mamori
