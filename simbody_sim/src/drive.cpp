// SPDX-License-Identifier: Apache-2.0
#include "drive.hpp"

#include <algorithm>
#include <cmath>

namespace mamori::sim::detail {

double calc_motor_torque(const JointModel& joint, double wanted_nm, double speed_rad_s) noexcept {
    if (!std::isfinite(wanted_nm)) {
        return 0.0;
    }
    const bool drives = wanted_nm * speed_rad_s > 0.0;
    const double margin = drives ? std::max(0.0, 1.0 - std::abs(speed_rad_s) / joint.speed_limit_rad_s) : 1.0;
    const double available = joint.torque_limit_nm * margin;
    return std::clamp(wanted_nm, -available, available);
}

void DelayedSwitch::reset(bool on) noexcept {
    on_ = on;
    differing_ = {};
}

bool DelayedSwitch::update(bool wanted, Duration on_delay, Duration off_delay, Duration step) noexcept {
    if (wanted == on_) {
        differing_ = {};
    } else if (differing_ >= (wanted ? on_delay : off_delay)) {
        on_ = wanted;
        differing_ = {};
    } else {
        differing_ = differing_ + step;
    }
    return on_;
}

}  // namespace mamori::sim::detail
