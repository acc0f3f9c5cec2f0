// SPDX-License-Identifier: Apache-2.0
#include "mamori/safety/supervision/execution_supervisor.hpp"

#include "mamori/kernel/component/execution_context.hpp"
#include "mamori/safety/base/saturating_increment.hpp"

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
    // What was seen before was held against no limits.
    get_records()[component].set_limits(limits.deadline.shortest, limits.deadline.longest);
    static_cast<void>(get_records()[component].take_seen());
    components_[component].is_global = limits.scope == SupervisionScope::kGlobal;
    return Status::kOk;
}

Status ExecutionSupervisor::watch(Span<const WatchRow> rows) noexcept {
    for (const WatchRow& row : rows) {
        const Status result = watch(find_component(table_components_, row.component), row.limits);
        if (result != Status::kOk) {
            return result;
        }
    }
    return Status::kOk;
}

Status ExecutionSupervisor::deactivate(std::size_t component) noexcept {
    const Status result = alive_.deactivate(component);
    if (result == Status::kOk) {
        components_[component].is_conspicuous = true;
    }
    return result;
}

bool ExecutionSupervisor::runs_in(std::size_t component, std::size_t mode) const noexcept {
    for (const ModeMemberRow& row : mode_members_) {
        if (row.mode == mode && row.index == component) {
            return true;
        }
    }
    return false;
}

void ExecutionSupervisor::follow_mode(std::size_t mode) noexcept {
    on_mode_step(ModeStep::kLeave, mode, Instant{});
    on_mode_step(ModeStep::kEnter, mode, Instant{});
}

/// A component is silent from the step in which it leaves to the step in which it enters. One that is not
/// watched is refused, and one that runs in both modes keeps its counts.
void ExecutionSupervisor::on_mode_step(ModeStep step, std::size_t index, Instant) noexcept {
    if (index >= mode_count_ || step == ModeStep::kSet) {
        return;
    }
    for (std::size_t component = 0U; component < components_.size(); ++component) {
        const bool runs = runs_in(component, index);
        if (step == ModeStep::kEnter && runs) {
            static_cast<void>(activate(component));
        } else if (step != ModeStep::kEnter && !runs) {
            static_cast<void>(deactivate(component));
        }
    }
}

Status ExecutionSupervisor::acknowledge(std::size_t component) noexcept {
    if (component >= components_.size()) {
        return Status::kBadParameter;
    }
    ComponentSlot& slot = components_[component];
    if (slot.status != LocalStatus::kExpired) {
        return Status::kPreconditionNotMet;
    }
    // Refuses where it has nothing to clear: the cause was another one.
    static_cast<void>(alive_.acknowledge(component));
    slot.status = LocalStatus::kOk;
    slot.cause = ExpiryCause::kNone;
    return Status::kOk;
}

/// Finds whom an overrun came for since the last step. One that comes in the meantime waits for the next.
void ExecutionSupervisor::collect_overruns() noexcept {
    if (!is_overrun_pending_.load(std::memory_order_relaxed)) {
        return;
    }
    static_cast<void>(is_overrun_pending_.exchange(false, std::memory_order_acquire));
    for (ComponentSlot& slot : components_) {
        if (slot.is_overrun_pending.load(std::memory_order_relaxed)) {
            slot.is_conspicuous = true;
        }
    }
}

