// SPDX-License-Identifier: Apache-2.0
#include "mamori/safety/supervision/challenge_gate.hpp"

namespace mamori::safety {

std::uint32_t ChallengeGate::Service::ask(Instant now) noexcept {
    asked_at_ = now;
    const Result<std::uint32_t> question = watchdog_.get_question();
    has_question_ = question.has_value();
    return question.get_value();
}

Status ChallengeGate::Service::service(Instant now) noexcept {
    if (!has_question_ || now != asked_at_) {
        return Status::kError;
    }
    const Status status = watchdog_.answer(now, answer_);
    was_wrong_ = status == Status::kBadParameter;
    return status;
}

bool ChallengeGate::Service::end() noexcept {
    const bool was_wrong = was_wrong_;
    has_question_ = false;
    was_wrong_ = false;
    return was_wrong;
}

std::uint32_t ChallengeGate::ask(Instant now) noexcept {
    return service_.ask(now);
}

ChallengeOutcome ChallengeGate::step(Instant now, GlobalStatus status, bool is_state_consistent,
                                     std::uint32_t answer) noexcept {
    if (is_closed()) {
        return ChallengeOutcome::kClosed;
    }
    service_.prepare(answer);
    const WatchdogOutcome outcome = gate_.step(now, status, is_state_consistent);
    if (service_.end()) {
        ++wrong_count_;
        return ChallengeOutcome::kWrong;
    }
    return to_challenge_outcome(outcome);
}

}  // namespace mamori::safety
