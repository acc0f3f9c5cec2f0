// SPDX-License-Identifier: Apache-2.0
#include "mamori/simbody_sim/physical_verdict.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mamori::sim {
namespace {

double calc_max_distance(const JointVector& a, const JointVector& b) noexcept {
    double distance = 0.0;
    for (std::size_t i = 0U; i < kArmJointCount; ++i) {
        distance = std::max(distance, std::abs(a[i] - b[i]));
    }
    return distance;
}

}  // namespace

PhysicalVerdict::PhysicalVerdict(const ArmModel& model, StandstillRule rule)
    : rule_(rule), min_position_margin_rad_(std::numeric_limits<double>::infinity()) {
    for (std::size_t i = 0U; i < kArmJointCount; ++i) {
        position_min_rad_[i] = model.joints[i].position_min_rad;
        position_max_rad_[i] = model.joints[i].position_max_rad;
    }
}

void PhysicalVerdict::on_substep(Instant now, const JointVector& q, const JointVector& u) {
    judge_limits(q, u);
    if (standstill_) {
        hold_drift_rad_ = std::max(hold_drift_rad_, calc_max_distance(q, slow_position_rad_));
        return;
    }
    if (injection_rad_) {
        for (std::size_t i = 0U; i < kArmJointCount; ++i) {
            stop_travel_rad_[i] = std::max(stop_travel_rad_[i], std::abs(q[i] - (*injection_rad_)[i]));
        }
    }
    if (stop_due_) {
        judge_standstill(now, q, u);
    }
}

void PhysicalVerdict::judge_limits(const JointVector& q, const JointVector& u) noexcept {
    for (std::size_t i = 0U; i < kArmJointCount; ++i) {
        max_speed_rad_s_[i] = std::max(max_speed_rad_s_[i], std::abs(u[i]));
        const double margin = std::min(q[i] - position_min_rad_[i], position_max_rad_[i] - q[i]);
        min_position_margin_rad_ = std::min(min_position_margin_rad_, margin);
    }
}

void PhysicalVerdict::judge_standstill(Instant now, const JointVector& q, const JointVector& u) noexcept {
    const bool slow =
        std::all_of(u.begin(), u.end(), [this](double speed) { return std::abs(speed) < rule_.speed_rad_s; });
    if (!slow) {
        slow_since_.reset();
        return;
    }
    if (!slow_since_) {
        slow_since_ = now;
        slow_position_rad_ = q;
        slow_drift_rad_ = 0.0;
    }
    slow_drift_rad_ = std::max(slow_drift_rad_, calc_max_distance(q, slow_position_rad_));
    if (now - *slow_since_ >= rule_.confirmation) {
        standstill_ = slow_since_;
        hold_drift_rad_ = slow_drift_rad_;
    }
}

void PhysicalVerdict::mark_injection(const JointVector& q) noexcept {
    injection_rad_ = q;
}

void PhysicalVerdict::mark_stop() noexcept {
    stop_due_ = true;
}

void PhysicalVerdict::judge_tracking(const JointVector& q, const JointVector& q_ref) noexcept {
    max_tracking_error_rad_ = std::max(max_tracking_error_rad_, calc_max_distance(q, q_ref));
}

}  // namespace mamori::sim