/// Weighs all that is known of a component.
void ExecutionSupervisor::judge(std::size_t component, Instant now) noexcept {
    ComponentSlot& slot = components_[component];
    ExecutionRecord& record = get_records()[component];
    const bool has_overrun = slot.is_overrun_pending.exchange(false, std::memory_order_relaxed);
    const std::uint32_t seen = record.take_seen();
    if (seen != 0U) {
        // Refused for one that is not watched, whose runs nobody waits for.
        static_cast<void>(alive_.report_alive(component));
    }
    alive_.end_cycle(component);
    slot.has_just_expired = false;
    if (slot.status == LocalStatus::kExpired) {
        return;
    }
    const AliveVerdict verdict = alive_.get_verdict(component);
    // The worst condition first, so that it is the cause that is named.
    ExpiryCause cause = ExpiryCause::kNone;
    if (has_overrun) {
        cause = ExpiryCause::kBudgetOverrun;
    } else if ((seen & ExecutionRecord::kOutside) != 0U) {
        cause = ExpiryCause::kDeadline;
    } else if (verdict == AliveVerdict::kExpired) {
        cause = get_state(component) == LifecycleState::kError ? ExpiryCause::kInError : ExpiryCause::kSilent;
    }
    if (cause != ExpiryCause::kNone) {
        slot.status = LocalStatus::kExpired;
        slot.cause = cause;
        slot.has_just_expired = true;
        slot.expired_at = now;
    } else {
        slot.status = verdict == AliveVerdict::kHealthy ? LocalStatus::kOk : LocalStatus::kFailed;
    }
    slot.is_conspicuous = seen == 0U || slot.status != LocalStatus::kOk || !alive_.is_active(component);
}

/// What a component that was weighed adds to the whole.
ExecutionSupervisor::Share ExecutionSupervisor::weigh(std::size_t component, Instant now) noexcept {
    judge(component, now);
    const ComponentSlot& slot = components_[component];
    if (!slot.is_global) {
        return {GlobalStatus::kOk, false};
    }
    return {to_global(slot.status), alive_.is_active(component)};
}

GlobalStatus ExecutionSupervisor::step(Instant now) noexcept {
    bool is_anything_proven = false;
    GlobalStatus worst = is_release_late_ ? GlobalStatus::kFailed : GlobalStatus::kOk;
    is_release_late_ = false;
    collect_overruns();
    ExecutionRecord* record = get_records().data();
    for (ComponentSlot& slot : components_) {
        // The way of nearly every cycle: runs within their limits, and nothing else to be weighed.
        if (record->get_seen() == ExecutionRecord::kWithin && !slot.is_conspicuous) {
            static_cast<void>(record->take_seen());
            is_anything_proven |= slot.is_global;
        } else {
            const auto component = static_cast<std::size_t>(&slot - components_.begin());
            const Share share = weigh(component, now);
            worst = share.status > worst ? share.status : worst;
            is_anything_proven |= share.proves_something;
        }
        ++record;
    }
    if (worst == GlobalStatus::kOk && !is_anything_proven) {
        worst = GlobalStatus::kFailed;
    }
    global_status_ = worst;
    return worst;
}

void ExecutionSupervisor::expire(std::size_t component, ExpiryCause cause, Instant now) noexcept {
    ComponentSlot& slot = components_[component];
    if (slot.status == LocalStatus::kExpired) {
        return;
    }
    slot.status = LocalStatus::kExpired;
    slot.cause = cause;
    slot.has_just_expired = true;
    slot.is_conspicuous = true;
    slot.expired_at = now;
    if (slot.is_global) {
        global_status_ = GlobalStatus::kExpired;
    }
}

LifecycleState ExecutionSupervisor::get_state(std::size_t component) const noexcept {
    if (component >= table_components_.size()) {
        return LifecycleState::kCreated;
    }
    const Component& watched = *table_components_[component];
    const Span<ExecutionContext* const> contexts = watched.get_participating_contexts();
    if (contexts.empty()) {
        return LifecycleState::kCreated;
    }
    const Result<LifecycleState> state = contexts[0U]->get_component_state(watched);
    return state.has_value() ? state.get_value() : LifecycleState::kCreated;
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

void ExecutionSupervisor::on_budget_overrun(std::size_t, std::size_t component, Instant) noexcept {
    MAMORI_REQUIRE(3, component < components_.size());
    components_[component].is_overrun_pending.store(true, std::memory_order_relaxed);
    // An exchange, so that whoever clears it sees the components of all who set it since.
    static_cast<void>(is_overrun_pending_.exchange(true, std::memory_order_acq_rel));
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
    saturating_increment(late_release_.count);
}

}  // namespace mamori::safety
