// SPDX-License-Identifier: Apache-2.0
#include "mamori/kernel/fsm_component.hpp"

#include "mamori/kernel/execution_context.hpp"
#include "mamori/kernel/fsm_check.hpp"

namespace mamori {

Status FsmComponent::send_stimulus(FsmIndex message, ContextHandle context, std::int64_t argument) noexcept {
    if (message >= get_fsm_structure().messages.size()) {
        return Status::kBadParameter;
    }
    const std::int32_t own_id = context_ == nullptr ? -1 : context_->get_id();
    if (context.id != -1 && context.id != own_id) {
        return Status::kBadParameter;
    }
    // Only an event-driven context takes a state machine, so its kind needs no further test.
    if (context_ == nullptr || get_state() != LifecycleState::kActive) {
        return Status::kPreconditionNotMet;
    }
    return fsm_.post({message, argument});
}

Result<FsmIndex> FsmComponent::find_message(const char* name) const noexcept {
    for (std::size_t i = 0U; i < get_fsm_structure().messages.size() && name != nullptr; ++i) {
        if (detail::is_same_text(name, get_fsm_structure().messages[i].name)) {
            return static_cast<FsmIndex>(i);
        }
    }
    return Status::kBadParameter;
}

}  // namespace mamori
