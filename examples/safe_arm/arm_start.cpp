// SPDX-License-Identifier: Apache-2.0
#include "arm_start.hpp"

#include "model_check.hpp"
#include "safe_arm_system.hpp"

namespace safe_arm {

using mamori::Instant;
using mamori::Status;

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

std::string start_system(const mamori::sim::ArmModel& model, const MotionTrack& track,
                         mamori::sim::ComputedTorqueController& law) {
    controller.configure(track, law, Instant{} + kMotionStart);
    if (reader.configure(get_encoder_scale(model)) != Status::kOk || watch_components() != Status::kOk ||
        executive.initialize() != Status::kOk || executive.start() != Status::kOk) {
        return "the system refuses to start: component " + std::to_string(executive.get_failed_component());
    }
    executive.set_observer(&supervision);
    return {};
}

}  // namespace safe_arm
