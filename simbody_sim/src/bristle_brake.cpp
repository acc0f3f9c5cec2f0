// SPDX-License-Identifier: Apache-2.0
#include "bristle_brake.hpp"

#include <algorithm>
#include <cmath>

namespace mamori::sim::detail {

double BristleBrake::hold(const BrakeModel& brake, double fade, double creep_rad, double q_rad,
                          double u_rad_s) noexcept {
    if (!attached_) {
        attached_ = true;
        anchor_rad_ = q_rad;
    }
    const double torque_nm = brake.torque_nm * (1.0 - fade);
    const double deflection_limit = torque_nm / brake.stiffness_nm_rad;
    const double deflection = std::clamp(q_rad - anchor_rad_, -deflection_limit, deflection_limit);
    anchor_rad_ = q_rad - deflection + std::copysign(creep_rad, deflection);
    const double wanted = brake.stiffness_nm_rad * deflection + brake.damping_nm_s_rad * u_rad_s;
    return -std::clamp(wanted, -torque_nm, torque_nm);
}

}  // namespace mamori::sim::detail
