// SPDX-License-Identifier: Apache-2.0
/// @file
/// Safety part of each system table of the example: modes, faults with confirmation, reactions, stops, brakes
/// and watchdog. Each table adds the supervision of its components.
///
/// @satisfies SWR-SAF-002, SWR-SAF-020, SWR-SAF-061, SWR-SAF-063      Design:
/// docs/design/safe_arm.md#reactions
#ifndef EXAMPLES_SAFE_ARM_ARM_SAFETY_HPP
#define EXAMPLES_SAFE_ARM_ARM_SAFETY_HPP

#include "arm_faults.hpp"
#include "arm_limits.hpp"
#include "mamori/safety/cycle/safety_rules.hpp"
#include "messages.hpp"

namespace safe_arm {

using mamori::safety::Reaction;

/// All components run in each mode: a switch deactivates none.
template <typename... Components>
constexpr auto make_arm_modes(Components&... components) noexcept {
    using Mode = OperatingMode;
    const auto all = mamori::runs(components...);
    return mamori::parts(mamori::system_mode<Mode::kHoldToRun>("hold_to_run", all),
                         mamori::system_mode<Mode::kReducedSpeed>("reduced_speed", all),
                         mamori::system_mode<Mode::kAutomatic>("automatic", all),
                         mamori::safe_mode<Mode::kSwitchFailed>("switch_failed", all),
                         mamori::mode_transition("hold_to_run", Mode::kReducedSpeed, "reduced_speed"),
                         mamori::mode_transition("hold_to_run", Mode::kAutomatic, "automatic"),
                         mamori::mode_transition("reduced_speed", Mode::kHoldToRun, "hold_to_run"),
                         mamori::mode_transition("reduced_speed", Mode::kAutomatic, "automatic"),
                         mamori::mode_transition("automatic", Mode::kHoldToRun, "hold_to_run"),
                         mamori::mode_transition("automatic", Mode::kReducedSpeed, "reduced_speed"));
}

inline constexpr auto kInAutomatic = mamori::in_modes<OperatingMode::kAutomatic>();
inline constexpr auto kWithEnabling =
    mamori::in_modes<OperatingMode::kHoldToRun, OperatingMode::kReducedSpeed, OperatingMode::kSwitchFailed>();
inline constexpr auto kWithRunButton =
    mamori::in_modes<OperatingMode::kHoldToRun, OperatingMode::kSwitchFailed>();
inline constexpr auto kWithoutRunButton =
    mamori::in_modes<OperatingMode::kReducedSpeed, OperatingMode::kAutomatic>();

/// Times are from the confirmed fault to the start of its reaction. STO always comes with closed brakes.
inline constexpr auto kArmReactions = mamori::parts(
    mamori::faults<ArmFault::kEncoderImplausible, ArmFault::kEncoderDiscrepancy, ArmFault::kEncoderStuck,
                   ArmFault::kFollowingError, ArmFault::kOverspeed, ArmFault::kPositionLimit,
                   ArmFault::kTorqueDeviation, ArmFault::kControllerSilent, ArmFault::kCommandStale,
                   ArmFault::kPowerLost, ArmFault::kBrakeFault, ArmFault::kSelfTestFailed,
                   ArmFault::kMeasurementStale, ArmFault::kReactionLate, ArmFault::kBrakeTestOld,
                   ArmFault::kStopNotFollowed, ArmFault::kEmergencyStop, ArmFault::kSwitchDiscrepancy,
                   ArmFault::kProtectiveStop, ArmFault::kMovementAtRest, ArmFault::kEnableLost,
                   ArmFault::kEnablingSqueezed, ArmFault::kModeSelector, ArmFault::kClockDeviation,
                   ArmFault::kPositionDoubtful, ArmFault::kRunReleased>(),
    mamori::react(ArmFault::kEncoderImplausible, Reaction::kSs1, mamori::within(2_ms)),
    mamori::react(ArmFault::kEncoderDiscrepancy, Reaction::kSto, mamori::within(2_ms)),
    mamori::react(ArmFault::kEncoderStuck, Reaction::kSto, mamori::within(2_ms)),
    mamori::react(ArmFault::kFollowingError, Reaction::kSs1, mamori::within(2_ms)),
    mamori::react(ArmFault::kOverspeed, Reaction::kSs1, mamori::within(2_ms)),
    mamori::react(ArmFault::kPositionLimit, Reaction::kSs1, mamori::within(2_ms)),
    mamori::react(ArmFault::kTorqueDeviation, Reaction::kSto, mamori::within(2_ms)),
    mamori::react(ArmFault::kControllerSilent, Reaction::kSs1, mamori::within(2_ms)),
    mamori::react(ArmFault::kCommandStale, Reaction::kSs1, mamori::within(2_ms)),
    mamori::react(ArmFault::kPowerLost, Reaction::kSto, mamori::within(2_ms)),
    mamori::react(ArmFault::kBrakeFault, Reaction::kSs1, mamori::within(2_ms)),
    mamori::react(ArmFault::kSelfTestFailed, Reaction::kSto, mamori::within(2_ms)),
    mamori::react(ArmFault::kMeasurementStale, Reaction::kSto, mamori::within(2_ms)),
    mamori::react(ArmFault::kReactionLate, Reaction::kSto, mamori::within(2_ms)),
    mamori::react(ArmFault::kBrakeTestOld, Reaction::kSs1, mamori::within(2_ms)),
    mamori::react(ArmFault::kStopNotFollowed, Reaction::kSto, mamori::within(2_ms)),
    mamori::react(ArmFault::kEmergencyStop, Reaction::kSs1, mamori::within(2_ms)),
    mamori::react(ArmFault::kSwitchDiscrepancy, Reaction::kSs1, mamori::within(2_ms)),
    mamori::react(ArmFault::kProtectiveStop, Reaction::kSs2, mamori::within(2_ms)),
    mamori::react(ArmFault::kMovementAtRest, Reaction::kSto, mamori::within(2_ms)),
    mamori::react(ArmFault::kEnableLost, Reaction::kSs2, mamori::within(2_ms), kWithEnabling),
    mamori::react(ArmFault::kEnableLost, Reaction::kNone, mamori::within(2_ms), kInAutomatic),
    mamori::react(ArmFault::kEnablingSqueezed, Reaction::kSs1, mamori::within(2_ms), kWithEnabling),
    mamori::react(ArmFault::kEnablingSqueezed, Reaction::kNone, mamori::within(2_ms), kInAutomatic),
    mamori::react(ArmFault::kRunReleased, Reaction::kSs2, mamori::within(2_ms), kWithRunButton),
    mamori::react(ArmFault::kRunReleased, Reaction::kNone, mamori::within(2_ms), kWithoutRunButton),
    mamori::react(ArmFault::kModeSelector, Reaction::kSs1, mamori::within(2_ms)),
    // The ramp of SS1 takes its time from the clock, and its position from the encoders.
    mamori::react(ArmFault::kClockDeviation, Reaction::kSto, mamori::within(2_ms)),
    mamori::react(ArmFault::kPositionDoubtful, Reaction::kSto, mamori::within(2_ms)));

/// @param[in] lateness_max latest window start that is tolerated; it depends on the platform.
constexpr auto make_arm_safety(mamori::Duration lateness_max) noexcept {
    namespace safety = mamori::safety;
    return mamori::parts(
        kArmReactions, safety::confirm(ArmFault::kEncoderDiscrepancy, {kDiscrepancyFrames}),
        safety::confirm(ArmFault::kOverspeed, {kOverspeedFrames}),
        safety::confirm(ArmFault::kTorqueDeviation, {kTorqueDeviationFrames}),
        safety::cycle(kStopBounds, kBrakes, kWatchdogWindow, safety::torque_feedback(kTorqueFeedbackTime),
                      safety::tolerated_lateness(lateness_max),
                      safety::on_late_reaction(safety::raises(ArmFault::kReactionLate)),
                      safety::on_failed_self_test(safety::raises(ArmFault::kSelfTestFailed)),
                      safety::on_unconfirmed_brakes(safety::raises(ArmFault::kBrakeFault)),
                      // Only the position is unknown: drives and clock are trusted.
                      safety::brakes_first<ArmFault::kEncoderDiscrepancy, ArmFault::kEncoderStuck,
                                           ArmFault::kPositionDoubtful>()));
}

}  // namespace safe_arm

#endif  // EXAMPLES_SAFE_ARM_ARM_SAFETY_HPP
