// SPDX-License-Identifier: Apache-2.0
#include "safety_supervisor.hpp"

#include "arm_faults.hpp"
#include "arm_limits.hpp"
#include "mamori/safety/base/elapsed.hpp"

namespace safe_arm {

using mamori::Instant;
using namespace mamori::safety;  // NOLINT: this component is made of them

CycleInputs SafetySupervisor::read_inputs(Instant at) noexcept {
    const JointReading& now = reading.read();
    is_brake_test_old_ = is_over(brakes_tested_at_.read().get_value(), at, kBrakeTestInterval) ||
                         !brakes_tested_at_.read().has_value();
    CycleInputs inputs{};
    inputs.is_standing = arm_state.read().is_standing;
    inputs.are_brakes_closed = now.brakes_closed;
    inputs.has_torque = now.torque_enabled;
    inputs.start_button = now.start_button;
    inputs.reset_button = now.reset_button;
    inputs.may_start = arm_state.read().is_setpoint_near;
    inputs.can_hold =
        true;  // by the gate; one valid encoder channel suffices, an unknown position demands STO
    inputs.applied = {drive.read().torque_enable, drive.read().brake_release,
                      drive.read().torque_enable && drive.read().source == TorqueSource::kStopLoop, false};
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
    const std::uint32_t faults = arm_state.read().faults | reading.read().panel_faults;
    return (faults & (std::uint32_t{1U} << fault)) != 0U;
}

void SafetySupervisor::command(SafeState state, const StopOutputs& outputs) noexcept {
    const bool is_testing = state == SafeState::kSelfTest;
    StopCommand result{state, outputs.torque_enable, outputs.brake_release, outputs.stop_requested};
    // A machine that is locked out uses both paths.
    result.relay_close = is_testing ? start_up_.is_relay_wanted() : state != SafeState::kLockedOut;
    result.brake_test_share = is_testing ? start_up_.get_push() : 0.0;
    result.torque_source =
        is_testing ? TorqueSource::kBrakeTest
                   : (outputs.stop_requested ? TorqueSource::kStopLoop : TorqueSource::kController);
    stop.write(result);
}

}  // namespace safe_arm
