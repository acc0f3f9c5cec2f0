// SPDX-License-Identifier: Apache-2.0
/// @file
/// What the components of the safe arm tell each other. Each message crosses a window or a partition as
/// bytes.
///
/// @satisfies SWR-SAF-001      Design: docs/design/safe_arm.md#messages
#ifndef EXAMPLES_SAFE_ARM_MESSAGES_HPP
#define EXAMPLES_SAFE_ARM_MESSAGES_HPP

#include <array>
#include <cstdint>

#include "mamori/kernel/payload/fields.hpp"
#include "mamori/safety/arm/arm_device.hpp"
#include "mamori/safety/reaction/safe_state.hpp"

namespace safe_arm {

using mamori::safety::JointVector;
using mamori::safety::kArmJointCount;

/// Modes of the system table, and the events that request them. In all modes but kAutomatic, the arm is slow
/// and needs the enabling device. The system starts in the strictest mode.
enum class OperatingMode : std::uint8_t {
    kHoldToRun,  ///< needs the hold-to-run button, too
    kReducedSpeed,
    kAutomatic,
    kSwitchFailed,  ///< safe mode: a mode switch failed, and the arm does not start
};

/// Device image in physical units, and what the operator demands. Nothing else is checked yet.
struct JointReading {
    JointVector position_a_rad{};
    JointVector position_b_rad{};
    JointVector measured_torque_nm{};
    bool brakes_closed{true};    ///< feedback: all seven are closed
    bool brakes_open{false};     ///< feedback: all seven are open; neither, while they move or one sticks
    bool torque_enabled{false};  ///< feedback
    bool relay_closed{false};    ///< feedback
    bool power_good{false};
    bool start_button{false};                             ///< a deliberate push ends in this frame
    bool reset_button{false};                             ///< likewise
    std::array<bool, kArmJointCount> reference_closed{};  ///< the joint angle is positive
    std::int64_t drive_clock_ns{0};                       ///< 0: no sample yet
    OperatingMode mode{OperatingMode::kHoldToRun};        ///< of the system, in this frame
    bool is_mode_changing{false};    ///< the selector shows another one, or a mode switch has not ended
    std::uint32_t panel_faults{0U};  ///< of the operator panel in any mode; bit n = ArmFault n
};

/// What the monitor vouches for, and the faults it sees in this cycle (bit n = ArmFault n).
struct JointState {
    JointVector position_rad{};    ///< from a channel that is not distrusted
    JointVector velocity_rad_s{};  ///< mean over the last 4 cycles
    std::uint32_t faults{0U};
    bool is_standing{false};       ///< below the standstill speed for the confirmation time
    bool is_clock_checked{false};  ///< compared with the clock of the drives
    bool is_setpoint_near{false};  ///< setpoint within the bumpless tolerance of the measured position
};

/// From the non-safety controller, over the grey channel.
struct TorqueCommand {
    std::uint32_t sequence{0U};
    std::int64_t sent_at_ns{0};
    JointVector setpoint_rad{};
    JointVector torque_nm{};
};

/// Where the torque of the drives comes from.
enum class TorqueSource : std::uint8_t {
    kController,
    kStopLoop,   ///< the gate stops the arm and holds it
    kBrakeTest,  ///< against closed brakes
    kCarry,      ///< against gravity at the last known position, while the brakes close
};

/// The supervisor's decision for this cycle.
struct StopCommand {
    mamori::safety::SafeState state{mamori::safety::SafeState::kSelfTest};
    bool torque_enable{false};
    bool brake_release{false};
    bool stop_requested{false};  ///< controlled stop or hold (SS1, SS2, SOS), made by the gate
    bool relay_close{false};     ///< second switch-off path
    TorqueSource torque_source{TorqueSource::kController};
    double brake_test_share{0.0};  ///< of the torque limit, -1 .. 1
    OperatingMode mode{OperatingMode::kHoldToRun};
};

/// What the drive gate gave to the drives.
struct DriveCommand {
    JointVector torque_nm{};
    bool torque_enable{false};
    bool brake_release{false};
    bool relay_close{false};
    TorqueSource source{TorqueSource::kController};
    JointVector stop_setpoint_rad{};  ///< of the stop loop
    JointVector gravity_nm{};         ///< torque that holds the arm at its measured position
};

}  // namespace safe_arm

MAMORI_FIELDS(safe_arm::JointReading, position_a_rad, position_b_rad, measured_torque_nm, brakes_closed,
              brakes_open, torque_enabled, relay_closed, power_good, start_button, reset_button,
              reference_closed, drive_clock_ns, mode, is_mode_changing, panel_faults)
MAMORI_FIELDS(safe_arm::JointState, position_rad, velocity_rad_s, faults, is_standing, is_clock_checked,
              is_setpoint_near)
MAMORI_FIELDS(safe_arm::TorqueCommand, sequence, sent_at_ns, setpoint_rad, torque_nm)
MAMORI_FIELDS(safe_arm::StopCommand, state, torque_enable, brake_release, stop_requested, relay_close,
              torque_source, brake_test_share, mode)
MAMORI_FIELDS(safe_arm::DriveCommand, torque_nm, torque_enable, brake_release, relay_close, source,
              stop_setpoint_rad, gravity_nm)

#endif  // EXAMPLES_SAFE_ARM_MESSAGES_HPP
