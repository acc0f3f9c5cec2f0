// SPDX-License-Identifier: Apache-2.0
#include "mamori/safety/supervision/checkpoint_supervisor.hpp"

#include "mamori/safety/base/elapsed.hpp"

namespace mamori::safety {
namespace {

/// Keeps the first violation.
void latch(EntityState& state, CheckpointViolation violation) noexcept {
    if (state.violation == CheckpointViolation::kNone) {
        state.violation = violation;
    }
}

CheckpointViolation judge_run(DeadlineLimits limits, Duration elapsed) noexcept {
    if (elapsed > limits.longest) {
        return CheckpointViolation::kTooLong;
    }
    return elapsed < limits.shortest ? CheckpointViolation::kTooShort : CheckpointViolation::kNone;
}

}  // namespace

/// Takes over the time of a call. Where it runs backwards, no limit can be judged any more.
void CheckpointSupervisor::advance(Instant now) noexcept {
    if (has_time_ && now < now_) {
        for (EntityState& state : entities_) {
            if (state.is_active) {
                latch(state, CheckpointViolation::kClock);
            }
        }
    }
    has_time_ = true;
    now_ = now;
}

/// Takes the reports up to `now`. One with a later time, from a context that runs beside this one, waits for
/// the next cycle. An entity that is not active reports in vain, an expired one whatever the time.
/// @return true when nothing speaks against the entity.
bool CheckpointSupervisor::take_reports(EntityIndex entity, Instant now) noexcept {
    EntityState& state = entities_[entity];
    CheckpointLog::Queue& queue = state.log.get_queue();
    const std::uint32_t lost_count = queue.get_rejected_count();
    if (lost_count != state.lost_count && state.is_active) {
        latch(state, CheckpointViolation::kLostReport);
    }
    state.lost_count = lost_count;
    // Bounded: an entity that goes on reporting meanwhile is not waited for.
    for (std::size_t i = 0U; i < kPendingCheckpointsMax && queue.peek() == Status::kOk; ++i) {
        const CheckpointEvent event = queue.get_front();
        if (event.at > now && state.violation == CheckpointViolation::kNone) {
            break;
        }
        if (is_judged(entity)) {
            judge_report(entity, event);
        }
        queue.drop();
        state.is_report_early = false;
    }
    return state.violation == CheckpointViolation::kNone;
}

/// A report whose time had not come in the last cycle must have come by now: a cycle lies between them.
void CheckpointSupervisor::judge_early_report(EntityIndex entity) noexcept {
    EntityState& state = entities_[entity];
    const bool is_early = is_judged(entity) && state.log.get_queue().peek() == Status::kOk;
    if (is_early && state.is_report_early) {
        latch(state, CheckpointViolation::kClock);
    }
    state.is_report_early = is_early;
}

void CheckpointSupervisor::judge_report(EntityIndex entity, const CheckpointEvent& event) noexcept {
    EntityState& state = entities_[entity];
    if (event.checkpoint >= table_.checkpoints.size() || get_owner(event.checkpoint) != entity) {
        latch(state, CheckpointViolation::kForeign);
        return;
    }
    if (state.has_reported && event.at < state.reported_at) {
        latch(state, CheckpointViolation::kClock);
        return;
    }
    state.has_reported = true;
    state.reported_at = event.at;
    const CheckpointRow& row = table_.checkpoints[event.checkpoint];
    if (row.role != CheckpointRole::kUnordered) {
        if (!is_next(state, row)) {
            latch(state, CheckpointViolation::kOrder);
            return;
        }
        state.last = row.checkpoint;
        state.is_run_begun = !is_final(row.role);
    }
    judge_deadlines_at(entity, event);
    count_report(event.checkpoint);
}

/// True when the graph allows this checkpoint now.
bool CheckpointSupervisor::is_next(const EntityState& state, const CheckpointRow& row) const noexcept {
    if (!state.is_run_begun) {
        return is_initial(row.role);
    }
    bool has_edge = false;
    for (const EdgeRow& edge : table_.edges) {
        has_edge = has_edge || (edge.from == state.last && edge.to == row.checkpoint);
    }
    return has_edge;
}

/// Ends and begins the times that this checkpoint ends and begins.
void CheckpointSupervisor::judge_deadlines_at(EntityIndex entity, const CheckpointEvent& event) noexcept {
    EntityState& state = entities_[entity];
    for (std::size_t i = 0U; i < deadlines_.size(); ++i) {
        const DeadlineRow& row = table_.deadlines[i];
        DeadlineState& deadline = deadlines_[i];
        if (row.finish == event.checkpoint) {
            latch(state, deadline.is_running
                             ? judge_run(row.limits, calc_elapsed(deadline.started_at, event.at))
                             : CheckpointViolation::kMissingStart);
            deadline.is_running = false;
        } else if (row.start == event.checkpoint) {
            latch(state,
                  deadline.is_running ? CheckpointViolation::kMissingFinish : CheckpointViolation::kNone);
            deadline.is_running = true;
            deadline.started_at = event.at;
        }
    }
}

void CheckpointSupervisor::count_report(CheckpointIndex checkpoint) noexcept {
    for (std::size_t i = 0U; i < alives_.size(); ++i) {
        if (table_.alives[i].checkpoint == checkpoint) {
            alives_[i].has_reported = true;
            ++alives_[i].count;
        }
    }
}

/// Counts the reference cycle as wrong, once.
void CheckpointSupervisor::record_wrong_cycle(std::size_t row) noexcept {
    AliveState& state = alives_[row];
    if (state.is_wrong) {
        return;
    }
    const EntityIndex entity = get_owner(table_.alives[row].checkpoint);
    state.is_wrong = true;
    ++state.failed_cycles;
    if (state.failed_cycles > table_.entities[entity].failed_reference_cycles) {
        latch(entities_[entity], CheckpointViolation::kAlive);
    }
}

/// Checks the reference cycle that a mode switch ends before its time: the reports up to now must not exceed
/// its maximum, nor be fewer than the part that has elapsed requires.
void CheckpointSupervisor::end_alive_early(std::size_t row) noexcept {
    const AliveCount& limits = table_.alives[row].count;
    const AliveState& state = alives_[row];
    const std::uint32_t least = limits.get_least() * state.cycle / limits.reference_cycles;
    if (state.count > limits.get_most() || state.count < least) {
        record_wrong_cycle(row);
    }
}

/// Ends a supervision cycle of one alive supervision. What is wrong in any case is so at once, once in each
/// reference cycle; whether the reports were enough is known at its end.
/// @return true when nothing was wrong in this cycle.
bool CheckpointSupervisor::end_alive_cycle(std::size_t row) noexcept {
    const AliveCount& limits = table_.alives[row].count;
    const EntityIndex entity = get_owner(table_.alives[row].checkpoint);
    if (!is_judged(entity)) {
        return !entities_[entity].is_active;
    }
    AliveState& state = alives_[row];
    // The count cannot wrap: 2^16 wrong reference cycles of less than 2^16 cycles expire every entity.
    state.silent_cycles = state.has_reported ? 0U : state.silent_cycles + 1U;
    state.has_reported = false;
    ++state.cycle;
    const bool is_end = state.cycle >= limits.reference_cycles;
    const bool is_stalled = state.silent_cycles > limits.calc_silence_max();
    const bool is_too_few = is_end && state.count < limits.get_least();
    const bool is_wrong = is_stalled || is_too_few || state.count > limits.get_most();
    if (is_wrong) {
        record_wrong_cycle(row);
    }
    if (is_end) {
        if (!state.is_wrong && state.failed_cycles > 0U) {
            --state.failed_cycles;
        }
        state.is_wrong = false;
        state.count = 0U;
        state.cycle = 0U;
    }
    return !is_wrong;
}

/// Holds a time that is running against now. The longest time itself is still legal.
/// @return true when it is not over.
bool CheckpointSupervisor::judge_running(std::size_t row, Instant now) noexcept {
    const EntityIndex entity = get_owner(table_.deadlines[row].start);
    if (!is_judged(entity)) {
        return !entities_[entity].is_active;
    }
    const DeadlineState& deadline = deadlines_[row];
    if (deadline.is_running && is_over(deadline.started_at, now, table_.deadlines[row].limits.longest)) {
        latch(entities_[entity], CheckpointViolation::kMissingFinish);
        return false;
    }
    return true;
}

/// The local status, worst first.
void CheckpointSupervisor::form_status(EntityIndex entity, Instant now) noexcept {
    EntityState& state = entities_[entity];
    if (state.violation != CheckpointViolation::kNone) {
        state.status = EntityStatus::kExpired;
        if (first_expired_ == kNoEntity) {
            first_expired_ = entity;
            // An older note that nobody has read yet stays: it tells of what came first.
            static_cast<void>(memory_.keep(entity, state.violation, now));
        }
        return;
    }
    if (!state.is_active) {
        state.status = EntityStatus::kDeactivated;
        return;
    }
    state.status = EntityStatus::kOk;
    for (std::size_t i = 0U; i < alives_.size(); ++i) {
        if (get_owner(table_.alives[i].checkpoint) == entity && alives_[i].failed_cycles > 0U) {
            state.status = EntityStatus::kFailed;
        }
    }
}

/// The global status, worst first. The table has an active entity in each mode, so there is something to
/// prove.
SupervisionStatus CheckpointSupervisor::form_whole() noexcept {
    if (status_ == SupervisionStatus::kStopped) {
        return status_;
    }
    EntityStatus worst = EntityStatus::kDeactivated;
    for (const EntityState& state : entities_) {
        worst = state.status > worst ? state.status : worst;
    }
    if (worst >= EntityStatus::kExpired) {
        if (expired_cycles_ >= table_.expired_cycles_tolerated) {
            return SupervisionStatus::kStopped;
        }
        ++expired_cycles_;
        return SupervisionStatus::kExpired;
    }
    expired_cycles_ = 0U;
    first_expired_ = kNoEntity;
    return worst == EntityStatus::kOk ? SupervisionStatus::kOk : SupervisionStatus::kFailed;
}

SupervisionStatus CheckpointSupervisor::step(Instant now, ProofChain& chain) noexcept {
    advance(now);
    for (EntityIndex e = 0U; e < get_entity_count(); ++e) {
        const bool is_sound = take_reports(e, now);
        judge_early_report(e);
        chain.add(ProofLink::kReports, e, is_sound ? 0U : 1U);
    }
    for (std::size_t i = 0U; i < alives_.size(); ++i) {
        chain.add(ProofLink::kAlive, i, end_alive_cycle(i) ? 0U : 1U);
    }
    for (std::size_t i = 0U; i < deadlines_.size(); ++i) {
        chain.add(ProofLink::kDeadline, i, judge_running(i, now) ? 0U : 1U);
    }
    for (EntityIndex e = 0U; e < get_entity_count(); ++e) {
        form_status(e, now);
        const EntityStatus wanted = is_wanted(e, mode_) ? EntityStatus::kOk : EntityStatus::kDeactivated;
        chain.add(ProofLink::kEntity, e, entities_[e].status == wanted ? 0U : 1U);
    }
    status_ = form_whole();
    chain.add(ProofLink::kWhole, 0U, status_ == SupervisionStatus::kOk ? 0U : 1U);
    return status_;
}

SupervisionStatus CheckpointSupervisor::step(Instant now) noexcept {
    ProofChain unasked{0U};
    return step(now, unasked);
}

/// Forgets the run, the reference cycle and the deadlines that the entity had begun. Silent cycles and wrong
/// reference cycles stay counted.
void CheckpointSupervisor::rest(EntityIndex entity) noexcept {
    EntityState& state = entities_[entity];
    state.is_run_begun = false;
    state.has_reported = false;
    for (std::size_t i = 0U; i < alives_.size(); ++i) {
        if (get_owner(table_.alives[i].checkpoint) == entity) {
            const AliveState before = alives_[i];
            alives_[i] = AliveState{};
            alives_[i].silent_cycles = before.has_reported ? 0U : before.silent_cycles;
            alives_[i].failed_cycles = before.failed_cycles;
        }
    }
    for (std::size_t i = 0U; i < deadlines_.size(); ++i) {
        if (get_owner(table_.deadlines[i].start) == entity) {
            deadlines_[i] = DeadlineState{};
        }
    }
}

Status CheckpointSupervisor::set_mode(std::size_t mode, Instant now) noexcept {
    if (mode >= table_.mode_count) {
        return Status::kBadParameter;
    }
    advance(now);
    for (EntityIndex e = 0U; e < get_entity_count(); ++e) {
        static_cast<void>(take_reports(e, now));
    }
    for (std::size_t i = 0U; i < deadlines_.size(); ++i) {
        static_cast<void>(judge_running(i, now));
    }
    for (std::size_t i = 0U; i < alives_.size(); ++i) {
        const EntityIndex entity = get_owner(table_.alives[i].checkpoint);
        if (is_judged(entity) && !is_wanted(entity, mode)) {
            end_alive_early(i);
        }
    }
    mode_ = mode;
    for (EntityIndex e = 0U; e < get_entity_count(); ++e) {
        if (entities_[e].is_active != is_wanted(e, mode)) {
            entities_[e].is_active = !entities_[e].is_active;
            rest(e);
        }
        form_status(e, now);
    }
    return Status::kOk;
}

Status CheckpointSupervisor::acknowledge(EntityIndex entity) noexcept {
    if (entity >= get_entity_count()) {
        return Status::kBadParameter;
    }
    if (entities_[entity].status != EntityStatus::kExpired || status_ == SupervisionStatus::kStopped) {
        return Status::kPreconditionNotMet;
    }
    entities_[entity].violation = CheckpointViolation::kNone;
    rest(entity);
    for (std::size_t i = 0U; i < alives_.size(); ++i) {
        if (get_owner(table_.alives[i].checkpoint) == entity) {
            alives_[i] = AliveState{};
        }
    }
    form_status(entity, now_);
    return Status::kOk;
}

}  // namespace mamori::safety
