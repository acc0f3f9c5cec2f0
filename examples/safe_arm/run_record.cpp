// SPDX-License-Identifier: Apache-2.0
#include "run_record.hpp"

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "arm_assumptions.hpp"
#include "arm_faults.hpp"
#include "arm_limits.hpp"
#include "safe_arm_system.hpp"
#include "table_output.hpp"

namespace safe_arm {
namespace {

using Json = nlohmann::ordered_json;
using mamori::Duration;
using mamori::Instant;
using mamori::safety::CycleEvent;
using mamori::safety::kCycleEventNames;
using mamori::safety::Reaction;
using mamori::safety::SafeState;

/// Start of the check of the tracking error: the brakes have opened and the position control has settled.
constexpr Duration kTransient = 500_ms;
constexpr Duration kDenseBefore = 50_ms;
constexpr Duration kDenseAfter = 400_ms;
constexpr std::int64_t kSparseFrames = 10;

Json to_json(const std::optional<Instant>& instant) {
    return instant.has_value() ? Json(to_seconds(*instant - Instant{})) : Json(nullptr);
}

void append(std::string& text, double value) {
    std::array<char, 32> buffer{};
    const int length = std::snprintf(buffer.data(), buffer.size(), ",%.9g", value);
    text.append(buffer.data(), static_cast<std::size_t>(length));
}

std::string make_series_header() {
    std::string header = "t_s";
    for (const char* group : {"q", "qd", "qref", "tau"}) {
        for (std::size_t j = 1U; j <= kArmJointCount; ++j) {
            header += "," + std::string(group) + std::to_string(j);
        }
    }
    return header + ",state,torque_enable,brake_release\n";
}

/// Name of the argument of an event.
std::string describe_argument(const mamori::Event& event) {
    switch (static_cast<CycleEvent>(event.code)) {
        case CycleEvent::kStateEntered:
            return get_name(static_cast<SafeState>(event.argument));
        case CycleEvent::kFaultLatched:
            return get_fault_names()[static_cast<std::size_t>(event.argument)].c_str();
        case CycleEvent::kReactionBegun:
            return get_name(static_cast<Reaction>(event.argument));
        case CycleEvent::kAssumptionFailed:
            return safety_state.get_table().assumptions[static_cast<std::size_t>(event.argument)].name;
        case CycleEvent::kComponentExpired:
            return mamori::safety::kExpiryCauseNames.at(static_cast<std::size_t>(event.argument));
        case CycleEvent::kWatchdogRefused:
        case CycleEvent::kSelfTestFailed:
            break;
    }
    return std::to_string(event.argument);
}

/// Name of the source of an event.
const char* get_source(const mamori::Event& event) {
    return event.source == 0U ? "supervisor" : executive.get_view().components[event.source - 1U]->get_name();
}

std::string make_events_text(const mamori::EventLog& events) {
    std::string text = "sequence,time_s,severity,source,event,argument\n";
    constexpr std::array<const char*, 3U> kSeverities{"info", "warning", "fault"};
    for (std::size_t i = 0U; i < events.size(); ++i) {
        const mamori::Event& event = events.get(i);
        text += std::to_string(event.sequence);
        append(text, to_seconds(event.time - Instant{}));
        text += std::string(",") + kSeverities[static_cast<std::size_t>(event.severity)] + "," +
                get_source(event) + "," + kCycleEventNames.at(event.code) + "," + describe_argument(event) +
                "\n";
    }
    return text;
}

/// First detector: the fault register of the supervisor, the drive gate without a fresh permission, or the
/// watchdog.
const char* find_detector(const FrameFacts& facts, bool has_begun_stop) {
    if (facts.first_fault != mamori::safety::kNoFault) {
        return get_fault_names()[facts.first_fault].c_str();
    }
    if (facts.is_watchdog_expired) {
        return "WatchdogExpired";
    }
    return has_begun_stop ? "SupervisorSilent" : nullptr;
}

const char* get_environment(const char* name, const char* fallback) {
    const char* value = std::getenv(name);  // NOLINT(concurrency-mt-unsafe): the program has one thread
    return value == nullptr ? fallback : value;
}

}  // namespace

bool replace_file(const std::filesystem::path& path, const std::string& text) {
    const std::filesystem::path partial{path.string() + ".partial"};
    std::ofstream file{partial, std::ios::binary};
    file << text;
    file.close();
    std::error_code error;
    if (!file.fail()) {
        std::filesystem::rename(partial, path, error);
        return !error;
    }
    std::filesystem::remove(partial, error);
    return false;
}

RunRecord::RunRecord(const RunOptions& options, const mamori::sim::ArmModel& model,
                     const mamori::sim::FaultPlan& fault, Instant motion_start, Instant motion_end)
    : options_(options),
      model_(model),
      fault_(fault),
      motion_start_(motion_start),
      motion_end_(motion_end),
      verdict_(model),
      series_(make_series_header()) {}

void RunRecord::add_frame(const FrameFacts& facts, const mamori::sim::ArmPlant& plant) {
    note_instants(facts, plant);
    add_series_line(facts, plant);
    last_ = facts;
}

void RunRecord::note_instants(const FrameFacts& facts, const mamori::sim::ArmPlant& plant) {
    if (!operational_at_.has_value() && facts.state == SafeState::kOperational) {
        operational_at_ = facts.start;
    }
    // The major frame that begins at the injection already runs with the fault, so the travel counts from its
    // start.
    if (has_fault() && !is_injected_ && facts.end >= Instant{} + fault_.at) {
        is_injected_ = true;
        verdict_.mark_injection(plant.positions());
    }
    const bool is_stop = facts.is_stopping || facts.is_watchdog_expired;
    const bool has_begun_stop = operational_at_.has_value() && !reacted_at_.has_value() && is_stop;
    if (!detected_at_.has_value()) {
        detector_ = find_detector(facts, has_begun_stop);
        if (detector_ != nullptr) {
            detected_at_ = facts.start;
        }
    }
    if (has_begun_stop) {
        reacted_at_ = facts.end;
        verdict_.mark_stop();
    }
    // The tracking is also checked with a tolerated fault, since only the tracking can become worse then.
    const bool is_judged = operational_at_.has_value() && facts.start >= *operational_at_ + kTransient &&
                           !reacted_at_.has_value();
    if (is_judged) {
        verdict_.judge_tracking(plant.positions(), facts.setpoint_rad);
    }
}

void RunRecord::add_series_line(const FrameFacts& facts, const mamori::sim::ArmPlant& plant) {
    const Duration since_fault = facts.start - (Instant{} + fault_.at);
    const bool is_dense =
        has_fault() && since_fault >= Duration{-kDenseBefore.ns} && since_fault <= kDenseAfter;
    const bool is_on_grid = (facts.start.ns / 1000000) % kSparseFrames == 0;
    if (!is_dense && !is_on_grid) {
        return;
    }
    std::array<char, 32> time{};
    const int length = std::snprintf(time.data(), time.size(), "%.6f", to_seconds(facts.end - Instant{}));
    series_.append(time.data(), static_cast<std::size_t>(length));
    for (const JointVector* group :
         {&plant.positions(), &plant.velocities(), &facts.setpoint_rad, &plant.torques()}) {
        for (const double value : *group) {
            append(series_, value);
        }
    }
    series_ += std::string(",") + get_name(facts.state) + (facts.torque_enable ? ",1" : ",0") +
               (facts.brake_release ? ",1\n" : ",0\n");
}

std::string RunRecord::make_summary(const Closing& closing) const {
    Json speed_limit = Json::array();
    for (const mamori::sim::JointModel& joint : model_.joints) {
        speed_limit.push_back(joint.speed_limit_rad_s);
    }
    Json fault = nullptr;
    if (has_fault()) {
        const bool is_for_time = fault_.span == mamori::sim::FaultSpan::kForTime;
        const bool is_once = fault_.span == mamori::sim::FaultSpan::kOnce;
        const double at_s = to_seconds(fault_.at);
        fault = {{"kind", get_name(fault_.kind)},
                 {"text", options_.fault_text},
                 {"at_s", at_s},
                 {"motion_at_s", at_s - to_seconds(motion_start_ - Instant{})}};
        fault["joint"] = uses_joint(fault_.kind) ? Json(fault_.joint + 1U) : Json(nullptr);
        fault["channel"] = uses_channel(fault_.kind) ? Json(get_name(fault_.channel)) : Json(nullptr);
        fault["duration_s"] = is_for_time
                                  ? Json(to_seconds(fault_.duration))
                                  : (is_once ? Json(to_seconds(mamori::sim::kOnceLength)) : Json(nullptr));
        fault["magnitude"] = uses_magnitude(fault_.kind) ? Json(fault_.magnitude) : Json(nullptr);
    }
    Json latent = nullptr;
    if (fault_.latent != mamori::sim::FaultKind::kNone) {
        latent = get_name(fault_.latent);
        if (uses_joint(fault_.latent)) {
            latent = latent.get<std::string>() + ":" + std::to_string(fault_.latent_joint + 1U);
        }
    }
    std::array<char, 17> hash{};
    std::snprintf(hash.data(), hash.size(), "%016llx", static_cast<unsigned long long>(closing.trace_hash));
    const bool is_safe_by_relay = last_.is_watchdog_expired;
    const Json detected = detector_ == nullptr ? Json(nullptr) : Json(detector_);
    Json reaction = nullptr;
    if (reacted_at_.has_value()) {
        // Without a reaction of the supervisor, the gate or the relay reacted. Both switch torque off.
        const bool is_by_supervisor = last_.reaction != Reaction::kNone;
        reaction = get_name(is_by_supervisor ? last_.reaction : Reaction::kSto);
    }
    const Json summary = {
        {"schema", "mamori.run/1"},
        {"commit", get_environment("MAMORI_COMMIT", "unknown")},
        {"compiler", SAFE_ARM_COMPILER},
        {"seed", options_.seed},
        {"frames", closing.frames},
        {"period_s", to_seconds(kFrame)},
        {"motion", options_.motion},
        {"model", options_.model},
        {"fault", fault},
        {"latent", latent},
        {"trace_hash", hash.data()},
        {"simulated_s", static_cast<double>(closing.frames) * to_seconds(kFrame)},
        {"wall_s", closing.wall_s},
        {"motion_start_s", to_seconds(motion_start_ - Instant{})},
        {"motion_end_s", to_seconds(motion_end_ - Instant{})},
        {"initial_state", get_name(SafeState::kSelfTest)},
        {"final_state", is_safe_by_relay ? get_name(SafeState::kSafe) : get_name(last_.state)},
        {"operational_at_s", to_json(operational_at_)},
        {"detected_fault", detected},
        {"detected_at_s", to_json(detected_at_)},
        {"reaction", reaction},
        {"reacted_at_s", to_json(reacted_at_)},
        {"standstill_at_s", to_json(verdict_.get_standstill())},
        {"watchdog_bitten", last_.is_watchdog_expired},
        {"physics",
         {{"max_speed_rad_s", verdict_.get_max_speed_rad_s()},
          {"speed_limit_rad_s", speed_limit},
          {"min_position_margin_rad", verdict_.get_min_position_margin_rad()},
          {"stop_travel_rad", verdict_.get_stop_travel_rad()},
          {"hold_drift_rad", verdict_.get_hold_drift_rad()},
          {"max_tracking_error_rad", verdict_.get_max_tracking_error_rad()}}}};
    return summary.dump(2) + "\n";
}

std::string claim_folder(const std::string& folder) {
    namespace fs = std::filesystem;
    std::error_code error;
    fs::create_directories(folder, error);
    // run.json is removed first and written last, so that its presence indicates a complete record of one
    // run.
    const bool is_clear = !error && (fs::remove(fs::path{folder} / "run.json", error) || !error);
    const fs::path series = fs::path{folder} / "series.csv";
    if (is_clear && replace_file(series, {}) && fs::remove(series, error)) {
        return {};
    }
    const std::string reason = error ? error.message() : "no file can be created in it";
    return folder + ": the record cannot be written (" + reason + "): specify a writable folder";
}

std::string RunRecord::write(const mamori::EventLog& events, const Closing& closing) const {
    const std::filesystem::path folder{options_.out};
    if (replace_file(folder / "series.csv", series_) &&
        replace_file(folder / "events.csv", make_events_text(events)) &&
        replace_file(folder / "run.json", make_summary(closing))) {
        return {};
    }
    return options_.out + ": the record cannot be written: check the free space and the folder";
}

}  // namespace safe_arm
