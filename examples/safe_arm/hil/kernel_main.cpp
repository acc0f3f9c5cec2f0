// SPDX-License-Identifier: Apache-2.0
// The safety components of the arm as a process in real time, between plant and controller.
#include <sched.h>

#include <array>
#include <nlohmann/json.hpp>
#include <thread>

#include "arm_start.hpp"
#include "hil_ends.hpp"
#include "hil_program.hpp"
#include "hil_system.hpp"
#include "mamori/ports/posix_rt/frame_clock.hpp"
#include "mamori/ports/posix_rt/machine_options.hpp"
#include "model_check.hpp"
#include "replay.hpp"
#include "table_output.hpp"

namespace {

using namespace safe_arm;
using mamori::Duration;
using mamori::Instant;
using mamori::Status;
namespace lcm = mamori::ports::lcm;
using mamori::ports::posix_rt::MachineOptions;
using mamori::ports::posix_rt::MachineReport;

constexpr const char* kName = "hil_kernel";
constexpr int kPatienceMs = 10'000;  ///< until the plant sends
constexpr std::uint32_t kPlantMessagesMin = 5U;

lcm::LcmLink g_link;
lcm::LcmSender g_drive_sender{g_link, kDriveChannel};
lcm::LcmSender g_state_sender{g_link, kStateChannel};

/// Triggers planned errors, and notes when the outputs were closed first.
class Watcher final : public mamori::Devices {
  public:
    Watcher(const mamori::ports::posix_rt::FrameClock& clock, std::uint64_t frames) noexcept
        : clock_(clock), frames_(frames) {}

    void sample(std::uint64_t frame, Instant) noexcept override {
        hil::drive_sink.set_frame(frame);
        hil::state_sink.set_frame(frame);
    }
    void apply(std::uint64_t frame, Instant start, Duration length) noexcept override {
        hil::watchdog_mirror.check(start + length);
        note_arrivals(start);
        was_enabled_ = was_enabled_ || hil::outputs.torque_enable;
        if (was_enabled_ && !hil::outputs.torque_enable && closed_at_ns_ < 0) {
            closed_at_ns_ = clock_.get_now().ns;
            last_answer_ns_ = hil::device_receiver.out.get_published().answered_ns;
        }
        if (frame + 2U >= frames_) {
            hil::hang_point.release();
        }
    }
    Duration get_device_gap() const noexcept { return device_gap_.get_longest(); }
    Duration get_command_gap() const noexcept { return command_gap_.get_longest(); }
    std::int64_t get_closed_at_ns() const noexcept { return closed_at_ns_; }
    std::int64_t get_last_answer_ns() const noexcept { return last_answer_ns_; }

  private:
    /// In whole frames.
    void note_arrivals(Instant start) noexcept {
        const std::uint32_t device = hil::device_receiver.get_news().used;
        const std::uint32_t command = hil::command_receiver.get_news().used;
        if (device != device_count_) {
            device_gap_.note(start);
        }
        if (command != command_count_) {
            command_gap_.note(start);
        }
        device_count_ = device;
        command_count_ = command;
    }

