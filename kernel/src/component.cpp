// SPDX-License-Identifier: Apache-2.0
#include "mamori/kernel/component.hpp"

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
    // Also refuses a call from on_initialize or on_finalize: the component is not alive there.
    if (context_ != nullptr || !is_alive()) {
        return Status::kPreconditionNotMet;
    }
    set_state(LifecycleState::kCreated);
    is_changing_ = true;
    const Status result = on_finalize();
    is_changing_ = false;
    return result;
}

}  // namespace mamori
