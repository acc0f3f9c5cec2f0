// SPDX-License-Identifier: Apache-2.0
#include "hil_controller.hpp"

namespace safe_arm {

using mamori::Instant;
using mamori::safety::SafeState;

void HilController::follow(const mamori::sim::FaultPlan& fault, Instant now) noexcept {
    const bool is_wrong = fault.kind == mamori::sim::FaultKind::kControllerWrong && is_active(fault, now);
    if (is_wrong && !wrong_.has_value()) {
        wrong_.emplace(static_cast<std::uint64_t>(fault.magnitude));
    }
    controller_.set_wrong(is_wrong ? &*wrong_ : nullptr);
}

TorqueCommand HilController::reply(const ControllerInput& input) noexcept {
    const Instant now{input.sent_at_ns};
    JointState state{};
    state.position_rad = input.position_rad;
    state.velocity_rad_s = input.velocity_rad_s;
    StopCommand stop{};
    stop.state = input.is_operational ? SafeState::kOperational : SafeState::kStandby;
    stop.torque_enable = input.torque_enable;
    stop.mode = input.is_reduced ? OperatingMode::kReducedSpeed : OperatingMode::kAutomatic;
    state_.write(state);
    stop_.write(stop);
    controller_.state.take(state_.get_staged_sample(now));
    controller_.stop.take(stop_.get_staged_sample(now));
    static_cast<void>(controller_.on_execute({0, now}));
    static_cast<void>(controller_.command.publish(now));
    return controller_.command.get_published();
}

}  // namespace safe_arm
