// SPDX-License-Identifier: Apache-2.0
/// @file
/// Safe limits of the example arm: decisions of the safety concept, not properties of the machine. The runner
/// refuses a model that does not lie around them. All per-joint values are ordered from the base to the
/// flange.
///
/// @satisfies SWR-SAF-003      Design: docs/design/safe_arm.md#limits
#ifndef EXAMPLES_SAFE_ARM_ARM_LIMITS_HPP
#define EXAMPLES_SAFE_ARM_ARM_LIMITS_HPP

#include <array>
#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/time.hpp"
#include "mamori/safety/arm/arm_device.hpp"
#include "mamori/safety/arm/guards.hpp"
#include "mamori/safety/reaction/brake_sequence.hpp"
#include "mamori/safety/reaction/safe_state_machine.hpp"
#include "mamori/safety/redundancy/clock_ratio.hpp"
#include "mamori/safety/supervision/execution_supervisor.hpp"
#include "mamori/safety/supervision/watchdog_gate.hpp"

namespace safe_arm {

using namespace mamori::literals;  // NOLINT: units of the constants below

/// The same limit for each joint.
constexpr mamori::safety::JointVector make_uniform(double limit) noexcept {
    return {limit, limit, limit, limit, limit, limit, limit};
}
/// Element-wise a * factor + offset.
constexpr mamori::safety::JointVector scale(const mamori::safety::JointVector& a, double factor,
                                            double offset) noexcept {
    mamori::safety::JointVector result{};
    for (std::size_t j = 0U; j < mamori::safety::kArmJointCount; ++j) {
        result[j] = a[j] * factor + offset;
    }
    return result;
}
/// -limit .. limit for each joint.
constexpr std::array<mamori::safety::AxisRange, mamori::safety::kArmJointCount> make_ranges(
    const mamori::safety::JointVector& limits) noexcept {
    std::array<mamori::safety::AxisRange, mamori::safety::kArmJointCount> ranges{};
    for (std::size_t j = 0U; j < mamori::safety::kArmJointCount; ++j) {
        ranges[j] = {-limits[j], limits[j]};
    }
    return ranges;
}

/// Frame of the system table; every cycle count below is in frames.
inline constexpr mamori::Duration kFrame = 1_ms;
inline constexpr double kFrameS = 0.001;

/// Mechanical speed limit [rad/s]: the speed at which the torque that a motor can give in the direction of
/// its motion has fallen to zero.
inline constexpr mamori::safety::JointVector kNoLoadSpeedRadS{1.0, 1.0, 2.0, 2.0, 6.28, 6.28, 6.28};
/// Safely limited speed (SLS): 90 % of the mechanical limit [rad/s]. Motions are planned below 80 %.
inline constexpr mamori::safety::JointVector kSafeSpeedRadS{0.9, 0.9, 1.8, 1.8, 5.65, 5.65, 5.65};
/// Limits in the modes reduced speed and hold-to-run: together, the joints move the flange by less than
/// kFlangeSpeedMax in each pose [rad/s, m/s]. Source: ISO 10218-1:2011, 5.6.2
inline constexpr mamori::safety::JointVector kReducedSpeedRadS{0.07, 0.07, 0.07, 0.07, 0.15, 0.15, 0.15};
inline constexpr double kFlangeSpeedMax = 0.25;
/// Speed of the path in these modes: a motion at 80 % of the mechanical limits stays below kReducedSpeedRadS.
inline constexpr double kReducedPathRate = 0.025;
/// The speed is checked as it will be when the stop begins to act: its change within 4 frames continues for 8
/// ms, from the middle of the measured mean (2 ms), over the confirmation and the rate of torque (2 frames
/// each), with 2 ms of margin.
inline constexpr double kSpeedPrediction = 2.0;
/// From the detection of a fault to the end of the travel at the measured speed: confirmation and one frame,
/// and a third of the ramp of a stop. Brakes without a ramp need less. A joint that would leave the safe
/// range within this time is stopped at once.
inline constexpr mamori::Duration kStopTime = 90_ms;
/// Safely limited position (SLP): 2 degrees inside the mechanical range, symmetric [rad].
inline constexpr mamori::safety::JointVector kSafePositionRad{3.05, 1.60, 3.00, 2.35, 4.41, 2.84, 4.41};
/// Farthest that a joint can move within one frame: mechanical speed limit plus 20 % and both channels' steps
/// [rad].
inline constexpr mamori::safety::JointVector kMaxStepRad{0.0016, 0.0016, 0.0028, 0.0028,
                                                         0.0080, 0.0080, 0.0080};
/// Torque limit of the drives [N m]; the gate saturates at it so that the deviation check compares like with
/// like.
inline constexpr mamori::safety::JointVector kTorqueLimitNm{232.0, 232.0, 100.0, 100.0, 14.5, 14.5, 14.5};

/// The torque of the controller may differ by this much from the torque that holds the arm [N m], and change
/// by this much in a frame [N m]. The motions of the example need at most a fifth of it.
inline constexpr mamori::safety::JointVector kControllerShareNm{60.0, 80.0, 25.0, 35.0, 4.0, 4.0, 4.0};
inline constexpr mamori::safety::JointVector kControllerStepNm{5.0, 8.0, 2.5, 3.5, 0.3, 0.3, 0.3};

/// Largest difference between the torques of the gravity model and of the arm [N m].
inline constexpr double kGravityDifferenceNm = 0.05;

/// Frames in a row in which a fault must be seen before it is latched; other faults in the first one.
inline constexpr std::uint32_t kDiscrepancyFrames = 2U;
inline constexpr std::uint32_t kOverspeedFrames = 2U;
inline constexpr std::uint32_t kTorqueDeviationFrames = 3U;
/// Channels A and B may differ by this much [rad]: mounting error plus the step of the coarser one.
inline constexpr double kDiscrepancyRad = 0.004;
/// Distance between setpoint and measured position [rad]; the fault-free motion stays below 0.02 rad.
inline constexpr double kFollowingErrorRad = 0.03;
/// Travel of the setpoint without any count of movement on either channel [rad].
inline constexpr double kStuckTravelRad = 0.004;
/// Share of the torque limit by which measured and commanded torque may differ [-].
inline constexpr double kTorqueDeviationShare = 0.15;
inline constexpr auto kSafeRange = make_ranges(kSafePositionRad);
/// Channel B is checked against a position of channel A. When A freezes, B leaves it by one step per frame:
/// it must stay plausible until the discrepancy is confirmed, or the sound channel would be the distrusted
/// one.
inline constexpr mamori::safety::JointVector kMaxStepBRad =
    scale(kMaxStepRad, kDiscrepancyFrames, kDiscrepancyRad);
inline constexpr mamori::safety::JointVector kTorqueDeviationNm =
    scale(kTorqueLimitNm, kTorqueDeviationShare, 0.0);
static_assert(mamori::safety::are_valid(kSafeRange) && mamori::safety::are_valid(kSafeSpeedRadS) &&
              mamori::safety::are_valid(kReducedSpeedRadS) && mamori::safety::are_valid(kMaxStepRad) &&
              mamori::safety::are_valid(kTorqueDeviationNm));
/// Distance of setpoint and measured position at which operation may begin [rad]: the start is bumpless.
inline constexpr double kBumplessRad = 0.002;
/// A joint below this speed stands [rad/s]; the confirmation time hides the step of the coarser encoder.
inline constexpr double kStandstillRadS = 0.02;

/// Messages of the controller that may be lost in a row, and the age at which one is stale: it is checked in
/// the frame after the one in which it was sent.
inline constexpr std::uint32_t kCommandLossesMax = 2U;
inline constexpr mamori::Duration kCommandAgeMax{kFrame.ns * (1 + kCommandLossesMax)};
/// Standing for this long is standstill.
inline constexpr mamori::Duration kStandstillTime = 50_ms;
/// Bounds of a controlled stop: then SS2 becomes SS1, and SS1 becomes STO.
inline constexpr mamori::safety::StopBounds kStopBounds{500_ms, 500_ms};
/// Torque feedback may contradict the command for this long. Torque that outlasts safe torque off locks the
/// machine out and leaves it to the watchdog to switch the drives off; torque that does not come is a
/// deviation.
inline constexpr mamori::Duration kTorqueFeedbackTime = 20_ms;
/// Brake feedback may contradict the command for this long: opening and closing delay with margin.
inline constexpr mamori::Duration kBrakeFeedbackTime = 100_ms;
inline constexpr mamori::safety::BrakeLimits kBrakes{kBrakeFeedbackTime, true};
/// Stop and hold under torque: stiffness [N m/rad] and damping [N m s/rad]. The smallest
/// inertia of a joint bounds the damping (delay of speed and output: 4 ms), its largest one the stiffness.
inline constexpr mamori::safety::JointVector kStopStiffness{6000.0, 6000.0, 2500.0, 2500.0,
                                                            200.0,  200.0,  200.0};
inline constexpr mamori::safety::JointVector kStopDamping{330.0, 330.0, 95.0, 95.0, 5.0, 5.0, 5.0};
/// Length of the ramp of a stop [s].
inline constexpr double kStopRampS = 0.25;
/// Distance between the ramp of a stop, or the place of a hold, and the measured position [rad].
inline constexpr double kStopDeviationRad = 0.03;
/// Distance by which the arm may move without torque, once the brakes have had kBrakeFeedbackTime [rad]. The
/// channels may differ by less.
inline constexpr double kRestTravelRad = 0.005;
static_assert(kRestTravelRad > kDiscrepancyRad);
/// Feedback of a switch-off path may contradict its command for this long.
inline constexpr mamori::Duration kPathTime = 20_ms;
/// The clocks of processor and drives may differ by this much: 5 ms of jitter between processes. A safe speed
/// that is measured with such a clock is still below the mechanical limit. A larger deviation is found by the
/// end of the second window.
inline constexpr mamori::safety::ClockRatioLimits kClockLimits{100_ms, 50'000U};
/// The torque of a joint and the torque of gravity and friction at its measured position and speed may differ
/// by this much [N m], as mean values over kModelTimeS [s]. The limit grows with the accelerations, because
/// the check omits inertia: an entry of the mass matrix is at most the product of the roots of its two
/// diagonal entries.
inline constexpr mamori::safety::JointVector kModelDifferenceNm{2.0, 4.0, 1.2, 2.5, 0.25, 0.3, 0.25};
/// Roots of the maximum inertias [kg^0.5 m].
inline constexpr mamori::safety::JointVector kInertiaRoot{2.0, 2.0, 1.0, 1.0, 0.32, 0.32, 0.32};
/// Viscous friction [N m s/rad].
inline constexpr mamori::safety::JointVector kFrictionNmSRad{5.0, 5.0, 1.0, 1.0, 0.05, 0.05, 0.05};
inline constexpr double kModelTimeS = 0.5;
/// The measured position may be this far on the wrong side of the reference switch [rad].
inline constexpr double kReferenceRad = 0.02;
/// Brake test: all drives push with their torque limit against the closed brakes, first forwards, then
/// backwards: ramp, then hold. A brake slips beyond 2 mrad.
inline constexpr mamori::Duration kBrakeTestRamp = 20_ms;
inline constexpr mamori::Duration kBrakeTestHold = 30_ms;
inline constexpr double kBrakeTestTravelRad = 0.0025;
/// A start needs a passed brake test that is not older than this; a longer operation is stopped.
inline constexpr mamori::Duration kBrakeTestInterval{std::int64_t{8} * 3600 * 1'000'000'000};
/// Channels of one switch may differ for this long: its contacts do not open and close at the same instant.
inline constexpr mamori::Duration kSwitchDiscrepancyTime = 100_ms;
/// A push of a button counts if it lasts for at least and at most this time: no bounce, and no stuck button.
inline constexpr mamori::Duration kPushMin = 20_ms;
inline constexpr mamori::Duration kPushMax = 3000_ms;
/// The self test begins with this many good frames in a row, and not before this time: links between
/// processes need a few frames to start. They come within kSelfTestTime.
inline constexpr mamori::Duration kQuietTime = 40_ms;
inline constexpr std::uint32_t kSelfTestFrames = 20U;
inline constexpr mamori::Duration kSelfTestTime = 500_ms;
/// Longest run of a component of the safety partition, and of the controller.
inline constexpr mamori::Duration kSafetyComponentMax = 100_us;
inline constexpr mamori::Duration kControllerMax = 350_us;
/// Latest release of a window that is tolerated.
inline constexpr mamori::Duration kLatenessMax = 50_us;
/// The watchdog takes torque and brake current away when it is not served for this long.
inline constexpr mamori::Duration kWatchdogTimeout = 5_ms;
/// Distance between two services as the gate keeps it: one frame, with room for a second try.
inline constexpr mamori::safety::WatchdogWindow kWatchdogWindow{500_us, 4_ms};

}  // namespace safe_arm

#endif  // EXAMPLES_SAFE_ARM_ARM_LIMITS_HPP
