// SPDX-License-Identifier: Apache-2.0
/// @file
/// Faults of the example arm and the reaction that each leads to. A fault without a reaction does not
/// compile.
///
/// @satisfies SWR-SAF-002, SWR-SAF-020      Design: docs/design/safe_arm.md#reactions
#ifndef EXAMPLES_SAFE_ARM_ARM_FAULTS_HPP
#define EXAMPLES_SAFE_ARM_ARM_FAULTS_HPP

#include <array>
#include <cstddef>
#include <cstdint>

#include "mamori/safety/reaction/reaction_table.hpp"

namespace safe_arm {

/// Numbers are positions in the fault register and bits in JointState::faults; they are never reused, and a
/// new fault comes last.
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
    kCount,               ///< number of faults
};
inline constexpr auto kArmFaultCount = static_cast<std::size_t>(ArmFault::kCount);

constexpr std::uint16_t to_index(ArmFault fault) noexcept {
    return static_cast<std::uint16_t>(fault);
}
constexpr std::uint32_t to_bit(ArmFault fault) noexcept {
    return std::uint32_t{1U} << to_index(fault);
}

/// Spelling of a fault in logs and reports, indexed by its number.
inline constexpr std::array<const char*, kArmFaultCount> kArmFaultNames{
    "EncoderImplausible", "EncoderDiscrepancy", "EncoderStuck",     "FollowingError", "Overspeed",
    "PositionLimit",      "TorqueDeviation",    "ControllerSilent", "CommandStale",   "PowerLost",
    "BrakeFault",         "SelfTestFailed",     "MeasurementStale"};

using mamori::safety::react;
using mamori::safety::Reaction;
using namespace mamori::literals;  // NOLINT: units of the bounds below

/// From the confirmed fault to the start of its reaction. STO always comes with closed brakes.
inline constexpr std::array<mamori::safety::ReactionRow, kArmFaultCount> kArmReactions{
    react(ArmFault::kEncoderImplausible, Reaction::kSs1, 2_ms),
    react(ArmFault::kEncoderDiscrepancy, Reaction::kSto, 2_ms),
    react(ArmFault::kEncoderStuck, Reaction::kSto, 2_ms),
    react(ArmFault::kFollowingError, Reaction::kSto, 2_ms),
    react(ArmFault::kOverspeed, Reaction::kSto, 2_ms),
    react(ArmFault::kPositionLimit, Reaction::kSto, 2_ms),
    react(ArmFault::kTorqueDeviation, Reaction::kSto, 2_ms),
    react(ArmFault::kControllerSilent, Reaction::kSto, 2_ms),
    react(ArmFault::kCommandStale, Reaction::kSto, 2_ms),
    react(ArmFault::kPowerLost, Reaction::kSto, 2_ms),
    react(ArmFault::kBrakeFault, Reaction::kSto, 2_ms),
    react(ArmFault::kSelfTestFailed, Reaction::kSto, 2_ms),
    react(ArmFault::kMeasurementStale, Reaction::kSto, 2_ms)};
static_assert(mamori::safety::covers_all<kArmReactions, ArmFault::kCount>());

/// Frames in a row in which a fault must be seen before it is latched, indexed by its number.
inline constexpr std::array<std::uint32_t, kArmFaultCount> kConfirmFrames{1U, 2U, 1U, 1U, 2U, 1U, 3U,
                                                                          1U, 1U, 1U, 1U, 1U, 1U};

}  // namespace safe_arm

#endif  // EXAMPLES_SAFE_ARM_ARM_FAULTS_HPP
