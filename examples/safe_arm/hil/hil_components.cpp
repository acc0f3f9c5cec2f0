// SPDX-License-Identifier: Apache-2.0
#include "hil_components.hpp"

#include "mamori/safety/arm/guards.hpp"

namespace safe_arm {

using mamori::ContextHandle;
using mamori::Instant;
using mamori::Status;
using mamori::safety::SafeState;

Status DeviceImage::on_execute(ContextHandle) noexcept {
    if (device.has_value()) {
        image_ = device.read().inputs;
    }
    return Status::kOk;
}

Status ReadingFilter::on_execute(ContextHandle context) noexcept {
    const bool is_fresh =
        device.has_value() &&
        !mamori::safety::is_message_too_old(Instant{device.read().answered_ns}, context.now, kDeviceAgeMax);
    if (is_fresh) {
        out.write(in.read());
    }
    return Status::kOk;
}

Status HangPoint::on_execute(ContextHandle context) noexcept {
    if (fault_.kind == mamori::sim::FaultKind::kSupervisorHang && is_active(fault_, context.now)) {
        while (!is_released_.load()) {
        }
    }
    return Status::kOk;
}

Status ControllerView::on_execute(ContextHandle context) noexcept {
    ControllerInput result{};
    result.sent_at_ns = context.now.ns;
    result.position_rad = state.read().position_rad;
    result.velocity_rad_s = state.read().velocity_rad_s;
    result.is_operational = stop.read().state == SafeState::kOperational;
    result.torque_enable = stop.read().torque_enable && !stop.read().stop_requested;
    result.is_reduced = stop.read().mode != OperatingMode::kAutomatic;
    out.write(result);
    return Status::kOk;
}

Status LinkWatchdog::service(Instant now) noexcept {
    const Status status = mirror_.service(now);
    service_count_ += status == Status::kOk ? 1U : 0U;
    return status;
}

Status DriveEncoder::on_execute(ContextHandle context) noexcept {
    DriveFrame result{};
    result.frame = static_cast<std::uint32_t>(context.now.ns / kFrame.ns);
    result.watchdog_services = watchdog_.get_service_count();
    if (!is_closed_.load()) {
        result.outputs = outputs_;
    }
    result.report.state = static_cast<std::uint8_t>(supervisor_.get_state());
    result.report.reaction = static_cast<std::uint8_t>(supervisor_.get_reaction());
    result.report.first_fault = supervisor_.get_first_fault();
    result.report.is_stopping = !result.outputs.torque_enable || stop.read().stop_requested;
    const mamori::safety::ExecutionSupervisor& supervision = safety_.get_supervision();
    const bool has_expired =
        supervision.get_first_expired() != mamori::safety::ExecutionSupervisor::kNoComponent;
    result.report.late_windows = supervision.get_late_release().count + (has_expired ? 1U : 0U);
    result.report.setpoint_rad = command.read().setpoint_rad;
    out.write(result);
    return Status::kOk;
}

}  // namespace safe_arm
