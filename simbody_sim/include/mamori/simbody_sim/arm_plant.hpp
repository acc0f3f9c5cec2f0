// SPDX-License-Identifier: Apache-2.0
/// @file
/// The simulated machine: arm, drives, brakes, encoders and supply behind the same process image as a real
/// one. Fixed-step and without any clock or randomness, so the same inputs give the same bits.
///
/// @satisfies SWR-SIM-004, SWR-SIM-005, SWR-SIM-006, SWR-SIM-007, SWR-SIM-008, SWR-SIM-009, SWR-SIM-010
/// Design: docs/design/simulation.md#plant
#ifndef MAMORI_SIMBODY_SIM_ARM_PLANT_HPP
#define MAMORI_SIMBODY_SIM_ARM_PLANT_HPP

#include <memory>

#include "mamori/kernel/base/status.hpp"
#include "mamori/kernel/base/time.hpp"
#include "mamori/safety/arm/arm_device.hpp"
#include "mamori/simbody_sim/arm_model.hpp"
#include "mamori/simbody_sim/plant_faults.hpp"

namespace mamori::sim {

/// Sees the true state after each integration step. Called from ArmPlant::step; must not call the plant.
class PlantObserver {
  public:
    /// @param[in] now end of the step. @param[in] q true positions [rad]. @param[in] u true velocities
    /// [rad/s].
    virtual void on_substep(Instant now, const JointVector& q, const JointVector& u) = 0;

  protected:
    ~PlantObserver() = default;
};

/// Seven-joint arm with its devices.
///
/// Thread safety: none; two plants may run in two threads.
/// Time:          a step of 1 ms is four integration steps, about 50 us in all at -O2. Memory: heap, also per
/// step.
class ArmPlant final {
  public:
    /// @param[in] model as load_arm_model accepts it; copied. Starts as after reset({}).
    explicit ArmPlant(const ArmModel& model);
    ~ArmPlant();
    ArmPlant(const ArmPlant&) = delete;
    ArmPlant& operator=(const ArmPlant&) = delete;

    /// Time zero, at rest, brakes closed, torque off, devices sound, watchdog served, relay open, buttons
    /// released. The observer stays. @param[in] q0 positions [rad], finite.
    void reset(const JointVector& q0);

    /// Lets time pass with constant commands. A command that is no finite number counts as zero torque.
    /// @param[in] outputs  what the safety partition writes to the devices.
    /// @param[in] duration positive multiple of kPlantSubstep.
    /// @return kOk; kBadParameter (duration; nothing has changed); kError (the state is no longer finite).
    Status step(const safety::ArmOutputs& outputs, Duration duration);

    /// Samples the devices now. @return the image, valid until the next call of a non-const member.
    const safety::ArmInputs& sample();

    /// Hardware watchdog: while expired, the relay is open, and torque and brake current are off.
    void set_watchdog_expired(bool expired) noexcept;
    /// Operator's buttons as the next sample shows them.
    void set_buttons(bool start, bool reset) noexcept;
    /// @param[in] observer must outlive the plant or be replaced; nullptr for none.
    void set_observer(PlantObserver* observer) noexcept;
    /// State of the devices; effective from the next step or sample.
    PlantFaults& faults() noexcept;

    /// @name Truth that no device delivers
    /// @{
    const JointVector& positions() const noexcept;   ///< [rad]
    const JointVector& velocities() const noexcept;  ///< [rad/s]
    const JointVector& torques()
        const noexcept;            ///< motor torque at the joint side in the last substep [N m]
    Instant now() const noexcept;  ///< time since reset
    double calc_energy_j();        ///< mechanical energy, see ArmMultibody
                                   /// @}

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace mamori::sim

#endif  // MAMORI_SIMBODY_SIM_ARM_PLANT_HPP
