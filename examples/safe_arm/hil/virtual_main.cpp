// SPDX-License-Identifier: Apache-2.0
// The scenario of the three processes in one process and in virtual time.
#include <cmath>
#include <nlohmann/json.hpp>

#include "arm_start.hpp"
#include "hil_program.hpp"
#include "mamori/simbody_sim/computed_torque_controller.hpp"
#include "model_check.hpp"
#include "virtual_hil.hpp"

namespace {

using namespace safe_arm;
using mamori::Instant;
using mamori::Status;

constexpr const char* kName = "hil_virtual";

}  // namespace

int main(int argc, char** argv) {
    const HilOptions options =
        parse_hil_options(kName, "The arm with its links in virtual time.", argc, argv);
    if (options.exit_code >= 0) {
        return options.exit_code;
    }
    mamori::sim::LoadedModel loaded;
    MotionTrack track;
    std::string refusal = load_inputs(options.run.model, options.run.motion, loaded, track);
    refusal = refusal.empty() ? claim_folder(options.run.out) : refusal;
    if (!refusal.empty()) {
        return fail_hil(kName, kHilExitUsage, refusal);
    }
    const mamori::sim::FaultPlan fault = mamori::sim::delay(options.run.fault, kMotionStart);
    const auto motion_ns = static_cast<std::int64_t>(std::llround(track.get_duration_s() * 1.0e9));
    const Instant motion_start = Instant{} + kMotionStart;
    mamori::sim::ArmPlant plant{*loaded.model};
    plant.reset(track.calc_point(0.0).position_rad);
    mamori::sim::ComputedTorqueController law{*loaded.model};
    RunRecord record{options.run, *loaded.model, fault, motion_start,
                     motion_start + mamori::Duration{motion_ns}};
    plant.set_observer(&record.get_verdict());
    HilPlant hil_plant{plant, fault, record};
    static HilController controller{track, law, motion_start};
    VirtualHil devices{hil_plant, controller, hil::get_virtual_host(), fault, options.error};
    if (hil::reader.configure(get_encoder_scale(*loaded.model)) != Status::kOk) {
        return fail_hil(kName, kHilExitFailed, "the system does not start");
    }
    const Status status = hil::run_in_virtual_time(options.run.frames, devices);
    // A component that hangs by the fault plan also hangs at the stop.
    if (status != Status::kOk && hil_plant.get_frame_count() == 0U) {
        return fail_hil(kName, kHilExitFailed, "the system does not start");
    }
    if (!hil_plant.is_sound()) {
        return fail_hil(kName, kHilExitFailed, "the simulated plant diverged");
    }
    const std::string unwritten =
        record.write(hil::event_log, {hil_plant.get_frame_count(), hil::get_virtual_trace_hash(), 0.0});
    return unwritten.empty() ? kHilExitOk : fail_hil(kName, kHilExitFailed, unwritten);
}
