// SPDX-License-Identifier: Apache-2.0
/// @file
/// The controller of the target image: commands each joint to hold its position.
///
/// @satisfies SWR-PRF-024      Design: docs/design/proofs.md#watermark
#ifndef VERIFICATION_PROOFS_TARGET_HOLD_CONTROLLER_HPP
#define VERIFICATION_PROOFS_TARGET_HOLD_CONTROLLER_HPP

#include <cstdint>

#include "mamori/kernel/system/system.hpp"
#include "messages.hpp"

namespace proof {

class HoldController final : public mamori::Component {
  public:
    constexpr HoldController() noexcept : Component("hold_controller") {}

    mamori::InPort<safe_arm::JointState> state{*this, "state"};
    mamori::InPort<safe_arm::StopCommand> stop{*this, "stop"};
    mamori::OutPort<safe_arm::TorqueCommand> command{*this, "command"};
    using Ports = mamori::Ports<&HoldController::state, &HoldController::stop, &HoldController::command>;

    mamori::Status on_execute(mamori::ContextHandle context) noexcept override {
        safe_arm::TorqueCommand result{};
        result.sequence = ++sequence_;
        result.sent_at_ns = context.now.ns;
        result.setpoint_rad = state.read().position_rad;
        command.write(result);
        return mamori::Status::kOk;
    }

  private:
    std::uint32_t sequence_{0U};
};

}  // namespace proof

#endif  // VERIFICATION_PROOFS_TARGET_HOLD_CONTROLLER_HPP
