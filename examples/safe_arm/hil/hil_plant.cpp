// SPDX-License-Identifier: Apache-2.0
#include "hil_plant.hpp"

#include "machine.hpp"

namespace safe_arm {

using mamori::Instant;
using mamori::Status;

DeviceFrame HilPlant::answer() {
    const Instant now = get_now();
    mamori::sim::apply_plant_faults(fault_, now, plant_.faults());
    const Buttons buttons = calc_buttons(fault_, now);
    plant_.set_buttons(buttons.start, buttons.reset);
    return {is_started_ ? now.ns - kFrame.ns : 0, plant_.sample()};
}

void HilPlant::take(const DriveFrame& frame) {
    is_started_ = true;
    if (lost_at_.has_value()) {
        return;  // only a power cycle ends the communication fault
    }
    while (frame_count_ < frame.frame) {
        step();
    }
    newest_ = frame;
    if (frame.watchdog_services != service_count_) {
        service_count_ = frame.watchdog_services;
        static_cast<void>(watchdog_.service(get_now()));  // an open relay stays open
    }
    if (frame_count_ == frame.frame) {
        step();
    }
}

void HilPlant::lose_link() {
    lost_at_ = get_now();
    for (std::int64_t passed = 0; passed < kDriveSilenceMax.ns; passed += kFrame.ns) {
        step();
    }
    newest_.outputs = {};
    newest_.report.is_stopping = true;
    closed_at_ = get_now();
}

void HilPlant::run_alone() {
    step();
}

void HilPlant::step() {
    const Instant now = get_now();
    mamori::sim::apply_plant_faults(fault_, now, plant_.faults());
    watchdog_.check(now + kFrame);
    plant_.set_watchdog_expired(watchdog_.has_expired());
    is_sound_ = plant_.step(newest_.outputs, kFrame) == Status::kOk && is_sound_;
    ++frame_count_;
    FrameFacts facts{};
    facts.start = now;
    facts.end = now + kFrame;
    facts.state = static_cast<mamori::safety::SafeState>(newest_.report.state);
    facts.first_fault = newest_.report.first_fault;
    facts.reaction = static_cast<mamori::safety::Reaction>(newest_.report.reaction);
    facts.is_watchdog_expired = watchdog_.has_expired();
    facts.setpoint_rad = newest_.report.setpoint_rad;
    facts.torque_enable = newest_.outputs.torque_enable;
    facts.brake_release = newest_.outputs.brake_release;
    facts.is_stopping = newest_.report.is_stopping;
    record_.add_frame(facts, plant_);
}

}  // namespace safe_arm
