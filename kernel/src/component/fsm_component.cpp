// SPDX-License-Identifier: Apache-2.0
#include "mamori/kernel/component/fsm_component.hpp"

#include "mamori/kernel/component/execution_context.hpp"
#include "mamori/kernel/component/fsm_check.hpp"

namespace mamori {

Status FsmComponent::send_stimulus(FsmIndex message, ContextHandle context, std::int64_t argument) noexcept {
    if (message >= get_fsm_structure().messages.size()) {
        return Status::kBadParameter;
    }
    // Another thread may call this while the machine is attached, detached or activated again, so all data
    // read here is atomic. The epoch is read first, so that an event for one activation is not processed in
    // the next.
    const std::uint32_t epoch = get_queue().get_epoch();
    const std::int32_t own_id = fsm_.get_context_id();
    if (context.id != -1 && context.id != own_id) {
        return Status::kBadParameter;
    }
    // Only an event-driven context accepts a state machine, so no check of its kind is necessary.
    if (own_id == -1 || get_state() != LifecycleState::kActive) {
        return Status::kPreconditionNotMet;
    }
    return fsm_.post({message, argument}, epoch);
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
