// SPDX-License-Identifier: Apache-2.0
#include "machine.hpp"

#include <cmath>

#include "safe_arm_system.hpp"

namespace safe_arm {
namespace {

using mamori::Duration;
using mamori::Instant;
using mamori::sim::FaultKind;

constexpr Duration kPush{50'000'000};
constexpr Instant kStartPushed{250'000'000};
/// From the demand of a stop.
constexpr Duration kResetAfter{1'000'000'000};
constexpr Duration kRestartAfter{1'400'000'000};

bool is_pushed(Instant since, Instant now) noexcept {
    return now >= since && now < since + kPush;
}

}  // namespace

Buttons calc_buttons(const mamori::sim::FaultPlan& fault, Instant now) noexcept {
    const Instant demanded_at = Instant{} + fault.at;
    const bool is_emergency_stop =
        fault.kind == FaultKind::kEmergencyStop || fault.kind == FaultKind::kEnablingSqueezed;
    const bool is_operator = is_emergency_stop || fault.kind == FaultKind::kProtectiveStop ||
                             fault.kind == FaultKind::kEnablingReleased ||
                             fault.kind == FaultKind::kRunReleased;
    // A brake that creeps shows before the start only.
    const bool is_early = fault.kind != FaultKind::kBrakeCreep;
    return {(is_early && is_pushed(kStartPushed, now)) ||
                ((is_operator || !is_early) && is_pushed(demanded_at + kRestartAfter, now)),
            is_emergency_stop && is_pushed(demanded_at + kResetAfter, now)};
}

void Machine::sample(std::uint64_t, Instant now) noexcept {
    mamori::sim::apply_plant_faults(fault_, now, plant_.faults());
    apply_software_faults(now);
    const Buttons buttons = calc_buttons(fault_, now);
    plant_.set_buttons(buttons.start, buttons.reset);
    inputs = plant_.sample();
}

void Machine::apply_software_faults(Instant now) noexcept {
    const bool is_active = mamori::sim::is_active(fault_, now);
    mamori::ports::virtual_time::ChannelFault channel_fault{};
    Duration controller_time = kControllerTime;
    Duration supervisor_time = kSafetyComponentTime;
    switch (fault_.kind) {
        case FaultKind::kControllerHang:
            controller_time = is_active ? mamori::ports::virtual_time::kNever : kControllerTime;
            break;
        case FaultKind::kSupervisorHang:
        case FaultKind::kProcessorStops:
            supervisor_time = is_active ? mamori::ports::virtual_time::kNever : kSafetyComponentTime;
            break;
        case FaultKind::kControllerWrong:
            controller.set_wrong(is_active ? &wrong_ : nullptr);
            break;
        case FaultKind::kMessageLost:
            channel_fault.is_losing = is_active;
            break;
        case FaultKind::kMessageLate:
            if (is_active) {
                channel_fault.delay = Duration{static_cast<std::int64_t>(fault_.magnitude * 1.0e9)};
            }
            break;
        case FaultKind::kMessageDamaged:
            if (is_active) {
                channel_fault.inverted_bit = static_cast<std::uint32_t>(fault_.magnitude);
            }
            break;
        case FaultKind::kNone:
        case FaultKind::kEncoderFreeze:
        case FaultKind::kEncoderBitFlip:
        case FaultKind::kEncoderBias:
        case FaultKind::kTorqueRunaway:
        case FaultKind::kPowerLoss:
        case FaultKind::kBrakeFade:
        case FaultKind::kBrakeStuckOpen:
        case FaultKind::kBrakesStuckOpen:
        case FaultKind::kStoIgnored:
        case FaultKind::kRelayStuck:
        case FaultKind::kEmergencyStop:
        case FaultKind::kProtectiveStop:
        case FaultKind::kBrakeCreep:
        case FaultKind::kEnablingReleased:
        case FaultKind::kEnablingSqueezed:
        case FaultKind::kRunReleased:
        case FaultKind::kReducedSpeed:
        case FaultKind::kHoldToRun:
        case FaultKind::kStartStuck:
        case FaultKind::kResetStuck:
        case FaultKind::kEncoderDrift:
        case FaultKind::kClockWrong:
            break;  // faults of the plant
    }
    channel.set_fault(channel_fault);
    // Both components are in the table, so both calls succeed.
    static_cast<void>(host_.set_duration(controller, controller_time));
    static_cast<void>(host_.set_duration(supervisor, supervisor_time));
}

/// A frame of a fast clock is shorter. The timeout of the watchdog counts frames, so the watchdog is not what
/// finds the fault.
Duration Machine::calc_true_time(Instant now, Duration length) noexcept {
    if (fault_.kind != FaultKind::kClockWrong || !mamori::sim::is_active(fault_, now)) {
        return length;
    }
    owed_ = owed_ + Duration{std::llround(static_cast<double>(length.ns) / fault_.magnitude)};
    const Duration time{owed_.ns - owed_.ns % mamori::sim::kPlantSubstep.ns};
    owed_ = owed_ - time;
    return time;
}

void Machine::apply(std::uint64_t, Instant now, Duration length) noexcept {
    watchdog.check(now + length);
    plant_.set_watchdog_expired(watchdog.has_expired());
    const bool has_stopped = fault_.kind == FaultKind::kProcessorStops && mamori::sim::is_active(fault_, now);
    applied_ = has_stopped ? applied_ : outputs;
    const Duration true_time = calc_true_time(now, length);
    if (true_time > Duration{} && plant_.step(applied_, true_time) != mamori::Status::kOk) {
        is_plant_sound_ = false;
        simulation.request_stop();
    }
    FrameFacts facts{};
    facts.start = now;
    facts.end = now + length;
    facts.state = supervisor.get_state();
    facts.first_fault = supervisor.get_first_fault();
    facts.reaction = supervisor.get_reaction();
    facts.is_watchdog_expired = watchdog.has_expired();
    facts.setpoint_rad = controller.command.get_published().setpoint_rad;
    facts.torque_enable = applied_.torque_enable;
    facts.brake_release = applied_.brake_release;
    facts.is_stopping = !applied_.torque_enable || supervisor.stop.get_published().stop_requested;
    record_.add_frame(facts, plant_);
}

}  // namespace safe_arm
