// SPDX-License-Identifier: Apache-2.0
/// @file
/// Dynamics of the arm from KDL, for the controller. Written independently of Simbody's, so each checks the
/// other.
///
/// @satisfies SWR-SIM-003      Design: docs/design/simulation.md#controller
#ifndef MAMORI_SIMBODY_SIM_ARM_DYNAMICS_HPP
#define MAMORI_SIMBODY_SIM_ARM_DYNAMICS_HPP

#include <memory>

#include "mamori/simbody_sim/arm_model.hpp"

namespace mamori::sim {

/// Rigid-body dynamics with armature; no friction, no end stops.
///
/// Thread safety: none; two objects may be used in two threads.
/// Time:          about 2 us per call at -O2. Memory: no heap after construction.
class ArmDynamics final {
  public:
    /// @param[in] model as load_arm_model accepts it; copied.
    explicit ArmDynamics(const ArmModel& model);
    ~ArmDynamics();
    ArmDynamics(const ArmDynamics&) = delete;
    ArmDynamics& operator=(const ArmDynamics&) = delete;

    /// Mass matrix with armature [kg m^2]. @param[in] q positions [rad].
    JointMatrix calc_mass_matrix(const JointVector& q);
    /// Torque that holds the arm at rest [N m]. @param[in] q positions [rad].
    JointVector calc_gravity_torque(const JointVector& q);
    /// Torque that gives the acceleration `qdd` [rad/s^2] at `q` [rad], `qd` [rad/s]: M qdd + C + G [N m].
    /// Source: recursive Newton-Euler algorithm, KDL ChainIdSolver_RNE.
    JointVector calc_inverse_dynamics(const JointVector& q, const JointVector& qd, const JointVector& qdd);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace mamori::sim

#endif  // MAMORI_SIMBODY_SIM_ARM_DYNAMICS_HPP
