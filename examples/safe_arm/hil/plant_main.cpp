// SPDX-License-Identifier: Apache-2.0
// The arm as a process: hardware that only its messages reach.
#include <cmath>
#include <nlohmann/json.hpp>

#include "arm_start.hpp"
#include "hil_ends.hpp"
#include "hil_program.hpp"

namespace {

using namespace safe_arm;
using mamori::Instant;
using mamori::Status;
namespace lcm = mamori::ports::lcm;

constexpr const char* kName = "hil_plant";
constexpr std::int64_t kPatienceNs = 60'000'000'000;  ///< until the first message of the kernel

lcm::LcmLink g_link;
lcm::LcmSender g_sender{g_link, kDeviceChannel};
DriveQueue g_queue;
Doorbell g_bell{g_queue};
FaultySink g_sink{Link::kDevice, kDeviceE2e};

/// Moves the plant by its messages, or by the clock while there are none.
class PlantLoop final {
  public:
    PlantLoop(HilPlant& plant, std::uint64_t frames) noexcept : plant_(plant), frames_(frames) {}

    /// @return why the run is not complete, or nothing.
    std::string run() {
        const std::int64_t end_ns = read_monotonic_ns() + kPatienceNs;
        deadline_ns_ = read_monotonic_ns();
        while (plant_.get_frame_count() < frames_ && plant_.is_sound()) {
            const bool has_message = g_bell.wait_until(deadline_ns_);
            if (is_stop_requested()) {
                return "stopped";
            }
            if (has_message) {
                receive();
            } else if (const std::int64_t woke_ns = read_monotonic_ns(); woke_ns >= deadline_ns_) {
                pass_deadline(woke_ns);
            }
            const bool is_waiting = plant_.get_frame_count() == 0U;
            if (is_waiting && read_monotonic_ns() > end_ns) {
                return "no message of the kernel within 60 s";
            }
        }
        return plant_.is_sound()
                   ? ""
                   : "the simulated plant diverged in frame " + std::to_string(plant_.get_frame_count());
    }
    const PlantEnd& get_end() const noexcept { return end_; }
    /// Lateness of the thread at the end of the time-out: caused by the host.
    std::int64_t get_late_ns() const noexcept { return late_ns_; }
    std::int64_t get_closed_after_ns() const noexcept { return closed_after_ns_; }

  private:
    void receive() {
        const Instant now{read_monotonic_ns()};
        if (!end_.receive(now)) {
            return;
        }
        plant_.take(end_.get_received());
        if (plant_.is_linked()) {
            heard_ns_ = now.ns;
            deadline_ns_ = now.ns + kDriveSilenceMax.ns;
            send_answer(plant_, end_, now);
        }
    }
    void pass_deadline(std::int64_t woke_ns) {
        if (plant_.is_linked()) {
            plant_.lose_link();
            closed_after_ns_ = read_monotonic_ns() - heard_ns_;
            late_ns_ = woke_ns - deadline_ns_;
        } else if (plant_.get_lost_at().has_value()) {
            plant_.run_alone();
        }
        send_answer(plant_, end_, Instant{read_monotonic_ns()});
        deadline_ns_ += kFrame.ns;
    }

    HilPlant& plant_;
    std::uint64_t frames_;
    PlantEnd end_{g_queue, g_sink};
    std::int64_t deadline_ns_{0};
    std::int64_t heard_ns_{0};
    std::int64_t closed_after_ns_{0};
    std::int64_t late_ns_{0};
};

nlohmann::ordered_json to_seconds_or_null(const std::optional<Instant>& instant) {
    return instant.has_value() ? nlohmann::ordered_json(to_seconds(*instant - Instant{}))
                               : nlohmann::ordered_json(nullptr);
}

}  // namespace

int main(int argc, char** argv) {
    const HilOptions options =
        parse_hil_options(kName, "The simulated arm as hardware behind an LCM network.", argc, argv);
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
    RunRecord record{options.run, *loaded.model, fault, motion_start,
                     motion_start + mamori::Duration{motion_ns}};
    plant.set_observer(&record.get_verdict());
    HilPlant hil_plant{plant, fault, record};
    PlantLoop loop{hil_plant, options.run.frames};
    g_sink.configure(options.error, g_sender);
    catch_stop_signals();
    static_cast<void>(g_sender.open());
    static_cast<void>(g_link.receive(kDriveChannel, g_bell));
    if (const int status = open_hil_link(kName, g_link, options.url); status != kHilExitOk) {
        return status;
    }
    const std::int64_t start_ns = read_monotonic_ns();
    const std::string reason = loop.run();
    g_link.close();
    if (!reason.empty()) {
        return fail_hil(kName, kHilExitFailed, reason);
    }
    const nlohmann::ordered_json report = {
        {"schema", "mamori.hil_plant/1"},
        {"drive", to_json(loop.get_end().get_news())},
        {"injected", g_sink.get_injected_count()},
        {"received_gap_s", to_seconds(loop.get_end().get_longest_received_gap())},
        {"sent_gap_s", to_seconds(loop.get_end().get_longest_sent_gap())},
        {"lost_at_s", to_seconds_or_null(hil_plant.get_lost_at())},
        {"closed_at_s", to_seconds_or_null(hil_plant.get_closed_at())},
        {"closed_after_s", to_seconds(mamori::Duration{loop.get_closed_after_ns()})},
        {"late_windows", hil_plant.get_late_windows()},
        {"late_s", to_seconds(mamori::Duration{loop.get_late_ns()})}};
    if (const int status = write_hil_report(kName, options.run.out, "plant.json", report);
        status != kHilExitOk) {
        return status;
    }
    const double wall_s = to_seconds(mamori::Duration{read_monotonic_ns() - start_ns});
    const std::string unwritten =
        record.write(mamori::EventLog{{}}, {hil_plant.get_frame_count(), 0U, wall_s});
    return unwritten.empty() ? kHilExitOk : fail_hil(kName, kHilExitFailed, unwritten);
}
