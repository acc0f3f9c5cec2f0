// SPDX-License-Identifier: Apache-2.0
#include "mamori/safety/alive_supervisor.hpp"

namespace mamori::safety {
namespace {

using State = AliveSlot::State;

/// The worst condition is judged first, so that equal limits give the severer answer.
AliveVerdict calc_verdict(const AliveSlot& slot) noexcept {
    if (slot.state == State::kExpired) {
        return AliveVerdict::kExpired;
    }
    if (slot.state != State::kActive || slot.silent_cycles < slot.limits.late_cycles) {
        return AliveVerdict::kHealthy;
    }
    return AliveVerdict::kLate;
}

void end_cycle(AliveSlot& slot) noexcept {
    if (slot.state != State::kActive) {
        return;
    }
    // The count cannot wrap: it stops when it reaches the limit.
    slot.silent_cycles = slot.has_reported ? 0U : slot.silent_cycles + 1U;
    slot.has_reported = false;
    if (slot.silent_cycles >= slot.limits.expired_cycles) {
        slot.state = State::kExpired;
    }
}

void start_afresh(AliveSlot& slot) noexcept {
    slot.silent_cycles = 0U;
    slot.has_reported = false;
    slot.state = State::kActive;
}

}  // namespace

bool AliveSupervisor::is_watched(std::size_t index) const noexcept {
    return index < slots_.size() && slots_[index].state != State::kFree;
}

Status AliveSupervisor::watch(std::size_t index, AliveLimits limits) noexcept {
    if (index >= slots_.size() || !is_valid(limits)) {
        return Status::kBadParameter;
    }
    if (is_watched(index)) {
        return Status::kPreconditionNotMet;
    }
    slots_[index].limits = limits;
    start_afresh(slots_[index]);
    return Status::kOk;
}

Status AliveSupervisor::deactivate(std::size_t index) noexcept {
    if (!is_watched(index)) {
        return Status::kBadParameter;
    }
    if (slots_[index].state != State::kActive) {
        return Status::kPreconditionNotMet;
    }
    slots_[index].state = State::kInactive;
    return Status::kOk;
}

Status AliveSupervisor::activate(std::size_t index) noexcept {
    if (!is_watched(index)) {
        return Status::kBadParameter;
    }
    if (slots_[index].state != State::kInactive) {
        return Status::kPreconditionNotMet;
    }
    start_afresh(slots_[index]);
    return Status::kOk;
}

Status AliveSupervisor::report_alive(std::size_t index) noexcept {
    if (!is_watched(index)) {
        return Status::kBadParameter;
    }
    slots_[index].has_reported = true;
    return Status::kOk;
}

Status AliveSupervisor::acknowledge(std::size_t index) noexcept {
    if (!is_watched(index)) {
        return Status::kBadParameter;
    }
    if (slots_[index].state != State::kExpired) {
        return Status::kPreconditionNotMet;
    }
    start_afresh(slots_[index]);
    return Status::kOk;
}

AliveVerdict AliveSupervisor::step() noexcept {
    AliveVerdict worst = AliveVerdict::kHealthy;
    for (AliveSlot& slot : slots_) {
        end_cycle(slot);
        const AliveVerdict verdict = calc_verdict(slot);
        worst = verdict > worst ? verdict : worst;
    }
    return worst;
}

AliveVerdict AliveSupervisor::get_verdict(std::size_t index) const noexcept {
    return calc_verdict(slots_[index]);
}

bool AliveSupervisor::is_active(std::size_t index) const noexcept {
    return slots_[index].state == State::kActive;
}

}  // namespace mamori::safety
