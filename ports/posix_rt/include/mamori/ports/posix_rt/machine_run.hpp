// SPDX-License-Identifier: Apache-2.0
/// @file
/// Part of a machine in real time that does not depend on its table. Users construct a Machine.
///
/// @satisfies SWR-PRT-070, SWR-PRT-071, SWR-PRT-072, SWR-PRT-073, SWR-PRT-074, SWR-PRT-085
/// @satisfies SWR-PRT-086      Design: docs/design/posix_rt.md#machine
#ifndef MAMORI_PORTS_POSIX_RT_MACHINE_RUN_HPP
#define MAMORI_PORTS_POSIX_RT_MACHINE_RUN_HPP

#include <pthread.h>

#include <atomic>
#include <cstdint>
#include <limits>

#include "mamori/kernel/record/flight_recorder.hpp"
#include "mamori/kernel/run/action_guard.hpp"
#include "mamori/kernel/run/devices.hpp"
#include "mamori/kernel/run/executives.hpp"
#include "mamori/ports/posix_rt/core_runner.hpp"
#include "mamori/ports/posix_rt/frame_clock.hpp"
#include "mamori/ports/posix_rt/grid_watch.hpp"
#include "mamori/ports/posix_rt/guarded_host.hpp"
#include "mamori/ports/posix_rt/machine_options.hpp"
#include "mamori/ports/posix_rt/mapped_file.hpp"
#include "mamori/ports/posix_rt/software_watchdog.hpp"
#include "mamori/ports/posix_rt/stop_signals.hpp"

namespace mamori::ports::posix_rt {

class MachineRun;

/// Calls the devices around the windows of the first core, measures them, and reports each completed frame.
///
/// Calling context: the thread that runs the windows of the first core. Memory: none of its own.
class DeviceCaller final : public OpeningObserver {
  public:
    /// @param[in] core of the table with at least one window. All references must outlive this object.
    DeviceCaller(const SystemView& view, std::size_t core, Devices& devices, const FrameClock& clock,
                 MachineRun& run) noexcept;

    void before_opening(const FrameSchedule::Opening& opening, Instant woke) noexcept override;
    void after_opening(const FrameSchedule::Opening& opening, WindowOutcome outcome) noexcept override;

    Duration get_longest_sample() const noexcept { return longest_sample_; }
    Duration get_longest_apply() const noexcept { return longest_apply_; }

  private:
    Devices& devices_;
    const FrameClock& clock_;
    MachineRun& run_;
    Duration frame_;
    Instant first_{};  ///< first window start of major frame 0
    Instant last_{};   ///< its last window start
    Duration longest_sample_{0};
    Duration longest_apply_{0};
};

/// Guard of the actions of one core: closes the outputs when an action exceeds its budget.
class MachineGuard final : public ActionGuard {
  public:
    /// All references must outlive this object, and `host` the executive.
    MachineGuard(GuardedHost& host, Duration budget, const Executive& executive, MachineRun& run) noexcept
        : ActionGuard(host, budget), executive_(executive), run_(run) {}

  private:
    void on_action_overrun(std::size_t component, ComponentAction action) noexcept override;

    const Executive& executive_;
    MachineRun& run_;
};

/// Thread that runs the windows of one core.
struct RunnerThread {
    ThreadPlace place{};
    CoreRunner* runner{nullptr};
    GridBeat* beat{nullptr};
    MachineRun* watched{nullptr};  ///< of the first core: serves the watchdog of this run; else nullptr
    Instant from{};
    std::uint64_t frames{0U};
    pthread_t thread{};
    ThreadRights rights{};
};

/// Parts that the table determines, one of each per core. All must outlive the run.
struct MachineParts {
    ExecutiveGroup& executives;
    FrameClock& clock;
    Span<GuardedHost> hosts;
    Span<CoreRunner> runners;
    Span<GridBeat> beats;
    Span<RunnerThread> threads;
    Span<ActionGuard* const> guards;
    const DeviceCaller& devices;
    std::size_t first_core;  ///< the core that calls the devices
};

/// Thread safety: request_stop() from any thread or signal handler; all other functions from one thread.
class MachineRun final : public StopListener {
  public:
    static constexpr std::uint64_t kAllFrames = std::numeric_limits<std::uint64_t>::max();

    MachineRun() noexcept = default;
    MachineRun(const MachineRun&) = delete;
    MachineRun& operator=(const MachineRun&) = delete;
    ~MachineRun() = default;

    /// As Machine::run().
    Status run(const MachineParts& parts, const MachineOptions& options, std::uint64_t frames) noexcept;
    /// As Machine::request_stop().
    void request_stop() noexcept;
    void on_stop_signal(int signal) noexcept override;
    const MachineReport& get_report() const noexcept { return report_; }

    /// A major frame of the first core has ended: serves the watchdog if the schedule watch has polled since
    /// the last service, and ends the run after a finding of the watch. Called by DeviceCaller.
    void end_frame(Instant now) noexcept;
    /// An action outside windows exceeded its budget: closes the outputs, then records it. Called by
    /// MachineGuard.
    void end_action(std::size_t component, const char* name, ComponentAction action) noexcept;

  private:
    Status fail(MachineStep step, Status status) noexcept;
    Status open_recorder(const MachineOptions& options) noexcept;
    Status run_protected(const MachineParts& parts, const MachineOptions& options,
                         std::uint64_t frames) noexcept;
    Status run_watched(const MachineParts& parts, const MachineOptions& options,
                       std::uint64_t frames) noexcept;
    Status run_threads(const MachineParts& parts) noexcept;
    Status start(const MachineParts& parts, int priority) noexcept;
    Status stop(const MachineParts& parts, int priority) noexcept;
    void collect(const MachineParts& parts) noexcept;
    void record(Instant time, MachineEvent event, Severity severity, std::int64_t argument) noexcept;
    void note_signal() noexcept;
    void record_end_of_frames() noexcept;
    static void close_outputs(void* self) noexcept;
    static void* serve(void* thread) noexcept;

    MachineReport report_{};
    MappedFile file_{};
    FlightRecorder recorder_{};
    const FrameClock* clock_{nullptr};
    Span<CoreRunner> runners_{};
    OutputGate outputs_{};
    SoftwareWatchdog* watchdog_{nullptr};
    const GridWatch* watch_{nullptr};
    std::uint64_t served_look_count_{0U};  ///< looks of the watch at the last service
    Duration frame_{};
    bool has_run_{false};
    std::atomic<bool> has_clock_{false};  ///< clock, runners_ and frame_ are final
    std::atomic<bool> is_stop_wanted_{false};
    std::atomic<bool> are_outputs_closed_{true};
    std::atomic<int> signal_{0};
    std::atomic<std::int64_t> signal_ns_{0};  ///< CLOCK_MONOTONIC, like the next one
    std::atomic<std::int64_t> closed_ns_{0};
};

}  // namespace mamori::ports::posix_rt

#endif  // MAMORI_PORTS_POSIX_RT_MACHINE_RUN_HPP
