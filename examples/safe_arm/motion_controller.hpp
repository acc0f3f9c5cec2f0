// SPDX-License-Identifier: Apache-2.0
/// @file
/// The non-safety component: follows the motion by computed torque (KDL). The safety concept does not rely on
/// it: stops are made by the drive gate.
///
/// @satisfies SWR-SAF-012      Design: docs/design/safe_arm.md#components
#ifndef EXAMPLES_SAFE_ARM_MOTION_CONTROLLER_HPP
#define EXAMPLES_SAFE_ARM_MOTION_CONTROLLER_HPP

#include <cstdint>

#include "mamori/kernel/system/system.hpp"
#include "messages.hpp"
#include "motion_track.hpp"
#include "wrong_controller.hpp"

namespace mamori::sim {
class ComputedTorqueController;
}

namespace safe_arm {

/// Host only. Between `configure` and the start of the motion it holds the measured position.
class MotionController final : public mamori::Component {
  public:
    constexpr MotionController() noexcept : Component("motion_controller") {}

    mamori::InPort<JointState> state{*this, "state"};
    mamori::InPort<StopCommand> stop{*this, "stop"};
    mamori::OutPort<TorqueCommand> command{*this, "command"};
    using Ports =
        mamori::Ports<&MotionController::state, &MotionController::stop, &MotionController::command>;

    /// @param[in] track, law  must outlive this component.
    /// @param[in] motion_start instant at which the path is begun, if the arm is operational and at its
    /// beginning.
    void configure(const MotionTrack& track, mamori::sim::ComputedTorqueController& law,
                   mamori::Instant motion_start) noexcept;

    /// From the next cycle on. @param[in] wrong corrupts each command; nullptr: none. Must outlive its use.
    void set_wrong(WrongController* wrong) noexcept { wrong_ = wrong; }

    /// @return kOk; kPreconditionNotMet (not configured).
    mamori::Status on_activated(mamori::ContextHandle context) noexcept override;
    mamori::Status on_execute(mamori::ContextHandle context) noexcept override;

  private:
    void advance_path(mamori::Instant now) noexcept;
    double get_path_rate() const noexcept;
    PathPoint calc_setpoint() const noexcept;

    const MotionTrack* track_{nullptr};
    mamori::sim::ComputedTorqueController* law_{nullptr};
    mamori::Instant motion_start_{};
    JointVector hold_rad_{};
    double path_time_s_{0.0};
    bool is_on_path_{false};
    WrongController* wrong_{nullptr};
    std::uint32_t sequence_{0U};
};

}  // namespace safe_arm

#endif  // EXAMPLES_SAFE_ARM_MOTION_CONTROLLER_HPP
