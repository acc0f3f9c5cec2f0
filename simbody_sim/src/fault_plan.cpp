// SPDX-License-Identifier: Apache-2.0
#include "mamori/simbody_sim/fault_plan.hpp"

#include "mamori/kernel/base/assert.hpp"

namespace mamori::sim {

bool operator==(const FaultPlan& a, const FaultPlan& b) noexcept {
    return a.kind == b.kind && a.joint == b.joint && a.channel == b.channel && a.at == b.at &&
           a.span == b.span && a.duration == b.duration && a.magnitude == b.magnitude && a.seed == b.seed &&
           a.latent == b.latent && a.latent_joint == b.latent_joint && a.latent_at == b.latent_at;
}

const char* get_name(FaultKind kind) noexcept {
    switch (kind) {
        case FaultKind::kNone:
            return "none";
        case FaultKind::kEncoderFreeze:
            return "encoder_freeze";
        case FaultKind::kEncoderBitFlip:
            return "encoder_bit_flip";
        case FaultKind::kEncoderBias:
            return "encoder_bias";
        case FaultKind::kTorqueRunaway:
            return "torque_runaway";
        case FaultKind::kPowerLoss:
            return "power_loss";
        case FaultKind::kBrakeFade:
            return "brake_fade";
        case FaultKind::kControllerHang:
            return "controller_hang";
        case FaultKind::kMessageLost:
            return "message_lost";
        case FaultKind::kMessageLate:
            return "message_late";
        case FaultKind::kSupervisorHang:
            return "supervisor_hang";
        case FaultKind::kBrakeStuckOpen:
            return "brake_stuck_open";
        case FaultKind::kBrakesStuckOpen:
            return "brakes_stuck_open";
        case FaultKind::kStoIgnored:
            return "sto_ignored";
        case FaultKind::kRelayStuck:
            return "relay_stuck";
        case FaultKind::kProcessorStops:
            return "processor_stops";
        case FaultKind::kEmergencyStop:
            return "emergency_stop";
        case FaultKind::kProtectiveStop:
            return "protective_stop";
        case FaultKind::kBrakeCreep:
            return "brake_creep";
        case FaultKind::kEnablingReleased:
            return "enabling_released";
        case FaultKind::kEnablingSqueezed:
            return "enabling_squeezed";
        case FaultKind::kRunReleased:
            return "run_released";
        case FaultKind::kReducedSpeed:
            return "reduced_speed";
        case FaultKind::kHoldToRun:
            return "hold_to_run";
        case FaultKind::kStartStuck:
            return "start_stuck";
        case FaultKind::kResetStuck:
            return "reset_stuck";
        case FaultKind::kMessageDamaged:
            return "message_damaged";
        case FaultKind::kControllerWrong:
            return "controller_wrong";
        case FaultKind::kEncoderDrift:
            return "encoder_drift";
        case FaultKind::kClockWrong:
            return "clock_wrong";
    }
    return "invalid";
}

const char* get_name(FaultChannel channel) noexcept {
    switch (channel) {
        case FaultChannel::kA:
            return "a";
        case FaultChannel::kB:
            return "b";
        case FaultChannel::kBoth:
            return "both";
    }
    return "invalid";
}

namespace {

bool is_of_encoder(FaultKind kind) noexcept {
    return kind == FaultKind::kEncoderFreeze || kind == FaultKind::kEncoderBitFlip ||
           kind == FaultKind::kEncoderBias || kind == FaultKind::kEncoderDrift;
}

bool is_stop(FaultKind kind) noexcept {
    return kind == FaultKind::kEmergencyStop || kind == FaultKind::kProtectiveStop ||
           kind == FaultKind::kEnablingReleased;
}

bool is_mode(FaultKind kind) noexcept {
    return kind == FaultKind::kReducedSpeed || kind == FaultKind::kHoldToRun;
}

}  // namespace

bool may_be_latent(FaultKind kind) noexcept {
    return kind == FaultKind::kBrakeStuckOpen || kind == FaultKind::kBrakesStuckOpen ||
           kind == FaultKind::kStoIgnored || kind == FaultKind::kRelayStuck ||
           kind == FaultKind::kBrakeFade || kind == FaultKind::kStartStuck ||
           kind == FaultKind::kResetStuck || is_mode(kind);
}

FaultPlan delay(const FaultPlan& plan, Duration by) noexcept {
    FaultPlan later = plan;
    later.at = plan.at + by;
    later.latent_at = plan.kind == FaultKind::kNone ? Duration{} : by;
    return later;
}

bool uses_channel(FaultKind kind) noexcept {
    return is_of_encoder(kind) || is_stop(kind);
}

bool uses_joint(FaultKind kind) noexcept {
    return is_of_encoder(kind) || kind == FaultKind::kTorqueRunaway || kind == FaultKind::kBrakeFade ||
           kind == FaultKind::kBrakeStuckOpen || kind == FaultKind::kBrakeCreep;
}

bool uses_magnitude(FaultKind kind) noexcept {
    return kind == FaultKind::kEncoderBitFlip || kind == FaultKind::kEncoderBias ||
           kind == FaultKind::kTorqueRunaway || kind == FaultKind::kBrakeFade ||
           kind == FaultKind::kBrakeCreep || kind == FaultKind::kMessageLate ||
           kind == FaultKind::kMessageDamaged || kind == FaultKind::kControllerWrong ||
           kind == FaultKind::kEncoderDrift || kind == FaultKind::kClockWrong;
}

bool is_active(const FaultPlan& plan, Instant now) noexcept {
    const Instant begin = Instant{} + plan.at;
    if (plan.kind == FaultKind::kNone || now < begin) {
        return false;
    }
    switch (plan.span) {
        case FaultSpan::kOnce:
            return now - begin < kOnceLength;
        case FaultSpan::kForTime:
            return now - begin < plan.duration;
        case FaultSpan::kPersistent:
            return true;
    }
    return false;
}

namespace {

void apply_to_encoder(const FaultPlan& plan, Instant now, bool active, EncoderFault& encoder) noexcept {
    if (plan.kind == FaultKind::kEncoderFreeze) {
        encoder.frozen = active;
    } else if (plan.kind == FaultKind::kEncoderBias) {
        encoder.bias_rad = active ? plan.magnitude : 0.0;
    } else if (plan.kind == FaultKind::kEncoderDrift) {
        encoder.bias_rad = active ? plan.magnitude * to_seconds(now - (Instant{} + plan.at)) : 0.0;
    } else if (active) {
        encoder.flipped_bit = static_cast<unsigned>(plan.magnitude);
    } else {
        encoder.flipped_bit.reset();
    }
}

void apply_to_switches(FaultKind kind, std::size_t joint, bool active, PlantFaults& faults) noexcept {
    if (kind == FaultKind::kBrakeStuckOpen) {
        faults.brake_stuck_open[joint] = active;
    } else if (kind == FaultKind::kBrakesStuckOpen) {
        faults.brake_stuck_open.fill(active);
    } else if (kind == FaultKind::kStoIgnored) {
        faults.sto_ignored = active;
    } else if (kind == FaultKind::kRelayStuck) {
        faults.relay_stuck = active;
    } else if (is_mode(kind)) {
        faults.mode = active ? (kind == FaultKind::kReducedSpeed ? 1U : 2U) : 0U;
    } else if (kind == FaultKind::kEnablingSqueezed) {
        faults.enabling_squeezed = active;
    } else if (kind == FaultKind::kRunReleased) {
        faults.run_released = active;
    } else if (kind == FaultKind::kStartStuck) {
        faults.start_stuck = active;
    } else if (kind == FaultKind::kResetStuck) {
        faults.reset_stuck = active;
    }
}

}  // namespace

void apply_plant_faults(const FaultPlan& plan, Instant now, PlantFaults& faults) noexcept {
    MAMORI_REQUIRE(1, plan.joint < safety::kArmJointCount && plan.latent_joint < safety::kArmJointCount);
    const bool active = is_active(plan, now);
    if (is_of_encoder(plan.kind)) {
        if (plan.channel != FaultChannel::kB) {
            apply_to_encoder(plan, now, active, faults.encoder_a[plan.joint]);
        }
        if (plan.channel != FaultChannel::kA) {
            apply_to_encoder(plan, now, active, faults.encoder_b[plan.joint]);
        }
    } else if (is_stop(plan.kind)) {
        auto& open = plan.kind == FaultKind::kEmergencyStop
                         ? faults.emergency_stop_open
                         : (plan.kind == FaultKind::kProtectiveStop ? faults.protective_stop_open
                                                                    : faults.enabling_open);
        open = {active && plan.channel != FaultChannel::kB, active && plan.channel != FaultChannel::kA};
    } else if (plan.kind == FaultKind::kTorqueRunaway) {
        faults.torque_runaway[plan.joint] = active ? std::optional<double>(plan.magnitude) : std::nullopt;
    } else if (plan.kind == FaultKind::kBrakeFade) {
        faults.brake_fade[plan.joint] = active ? plan.magnitude : 0.0;
    } else if (plan.kind == FaultKind::kBrakeCreep) {
        faults.brake_creep_rad_s[plan.joint] = active ? plan.magnitude : 0.0;
    } else if (plan.kind == FaultKind::kPowerLoss) {
        faults.power_lost = active;
    } else {
        apply_to_switches(plan.kind, plan.joint, active, faults);
    }
    const bool is_latent_active = now >= Instant{} + plan.latent_at || is_mode(plan.latent);
    if (plan.latent == FaultKind::kBrakeFade && is_latent_active) {
        faults.brake_fade[plan.latent_joint] = kLatentFade;
    }
    apply_to_switches(plan.latent, plan.latent_joint, is_latent_active, faults);
}

}  // namespace mamori::sim
