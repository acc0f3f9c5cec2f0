// SPDX-License-Identifier: Apache-2.0
/// @file
/// Start and stop of an execution context, for direct calls and for calls through an ActionCaller.
#ifndef MAMORI_KERNEL_SRC_CONTEXT_START_HPP
#define MAMORI_KERNEL_SRC_CONTEXT_START_HPP

#include "mamori/kernel/component/execution_context.hpp"
#include "mamori/kernel/component/external_trigger.hpp"

namespace mamori {

/// @param[in] caller none, or one ActionCaller.
template <typename... Caller>
Status ExecutionContext::start_by(Instant now, Caller&... caller) noexcept {
    if (id_ < 0 || is_running_ || is_busy()) {
        return Status::kPreconditionNotMet;
    }
    refusing_position_ = kNoPosition;
    for (std::size_t i = 0U; i < participants_.size(); ++i) {
        if (!participants_[i]->is_alive()) {
            refusing_position_ = i;
            return Status::kPreconditionNotMet;
        }
    }
    for (std::size_t i = 0U; i < participants_.size(); ++i) {
        const Status result = act(ComponentAction::kStartup, i, now, caller...);
        if (result != Status::kOk) {
            // The caller must receive the startup failure; a second failure would only hide it.
            static_cast<void>(shut_down(i, now, caller...));
            refusing_position_ = i;
            return result;
        }
    }
    is_running_ = true;
    windows_to_skip_ = 0;
    if (plan_.trigger != nullptr) {
        plan_.trigger->ignore_waiting();
    }
    return Status::kOk;
}

template <typename... Caller>
Status ExecutionContext::stop_by(Instant now, Caller&... caller) noexcept {
    if (!is_running_ || is_busy()) {
        return Status::kPreconditionNotMet;
    }
    is_running_ = false;
    return shut_down(participants_.size(), now, caller...);
}

/// Calls on_shutdown of the first `count` participants, except those that exit() has ended. An abandoned
/// context calls no further action. @return the first failure.
template <typename... Caller>
Status ExecutionContext::shut_down(std::size_t count, Instant now, Caller&... caller) noexcept {
    Status first_failure = Status::kOk;
    for (std::size_t i = 0U; i < count && !is_busy(); ++i) {
        if (participants_[i]->is_alive()) {
            const Status result = act(ComponentAction::kShutdown, i, now, caller...);
            first_failure = first_failure == Status::kOk ? result : first_failure;
        }
    }
    return first_failure;
}

}  // namespace mamori

#endif  // MAMORI_KERNEL_SRC_CONTEXT_START_HPP
