// SPDX-License-Identifier: Apache-2.0
#include "timing_command.hpp"

#include <iostream>
#include <string>
#include <vector>

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

/// Final state of the supervisor: lateness of the host can stop the arm.
std::vector<std::string> make_notes(const RealTimeMachine& machine) {
    std::string state = std::string{"the arm ended in state "} + get_name(supervisor.get_state());
    if (supervisor.get_first_fault() < kArmFaultCount) {
        state += std::string{", first fault "} + get_fault_names()[supervisor.get_first_fault()];
    }
    return {state,
            "the simulated arm was not ready for " + std::to_string(machine.get_late_count()) + " frames"};
}

}  // namespace

std::vector<std::string> make_findings(mamori::safety::SafeState state, std::size_t first_fault) {
    using mamori::safety::SafeState;
    if (state == SafeState::kSelfTest || state == SafeState::kStandby || state == SafeState::kOperational) {
        return {};
    }
    std::string finding = std::string{"the arm left its operating state and ended in "} + get_name(state);
    if (first_fault < kArmFaultCount) {
        finding += std::string{", first fault "} + get_fault_names()[first_fault];
    }
    return {finding};
}

/// The states of the supervisor, numbered from 1.
std::vector<mamori::timing::SystemState> list_states() {
    std::vector<mamori::timing::SystemState> states;
    for (std::size_t i = 0U; i < mamori::safety::kSafeStateCount; ++i) {
        const auto state = static_cast<mamori::safety::SafeState>(i + 1U);
        states.push_back({get_name(state), state == mamori::safety::SafeState::kOperational});
    }
    return states;
}

int run_timing_command(const RunOptions& options) {
    // Static, since hanging work can use these objects after the run.
    static mamori::sim::LoadedModel loaded;
    static MotionTrack track;
    const std::string refusal = load_inputs(options.model, options.motion, loaded, track);
    if (!refusal.empty()) {
        return fail(kExitUsage, refusal);
    }
    mamori::sim::ArmPlant plant{*loaded.model};
    plant.reset(track.calc_point(0.0).position_rad);
    static mamori::sim::ComputedTorqueController law{*loaded.model};
    const std::string obstacle = start_system(*loaded.model, track, law);
    if (!obstacle.empty()) {
        return fail(kExitFailed, obstacle);
    }
    if (options.with_requests) {
        executive.set_introspection(&introspection);
    }
    // Never destroyed, since hanging work can use it after this function has returned.
    static auto& threads =
        *new std::vector<mamori::ports::posix_rt::WindowThread>(executive.get_view().windows.size());
    RealTimeMachine machine{plant};
    mamori::timing::TimingOptions timing;
    timing.cycles = options.frames;
    timing.out = options.out;
    timing.with_requests = options.with_requests;
    timing.introspection = &introspection;
    timing.states = list_states();
    timing.get_state = [] { return static_cast<std::size_t>(supervisor.get_state()) - 1U; };
    timing.save_table = save_table;
    timing.tell_notes = [&machine] { return make_notes(machine); };
    timing.tell_findings = [] { return make_findings(supervisor.get_state(), supervisor.get_first_fault()); };
    const mamori::timing::TimingResult result =
        mamori::timing::run_timing({{executive, {threads.data(), threads.size()}, &machine}}, timing);
    if (!result.message.empty()) {
        return fail(get_exit_status(result.outcome), result.message);
    }
    for (const std::string& note : make_notes(machine)) {
        std::cerr << "safe_arm: " << note << '\n';
    }
    if (!machine.is_plant_sound()) {
        return fail(kExitFailed, "the simulated plant diverged");
    }
    return get_exit_status(result.outcome);
}

}  // namespace safe_arm
