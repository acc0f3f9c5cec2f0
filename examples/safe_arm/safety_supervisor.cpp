// SPDX-License-Identifier: Apache-2.0
#include "safety_supervisor.hpp"

namespace safe_arm {

using mamori::ContextHandle;
using mamori::Duration;
using mamori::Instant;
using mamori::Severity;
using mamori::Status;
using namespace mamori::safety;  // NOLINT: this component is made of them

Status SafetySupervisor::on_initialize() noexcept {
    controller_index_ = supervision_.find(controller_);
    for (std::size_t fault = 0U; fault < kArmFaultCount; ++fault) {
        const Status result =
            faults_.set_confirmation(static_cast<FaultIndex>(fault), {kConfirmFrames[fault]});
        if (result != Status::kOk) {
            return result;
        }
    }
    return Status::kOk;
}

Status SafetySupervisor::on_execute(ContextHandle context) noexcept {
    flow_.report(FlowPoint::kBegun, context.now);
    const JointReading& now = reading.read();
    const GlobalStatus health = supervision_.step(context.now);
    SafeStateInputs inputs{};
    inputs.self_test = combine(step_self_test(now, context.now), check_assumptions(context.now));
    report_faults(inputs.self_test, context.now);
    follow_reset(now);
    const ReactionDemand demand = calc_reaction(kArmReactions, faults_);
    inputs.now = context.now;
    inputs.demand = demand.reaction;
    inputs.start_button = now.start_button;
    inputs.reset_button = now.reset_button;
    inputs.standstill = arm_state.read().is_standing && (!is_in_ss1() || now.brakes_closed);
    inputs.faults_cleared = faults_.get_latched_count() == 0U;
    inputs.start_permitted = arm_state.read().is_setpoint_near && is_watchdog_served_;
    inputs.lock_out = is_sto_unconfirmed(now);
    const SafeState before = machine_.get_state();
    const SafeState state = machine_.step(inputs);
    flow_.report(FlowPoint::kJudged, context.now);
    if (state != before) {
        write_event(context.now, Severity::kInfo, ArmEvent::kStateEntered, static_cast<std::int64_t>(state));
    }
    note_reaction(demand.reaction, context.now);
    const StopOutputs outputs = calc_stop_outputs(state);
    stop.write(
        {state, outputs.torque_enable, outputs.brake_release && !are_brakes_due(), outputs.stop_requested});
    flow_.report(FlowPoint::kCommanded, context.now);
    const GlobalStatus flow = to_global_status(flow_.supervisor.step(context.now));
    serve_watchdog(calc_worst(health, flow), machine_.is_consistent() && !inputs.lock_out, context.now);
    return Status::kOk;
}

/// Good means: nothing to report, brakes closed, torque off, and the watchdog watches: one that was never
/// served would not. So many good frames in a row pass the test.
SelfTestStatus SafetySupervisor::step_self_test(const JointReading& now, Instant instant) noexcept {
    if (machine_.get_state() != SafeState::kSelfTest) {
        is_self_testing_ = false;
        return SelfTestStatus::kPassed;
    }
    if (!is_self_testing_) {
        is_self_testing_ = true;
        self_test_began_ = instant;
        good_frames_ = 0U;
    }
    const bool is_good =
        arm_state.read().faults == 0U && now.brakes_closed && !now.torque_enabled && is_watchdog_served_;
    good_frames_ = is_good ? good_frames_ + 1U : 0U;
    if (is_over(self_test_began_, instant, kSelfTestTime)) {
        return SelfTestStatus::kFailed;
    }
    return good_frames_ >= kSelfTestFrames ? SelfTestStatus::kPassed : SelfTestStatus::kRunning;
}

/// One that is lost while the arm moves fails the self test too, and that locks out.
SelfTestStatus SafetySupervisor::check_assumptions(Instant instant) noexcept {
    const bool had_failed = assumptions_.get_status() == SelfTestStatus::kFailed;
    const SelfTestStatus status = assumptions_.step(instant);
    if (status == SelfTestStatus::kFailed && !had_failed) {
        write_event(instant, Severity::kFault, ArmEvent::kAssumptionFailed, assumptions_.get_failed());
    }
    return status;
}

void SafetySupervisor::report_faults(SelfTestStatus self_test, Instant instant) noexcept {
    const std::uint32_t seen = arm_state.read().faults;
    for (std::size_t i = 0U; i < kArmFaultCount; ++i) {
        const auto fault = static_cast<ArmFault>(i);
        bool is_present = (seen & to_bit(fault)) != 0U;
        if (fault == ArmFault::kControllerSilent) {
            is_present = is_controller_silent();
        } else if (fault == ArmFault::kSelfTestFailed) {
            is_present = self_test == SelfTestStatus::kFailed;
        } else if (fault == ArmFault::kMeasurementStale) {
            is_present = !reading.is_new() || !arm_state.is_new();
        }
        const bool was_latched = faults_.is_latched(to_index(fault));
        faults_.report(to_index(fault), is_present, instant);
        if (!was_latched && faults_.is_latched(to_index(fault))) {
            write_event(instant, Severity::kFault, ArmEvent::kFaultLatched, to_index(fault));
        }
    }
    if (first_fault_ == kNoFault) {
        first_fault_ = faults_.get_first();
    }
}

/// In the safe state each frame is judged anew: a controller that still hangs expires again in every frame,
/// one that runs again is silent no more, and the fault register alone remembers that it was.
bool SafetySupervisor::is_controller_silent() noexcept {
    const bool is_expired = supervision_.get_local_status(controller_index_) == LocalStatus::kExpired;
    if (is_expired && machine_.get_state() == SafeState::kSafe) {
        static_cast<void>(supervision_.acknowledge(controller_index_));
    }
    return is_expired;
}

/// A deliberate push acknowledges what is no longer present; the state machine judges the same push by
/// itself.
void SafetySupervisor::follow_reset(const JointReading& now) noexcept {
    if (!reset_edge_.step(now.reset_button)) {
        return;
    }
    // What is still present stays latched, and the machine then refuses the reset: no status to act on here.
    static_cast<void>(faults_.acknowledge_all());
}

/// The stop of last resort has a confirmation too: the drives' own feedback. Memory that has changed by
/// itself does not tell how long it has been missing, and stays so: that counts as too long.
bool SafetySupervisor::is_sto_unconfirmed(const JointReading& now) noexcept {
    const mamori::Result<Duration> so_far = torque_despite_sto_for_.read();
    if (!so_far.has_value()) {
        return true;
    }
    const bool is_contradicted = !calc_stop_outputs(machine_.get_state()).torque_enable && now.torque_enabled;
    const Duration missing_for = is_contradicted ? so_far.get_value() + kFrame : Duration{0};
    torque_despite_sto_for_.set(missing_for);
    return missing_for > kTorqueFeedbackTime;
}

/// At the end of a controlled stop the brakes close while the torque still holds the arm, so it does not sag
/// between the two. Once begun, the closing goes on; the bound of the stop ends it if the brakes never
/// report.
bool SafetySupervisor::are_brakes_due() noexcept {
    has_stood_in_ss1_ = is_in_ss1() && (has_stood_in_ss1_ || arm_state.read().is_standing);
    return has_stood_in_ss1_;
}

void SafetySupervisor::note_reaction(Reaction reaction, Instant instant) noexcept {
    if (reaction > worst_reaction_) {
        worst_reaction_ = reaction;
        write_event(instant, Severity::kWarning, ArmEvent::kReactionBegun,
                    static_cast<std::int64_t>(reaction));
    }
}

void SafetySupervisor::serve_watchdog(GlobalStatus health, bool is_trustworthy, Instant instant) noexcept {
    const WatchdogOutcome outcome = gate_.step(instant, health, is_trustworthy);
    is_watchdog_served_ = outcome == WatchdogOutcome::kServiced;
    const bool is_refused = outcome != WatchdogOutcome::kServiced && outcome != WatchdogOutcome::kHeldBack;
    if (is_refused && !is_watchdog_refused_) {
        write_event(instant, Severity::kFault, ArmEvent::kWatchdogRefused, static_cast<std::int64_t>(health));
    }
    is_watchdog_refused_ = is_refused;
}

void SafetySupervisor::write_event(Instant instant, Severity severity, ArmEvent event,
                                   std::int64_t argument) noexcept {
    log_.write(instant, severity, 0U, static_cast<std::uint16_t>(event), argument);
}

}  // namespace safe_arm
