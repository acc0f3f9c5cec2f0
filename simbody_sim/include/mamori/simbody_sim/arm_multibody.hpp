// SPDX-License-Identifier: Apache-2.0
/// @file
/// Equations of motion of the arm from Simbody: mass matrix, bias torque and energy at a given state.
/// The plant integrates them; the tests compare them with those of KDL, which is written independently.
///
/// @satisfies SWR-SIM-003      Design: docs/design/simulation.md#plant
#ifndef MAMORI_SIMBODY_SIM_ARM_MULTIBODY_HPP
#define MAMORI_SIMBODY_SIM_ARM_MULTIBODY_HPP

#include <memory>

#include "mamori/simbody_sim/arm_model.hpp"

namespace mamori::sim {

/// (M + armature) * qdd + bias = torque, where bias holds Coriolis, centrifugal, gravity and end-stop
/// torques.
///
/// Thread safety: none; two objects may be used in two threads.
/// Time:          about 10 us per evaluate() at -O2. Memory: heap, also per call.
class ArmMultibody final {
  public:
    /// @param[in] model as load_arm_model accepts it; copied.
    explicit ArmMultibody(const ArmModel& model);
    ~ArmMultibody();
    ArmMultibody(const ArmMultibody&) = delete;
    ArmMultibody& operator=(const ArmMultibody&) = delete;

    /// Computes mass matrix, bias torque and energy at a state.
    /// @param[in] q positions [rad], finite. @param[in] u velocities [rad/s], finite.
    void evaluate(const JointVector& q, const JointVector& u);

    /// Mass matrix with the armature on its diagonal [kg m^2] at the last evaluated state.
    const JointMatrix& get_mass_matrix() const noexcept;
    /// Torque that gives zero acceleration [N m] at the last evaluated state.
    const JointVector& get_bias_torque() const noexcept;
    /// Kinetic (rotors included) + potential energy [J] at the last evaluated state; end-stop springs
    /// included.
    double calc_energy_j() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace mamori::sim

#endif  // MAMORI_SIMBODY_SIM_ARM_MULTIBODY_HPP
