// SPDX-License-Identifier: Apache-2.0
/// @file
/// Computed-torque control of the arm: the non-safety calculation that follows a motion.
///
/// @satisfies SWR-SIM-013      Design: docs/design/simulation.md#controller
/// Source:   Siciliano et al., Robotics: Modelling, Planning and Control, inverse dynamics control
#ifndef MAMORI_SIMBODY_SIM_COMPUTED_TORQUE_CONTROLLER_HPP
#define MAMORI_SIMBODY_SIM_COMPUTED_TORQUE_CONTROLLER_HPP

#include "mamori/simbody_sim/arm_dynamics.hpp"

namespace mamori::sim {

/// Gains of the error dynamics e'' + kd e' + kp e = 0, the same for each joint.
/// Default: both poles at -20 rad/s, slow enough for a velocity differentiated from encoder counts at 1 kHz.
struct TrackingGains {
    double kp_per_s2{400.0};  ///< >= 0
    double kd_per_s{40.0};    ///< >= 0
};

/// Pure calculation: keeps nothing between calls.
///
/// Thread safety: none. Time: about 2 us per call at -O2. Memory: no heap after construction.
class ComputedTorqueController final {
  public:
    explicit ComputedTorqueController(const ArmModel& model, TrackingGains gains = {});

    /// M(q) (qdd_ref + kd (qd_ref - qd) + kp (q_ref - q)) + C(q, qd) + G(q) [N m], not saturated.
    /// @param[in] q_ref, qd_ref, qdd_ref wanted motion [rad, rad/s, rad/s^2].
    /// @param[in] q, qd measured motion [rad, rad/s].
    JointVector calc_torque(const JointVector& q_ref, const JointVector& qd_ref, const JointVector& qdd_ref,
                            const JointVector& q, const JointVector& qd);
    /// Torque that holds the arm at rest at `q` [N m].
    JointVector calc_gravity_torque(const JointVector& q);

  private:
    ArmDynamics dynamics_;
    TrackingGains gains_;
};

}  // namespace mamori::sim

#endif  // MAMORI_SIMBODY_SIM_COMPUTED_TORQUE_CONTROLLER_HPP
