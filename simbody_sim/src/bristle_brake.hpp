// SPDX-License-Identifier: Apache-2.0
/// @file
/// Friction brake that holds without creep and slips at its torque: a stiff spring (the bristle) between the
/// joint and an anchor; when the spring reaches the brake torque, the anchor is dragged along. Source:
/// elasto-plastic friction, Dupont et al., IEEE Trans. Automatic Control 47 (2002), without Stribeck effect
#ifndef MAMORI_SIMBODY_SIM_SRC_BRISTLE_BRAKE_HPP
#define MAMORI_SIMBODY_SIM_SRC_BRISTLE_BRAKE_HPP

#include "mamori/simbody_sim/arm_model.hpp"

namespace mamori::sim::detail {

class BristleBrake final {
  public:
    /// Lets go of the joint.
    void open() noexcept { attached_ = false; }
    /// Torque on the joint [N m] while closed, never more than what is left of the brake torque.
    /// The anchor is where the joint was at the first call after open().
    /// @param[in] fade fraction of the brake torque that is lost, 0 .. 1.
    /// @param[in] creep_rad    the anchor yields to the load by this much in this step, >= 0.
    double hold(const BrakeModel& brake, double fade, double creep_rad, double q_rad,
                double u_rad_s) noexcept;

  private:
    bool attached_{false};
    double anchor_rad_{0.0};
};

}  // namespace mamori::sim::detail

#endif  // MAMORI_SIMBODY_SIM_SRC_BRISTLE_BRAKE_HPP
