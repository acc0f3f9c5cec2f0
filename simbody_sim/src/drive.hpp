// SPDX-License-Identifier: Apache-2.0
/// @file
/// Torque that a drive with its motor gives, and a contact that follows its input after a delay.
#ifndef MAMORI_SIMBODY_SIM_SRC_DRIVE_HPP
#define MAMORI_SIMBODY_SIM_SRC_DRIVE_HPP

#include "mamori/kernel/base/time.hpp"
#include "mamori/simbody_sim/arm_model.hpp"

namespace mamori::sim::detail {

/// Torque at the joint side [N m] for a wanted one. Saturates at the torque limit; in the driving direction
/// the limit falls linearly with speed to zero at the speed limit (back-EMF). A torque that is no finite
/// number is zero.
double calc_motor_torque(const JointModel& joint, double wanted_nm, double speed_rad_s) noexcept;

/// On/off state that follows its input when the input has differed for the whole delay.
class DelayedSwitch final {
  public:
    void reset(bool on) noexcept;
    /// Ends at the state for the next `step` of time. The delays must not be negative.
    bool update(bool wanted, Duration on_delay, Duration off_delay, Duration step) noexcept;
    bool is_on() const noexcept { return on_; }

  private:
    bool on_{false};
    Duration differing_{};
};

}  // namespace mamori::sim::detail

#endif  // MAMORI_SIMBODY_SIM_SRC_DRIVE_HPP
