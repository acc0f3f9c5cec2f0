// SPDX-License-Identifier: Apache-2.0
#include "arm_reader.hpp"

namespace safe_arm {

using mamori::ContextHandle;
using mamori::Status;

Status ArmReader::configure(const EncoderScale& scale) noexcept {
    for (std::size_t j = 0U; j < kArmJointCount; ++j) {
        if (!(scale.a_counts_per_rad[j] > 0.0) || !(scale.b_counts_per_rad[j] > 0.0)) {
            return Status::kBadParameter;
        }
    }
    scale_ = scale;
    is_configured_ = true;
    return Status::kOk;
}

Status ArmReader::on_activated(ContextHandle) noexcept {
    if (!is_configured_ || modes_ == nullptr) {
        return Status::kPreconditionNotMet;
    }
    requested_ = modes_->get_mode<OperatingMode>();
    return Status::kOk;
}

Status ArmReader::on_execute(ContextHandle context) noexcept {
    JointReading result{};
    result.brakes_open = true;
    for (std::size_t j = 0U; j < kArmJointCount; ++j) {
        result.position_a_rad[j] =
            static_cast<double>(inputs_.encoder_a_counts[j]) / scale_.a_counts_per_rad[j];
        result.position_b_rad[j] =
            static_cast<double>(inputs_.encoder_b_counts[j]) / scale_.b_counts_per_rad[j];
        result.brakes_closed = result.brakes_closed && inputs_.brake_closed[j];
        result.brakes_open = result.brakes_open && !inputs_.brake_closed[j];
    }
    result.measured_torque_nm = inputs_.measured_torque_nm;
    result.torque_enabled = inputs_.torque_enabled;
    result.relay_closed = inputs_.relay_closed;
    result.power_good = inputs_.power_good;
    result.reference_closed = inputs_.reference_closed;
    result.drive_clock_ns = inputs_.drive_clock_ns;
    result.mode = modes_->get_mode<OperatingMode>();
    const PanelState panel = panel_.step(inputs_, result.mode, context.now);
    // A rejected request, for example during a mode switch, is repeated in the next frame.
    if (panel.selected != result.mode && modes_->request(panel.selected) == Status::kOk) {
        requested_ = panel.selected;
    }
    result.is_mode_changing = panel.selected != result.mode || requested_ != result.mode;
    result.start_button = panel.start;
    result.reset_button = panel.reset;
    result.panel_faults = panel.faults;
    reading.write(result);
    return Status::kOk;
}

}  // namespace safe_arm
