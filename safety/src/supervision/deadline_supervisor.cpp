// SPDX-License-Identifier: Apache-2.0
#include "mamori/safety/supervision/deadline_supervisor.hpp"

#include "mamori/safety/base/elapsed.hpp"

namespace mamori::safety {
namespace {

DeadlineViolation judge_run(DeadlineLimits limits, Duration elapsed) noexcept {
    if (elapsed > limits.longest) {
        return DeadlineViolation::kTooLong;
    }
    return elapsed < limits.shortest ? DeadlineViolation::kTooShort : DeadlineViolation::kNone;
}

/// Keeps the first violation; kNone never takes one away.
void latch(DeadlineSlot& slot, DeadlineViolation violation) noexcept {
    if (slot.violation == DeadlineViolation::kNone) {
        slot.violation = violation;
    }
}

}  // namespace

Status DeadlineSupervisor::watch(std::size_t index, DeadlineLimits limits) noexcept {
    if (index >= slots_.size() || !is_valid(limits)) {
        return Status::kBadParameter;
    }
    if (is_watched(index)) {
        return Status::kPreconditionNotMet;
    }
    DeadlineSlot& slot = slots_[index];
    slot = DeadlineSlot{};
    slot.limits = limits;
    slot.is_watched = true;
    return Status::kOk;
}

Status DeadlineSupervisor::start(std::size_t index, Instant now) noexcept {
    if (!is_watched(index)) {
        return Status::kBadParameter;
    }
    DeadlineSlot& slot = slots_[index];
    if (slot.is_running) {
        latch(slot, DeadlineViolation::kMissingFinish);
    }
    slot.is_running = true;
    slot.started_at = now;
    return Status::kOk;
}

Status DeadlineSupervisor::finish(std::size_t index, Instant now) noexcept {
    if (!is_watched(index)) {
        return Status::kBadParameter;
    }
    DeadlineSlot& slot = slots_[index];
    latch(slot, slot.is_running ? judge_run(slot.limits, calc_elapsed(slot.started_at, now))
                                : DeadlineViolation::kMissingStart);
    slot.is_running = false;
    return Status::kOk;
}

Status DeadlineSupervisor::acknowledge(std::size_t index) noexcept {
    if (!is_watched(index)) {
        return Status::kBadParameter;
    }
    DeadlineSlot& slot = slots_[index];
    if (!slot.is_expired) {
        return Status::kPreconditionNotMet;
    }
    slot.is_expired = false;
    slot.violation = DeadlineViolation::kNone;
    slot.is_running = false;
    return Status::kOk;
}

void DeadlineSupervisor::judge(DeadlineSlot& slot, Instant now) noexcept {
    if (slot.is_running && is_over(slot.started_at, now, slot.limits.longest)) {
        latch(slot, DeadlineViolation::kMissingFinish);
    }
    slot.is_expired = slot.is_expired || slot.violation != DeadlineViolation::kNone;
}

bool DeadlineSupervisor::step(Instant now) noexcept {
    bool has_expired = false;
    for (DeadlineSlot& slot : slots_) {
        judge(slot, now);
        has_expired = has_expired || slot.is_expired;
    }
    return has_expired;
}

}  // namespace mamori::safety
