// SPDX-License-Identifier: Apache-2.0
#include "mamori/safety/cycle/safety_cycle.hpp"

#include "mamori/safety/base/elapsed.hpp"
#include "mamori/safety/reaction/reaction_table.hpp"

namespace mamori::safety {
namespace {

ExpiryCause to_cause(CheckpointViolation violation) noexcept {
    const bool is_time = violation == CheckpointViolation::kTooShort ||
                         violation == CheckpointViolation::kTooLong ||
                         violation == CheckpointViolation::kMissingFinish;
    return is_time ? ExpiryCause::kDeadline : ExpiryCause::kOutOfOrder;
}

}  // namespace

/// A degraded mode shows in no output: it begins with the state.
bool SafetyCycle::has_begun(const ReactionDemand& demand, const StopOutputs& applied) const noexcept {
    if (demand.reaction < Reaction::kSs2) {
        return true;
    }
    if (demand.reaction >= Reaction::kSto && waits_for_brakes(demand.fault) && !applied.brake_release) {
        return true;
    }
    return !applied.torque_enable || (demand.reaction < Reaction::kSto && applied.stop_requested);
}

bool SafetyCycle::has_reaction(FaultIndex fault, std::size_t mode) const noexcept {
    return find_demand(state_.reactions_, fault, mode).reaction != Reaction::kNone;
}

Status SafetyCycle::apply_table() noexcept {
    for (const ConfirmRow& row : state_.table_.confirmations) {
        Status result = state_.faults_.set_confirmation(row.fault, row.confirmation);
        if (result == Status::kOk) {
            result = state_.faults_.set_healing(row.fault, row.healing);
        }
        if (result != Status::kOk) {
            return result;
        }
    }
    for (const SuperviseRow& row : state_.table_.supervised) {
        const Checkpoints& points = row.checkpoints;
        if (points.supervisor != nullptr && &points.supervisor->get_table() != points.table) {
            return Status::kBadParameter;
        }
        Status result =
            state_.supervision_.watch(state_.supervision_.find(*row.watch.component), row.watch.limits);
        if (result == Status::kOk) {
            result = require_healing(row);
        }
        if (result != Status::kOk) {
            return result;
        }
    }
    for (SelfTestSchedule& schedule : state_.schedules_) {
        const Status result = schedule.start(Instant{}, state_.period_);
        if (result != Status::kOk) {
            return result;
        }
    }
    return Status::kOk;
}

/// A silent component is found once in its expired_cycles. Its fault must not heal in between.
Status SafetyCycle::require_healing(const SuperviseRow& row) noexcept {
    if (row.fault == kNoFault) {
        return Status::kOk;
    }
    Healing healing = state_.faults_.get_record(row.fault).healing;
    if (healing.cycles > row.watch.limits.alive.expired_cycles) {
        return Status::kOk;
    }
    healing.cycles = row.watch.limits.alive.expired_cycles;
    return state_.faults_.set_healing(row.fault, healing);
}

void SafetyCycle::decide(Instant now) noexcept {
    state_.flow_.report(FlowPoint::kBegun, now);
    CycleInputs machine = read_inputs(now);
    if (machine.mode != followed_mode_) {
        followed_mode_ = machine.mode;
        state_.supervision_.follow_mode(machine.mode);
    }
    static_cast<void>(state_.supervision_.step(now));
    step_checkpoints(now);
    const GlobalStatus health = state_.supervision_.get_global_status();
    drop_unproven(machine);
    record_expiries(now);
    const SafeState before = state_.machine_.get_state();
    SafeStateInputs inputs{};
    inputs.standstill = state_.brakes_.confirm(before, machine.is_standing, machine.are_brakes_closed, now);
    inputs.self_test = combine(combine(test(now), check_assumptions(now)), repeat_self_tests(now));
    report_faults(inputs.self_test, now);
    follow_reset(machine.reset_button);
    const ReactionDemand demand = calc_reaction(state_.reactions_, state_.faults_, machine.mode);
    measure_reaction(demand, machine.applied, now);
    inputs.now = now;
    inputs.demand = demand.reaction;
    inputs.start_button = machine.start_button;
    inputs.reset_button = machine.reset_button;
    inputs.faults_cleared = state_.faults_.get_latched_count() == 0U;
    inputs.brakes_failed = have_brakes_failed(machine, before, now);
    inputs.start_permitted = machine.may_start && is_watchdog_serviced_ && are_connections_fresh(now);
    inputs.lock_out = is_sto_unconfirmed(machine.has_torque, now);
    const SafeState state = state_.machine_.step(inputs);
    state_.flow_.report(FlowPoint::kJudged, now);
    if (state != before) {
        write_event(now, Severity::kInfo, CycleEvent::kStateEntered, static_cast<std::int64_t>(state));
    }
    if (demand.reaction > worst_reaction_) {
        worst_reaction_ = demand.reaction;
        write_event(now, Severity::kWarning, CycleEvent::kReactionBegun,
                    static_cast<std::int64_t>(demand.reaction));
    }
    StopOutputs outputs = state_.brakes_.apply(state, now);
    if (carries_until_closed(state, machine.can_hold, now)) {
        outputs.torque_enable = true;
        outputs.stop_requested = true;
    }
    outputs.torque_enable =
        outputs.torque_enable || (state == SafeState::kSelfTest && is_self_testing_ && wants_test_torque());
    command(state, outputs);
    state_.flow_.report(FlowPoint::kCommanded, now);
    const GlobalStatus flow = to_global_status(state_.flow_.supervisor.step(now));
    service_watchdog(calc_worst(health, flow), state_.machine_.is_consistent() && !inputs.lock_out, now);
    was_torque_wanted_ = outputs.torque_enable;
    stepped_at_ = now;
    has_stepped_ = true;
}

/// Once in each cycle, after the status of the components is formed.
void SafetyCycle::step_checkpoints(Instant now) noexcept {
    if (state_.checkpoints_ == nullptr) {
        return;
    }
    // The status of the whole is that of the components, which have their own scopes.
    static_cast<void>(state_.checkpoints_->step(now));
    for (const SuperviseRow& row : state_.table_.supervised) {
        if (row.checkpoints.supervisor == nullptr) {
            continue;
        }
        const CheckpointViolation violation = state_.checkpoints_->get_violation(row.checkpoints.entity);
        if (violation != CheckpointViolation::kNone) {
            state_.supervision_.expire(state_.supervision_.find(*row.watch.component), to_cause(violation),
                                       now);
        }
    }
}

/// The value of a source that is late or expired may be old: it confirms nothing.
void SafetyCycle::drop_unproven(CycleInputs& machine) const noexcept {
    machine.is_standing = machine.is_standing && is_proven(StopConfirmation::kStandstill);
    machine.are_brakes_closed = machine.are_brakes_closed && is_proven(StopConfirmation::kClosedBrakes);
    machine.has_torque = machine.has_torque || !is_proven(StopConfirmation::kTorqueOff);
}

bool SafetyCycle::is_proven(StopConfirmation confirmation) const noexcept {
    const std::size_t source = state_.stop_sources_[static_cast<std::size_t>(confirmation)];
    return source == kNoIndex || state_.supervision_.get_local_status(source) == LocalStatus::kOk;
}

SelfTestStatus SafetyCycle::test(Instant now) noexcept {
    if (state_.machine_.get_state() != SafeState::kSelfTest) {
        is_self_testing_ = false;
        return SelfTestStatus::kPassed;
    }
    const bool is_first = !is_self_testing_;
    is_self_testing_ = true;
    return step_self_test(is_first, now);
}

/// One that is lost while the machine moves fails the self test too, and that locks out.
SelfTestStatus SafetyCycle::check_assumptions(Instant now) noexcept {
    auto status = SelfTestStatus::kPassed;
    for (AssumptionMonitor& monitor : state_.assumptions_) {
        const bool had_failed = monitor.get_status() == SelfTestStatus::kFailed;
        status = monitor.step(now);
        if (status == SelfTestStatus::kFailed && !had_failed) {
            write_event(now, Severity::kFault, CycleEvent::kAssumptionFailed, monitor.get_failed());
        }
    }
    return status;
}

/// @return kRunning until each first pass has ended; a failed test is its fault, whose reaction is in the
/// table, and else does not prevent the end of the state SelfTest.
SelfTestStatus SafetyCycle::repeat_self_tests(Instant now) noexcept {
    auto result = SelfTestStatus::kPassed;
    is_test_failed_ = false;
    for (std::size_t i = 0U; i < state_.schedules_.size(); ++i) {
        SelfTestSchedule& schedule = state_.schedules_[i];
        const bool had_failed = schedule.get_failure() != SelfTestFailure::kNone;
        if (!has_stepped_) {
            // The time begins here. The initialisation has shown that the steps fit.
            static_cast<void>(schedule.start(now, state_.period_));
        }
        const SelfTestStatus status = schedule.step(now);
        result = status == SelfTestStatus::kRunning ? status : result;
        const bool has_failed = status >= SelfTestStatus::kFailed;
        is_test_failed_ = is_test_failed_ || has_failed;
        if (has_failed && !had_failed) {
            write_event(now, Severity::kFault, CycleEvent::kSelfTestFailed, static_cast<std::int64_t>(i));
        }
    }
    return result;
}

bool SafetyCycle::has_failed_test(FaultIndex fault) const noexcept {
    bool result = false;
    for (std::size_t i = 0U; i < state_.schedules_.size(); ++i) {
        result = result || (state_.table_.self_tests[i].fault == fault &&
                            state_.schedules_[i].get_status() >= SelfTestStatus::kFailed);
    }
    return result;
}

/// A connection is needed while the machine moves as others command. The controlled stops do without.
bool SafetyCycle::has_lost_connection(FaultIndex fault, Instant now) const noexcept {
    const SafeState state = state_.machine_.get_state();
    const bool is_needed = state == SafeState::kOperational || state == SafeState::kDegraded;
    bool result = false;
    for (const ProtectRow& row : state_.table_.protections) {
        result = result || (is_needed && row.fault == fault && !row.receiver->is_fresh(now, row.limit));
    }
    return result;
}

bool SafetyCycle::are_connections_fresh(Instant now) const noexcept {
    bool result = true;
    for (const ProtectRow& row : state_.table_.protections) {
        result = result && row.receiver->is_fresh(now, row.limit);
    }
    return result;
}

void SafetyCycle::report_faults(SelfTestStatus self_test, Instant now) noexcept {
    for (std::size_t i = 0U; i < state_.faults_.get_capacity(); ++i) {
        const auto fault = static_cast<FaultIndex>(i);
        const bool was_latched = state_.faults_.is_latched(fault);
        state_.faults_.report(fault, find_presence(fault, self_test, now), now);
        if (!was_latched && state_.faults_.is_latched(fault)) {
            write_event(now, Severity::kFault, CycleEvent::kFaultLatched, fault);
        }
    }
    if (first_fault_ == kNoFault) {
        first_fault_ = state_.faults_.get_first();
    }
}

bool SafetyCycle::find_presence(FaultIndex fault, SelfTestStatus self_test, Instant now) noexcept {
    bool result = is_present(fault);
    result = result || (fault == state_.table_.cycle.self_test_fault && self_test == SelfTestStatus::kFailed);
    result = result || (fault == state_.table_.cycle.late_fault && is_reaction_late_);
    result = result || (fault == state_.table_.cycle.brake_fault && state_.brakes_.is_overdue(now));
    result = result || (is_test_failed_ && has_failed_test(fault)) || has_lost_connection(fault, now);
    for (const SuperviseRow& row : state_.table_.supervised) {
        if (row.fault == fault && is_expired(row)) {
            result = true;
        }
    }
    return result;
}

/// Before the faults of this cycle: a component that expires again while its fault is latched is no news.
void SafetyCycle::record_expiries(Instant now) noexcept {
    if (state_.supervision_.get_first_expired() == ExecutionSupervisor::kNoComponent) {
        return;
    }
    for (const SuperviseRow& row : state_.table_.supervised) {
        const std::size_t index = state_.supervision_.find(*row.watch.component);
        const bool is_known = row.fault != kNoFault && state_.faults_.is_latched(row.fault);
        if (state_.supervision_.has_just_expired(index) && !is_known) {
            last_expiry_ = {index, state_.supervision_.get_cause(index)};
            write_event(now, Severity::kFault, CycleEvent::kComponentExpired,
                        static_cast<std::int64_t>(last_expiry_.cause),
                        static_cast<std::uint16_t>(index + 1U));
        }
    }
}

/// Once the fault is latched, the supervision starts again. A component that still hangs expires again, at
/// the latest after its expired_cycles; until then, the healing of the fault is not complete.
bool SafetyCycle::is_expired(const SuperviseRow& row) noexcept {
    const std::size_t index = state_.supervision_.find(*row.watch.component);
    const bool result = state_.supervision_.get_local_status(index) == LocalStatus::kExpired;
    if (result && state_.faults_.is_latched(row.fault)) {
        static_cast<void>(state_.supervision_.acknowledge(index));
        if (row.checkpoints.supervisor != nullptr) {
            // Refused unless its checkpoints are the cause, or once they are stopped for good.
            static_cast<void>(state_.checkpoints_->acknowledge(row.checkpoints.entity));
        }
    }
    return result;
}

/// A deliberate push acknowledges what is no longer present; the state machine judges the same push by
/// itself.
void SafetyCycle::follow_reset(bool reset_button) noexcept {
    if (reset_edge_.step(reset_button)) {
        // What is still present stays latched, and the machine then refuses the reset: no status to act on.
        static_cast<void>(state_.faults_.acknowledge_all());
    }
}

/// Torque may not end while nothing else holds the machine. The bound of the stop is the last chance to say
/// so.
bool SafetyCycle::have_brakes_failed(const CycleInputs& machine, SafeState state,
                                     Instant now) const noexcept {
    const bool is_at_bound =
        calc_elapsed(state_.machine_.get_entered_at(), now) >= state_.table_.cycle.stops.ss1_within;
    const bool is_over = state_.brakes_.is_overdue(now) || (is_at_bound && state_.brakes_.is_waiting());
    return state == SafeState::kProtectiveStopSs1 && machine.can_hold && machine.is_standing && is_over;
}

/// Where only the position is unknown, torque carries the machine until its brakes have bitten. Any other
/// cause of STO, such as a drive that is not trusted, ends it at once.
bool SafetyCycle::carries_until_closed(SafeState state, bool can_hold, Instant now) const noexcept {
    if (state != SafeState::kSafe || !can_hold || !was_torque_wanted_ || !state_.brakes_.is_closing(now)) {
        return false;
    }
    bool is_demanded = false;
    for (std::size_t i = 0U; i < state_.faults_.get_capacity(); ++i) {
        const auto fault = static_cast<FaultIndex>(i);
        const FaultRecord& record = state_.faults_.get_record(fault);
        if (record.is_latched && record.demand.reaction >= Reaction::kSto) {
            if (!waits_for_brakes(fault)) {
                return false;
            }
            is_demanded = true;
        }
    }
    return is_demanded;
}

/// The stop of last resort has a confirmation too: the drives' own feedback. Memory that has changed by
/// itself does not tell how long it has been missing, and stays so: that counts as too long.
bool SafetyCycle::is_sto_unconfirmed(bool has_torque, Instant now) noexcept {
    const Result<Duration> so_far = state_.torque_despite_sto_for_.read();
    if (!so_far.has_value()) {
        return true;
    }
    const bool is_contradicted = has_torque && !was_torque_wanted_ && has_stepped_;
    const Duration elapsed = calc_elapsed(stepped_at_, now);
    const Duration missing_for = is_contradicted ? so_far.get_value() + elapsed : Duration{0};
    state_.torque_despite_sto_for_.set(missing_for);
    return elapsed < Duration{0} || missing_for > state_.table_.cycle.torque_feedback;
}

/// The outputs of the last frame show whether a reaction has begun. Each latched fault keeps its own time: a
/// worse one that comes later gives no additional one.
void SafetyCycle::measure_reaction(const ReactionDemand& demand, const StopOutputs& applied,
                                   Instant now) noexcept {
    is_reaction_late_ = false;
    for (std::size_t i = 0U; i < state_.faults_.get_capacity(); ++i) {
        const FaultRecord& record = state_.faults_.get_record(static_cast<FaultIndex>(i));
        const bool is_awaited = record.is_latched && !has_begun(record.demand, applied);
        if (is_awaited && is_over(record.latched_at, now, record.demand.within)) {
            is_reaction_late_ = true;
        }
    }
    if (demand.fault == kNoFault) {
        measured_fault_ = kNoFault;
        return;
    }
    if (has_begun(demand, applied) && measured_fault_ != demand.fault) {
        measured_fault_ = demand.fault;
        const Duration time = calc_elapsed(state_.faults_.get_record(demand.fault).latched_at, now);
        longest_reaction_ = time > longest_reaction_ ? time : longest_reaction_;
    }
}

void SafetyCycle::service_watchdog(GlobalStatus health, bool is_trustworthy, Instant now) noexcept {
    const WatchdogOutcome outcome = state_.gate_.step(now, health, is_trustworthy);
    is_watchdog_serviced_ = outcome == WatchdogOutcome::kServiced;
    const bool is_refused = outcome != WatchdogOutcome::kServiced && outcome != WatchdogOutcome::kHeldBack;
    if (is_refused && !is_watchdog_refused_) {
        write_event(now, Severity::kFault, CycleEvent::kWatchdogRefused, static_cast<std::int64_t>(health));
    }
    is_watchdog_refused_ = is_refused;
}

void SafetyCycle::write_event(Instant now, Severity severity, CycleEvent event, std::int64_t argument,
                              std::uint16_t source) noexcept {
    if (log_ != nullptr) {
        log_->write(now, severity, source, static_cast<std::uint16_t>(event), argument);
    }
}

}  // namespace mamori::safety
