// SPDX-License-Identifier: Apache-2.0
#include "mamori/kernel/component.hpp"

namespace mamori {

Status Component::initialize() noexcept {
    const LifecycleTransition transition = get_transition(state_, LifecycleEvent::kInitialize);
    if (transition.admission != Status::kOk) {
        return transition.admission;
    }
    const Status result = on_initialize();
    if (result == Status::kOk) {
        state_ = transition.target;
    }
    return result;
}

Status Component::finalize() noexcept {
    if (!is_alive() || is_participating_) {
        return Status::kPreconditionNotMet;
    }
    state_ = LifecycleState::kCreated;
    return on_finalize();
}

}  // namespace mamori
