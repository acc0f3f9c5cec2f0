// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <stdexcept>
#include <system_error>
#include <vector>

#include "mamori/simbody_sim/fault_plan.hpp"
#include "mamori/simbody_sim/nearest_name.hpp"
#include "number_text.hpp"

namespace mamori::sim {
namespace {

using Pairs = std::map<std::string, std::string, std::less<>>;

/// Stays inside this file; its text is the error that the user reads.
class PlanError final : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

constexpr std::array<FaultKind, 30U> kKinds{FaultKind::kNone,
                                            FaultKind::kEncoderFreeze,
                                            FaultKind::kEncoderBitFlip,
                                            FaultKind::kEncoderBias,
                                            FaultKind::kTorqueRunaway,
                                            FaultKind::kPowerLoss,
                                            FaultKind::kBrakeFade,
                                            FaultKind::kControllerHang,
                                            FaultKind::kMessageLost,
                                            FaultKind::kMessageLate,
                                            FaultKind::kSupervisorHang,
                                            FaultKind::kBrakeStuckOpen,
                                            FaultKind::kBrakesStuckOpen,
                                            FaultKind::kStoIgnored,
                                            FaultKind::kRelayStuck,
                                            FaultKind::kProcessorStops,
                                            FaultKind::kEmergencyStop,
                                            FaultKind::kProtectiveStop,
                                            FaultKind::kBrakeCreep,
                                            FaultKind::kEnablingReleased,
                                            FaultKind::kEnablingSqueezed,
                                            FaultKind::kRunReleased,
                                            FaultKind::kReducedSpeed,
                                            FaultKind::kHoldToRun,
                                            FaultKind::kStartStuck,
                                            FaultKind::kResetStuck,
                                            FaultKind::kMessageDamaged,
                                            FaultKind::kControllerWrong,
                                            FaultKind::kEncoderDrift,
                                            FaultKind::kClockWrong};
constexpr std::array<FaultChannel, 3U> kChannels{FaultChannel::kA, FaultChannel::kB, FaultChannel::kBoth};

/// Times in a plan end here, so that they stay far from the range of Instant.
constexpr double kLatestSeconds = 1.0e6;

std::string join(const std::vector<std::string_view>& names) {
    std::string text;
    for (const std::string_view name : names) {
        text += (text.empty() ? "" : ", ") + std::string(name);
    }
    return text;
}

Pairs split(std::string_view text) {
    const std::vector<std::string_view> keys{"kind",     "joint",     "channel", "at",
                                             "duration", "magnitude", "seed",    "latent"};
    Pairs pairs;
    while (true) {
        const std::size_t comma = text.find(',');
        const std::string_view pair = text.substr(0U, comma);
        const std::size_t equal = pair.find('=');
        if (equal == std::string_view::npos || equal == 0U || equal + 1U == pair.size()) {
            throw PlanError("'" + std::string(pair) + "' is not key=value");
        }
        const std::string key(pair.substr(0U, equal));
        if (std::find(keys.begin(), keys.end(), key) == keys.end()) {
            throw PlanError("unknown key '" + key + "'; did you mean '" +
                            std::string(find_nearest_name(key, keys)) + "'? valid: " + join(keys));
        }
        if (!pairs.emplace(key, pair.substr(equal + 1U)).second) {
            throw PlanError(key + " is given twice");
        }
        if (comma == std::string_view::npos) {
            return pairs;
        }
        text.remove_prefix(comma + 1U);
    }
}

/// The element of `all` that is spelt like `word`.
template <typename Enum, std::size_t N>
Enum find_by_name(const char* key, const std::string& word, const std::array<Enum, N>& all) {
    std::vector<std::string_view> names;
    for (const Enum element : all) {
        if (word == get_name(element)) {
            return element;
        }
        names.emplace_back(get_name(element));
    }
    throw PlanError("unknown " + std::string(key) + " '" + word + "'; did you mean '" +
                    std::string(find_nearest_name(word, names)) + "'? valid: " + join(names));
}

/// Value of `key`, which must be there exactly when the kind uses it; empty otherwise.
std::string take(const Pairs& pairs, const char* key, FaultKind kind, bool used) {
    const auto found = pairs.find(key);
    if (used && found == pairs.end()) {
        throw PlanError(std::string("kind ") + get_name(kind) + " needs " + key + "=");
    }
    if (!used && found != pairs.end()) {
        throw PlanError(std::string("kind ") + get_name(kind) + " takes no " + key);
    }
    return used ? found->second : std::string();
}

double to_number(const char* key, const std::string& text) {
    double number = 0.0;
    if (!detail::try_parse_number(text, number)) {
        throw PlanError(std::string(key) + " must be a finite number, is '" + text + "'");
    }
    return number;
}

std::uint64_t to_whole_number(const char* key, const std::string& text) {
    std::uint64_t number = 0U;
    const char* const end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data(), end, number);
    if (error != std::errc{} || rest != end) {
        throw PlanError(std::string(key) + " must be a whole number from 0, is '" + text + "'");
    }
    return number;
}

std::size_t to_joint(const std::string& text) {
    const std::uint64_t number = to_whole_number("joint", text);
    if (number < 1U || number > safety::kArmJointCount) {
        throw PlanError("joint must be 1 to 7, is " + text);
    }
    return static_cast<std::size_t>(number - 1U);
}

Duration to_time(const char* key, const std::string& text, bool zero_allowed) {
    const double seconds = to_number(key, text);
    const Duration time{std::abs(seconds) <= kLatestSeconds ? std::llround(seconds * 1.0e9) : -1};
    if (time < Duration{} || (time == Duration{} && !zero_allowed)) {
        throw PlanError(std::string(key) + " must be " + (zero_allowed ? "at least" : "more than") +
                        " 0 s and at most 1000000 s, is " + text);
    }
    return time;
}

double to_magnitude(FaultKind kind, const std::string& text) {
    const double value = to_number("magnitude", text);
    const auto demand = [kind, &text](bool met, const char* wanted) {
        if (!met) {
            throw PlanError(std::string("magnitude of ") + get_name(kind) + " must be " + wanted + ", is " +
                            text);
        }
    };
    switch (kind) {
        case FaultKind::kEncoderBitFlip:
            demand(value == std::floor(value) && value >= 0.0 && value <= 31.0, "a bit from 0 to 31");
            break;
        case FaultKind::kEncoderBias:
            demand(value != 0.0 && std::abs(value) <= 10.0, "an angle from -10 to 10 rad, not 0");
            break;
        case FaultKind::kEncoderDrift:
            demand(value != 0.0 && std::abs(value) <= 10.0, "a speed from -10 to 10 rad/s, not 0");
            break;
        case FaultKind::kClockWrong:
            demand(value != 1.0 && value >= 0.1 && value <= 10.0, "a rate from 0.1 to 10, not 1");
            break;
        case FaultKind::kTorqueRunaway:
            demand(value != 0.0 && std::abs(value) <= 1.0,
                   "a fraction of the torque limit from -1 to 1, not 0");
            break;
        case FaultKind::kBrakeFade:
            demand(value > 0.0 && value <= 1.0,
                   "the lost fraction of the brake torque, above 0 and at most 1");
            break;
        case FaultKind::kBrakeCreep:
            demand(value > 0.0 && value <= 1.0, "a speed above 0 and at most 1 rad/s");
            break;
        case FaultKind::kMessageLate:
            demand(value > 0.0 && value <= 10.0, "a delay above 0 s and at most 10 s");
            break;
        case FaultKind::kMessageDamaged:
            demand(value == std::floor(value) && value >= 0.0 && value <= 65535.0, "a bit from 0 to 65535");
            break;
        case FaultKind::kControllerWrong:
            demand(value == std::floor(value) && value >= 0.0 && value <= kWrongControllerMax,
                   "an integer from 0 to 1e9");
            break;
        case FaultKind::kNone:
        case FaultKind::kEncoderFreeze:
        case FaultKind::kPowerLoss:
        case FaultKind::kControllerHang:
        case FaultKind::kMessageLost:
        case FaultKind::kSupervisorHang:
        case FaultKind::kBrakeStuckOpen:
        case FaultKind::kBrakesStuckOpen:
        case FaultKind::kStoIgnored:
        case FaultKind::kRelayStuck:
        case FaultKind::kProcessorStops:
        case FaultKind::kEmergencyStop:
        case FaultKind::kProtectiveStop:
        case FaultKind::kEnablingReleased:
        case FaultKind::kEnablingSqueezed:
        case FaultKind::kRunReleased:
        case FaultKind::kReducedSpeed:
        case FaultKind::kHoldToRun:
        case FaultKind::kStartStuck:
        case FaultKind::kResetStuck:
            break;
    }
    return value;
}

void read_span(const Pairs& pairs, FaultPlan& plan) {
    const auto found = pairs.find("duration");
    if (found == pairs.end() || found->second == "persistent") {
        plan.span = FaultSpan::kPersistent;
    } else if (found->second == "once") {
        plan.span = FaultSpan::kOnce;
    } else {
        double ignored = 0.0;
        if (!detail::try_parse_number(found->second, ignored)) {
            throw PlanError("duration must be once, persistent or seconds, is '" + found->second + "'");
        }
        plan.span = FaultSpan::kForTime;
        plan.duration = to_time("duration", found->second, false);
    }
}

/// `kind` or `kind:joint`.
void read_latent(const std::string& text, FaultPlan& plan) {
    const std::size_t colon = text.find(':');
    plan.latent = find_by_name("latent fault", text.substr(0U, colon), kKinds);
    if (!may_be_latent(plan.latent)) {
        throw PlanError(std::string(get_name(plan.latent)) +
                        " is not a latent fault; valid: brake_stuck_open, brakes_stuck_open, brake_fade, "
                        "sto_ignored, relay_stuck, start_stuck, reset_stuck, reduced_speed, hold_to_run");
    }
    if (uses_joint(plan.latent) != (colon != std::string::npos)) {
        throw PlanError(std::string("latent=") + get_name(plan.latent) +
                        (uses_joint(plan.latent) ? " needs a joint, for example latent=brake_stuck_open:2"
                                                 : " takes no joint"));
    }
    plan.latent_joint = colon == std::string::npos ? 0U : to_joint(text.substr(colon + 1U));
}

FaultPlan read_plan(std::string_view text) {
    const Pairs pairs = split(text);
    const auto kind = pairs.find("kind");
    if (kind == pairs.end()) {
        throw PlanError("kind= is missing");
    }
    FaultPlan plan;
    plan.kind = find_by_name("kind", kind->second, kKinds);
    const bool is_fault = plan.kind != FaultKind::kNone;
    const std::string joint = take(pairs, "joint", plan.kind, uses_joint(plan.kind));
    const std::string channel = take(pairs, "channel", plan.kind, uses_channel(plan.kind));
    const std::string at = take(pairs, "at", plan.kind, is_fault);
    const std::string magnitude = take(pairs, "magnitude", plan.kind, uses_magnitude(plan.kind));
    plan.joint = joint.empty() ? 0U : to_joint(joint);
    plan.channel = channel.empty() ? FaultChannel::kA : find_by_name("channel", channel, kChannels);
    plan.at = at.empty() ? Duration{} : to_time("at", at, true);
    plan.magnitude = magnitude.empty() ? 0.0 : to_magnitude(plan.kind, magnitude);
    if (!is_fault && pairs.count("duration") != 0U) {
        throw PlanError("kind none takes no duration");
    }
    read_span(pairs, plan);
    const auto latent = pairs.find("latent");
    if (latent != pairs.end()) {
        read_latent(latent->second, plan);
    }
    const auto seed = pairs.find("seed");
    plan.seed = seed == pairs.end() ? 0U : to_whole_number("seed", seed->second);
    return plan;
}

/// Whole nanoseconds as decimal seconds, without rounding.
std::string to_seconds_text(Duration time) {
    constexpr std::int64_t kNsPerSecond = 1000000000;
    std::string fraction = std::to_string(kNsPerSecond + time.ns % kNsPerSecond).substr(1U);
    fraction.erase(fraction.find_last_not_of('0') + 1U);
    return std::to_string(time.ns / kNsPerSecond) + (fraction.empty() ? "" : "." + fraction);
}

}  // namespace

