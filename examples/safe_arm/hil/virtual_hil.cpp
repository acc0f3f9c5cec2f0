// SPDX-License-Identifier: Apache-2.0
#include "virtual_hil.hpp"

namespace safe_arm {

using mamori::Duration;
using mamori::Instant;

VirtualHil::VirtualHil(HilPlant& plant, HilController& controller,
                       mamori::ports::virtual_time::VirtualHost& host, const mamori::sim::FaultPlan& fault,
                       const LinkErrorPlan& error)
    : plant_(plant), controller_(controller), host_(host), fault_(fault) {
    hil::drive_sink.configure(error, to_plant_);
    hil::state_sink.configure(error, to_controller_);
    device_sink_.configure(error, to_kernel_devices_);
    command_sink_.configure(error, to_kernel_commands_);
}

void VirtualHil::sample(std::uint64_t frame, Instant now) noexcept {
    // The plant sends before the kernel starts: the first messages of a link only establish their order.
    constexpr int kBeforeStart = 3;
    for (int i = 0; frame == 0U && i < kBeforeStart; ++i) {
        send_answer(plant_, plant_end_, now);
    }
    now_ = now;
    hil::drive_sink.set_frame(frame);
    hil::state_sink.set_frame(frame);
    const bool is_hanging = fault_.kind == mamori::sim::FaultKind::kSupervisorHang && is_active(fault_, now);
    // In the table, so the call cannot be rejected.
    static_cast<void>(
        host_.set_duration(hil::hang_point, is_hanging ? mamori::ports::virtual_time::kNever : Duration{0}));
}

void VirtualHil::apply(std::uint64_t, Instant now, Duration length) noexcept {
    hil::watchdog_mirror.check(now + length);
    const bool has_message = plant_end_.receive(now);
    if (has_message) {
        plant_.take(plant_end_.get_received());
    }
    if (plant_.get_lost_at().has_value()) {
        plant_.run_alone();
    } else if (!has_message) {
        silence_ = silence_ + length;
        if (silence_ < kDriveSilenceMax || !plant_.is_linked()) {
            return;  // the plant answers messages only
        }
        plant_.lose_link();
    }
    silence_ = Duration{0};
    send_answer(plant_, plant_end_, now);
}

}  // namespace safe_arm
