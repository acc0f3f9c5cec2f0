// SPDX-License-Identifier: Apache-2.0
/// @file
/// Process image of a seven-joint arm: what its devices give and take in each frame. A machine and a
/// simulated plant fill the same image, so the safety code cannot tell them apart.
///
/// @satisfies SWR-ARM-001      Design: docs/design/safe_arm.md#process-image
#ifndef MAMORI_SAFETY_ARM_ARM_DEVICE_HPP
#define MAMORI_SAFETY_ARM_ARM_DEVICE_HPP

#include <array>
#include <cstddef>
#include <cstdint>

#include "mamori/kernel/payload/fields.hpp"

namespace mamori::safety {

/// Joints of the arm, numbered 0 .. 6 from the base to the flange.
inline constexpr std::size_t kArmJointCount = 7U;

/// One number per joint.
using JointVector = std::array<double, kArmJointCount>;

/// Sampled by the device layer at the start of each frame.
struct ArmInputs {
    /// Channel A: incremental encoder at the motor, as counts of the joint angle; zero at joint angle 0.
    std::array<std::int32_t, kArmJointCount> encoder_a_counts{};
    /// Channel B: absolute encoder at the link, as counts of the joint angle; zero at joint angle 0.
    std::array<std::int32_t, kArmJointCount> encoder_b_counts{};
    /// Torque at the joint side as measured from the motor current [N m].
    JointVector measured_torque_nm{};
    /// Feedback contact of each brake: true = closed (holding).
    std::array<bool, kArmJointCount> brake_closed{};
    /// Feedback of the safe-torque-off input of the drives: true = torque is possible.
    bool torque_enabled{false};
    /// Feedback contact of the relay that feeds drives and brakes (EDM): true = closed.
    bool relay_closed{false};
    /// Drive supply voltage is inside its range.
    bool power_good{false};
    /// Operator requests operation. True while the button is pushed.
    bool start_button{false};
    /// Operator acknowledges a latched fault. True while the button is pushed.
    bool reset_button{false};
    /// Both channels of the emergency stop: true = circuit closed. An open one demands the stop, and a broken
    /// wire is an open one.
    std::array<bool, 2U> emergency_stop_closed{};
    /// Both channels of the protective stop, for example of a guard door: true = circuit closed.
    std::array<bool, 2U> protective_stop_closed{};
    /// Both channels of the enabling device: true = held in its middle position.
    std::array<bool, 2U> enabling_closed{};
    /// Contact of the third position of the enabling device: true = squeezed.
    bool enabling_squeezed{false};
    /// Hold-to-run button: true while it is held.
    bool run_button{false};
    /// Reference switch of each joint, a cam at the link: true = the joint angle is positive.
    std::array<bool, kArmJointCount> reference_closed{};
    /// Clock of the drives when they took this sample [ns], from a quartz of its own; 0: no sample yet.
    std::int64_t drive_clock_ns{0};
    /// Contacts of the mode selector, exactly one of which is closed: automatic, reduced speed, hold-to-run.
    std::array<bool, 3U> mode_selected{};
};

/// Written by the safety partition at the end of each frame. Default: the safe state.
struct ArmOutputs {
    /// Torque asked of each drive at the joint side [N m]; the drive saturates it.
    JointVector torque_nm{};
    /// Safe torque off, inverted: false = no torque on any joint (STO, IEC 61800-5-2).
    bool torque_enable{false};
    /// Safe brake control: false = all brakes close (SBC, IEC 61800-5-2).
    bool brake_release{false};
    /// Second switch-off path: false = the relay cuts the supply of drives and brakes. The watchdog opens it,
    /// too.
    bool relay_close{false};
};

}  // namespace mamori::safety

MAMORI_FIELDS(mamori::safety::ArmInputs, encoder_a_counts, encoder_b_counts, measured_torque_nm, brake_closed,
              torque_enabled, relay_closed, power_good, start_button, reset_button, emergency_stop_closed,
              protective_stop_closed, enabling_closed, enabling_squeezed, run_button, reference_closed,
              drive_clock_ns, mode_selected)
MAMORI_FIELDS(mamori::safety::ArmOutputs, torque_nm, torque_enable, brake_release, relay_close)

#endif  // MAMORI_SAFETY_ARM_ARM_DEVICE_HPP
