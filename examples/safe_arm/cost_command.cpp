// SPDX-License-Identifier: Apache-2.0
#include "cost_command.hpp"

#include <iostream>

#include "arm_start.hpp"
#include "machine.hpp"
#include "mamori/timing/cost_run.hpp"
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

/// Final state of the supervisor: if the arm stopped, the class of inputs measures other branches than
/// intended.
std::vector<std::string> make_notes() {
    std::string state = std::string{"the arm ended in state "} + get_name(supervisor.get_state());
    if (supervisor.get_first_fault() < kArmFaultCount) {
        state += std::string{", first fault "} + get_fault_names()[supervisor.get_first_fault()];
    }
    return {state};
}

}  // namespace

int run_cost_command(const RunOptions& options) {
    mamori::sim::LoadedModel loaded;
    MotionTrack track;
    const std::string refusal = load_inputs(options.model, options.motion, loaded, track);
    if (!refusal.empty()) {
        return fail(kExitUsage, refusal);
    }
    const mamori::sim::FaultPlan fault = mamori::sim::delay(options.fault, kMotionStart);
    mamori::sim::ArmPlant plant{*loaded.model};
    plant.reset(track.calc_point(0.0).position_rad);
    mamori::sim::ComputedTorqueController law{*loaded.model};
    const mamori::Instant start = mamori::Instant{} + kMotionStart;
    RunRecord record{options, *loaded.model, fault, start, start};
    const std::string obstacle = start_system(*loaded.model, track, law);
    if (!obstacle.empty()) {
        return fail(kExitFailed, obstacle);
    }
    Machine machine{plant, virtual_host, fault, record};
    mamori::timing::CostOptions cost;
    cost.cycles = options.frames;
    cost.counted = {options.first_counted, options.count_every};
    cost.is_paced = options.is_by_clock;
    cost.out = options.out;
    cost.save_table = save_table;
    cost.tell_notes = make_notes;
    const mamori::timing::TimingResult result =
        mamori::timing::run_cost({{executive, virtual_host}}, machine, cost);
    if (!result.message.empty()) {
        return fail(get_exit_status(result.outcome), result.message);
    }
    if (!machine.is_plant_sound()) {
        return fail(kExitFailed, "the simulated plant diverged");
    }
    return get_exit_status(result.outcome);
}

}  // namespace safe_arm
