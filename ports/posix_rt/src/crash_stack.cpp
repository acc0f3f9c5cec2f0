// SPDX-License-Identifier: Apache-2.0
#include "mamori/ports/posix_rt/crash_stack.hpp"

namespace mamori::ports::posix_rt {

Status CrashStack::take() noexcept {
    if (is_taken_) {
        return Status::kPreconditionNotMet;
    }
    stack_t stack{};
    stack.ss_sp = memory_.data();
    stack.ss_size = memory_.size();
    if (::sigaltstack(&stack, &previous_) != 0) {
        return Status::kOutOfResources;
    }
    is_taken_ = true;
    return Status::kOk;
}

void CrashStack::give_back() noexcept {
    if (is_taken_) {
        static_cast<void>(::sigaltstack(&previous_, nullptr));
        is_taken_ = false;
    }
}

}  // namespace mamori::ports::posix_rt
