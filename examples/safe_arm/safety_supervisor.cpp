// SPDX-License-Identifier: Apache-2.0
#include "safety_supervisor.hpp"

#include "arm_faults.hpp"
#include "arm_limits.hpp"
#include "mamori/safety/base/elapsed.hpp"

namespace safe_arm {

using mamori::Instant;
using namespace mamori::safety;  // NOLINT: this component is made of them

CycleInputs SafetySupervisor::read_inputs(Instant) noexcept {
    const JointReading& now = reading.read();
    CycleInputs inputs{};
    inputs.is_standing = arm_state.read().is_standing;
    inputs.are_brakes_closed = now.brakes_closed;
    inputs.has_torque = now.torque_enabled;
    inputs.start_button = now.start_button;
    inputs.reset_button = now.reset_button;
    inputs.may_start = arm_state.read().is_setpoint_near;
    inputs.applied = {drive.read().torque_enable, drive.read().brake_release,
                      stop.get_published().stop_requested, false};
    return inputs;
}

/// Good means: nothing to report, brakes closed, torque off, and the watchdog watches: one that was never
/// served would not. So many good frames in a row pass the test.
SelfTestStatus SafetySupervisor::step_self_test(bool is_first, Instant now) noexcept {
    if (is_first) {
        self_test_began_ = now;
        good_frames_ = 0U;
    }
    const bool is_good = arm_state.read().faults == 0U && reading.read().brakes_closed &&
                         !reading.read().torque_enabled && is_watchdog_served();
    good_frames_ = is_good ? good_frames_ + 1U : 0U;
    if (is_over(self_test_began_, now, kSelfTestTime)) {
        return SelfTestStatus::kFailed;
    }
    return good_frames_ >= kSelfTestFrames ? SelfTestStatus::kPassed : SelfTestStatus::kRunning;
}

bool SafetySupervisor::is_present(FaultIndex fault) noexcept {
    if (fault == to_index(ArmFault::kMeasurementStale)) {
        return !reading.is_new() || !arm_state.is_new();
    }
    return (arm_state.read().faults & (std::uint32_t{1U} << fault)) != 0U;
}

void SafetySupervisor::command(SafeState state, const StopOutputs& outputs) noexcept {
    stop.write({state, outputs.torque_enable, outputs.brake_release, outputs.stop_requested});
}

}  // namespace safe_arm