    const mamori::ports::posix_rt::FrameClock& clock_;
    std::uint64_t frames_;
    std::uint32_t device_count_{0U};
    std::uint32_t command_count_{0U};
    GapWatch device_gap_{};
    GapWatch command_gap_{};
    bool was_enabled_{false};
    std::int64_t closed_at_ns_{-1};
    std::int64_t last_answer_ns_{-1};
};

void close_outputs(void*) noexcept {
    hil::encoder.close();
}

/// The last processor that this process may use: on a host with several, the others remain for plant and
/// controller.
int find_last_processor() noexcept {
    cpu_set_t set{};
    int last = mamori::ports::posix_rt::ThreadPlace::kAnyProcessor;
    if (::sched_getaffinity(0, sizeof set, &set) == 0) {
        for (std::size_t i = 0U; i < CPU_SETSIZE; ++i) {
            last = CPU_ISSET(i, &set) ? static_cast<int>(i) : last;
        }
    }
    return last;
}

bool is_plant_sending() {
    for (int i = 0; i < kPatienceMs; ++i) {
        if (hil::device_queue.get_counts().accepted >= kPlantMessagesMin) {
            return true;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds{1});
    }
    return false;
}

nlohmann::ordered_json to_s(std::int64_t ns) {
    return ns < 0 ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(to_seconds(Duration{ns}));
}

nlohmann::ordered_json make_report(const Watcher& watcher, Status status) {
    const MachineReport& report = hil::get_report();
    const mamori::safety::FaultIndex first = hil::supervisor.get_first_fault();
    return {{"schema", "mamori.hil_kernel/1"},
            {"status", status == Status::kOk ? "ok" : describe(report.failed_step)},
            {"has_priority", report.priority.is_granted},
            {"has_locked_memory", report.memory.is_granted},
            {"opened", report.openings.opened},
            {"overran", report.openings.overran},
            {"missed", report.openings.missed},
            {"worst_lateness_s", to_seconds(report.openings.worst_lateness)},
            {"late_releases", hil::safety_state.get_supervision().get_late_release().count},
            {"final_state", get_name(hil::supervisor.get_state())},
            {"first_fault", first < kArmFaultCount ? nlohmann::ordered_json(get_fault_names()[first])
                                                   : nlohmann::ordered_json(nullptr)},
            {"closed_at_s", to_s(watcher.get_closed_at_ns())},
            {"last_answer_s", to_s(watcher.get_last_answer_ns())},
            {"closes_within_s", to_seconds(kKernelClosesWithin)},
            {"device_gap_s", to_seconds(watcher.get_device_gap())},
            {"command_gap_s", to_seconds(watcher.get_command_gap())},
            {"device", to_json(hil::device_receiver.get_news())},
            {"command", to_json(hil::command_receiver.get_news())},
            {"injected", hil::drive_sink.get_injected_count() + hil::state_sink.get_injected_count()}};
}

/// In virtual time. @return the exit status.
int replay(const HilOptions& options, const mamori::sim::ArmModel& model) {
    static Replay devices;
    const std::string reason = devices.open(options.replay);
    if (!reason.empty()) {
        return fail_hil(kName, kHilExitUsage, reason);
    }
    if (hil::reader.configure(get_encoder_scale(model)) != Status::kOk ||
        hil::run_in_virtual_time(options.run.frames, devices) != Status::kOk) {
        return fail_hil(kName, kHilExitFailed, "the system does not start");
    }
    const std::optional<std::uint32_t> first = devices.get_first_difference();
    return write_hil_report(kName, options.run.out, "replay.json",
                            {{"schema", "mamori.hil_replay/1"},
                             {"sent", devices.get_sent_count()},
                             {"equal", devices.get_equal_count()},
                             {"first_difference", first.has_value() ? nlohmann::ordered_json(*first)
                                                                    : nlohmann::ordered_json(nullptr)},
                             {"hash", std::to_string(devices.get_hash())},
                             {"final_state", get_name(hil::supervisor.get_state())}});
}

}  // namespace

int main(int argc, char** argv) {
    const HilOptions options =
        parse_hil_options(kName, "The safety components of the arm on an LCM network.", argc, argv);
    if (options.exit_code >= 0) {
        return options.exit_code;
    }
    mamori::sim::LoadedModel loaded;
    MotionTrack track;
    const std::string refusal = load_inputs(options.run.model, options.run.motion, loaded, track);
    if (!refusal.empty()) {
        return fail_hil(kName, kHilExitUsage, refusal);
    }
    if (!options.replay.empty()) {
        return replay(options, *loaded.model);
    }
    const mamori::sim::FaultPlan fault = mamori::sim::delay(options.run.fault, kMotionStart);
    hil::hang_point.configure(fault);
    hil::drive_sink.configure(options.error, g_drive_sender);
    hil::state_sink.configure(options.error, g_state_sender);
    static_cast<void>(g_drive_sender.open());
    static_cast<void>(g_state_sender.open());
    static_cast<void>(g_link.receive(kDeviceChannel, hil::device_queue));
    static_cast<void>(g_link.receive(kCommandChannel, hil::command_queue));
    if (const int status = open_hil_link(kName, g_link, options.url); status != kHilExitOk) {
        return status;
    }
    if (!is_plant_sending()) {
        return fail_hil(kName, kHilExitFailed,
                        std::string{"no message of the plant on the channel "} + kDeviceChannel +
                            " within 10 s; start the plant first, on the same network");
    }
    MachineOptions machine_options;
    machine_options.outputs = {&close_outputs, nullptr};
    static const std::array<int, 1U> processors{find_last_processor()};
    machine_options.processors = processors;
    static Watcher watcher{hil::make_real_time(machine_options), options.run.frames};
    if (hil::reader.configure(get_encoder_scale(*loaded.model)) != Status::kOk) {
        return fail_hil(kName, kHilExitFailed, "the system does not start");
    }
    const Status status = hil::run_in_real_time(options.run.frames, watcher);
    g_link.close();
    const int written = write_hil_report(kName, options.run.out, "kernel.json", make_report(watcher, status));
    if (status != Status::kOk) {
        return fail_hil(kName, kHilExitFailed, describe(hil::get_report().failed_step));
    }
    return written;
}
