// SPDX-License-Identifier: Apache-2.0
/// @file
/// Last component before the drives: passes the controller's torque on only while the supervisor allows it,
/// holds the arm and tests its brakes when the supervisor says so, and falls back to the safe outputs by
/// itself when the supervisor falls silent.
///
/// @satisfies SWR-SAF-009, SWR-SAF-010, SWR-SAF-025, SWR-SAF-042, SWR-SAF-051
/// Design: docs/design/safe_arm.md#components
#ifndef EXAMPLES_SAFE_ARM_DRIVE_GATE_HPP
#define EXAMPLES_SAFE_ARM_DRIVE_GATE_HPP

#include "mamori/kernel/system/system.hpp"
#include "mamori/safety/arm/arm_device.hpp"
#include "messages.hpp"
#include "stop_loop.hpp"

namespace safe_arm {

class DriveGate final : public mamori::Component {
  public:
    /// @param[in] outputs image that the device layer takes after each frame; static storage.
    constexpr explicit DriveGate(mamori::safety::ArmOutputs& outputs) noexcept
        : Component("drive_gate"), outputs_(outputs) {}

    mamori::InPort<StopCommand> stop{*this, "stop"};
    mamori::InPort<TorqueCommand> command{*this, "command"};
    mamori::InPort<JointState> arm_state{*this, "arm_state"};
    mamori::OutPort<DriveCommand> drive{*this, "drive"};
    using Ports =
        mamori::Ports<&DriveGate::stop, &DriveGate::command, &DriveGate::arm_state, &DriveGate::drive>;

    mamori::Status on_execute(mamori::ContextHandle context) noexcept override;
    /// The outputs are safe whenever this component does not run.
    mamori::Status on_deactivated(mamori::ContextHandle context) noexcept override;
    mamori::Status on_aborting(mamori::ContextHandle context) noexcept override;

  private:
    JointVector calc_torque(const StopCommand& decision, const JointVector& gravity_nm) noexcept;
    JointVector limit_controller(const JointVector& wanted_nm, const JointVector& gravity_nm) const noexcept;

    mamori::safety::ArmOutputs& outputs_;
    StopLoop stop_loop_{};
};

}  // namespace safe_arm

#endif  // EXAMPLES_SAFE_ARM_DRIVE_GATE_HPP
