// SPDX-License-Identifier: Apache-2.0
#include "arm_start.hpp"

#include "model_check.hpp"
#include "safe_arm_system.hpp"

namespace safe_arm {

using mamori::Instant;
using mamori::Status;

namespace {

/// Seconds with microsecond resolution, without trailing zeros.
std::string show_seconds(double seconds) {
    std::string text = std::to_string(seconds);
    text.erase(text.find_last_not_of('0') + 1U);
    return (text.back() == '.' ? text + "0" : text) + " s";
}

}  // namespace

std::string load_inputs(const std::string& model_path, const std::string& motion_path,
                        mamori::sim::LoadedModel& loaded, MotionTrack& track) {
    loaded = mamori::sim::load_arm_model(model_path);
    if (!loaded.model.has_value()) {
        return loaded.error;
    }
    const std::string refusal = check_model(*loaded.model);
    if (!refusal.empty()) {
        return model_path + ": " + refusal;
    }
    std::string error;
    if (!motion_path.empty() && !track.read(motion_path, kFrameS, error)) {
        return error;
    }
    return {};
}

std::string check_fault_instant(const mamori::sim::FaultPlan& fault, const MotionTrack& track) {
    const double end_s = track.get_duration_s();
    if (fault.kind == mamori::sim::FaultKind::kNone || static_cast<double>(fault.at.ns) < end_s * 1.0e9) {
        return {};
    }
    return "at=" + show_seconds(static_cast<double>(fault.at.ns) / 1.0e9) +
           " is not before the end of the motion at " + show_seconds(end_s) + "; choose an earlier instant";
}

std::string describe_failed_start() {
    return "the system refuses to start: component " + std::to_string(executive.get_failed_component());
}

std::string prepare_system(const mamori::sim::ArmModel& model, const MotionTrack& track,
                           mamori::sim::ComputedTorqueController& law) {
    controller.configure(track, law, Instant{} + kMotionStart);
    if (reader.configure(get_encoder_scale(model)) != Status::kOk) {
        return "the system was prepared before";
    }
    reader.set_modes(modes);
    executive.set_observer(&safety_state.get_observer());
    return {};
}

std::string start_system(const mamori::sim::ArmModel& model, const MotionTrack& track,
                         mamori::sim::ComputedTorqueController& law) {
    std::string obstacle = prepare_system(model, track, law);
    if (obstacle.empty() && (executive.initialize() != Status::kOk || executive.start() != Status::kOk)) {
        obstacle = describe_failed_start();
    }
    return obstacle;
}

}  // namespace safe_arm
