// SPDX-License-Identifier: Apache-2.0
#include "mamori/kernel/component/detail/fsm_machine.hpp"

namespace mamori {

void FsmMachine::restart() noexcept {
    queue_.clear();
    step_ = {};
    state_ = table_.initial;
}

const FsmTransition* FsmMachine::choose_transition(const FsmEvent& event) noexcept {
    for (std::size_t i = 0U; i < table_.transitions.size(); ++i) {
        const FsmTransition& row = table_.transitions[i];
        if (row.source == state_ && row.message == event.message &&
            (row.guard == nullptr || row.guard(owner_, event))) {
            step_.transition = i;
            step_.event = event;
            return &row;
        }
    }
    ++ignored_count_;
    return nullptr;
}

}  // namespace mamori
