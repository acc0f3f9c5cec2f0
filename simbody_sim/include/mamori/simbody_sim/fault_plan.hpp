// SPDX-License-Identifier: Apache-2.0
/// @file
/// A fault as data: what, where, when, how long, how much. It is triggered by simulated time only, so the
/// same plan gives the same run.
///
/// @satisfies SWR-SIM-011, SWR-SIM-012, SWR-SIM-015      Design: docs/design/simulation.md#fault-plan
#ifndef MAMORI_SIMBODY_SIM_FAULT_PLAN_HPP
#define MAMORI_SIMBODY_SIM_FAULT_PLAN_HPP

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "mamori/kernel/base/time.hpp"
#include "mamori/simbody_sim/plant_faults.hpp"

namespace mamori::sim {

/// From kControllerHang to kSupervisorHang and kProcessorStops on, the runner's, the others are faults of the
/// plant.
enum class FaultKind : std::uint8_t {
    kNone,
    kEncoderFreeze,
    kEncoderBitFlip,  ///< magnitude: bit, 0 .. 31
    kEncoderBias,     ///< magnitude: rad, -10 .. 10, not 0
    kTorqueRunaway,   ///< magnitude: fraction of the torque limit, -1 .. 1, not 0
    kPowerLoss,
    kBrakeFade,  ///< magnitude: fraction of the brake torque that is lost, above 0 up to 1
    kControllerHang,
    kMessageLost,
    kMessageLate,  ///< magnitude: delay in seconds, above 0 up to 10
    kSupervisorHang,
    kBrakeStuckOpen,    ///< one brake does not close
    kBrakesStuckOpen,   ///< no brake closes
    kStoIgnored,        ///< the drives ignore safe torque off
    kRelayStuck,        ///< the second switch-off path does not open
    kProcessorStops,    ///< the outputs keep their last values, and nothing services the watchdog
    kEmergencyStop,     ///< is pushed; with one channel, the contact of the other one does not open
    kProtectiveStop,    ///< is opened; with one channel, the contact of the other one does not open
    kBrakeCreep,        ///< a closed brake yields to its load; magnitude: rad/s, above 0 up to 1
    kEnablingReleased,  ///< the enabling device; with one channel, as kEmergencyStop
    kEnablingSqueezed,  ///< the enabling device, to its third position
    kRunReleased,       ///< the hold-to-run button
    kReducedSpeed,      ///< the mode selector is turned from automatic to it; latent: since power-up
    kHoldToRun,         ///< likewise
    kStartStuck,        ///< the start button stays pushed once it is pushed
    kResetStuck,        ///< the reset button stays pushed once it is pushed
    kMessageDamaged,    ///< magnitude: bit of each message that is inverted, 0 .. 65535
    kControllerWrong,   ///< magnitude: number of a wrong controller, an integer, 0 .. kWrongControllerMax
    kEncoderDrift,      ///< magnitude: rad/s, -10 .. 10, not 0
    kClockWrong,        ///< the clock of the processor; magnitude: its rate, 0.1 .. 10, not 1
};

enum class FaultChannel : std::uint8_t { kA, kB, kBoth };

/// How long a fault stays.
enum class FaultSpan : std::uint8_t {
    kOnce,        ///< for kOnceLength, one frame
    kForTime,     ///< for FaultPlan::duration
    kPersistent,  ///< until the end of the run
};

/// Length of a fault that happens once.
inline constexpr Duration kOnceLength{1000000};

inline constexpr double kWrongControllerMax = 1.0e9;

/// Fraction of its torque that a latent brake_fade takes from the brake.
inline constexpr double kLatentFade = 0.5;

/// Parts that a kind does not use keep their default.
struct FaultPlan {
    FaultKind kind{FaultKind::kNone};
    std::size_t joint{0U};  ///< 0 .. 6; 1 .. 7 in text
    FaultChannel channel{FaultChannel::kA};
    Duration at{};  ///< since time zero, >= 0
    FaultSpan span{FaultSpan::kPersistent};
    Duration duration{};  ///< > 0 with kForTime, otherwise 0
    double magnitude{0.0};
    std::uint64_t seed{0U};  ///< of the run; no kind draws from it by itself
    /// Second fault, which shows nothing until something else fails: see may_be_latent; kNone: none.
    FaultKind latent{FaultKind::kNone};
    std::size_t latent_joint{0U};
    Duration latent_at{};  ///< since time zero, >= 0; it stays
};

bool operator==(const FaultPlan& a, const FaultPlan& b) noexcept;
inline bool operator!=(const FaultPlan& a, const FaultPlan& b) noexcept {
    return !(a == b);
}

/// Spelling in text and in evidence files, for example "encoder_freeze"; "invalid" for a corrupted value.
const char* get_name(FaultKind kind) noexcept;
/// "a", "b" or "both".
const char* get_name(FaultChannel channel) noexcept;

/// All kinds as text, separated by commas, for a help text.
std::string list_fault_kinds();

/// True for the kinds that can be latent.
bool may_be_latent(FaultKind kind) noexcept;

/// The plan with its instants counted from `by` later. Without another fault, a latent one is present since
/// time zero: it is there when the machine is switched on.
FaultPlan delay(const FaultPlan& plan, Duration by) noexcept;

/// Which parts a kind uses; the parser demands them and refuses the others.
bool uses_joint(FaultKind kind) noexcept;
bool uses_channel(FaultKind kind) noexcept;
bool uses_magnitude(FaultKind kind) noexcept;

/// A plan, or the reason in one line.
struct ParsedFaultPlan {
    std::optional<FaultPlan> plan;
    std::string error;
};

/// Reads `key=value` pairs, separated by commas: kind (always), joint, channel, at [s], duration
/// (once | persistent | seconds; persistent when left out), magnitude, seed, latent (kind, or kind:joint).
/// Example: `kind=encoder_freeze,joint=2,channel=a,at=2.0,latent=brake_stuck_open:2`
ParsedFaultPlan parse_fault_plan(std::string_view text);

/// The text that parses to the same plan.
std::string to_text(const FaultPlan& plan);

/// The fault is present at `now`: at <= now < at + its length. Never for kNone. Pure.
bool is_active(const FaultPlan& plan, Instant now) noexcept;

/// Brings the fields that the plan governs to their value at `now`, faulty or sound; leaves the others alone.
/// A kind that is not of the plant changes nothing.
void apply_plant_faults(const FaultPlan& plan, Instant now, PlantFaults& faults) noexcept;

}  // namespace mamori::sim

#endif  // MAMORI_SIMBODY_SIM_FAULT_PLAN_HPP
