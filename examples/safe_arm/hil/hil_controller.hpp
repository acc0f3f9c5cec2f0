// SPDX-License-Identifier: Apache-2.0
/// @file
/// The motion controller of the arm behind a link: each input gives one command.
///
/// @satisfies SWR-HIL-001      Design: docs/design/safe_arm.md#hardware-in-the-loop
#ifndef EXAMPLES_SAFE_ARM_HIL_HIL_CONTROLLER_HPP
#define EXAMPLES_SAFE_ARM_HIL_HIL_CONTROLLER_HPP

#include <optional>

#include "hil_messages.hpp"
#include "mamori/simbody_sim/fault_plan.hpp"
#include "motion_controller.hpp"

namespace safe_arm {

/// Thread safety: none. Time: that of MotionController.
class HilController final {
  public:
    /// @param[in] track, law must outlive this object.
    HilController(const MotionTrack& track, mamori::sim::ComputedTorqueController& law,
                  mamori::Instant motion_start) noexcept {
        controller_.configure(track, law, motion_start);
    }

    /// Before reply(). @param[in] fault replaces the controller at `now` if it is controller_wrong.
    void follow(const mamori::sim::FaultPlan& fault, mamori::Instant now) noexcept;
    TorqueCommand reply(const ControllerInput& input) noexcept;

  private:
    MotionController controller_;
    std::optional<WrongController> wrong_{};
    mamori::OutPort<JointState> state_{mamori::kNoOwner, "state"};
    mamori::OutPort<StopCommand> stop_{mamori::kNoOwner, "stop"};
};

}  // namespace safe_arm

#endif  // EXAMPLES_SAFE_ARM_HIL_HIL_CONTROLLER_HPP
