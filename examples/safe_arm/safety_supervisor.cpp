// SPDX-License-Identifier: Apache-2.0
#include "safety_supervisor.hpp"

#include "arm_faults.hpp"
#include "arm_limits.hpp"
#include "mamori/safety/base/elapsed.hpp"

namespace safe_arm {

using mamori::Instant;
using namespace mamori::safety;  // NOLINT: this component is made of them

namespace {

TorqueSource choose_source(SafeState state) noexcept {
    switch (state) {
        case SafeState::kSelfTest:
            return TorqueSource::kBrakeTest;
        case SafeState::kOperational:
            return TorqueSource::kController;
        case SafeState::kSafe:
            return TorqueSource::kCarry;
        case SafeState::kStandby:
        case SafeState::kDegraded:
        case SafeState::kProtectiveStopSs2:
        case SafeState::kProtectiveStopSs1:
        case SafeState::kStandstillHold:
        case SafeState::kLockedOut:
        case SafeState::kLockedHold:
            break;
    }
    return TorqueSource::kStopLoop;
}

}  // namespace

/// Keeps the faults of the panel to which the table reacts in the current mode.
std::uint32_t SafetySupervisor::find_panel_faults(const JointReading& now) const noexcept {
    std::uint32_t faults = 0U;
    for (FaultIndex fault = 0U; fault < kArmFaultCount; ++fault) {
        const std::uint32_t bit = now.panel_faults & (std::uint32_t{1U} << fault);
        faults |= bit != 0U && has_reaction(fault, static_cast<std::size_t>(now.mode)) ? bit : 0U;
    }
    return faults;
}

CycleInputs SafetySupervisor::read_inputs(Instant at) noexcept {
    const JointReading& now = reading.read();
    panel_faults_ = find_panel_faults(now);
    is_brake_test_old_ = is_over(brakes_tested_at_.read().get_value(), at, kBrakeTestInterval) ||
                         !brakes_tested_at_.read().has_value();
    CycleInputs inputs{};
    inputs.is_standing = arm_state.read().is_standing;
    inputs.are_brakes_closed = now.brakes_closed;
    inputs.has_torque = now.torque_enabled;
    // One push of start ends the hold in its frame, and starts in the next one: no fault needs a reset there.
    const bool ends_hold = now.start_button && get_state() == SafeState::kStandstillHold;
    inputs.start_button = (now.start_button && !ends_hold) || has_ended_hold_;
    inputs.reset_button = now.reset_button || ends_hold;
    has_ended_hold_ = ends_hold;
    inputs.may_start =
        arm_state.read().is_setpoint_near && arm_state.read().is_clock_checked && panel_faults_ == 0U;
    inputs.mode = static_cast<std::size_t>(now.mode);
    // By the gate. One valid encoder channel suffices; an unknown position demands STO.
    inputs.can_hold = true;
    const TorqueSource source = drive.read().source;
    const bool is_stopping = source == TorqueSource::kStopLoop || source == TorqueSource::kCarry;
    inputs.applied = {drive.read().torque_enable, drive.read().brake_release,
                      drive.read().torque_enable && is_stopping, false};
    return inputs;
}

SelfTestStatus SafetySupervisor::step_self_test(bool is_first, Instant now) noexcept {
    if (is_first) {
        start_up_.begin(now);
    }
    const SelfTestStatus status =
        start_up_.step({arm_state.read().faults == 0U && is_watchdog_serviced(), reading.read()}, now);
    if (status == SelfTestStatus::kPassed) {
        brakes_tested_at_.set(now);
    }
    return status;
}

bool SafetySupervisor::is_present(FaultIndex fault) noexcept {
    if (fault == to_index(ArmFault::kMeasurementStale)) {
        return !reading.is_new() || !arm_state.is_new();
    }
    if (fault == to_index(ArmFault::kBrakeTestOld)) {
        // A stopped machine tests its brakes again after a reset; the fault must not refuse that reset.
        return is_brake_test_old_ && get_state() != SafeState::kSafe && get_state() != SafeState::kSelfTest;
    }
    // In the self test, the system may follow the selector: it cannot start there.
    if (fault == to_index(ArmFault::kModeSelector) && reading.read().is_mode_changing &&
        get_state() != SafeState::kSelfTest) {
        return true;
    }
    std::uint32_t faults = arm_state.read().faults | panel_faults_;
    faults &= is_active() ? ~0U : ~kPermissions;
    return (faults & (std::uint32_t{1U} << fault)) != 0U;
}

void SafetySupervisor::command(SafeState state, const StopOutputs& outputs) noexcept {
    const bool is_testing = state == SafeState::kSelfTest;
    StopCommand result{state, outputs.torque_enable, outputs.brake_release, outputs.stop_requested};
    // A machine that is locked out uses both paths.
    result.relay_close = is_testing ? start_up_.is_relay_wanted() : state != SafeState::kLockedOut;
    result.brake_test_share = is_testing ? start_up_.get_push() : 0.0;
    result.torque_source = choose_source(state);
    result.mode = reading.read().mode;
    stop.write(result);
}

}  // namespace safe_arm
