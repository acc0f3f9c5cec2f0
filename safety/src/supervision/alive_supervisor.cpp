// SPDX-License-Identifier: Apache-2.0
#include "mamori/safety/supervision/alive_supervisor.hpp"

namespace mamori::safety {
namespace {

using State = AliveSlot::State;

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
    for (std::size_t i = 0U; i < slots_.size(); ++i) {
        end_cycle(i);
        const AliveVerdict verdict = get_verdict(i);
        worst = verdict > worst ? verdict : worst;
    }
    return worst;
}

}  // namespace mamori::safety
