// SPDX-License-Identifier: Apache-2.0
// One process runs one scenario: every component starts from the constants of the program.
#include <chrono>
#include <cmath>
#include <iostream>

#include "arm_start.hpp"
#include "cost_command.hpp"
#include "machine.hpp"
#include "mamori/simbody_sim/computed_torque_controller.hpp"
#include "run_recorder.hpp"
#include "safe_arm_system.hpp"
#include "table_output.hpp"
#include "timing_command.hpp"

namespace {

using mamori::Duration;
using mamori::Instant;
using namespace mamori::literals;  // NOLINT: units of the constants below

constexpr int kExitOk = 0;
constexpr int kExitFailed = 1;
constexpr int kExitUsage = 2;
/// Time after the path: long enough for a stop late in the motion and for the drift after it.
constexpr Duration kSettling = 2000_ms;

int fail(int exit_code, const std::string& message) {
    std::cerr << "safe_arm: " << message << '\n';
    return exit_code;
}

int run_scenario(const safe_arm::RunOptions& options) {
    mamori::sim::LoadedModel loaded;
    safe_arm::MotionTrack track;
    const std::string refusal = safe_arm::load_inputs(options.model, options.motion, loaded, track);
    if (!refusal.empty()) {
        return fail(kExitUsage, refusal);
    }
    const std::string misplaced = safe_arm::check_fault_instant(options.fault, track);
    if (!misplaced.empty()) {
        return fail(kExitUsage, "--fault: " + misplaced);
    }
    const std::string unwritable = safe_arm::claim_folder(options.out);
    if (!unwritable.empty()) {
        return fail(kExitUsage, unwritable);
    }
    safe_arm::RunRecorder recorder;
    if (!options.recorder.empty()) {
        const std::string unrecordable = recorder.begin(options.recorder, safe_arm::event_log);
        if (!unrecordable.empty()) {
            return fail(kExitUsage, unrecordable);
        }
    }
    const auto motion_ns = static_cast<std::int64_t>(std::llround(track.get_duration_s() * 1.0e9));
    const Instant motion_end = Instant{} + safe_arm::kMotionStart + Duration{motion_ns};
    const mamori::sim::FaultPlan fault = mamori::sim::delay(options.fault, safe_arm::kMotionStart);

    mamori::sim::ArmPlant plant{*loaded.model};
    plant.reset(track.calc_point(0.0).position_rad);
    mamori::sim::ComputedTorqueController law{*loaded.model};
    safe_arm::RunRecord record{options, *loaded.model, fault, Instant{} + safe_arm::kMotionStart, motion_end};
    plant.set_observer(&record.get_verdict());
    const std::string obstacle = safe_arm::prepare_system(*loaded.model, track, law);
    if (!obstacle.empty()) {
        return fail(kExitFailed, obstacle);
    }

    safe_arm::Machine machine{plant, safe_arm::virtual_host, fault, record};
    const auto wall_start = std::chrono::steady_clock::now();
    const auto settled =
        static_cast<std::uint64_t>((motion_end + kSettling - Instant{}).ns / safe_arm::kFrame.ns);
    const mamori::Status status =
        safe_arm::simulate(options.frames == 0U ? settled : options.frames, machine);
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - wall_start;
    const std::uint64_t frames = safe_arm::simulation.get_frame_count();
    if (!machine.is_plant_sound()) {
        return fail(kExitFailed, "the simulated plant diverged in frame " + std::to_string(frames));
    }
    // A component that hangs by the fault plan also hangs at the stop.
    if (status != mamori::Status::kOk && frames == 0U) {
        return fail(kExitFailed, safe_arm::describe_failed_start());
    }
    const std::string reason =
        record.write(safe_arm::event_log, {frames, safe_arm::executive.get_trace_hash(), wall.count()});
    return reason.empty() ? kExitOk : fail(kExitFailed, reason);
}

int write_table(const std::string& path) {
    const std::string reason = safe_arm::save_table(path);
    return reason.empty() ? kExitOk : fail(kExitUsage, reason);
}

}  // namespace

int main(int argc, char** argv) {
    const safe_arm::ParsedCommand command = safe_arm::parse_command(argc, argv);
    if (command.exit_code >= 0) {
        return command.exit_code;
    }
    if (!command.table.empty()) {
        return write_table(command.table);
    }
    if (command.is_cost) {
        return safe_arm::run_cost_command(command.options);
    }
    return command.is_timing ? safe_arm::run_timing_command(command.options) : run_scenario(command.options);
}
