// SPDX-License-Identifier: Apache-2.0
#include "joint_monitor.hpp"

#include <cmath>

namespace safe_arm {
namespace {

using mamori::safety::AxisSet;

/// The fault, when any joint is in the set.
std::uint32_t flag(const AxisSet& joints, ArmFault fault) noexcept {
    return joints.is_empty() ? 0U : to_bit(fault);
}

}  // namespace

using mamori::ContextHandle;
using mamori::Duration;
using mamori::Instant;
using mamori::Status;
using namespace mamori::safety;  // NOLINT: the guards

Status JointMonitor::on_activated(ContextHandle) noexcept {
    standstill_ = StandstillDetector{make_uniform(kStandstillRadS), kStandstillTime};
    brake_contradiction_for_ = {};
    torque_absent_for_ = {};
    relay_open_for_ = {};
    resting_for_ = {};
    has_history_ = false;
    return Status::kOk;
}

Status JointMonitor::on_execute(ContextHandle context) noexcept {
    const JointReading& now = reading.read();
    const bool is_reset = reset_edge_.step(now.reset_button) && !is_torque_on();
    if (!has_history_ || is_reset) {
        begin_history(now);
    }
    JointState result{};
    result.faults = judge_channels(now, result.position_rad);
    for (std::size_t j = 0U; j < kArmJointCount; ++j) {
        result.velocity_rad_s[j] =
            (result.position_rad[j] - past_rad_[oldest_][j]) / (static_cast<double>(kSpeedCycles) * kFrameS);
    }
    result.faults |= judge_stuck(now) | judge_motion(result) | judge_torque(now) | judge_brakes(now) |
                     judge_power(now) | check_rest(result) | check_reference(result.position_rad) |
                     compare_with_model(result) | check_clock(Instant{now.drive_clock_ns}, context.now);
    result.is_clock_checked = clocks_.get_verdict() == ClockVerdict::kGood;
    result.is_standing = standstill_.step(result.velocity_rad_s, context.now);
    result.is_setpoint_near =
        calc_following_errors(command.read().setpoint_rad, result.position_rad, make_uniform(kBumplessRad))
            .is_empty();
    past_rad_[oldest_] = result.position_rad;
    oldest_ = (oldest_ + 1U) % kSpeedCycles;
    last_rad_ = result.position_rad;
    last_ = now;
    state.write(result);
    return Status::kOk;
}

void JointMonitor::begin_history(const JointReading& now) noexcept {
    distrusted_a_ = {};
    distrusted_b_ = {};
    past_rad_.fill(now.position_a_rad);
    past_rad_s_ = {};
    oldest_ = 0U;
    last_rad_ = now.position_a_rad;
    last_ = now;
    stuck_since_rad_ = command.read().setpoint_rad;
    resting_for_ = {};
    clocks_ = ClockRatio{kClockLimits};
    has_drive_clock_ = false;
    has_history_ = true;
}

/// Compares each channel with the last trusted position: farther than the joint can move is implausible. A
/// distrusted channel stays distrusted until a person resets the machine while no torque flows; channels that
/// still contradict each other are reported again then.
std::uint32_t JointMonitor::judge_channels(const JointReading& now, JointVector& position_rad) noexcept {
    const AxisSet distrusted_before = distrusted_a_;
    distrusted_a_ = unite(distrusted_a_, calc_jumps(now.position_a_rad, last_rad_, kMaxStepRad));
    distrusted_b_ = unite(distrusted_b_, calc_jumps(now.position_b_rad, last_rad_, kMaxStepBRad));
    const AxisSet differing =
        calc_discrepancies(now.position_a_rad, now.position_b_rad, make_uniform(kDiscrepancyRad));
    std::uint32_t faults = 0U;
    for (std::size_t j = 0U; j < kArmJointCount; ++j) {
        const bool is_a_bad = distrusted_a_.contains(j);
        const bool is_b_bad = distrusted_b_.contains(j);
        if (is_a_bad && is_b_bad) {
            position_rad[j] = last_rad_[j];
            faults |= to_bit(ArmFault::kEncoderDiscrepancy);
        } else if (is_a_bad || is_b_bad) {
            if (is_a_bad && !distrusted_before.contains(j)) {
                move_history_to_b(j);
            }
            position_rad[j] = is_a_bad ? now.position_b_rad[j] : now.position_a_rad[j];
            faults |= to_bit(ArmFault::kEncoderImplausible);
        } else {
            position_rad[j] = now.position_a_rad[j];
            faults |= differing.contains(j) ? to_bit(ArmFault::kEncoderDiscrepancy) : 0U;
        }
    }
    return faults;
}

/// The channels differ by their mounting. Without this the change from A to B would be a movement, and its
/// speed an overspeed.
void JointMonitor::move_history_to_b(std::size_t joint) noexcept {
    const double offset_rad = last_.position_b_rad[joint] - last_.position_a_rad[joint];
    for (JointVector& past : past_rad_) {
        past[joint] += offset_rad;
    }
}

/// A turning joint always shows counts. When the setpoint travels and neither channel moves, both are stuck.
std::uint32_t JointMonitor::judge_stuck(const JointReading& now) noexcept {
    const JointVector& setpoint_rad = command.read().setpoint_rad;
    for (std::size_t j = 0U; j < kArmJointCount; ++j) {
        const bool has_moved = now.position_a_rad[j] != last_.position_a_rad[j] ||
                               now.position_b_rad[j] != last_.position_b_rad[j];
        if (has_moved || !is_controlled()) {
            stuck_since_rad_[j] = setpoint_rad[j];
        }
    }
    return flag(calc_following_errors(setpoint_rad, stuck_since_rad_, make_uniform(kStuckTravelRad)),
                ArmFault::kEncoderStuck);
}

/// The speed limit holds for the speed that the joint will have when a stop begins to act, too. The range
/// holds for the place where the joint can be stopped, too: at the limit itself a fast joint is already lost.
std::uint32_t JointMonitor::judge_motion(const JointState& now) noexcept {
    JointVector stopped_rad{};
    JointVector predicted_rad_s{};
    for (std::size_t j = 0U; j < kArmJointCount; ++j) {
        stopped_rad[j] = now.position_rad[j] + now.velocity_rad_s[j] * mamori::to_seconds(kStopTime);
        predicted_rad_s[j] =
            now.velocity_rad_s[j] + kSpeedPrediction * (now.velocity_rad_s[j] - past_rad_s_[oldest_][j]);
    }
    past_rad_s_[oldest_] = now.velocity_rad_s;
    const AxisSet outside = unite(calc_position_violations(now.position_rad, kSafeRange),
                                  calc_position_violations(stopped_rad, kSafeRange));
    // A stop begins with the speed of the mode before.
    const bool is_reduced = is_controlled() && reading.read().mode != OperatingMode::kAutomatic;
    const JointVector& speed_max_rad_s = is_reduced ? kReducedSpeedRadS : kSafeSpeedRadS;
    std::uint32_t faults = flag(unite(calc_speed_violations(predicted_rad_s, speed_max_rad_s),
                                      calc_speed_violations(now.velocity_rad_s, speed_max_rad_s)),
                                ArmFault::kOverspeed) |
                           flag(outside, ArmFault::kPositionLimit);
    if (is_controlled()) {
        faults |= flag(calc_following_errors(command.read().setpoint_rad, now.position_rad,
                                             make_uniform(kFollowingErrorRad)),
                       ArmFault::kFollowingError);
    } else if (is_torque_on() && drive.read().source == TorqueSource::kStopLoop) {
        faults |= flag(calc_following_errors(drive.read().stop_setpoint_rad, now.position_rad,
                                             make_uniform(kStopDeviationRad)),
                       ArmFault::kStopNotFollowed);
    }
    return faults;
}

/// Compares only while both command and feedback say that torque is on: switching takes a few milliseconds. A
/// feedback that stays away is a deviation too, or a broken contact would switch this judgement off for good.
std::uint32_t JointMonitor::judge_torque(const JointReading& now) noexcept {
    const bool is_absent = is_torque_on() && !now.torque_enabled;
    torque_absent_for_ = is_absent ? torque_absent_for_ + kFrame : Duration{0};
    if (torque_absent_for_ > kTorqueFeedbackTime) {
        return to_bit(ArmFault::kTorqueDeviation);
    }
    if (!is_torque_on() || !now.torque_enabled) {
        return 0U;
    }
    return flag(calc_torque_deviations(drive.read().torque_nm, now.measured_torque_nm, kTorqueDeviationNm),
                ArmFault::kTorqueDeviation);
}

/// A relay that opens by itself cuts the supply as well.
std::uint32_t JointMonitor::judge_power(const JointReading& now) noexcept {
    const bool is_contradicted = drive.has_value() && drive.read().relay_close && !now.relay_closed;
    relay_open_for_ = is_contradicted ? relay_open_for_ + kFrame : Duration{0};
    return !now.power_good || relay_open_for_ > kPathTime ? to_bit(ArmFault::kPowerLost) : 0U;
}

/// One brake that sticks is enough, in either direction.
std::uint32_t JointMonitor::judge_brakes(const JointReading& now) noexcept {
    const bool is_obeyed = drive.read().brake_release ? now.brakes_open : now.brakes_closed;
    const bool is_contradicted = drive.has_value() && !is_obeyed;
    brake_contradiction_for_ = is_contradicted ? brake_contradiction_for_ + kFrame : Duration{0};
    return brake_contradiction_for_ > kBrakeFeedbackTime ? to_bit(ArmFault::kBrakeFault) : 0U;
}

/// Without torque, only the brakes hold the arm. A reset begins again: the brake test decides then.
std::uint32_t JointMonitor::check_rest(const JointState& now) noexcept {
    resting_for_ = is_torque_on() ? Duration{0} : resting_for_ + kFrame;
    if (resting_for_ <= kBrakeFeedbackTime) {
        rest_rad_ = now.position_rad;
    }
    return flag(calc_following_errors(rest_rad_, now.position_rad, make_uniform(kRestTravelRad)),
                ArmFault::kMovementAtRest);
}

/// Before the first sample, there is nothing to compare, and no start.
std::uint32_t JointMonitor::check_clock(Instant drives, Instant own) noexcept {
    has_drive_clock_ = has_drive_clock_ || drives != Instant{};
    const bool is_violated = has_drive_clock_ && clocks_.step(drives, own) == ClockVerdict::kViolated;
    return is_violated ? to_bit(ArmFault::kClockDeviation) : 0U;
}

/// An independent check of the position of each joint: both channels may fail by one cause.
std::uint32_t JointMonitor::check_reference(const JointVector& position_rad) noexcept {
    std::uint32_t faults = 0U;
    for (std::size_t j = 0U; j < kArmJointCount; ++j) {
        const double inside_rad = reading.read().reference_closed[j] ? position_rad[j] : -position_rad[j];
        faults |= inside_rad < -kReferenceRad ? to_bit(ArmFault::kPositionDoubtful) : 0U;
    }
    return faults;
}

/// If the true position differs from the measured one, gravity needs a different torque. The difference of a
/// speed from its mean, divided by the time of the mean, is the filtered acceleration. Closed brakes, also
/// those that fail to close, take any torque. A contact that flickers does not clear the mean.
std::uint32_t JointMonitor::compare_with_model(const JointState& now) noexcept {
    const JointReading& measured = reading.read();
    if (!is_torque_on() || !drive.read().brake_release) {
        mean_difference_nm_ = {};
        mean_rad_s_ = now.velocity_rad_s;
        return 0U;
    }
    if (!measured.torque_enabled || !measured.brakes_open) {
        return 0U;
    }
    constexpr double kShare = kFrameS / kModelTimeS;
    double acceleration = 0.0;  // weighted by the roots of the inertias
    for (std::size_t j = 0U; j < kArmJointCount; ++j) {
        const double needed_nm = drive.read().gravity_nm[j] + kFrictionNmSRad[j] * now.velocity_rad_s[j];
        const double difference_nm = measured.measured_torque_nm[j] - needed_nm;
        // A torque that no drive has is a deviation; it must not stay in the mean.
        if (is_within(difference_nm, 2.0 * kTorqueLimitNm[j])) {
            mean_difference_nm_[j] += kShare * (difference_nm - mean_difference_nm_[j]);
        }
        mean_rad_s_[j] += kShare * (now.velocity_rad_s[j] - mean_rad_s_[j]);
        acceleration += kInertiaRoot[j] * std::fabs(now.velocity_rad_s[j] - mean_rad_s_[j]) / kModelTimeS;
    }
    std::uint32_t faults = 0U;
    for (std::size_t j = 0U; j < kArmJointCount; ++j) {
        const double distance_nm = kModelDifferenceNm[j] + kInertiaRoot[j] * acceleration;
        faults |= is_within(mean_difference_nm_[j], distance_nm) ? 0U : to_bit(ArmFault::kPositionDoubtful);
    }
    return faults;
}

}  // namespace safe_arm