std::string list_fault_kinds() {
    std::vector<std::string_view> names;
    for (const FaultKind kind : kKinds) {
        names.emplace_back(get_name(kind));
    }
    return join(names);
}

ParsedFaultPlan parse_fault_plan(std::string_view text) {
    try {
        return {read_plan(text), {}};
    } catch (const PlanError& error) {
        return {std::nullopt, "fault plan '" + std::string(text) + "': " + error.what()};
    }
}

std::string to_text(const FaultPlan& plan) {
    std::string text = std::string("kind=") + get_name(plan.kind);
    if (uses_joint(plan.kind)) {
        text += ",joint=" + std::to_string(plan.joint + 1U);
    }
    if (uses_channel(plan.kind)) {
        text += std::string(",channel=") + get_name(plan.channel);
    }
    if (plan.kind != FaultKind::kNone) {
        text += ",at=" + to_seconds_text(plan.at);
    }
    if (plan.span == FaultSpan::kOnce) {
        text += ",duration=once";
    } else if (plan.span == FaultSpan::kForTime) {
        text += ",duration=" + to_seconds_text(plan.duration);
    }
    if (uses_magnitude(plan.kind)) {
        text += ",magnitude=" + detail::to_text(plan.magnitude);
    }
    if (plan.latent != FaultKind::kNone) {
        text += std::string(",latent=") + get_name(plan.latent);
        text += uses_joint(plan.latent) ? ":" + std::to_string(plan.latent_joint + 1U) : std::string{};
    }
    return plan.seed == 0U ? text : text + ",seed=" + std::to_string(plan.seed);
}

}  // namespace mamori::sim
