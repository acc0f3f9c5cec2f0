// SPDX-License-Identifier: Apache-2.0
#include "mamori/safety/execution_supervisor.hpp"

namespace mamori::safety {
namespace {

/// The status that a component adds to the whole; the two scales are the same by intention.
constexpr GlobalStatus to_global(LocalStatus status) noexcept {
    if (status == LocalStatus::kExpired) {
        return GlobalStatus::kExpired;
    }
    return status == LocalStatus::kOk ? GlobalStatus::kOk : GlobalStatus::kFailed;
}

}  // namespace

Status ExecutionSupervisor::watch(std::size_t component, const ComponentLimits& limits) noexcept {
    if (!is_valid(limits.deadline)) {
        return Status::kBadParameter;
    }
    const Status result = alive_.watch(component, limits.alive);
    if (result != Status::kOk) {
        return result;
    }
    const Status deadline_result = deadline_.watch(component, limits.deadline);
    MAMORI_ENSURE(4, deadline_result == Status::kOk);  // both are always watched together
    components_[component].scope = limits.scope;
    return Status::kOk;
}

Status ExecutionSupervisor::acknowledge(std::size_t component) noexcept {
    if (component >= components_.size()) {
        return Status::kBadParameter;
    }
    ComponentSlot& slot = components_[component];
    if (slot.status != LocalStatus::kExpired) {
        return Status::kPreconditionNotMet;
    }
    // Each refuses where it has nothing to clear: the cause was another one.
    static_cast<void>(alive_.acknowledge(component));
    static_cast<void>(deadline_.acknowledge(component));
    slot.status = LocalStatus::kOk;
    slot.cause = ExpiryCause::kNone;
    return Status::kOk;
}

void ExecutionSupervisor::judge(std::size_t component, Instant now) noexcept {
    ComponentSlot& slot = components_[component];
    const bool has_overrun = slot.is_overrun_pending.exchange(false, std::memory_order_acq_rel);
    if (slot.status == LocalStatus::kExpired) {
        return;
    }
    ExpiryCause cause = ExpiryCause::kNone;
    if (has_overrun) {
        cause = ExpiryCause::kBudgetOverrun;
    } else if (deadline_.is_expired(component)) {
        cause = ExpiryCause::kDeadline;
    } else if (alive_.get_verdict(component) == AliveVerdict::kExpired) {
        cause = ExpiryCause::kSilent;
    }
    if (cause != ExpiryCause::kNone) {
        slot.status = LocalStatus::kExpired;
        slot.cause = cause;
        slot.expired_at = now;
        return;
    }
    const bool is_late = alive_.get_verdict(component) != AliveVerdict::kHealthy;
    slot.status = is_late ? LocalStatus::kFailed : LocalStatus::kOk;
}

GlobalStatus ExecutionSupervisor::step(Instant now) noexcept {
    bool is_anything_proven = false;
    GlobalStatus worst = is_release_late_ ? GlobalStatus::kFailed : GlobalStatus::kOk;
    is_release_late_ = false;
    for (std::size_t i = 0U; i < components_.size(); ++i) {
        const ComponentSlot& slot = components_.data()[i];
        // The way of nearly every cycle: a sign of life, and nothing that would have to be weighed.
        const bool is_inconspicuous = slot.status == LocalStatus::kOk && deadline_.is_clean(i) &&
                                      !slot.is_overrun_pending.load(std::memory_order_acquire) &&
                                      alive_.end_lively_cycle(i);
        if (!is_inconspicuous) {
            alive_.end_cycle(i);
            deadline_.end_cycle(i, now);
            judge(i, now);
        }
        if (slot.scope != SupervisionScope::kGlobal) {
            continue;
        }
        if (is_inconspicuous) {
            is_anything_proven = true;
            continue;
        }
        const GlobalStatus status = to_global(slot.status);
        worst = status > worst ? status : worst;
        is_anything_proven = is_anything_proven || alive_.is_active(i);
    }
    if (worst == GlobalStatus::kOk && !is_anything_proven) {
        worst = GlobalStatus::kFailed;
    }
    global_status_ = worst;
    return worst;
}

std::size_t ExecutionSupervisor::get_first_expired() const noexcept {
    std::size_t first = kNoComponent;
    for (std::size_t i = 0U; i < components_.size(); ++i) {
        const bool is_expired = components_[i].status == LocalStatus::kExpired;
        if (is_expired &&
            (first == kNoComponent || components_[i].expired_at < components_[first].expired_at)) {
            first = i;
        }
    }
    return first;
}

void ExecutionSupervisor::on_component_executed(std::size_t component, Instant started,
                                                Instant finished) noexcept {
    MAMORI_REQUIRE(1, component < components_.size());
    if (deadline_.is_watched(component)) {
        deadline_.observe(component, started, finished);
        alive_.note_life(component);
    }
}

void ExecutionSupervisor::on_budget_overrun(std::size_t, std::size_t component, Instant) noexcept {
    MAMORI_REQUIRE(3, component < components_.size());
    components_[component].is_overrun_pending.store(true, std::memory_order_release);
}

void ExecutionSupervisor::on_late_release(std::size_t window, Duration lateness, Instant now) noexcept {
    // A negative lateness is a clock that ran backwards: no better than a late window.
    if (lateness >= Duration{0} && lateness <= lateness_max_) {
        return;
    }
    is_release_late_ = true;
    if (late_release_.count == 0U) {
        late_release_ = LateRelease{0U, window, lateness, now};
    }
    constexpr std::uint32_t kCountMax = 0xFFFFFFFFU;
    late_release_.count += late_release_.count < kCountMax ? 1U : 0U;
}

}  // namespace mamori::safety
