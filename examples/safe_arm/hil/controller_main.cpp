// SPDX-License-Identifier: Apache-2.0
// The motion controller as a process. It is not safety-related: the kernel checks what it sends.
#include <nlohmann/json.hpp>

#include "arm_start.hpp"
#include "hil_ends.hpp"
#include "hil_program.hpp"
#include "mamori/simbody_sim/computed_torque_controller.hpp"

namespace {

using namespace safe_arm;
using mamori::Instant;
namespace lcm = mamori::ports::lcm;

constexpr const char* kName = "hil_controller";
constexpr std::int64_t kPollNs = 100'000'000;

lcm::LcmLink g_link;
lcm::LcmSender g_sender{g_link, kCommandChannel};
StateQueue g_queue;
Doorbell g_bell{g_queue};
FaultySink g_sink{Link::kCommand, kCommandE2e};

}  // namespace

int main(int argc, char** argv) {
    const HilOptions options =
        parse_hil_options(kName, "The motion controller of the arm on an LCM network.", argc, argv);
    if (options.exit_code >= 0) {
        return options.exit_code;
    }
    mamori::sim::LoadedModel loaded;
    MotionTrack track;
    const std::string refusal = load_inputs(options.run.model, options.run.motion, loaded, track);
    if (!refusal.empty()) {
        return fail_hil(kName, kHilExitUsage, refusal);
    }
    const mamori::sim::FaultPlan fault = mamori::sim::delay(options.run.fault, kMotionStart);
    mamori::sim::ComputedTorqueController law{*loaded.model};
    static HilController controller{track, law, Instant{} + kMotionStart};
    g_sink.configure(options.error, g_sender);
    catch_stop_signals();
    static_cast<void>(g_sender.open());
    static_cast<void>(g_link.receive(kStateChannel, g_bell));
    if (const int status = open_hil_link(kName, g_link, options.url); status != kHilExitOk) {
        return status;
    }
    ControllerEnd end{g_queue, g_sink};
    while (!is_stop_requested()) {
        static_cast<void>(g_bell.wait_until(read_monotonic_ns() + kPollNs));
        reply(controller, end, fault, Instant{read_monotonic_ns()});
    }
    g_link.close();
    return write_hil_report(kName, options.run.out, "controller.json",
                            {{"schema", "mamori.hil_controller/1"},
                             {"state", to_json(end.get_news())},
                             {"injected", g_sink.get_injected_count()},
                             {"received_gap_s", to_seconds(end.get_longest_received_gap())},
                             {"sent_gap_s", to_seconds(end.get_longest_sent_gap())}});
}
