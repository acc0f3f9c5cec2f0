// SPDX-License-Identifier: Apache-2.0
/// @file
/// Faults of the example arm. arm_safety.hpp declares the reaction to each.
///
/// @satisfies SWR-SAF-002      Design: docs/design/safe_arm.md#reactions
#ifndef EXAMPLES_SAFE_ARM_ARM_FAULTS_HPP
#define EXAMPLES_SAFE_ARM_ARM_FAULTS_HPP

#include <cstddef>
#include <cstdint>

namespace safe_arm {

/// Numbers are positions in the fault register and bits in JointState::faults; they are never reused, and a
/// new fault comes last. Logs and reports spell a fault as its enumerator, without the k.
enum class ArmFault : std::uint16_t {
    kEncoderImplausible,  ///< one channel moved farther in a cycle than the joint can; the other is trusted
    kEncoderDiscrepancy,  ///< the channels disagree and neither is known to be right, or both are implausible
    kEncoderStuck,        ///< the setpoint travels and no channel shows any movement
    kFollowingError,      ///< measured position is far from the setpoint
    kOverspeed,           ///< joint speed above the safe limit (SLS)
    kPositionLimit,       ///< joint outside the safe range (SLP), or too fast to be stopped inside
    kTorqueDeviation,     ///< a drive delivers torque that was not commanded
    kControllerSilent,    ///< the controller overran its window or did not run
    kCommandStale,        ///< controller messages lost or late
    kPowerLost,           ///< drive supply out of range
    kBrakeFault,          ///< brake feedback contradicts the brake command
    kSelfTestFailed,      ///< power-up self test did not pass in time
    kMeasurementStale,    ///< reading or judgement of this frame did not come: reader or monitor does not run
    kReactionLate,        ///< the outputs did not show a reaction within its time
    kBrakeTestOld,        ///< the last passed brake test is too long ago
    kStopNotFollowed,     ///< the arm leaves the ramp of its stop, or the place of its hold
    kEmergencyStop,       ///< the emergency stop is pushed, or a channel of it is open
    kSwitchDiscrepancy,   ///< the channels of a switch differ for too long
    kProtectiveStop,      ///< the protective stop is open while torque is on
    kMovementAtRest,      ///< the arm moves without torque, behind closed brakes
    kEnableLost,          ///< the enabling device is released while torque is on
    kEnablingSqueezed,    ///< the enabling device is squeezed
    kModeSelector,        ///< the system is not in the mode of the selector, or that shows none
    kClockDeviation,      ///< the clocks of processor and drives run at different rates
    kPositionDoubtful,    ///< torque or reference switch contradicts both encoder channels
    kRunReleased,         ///< the hold-to-run button is released while torque is on
    kCount,               ///< number of faults
};
inline constexpr auto kArmFaultCount = static_cast<std::size_t>(ArmFault::kCount);

constexpr std::uint16_t to_index(ArmFault fault) noexcept {
    return static_cast<std::uint16_t>(fault);
}
constexpr std::uint32_t to_bit(ArmFault fault) noexcept {
    return std::uint32_t{1U} << to_index(fault);
}

/// Faults that need no reset without torque: there, they only prevent the start.
inline constexpr std::uint32_t kPermissions =
    to_bit(ArmFault::kProtectiveStop) | to_bit(ArmFault::kEnableLost) | to_bit(ArmFault::kRunReleased);

}  // namespace safe_arm

#endif  // EXAMPLES_SAFE_ARM_ARM_FAULTS_HPP
