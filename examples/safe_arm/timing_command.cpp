// SPDX-License-Identifier: Apache-2.0
#include "timing_command.hpp"

#include <array>
#include <iostream>

#include "arm_start.hpp"
#include "mamori/timing/timing_run.hpp"
#include "real_time_machine.hpp"
#include "safe_arm_system.hpp"
#include "table_output.hpp"

namespace safe_arm {
namespace {

constexpr int kExitFailed = 1;
constexpr int kExitUsage = 2;

int fail(int exit_code, const std::string& message) {
    std::cerr << "safe_arm: " << message << '\n';
    return exit_code;
}

/// What the supervisor made of the run: lateness of the machine may well have stopped the arm.
void tell_end(const RealTimeMachine& machine) {
    std::cerr << "safe_arm: state " << get_name(supervisor.get_state());
    if (supervisor.get_first_fault() < kArmFaultCount) {
        std::cerr << ", first fault " << kArmFaultNames[supervisor.get_first_fault()];
    }
    std::cerr << ", the plant was late for " << machine.get_late_count() << " frames\n";
}

}  // namespace

int run_timing_command(const RunOptions& options) {
    mamori::sim::LoadedModel loaded;
    MotionTrack track;
    const std::string refusal = load_inputs(options.model, options.motion, loaded, track);
    if (!refusal.empty()) {
        return fail(kExitUsage, refusal);
    }
    mamori::sim::ArmPlant plant{*loaded.model};
    plant.reset(track.calc_point(0.0).position_rad);
    mamori::sim::ComputedTorqueController law{*loaded.model};
    const std::string obstacle = start_system(*loaded.model, track, law);
    if (!obstacle.empty()) {
        return fail(kExitFailed, obstacle);
    }
    static std::array<mamori::ports::posix_rt::WindowThread, kWindowCount> threads;
    RealTimeMachine machine{plant};
    mamori::timing::TimingOptions timing;
    timing.cycles = options.frames;
    timing.out = options.out;
    timing.save_table = save_table;
    const mamori::timing::TimingResult result =
        mamori::timing::run_timing({{executive, threads, &machine}}, timing);
    if (!result.message.empty()) {
        return fail(get_exit_status(result.outcome), result.message);
    }
    tell_end(machine);
    if (!machine.is_plant_sound()) {
        return fail(kExitFailed, "the simulated plant diverged");
    }
    return get_exit_status(result.outcome);
}

}  // namespace safe_arm
