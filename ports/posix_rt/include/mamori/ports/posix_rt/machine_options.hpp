// SPDX-License-Identifier: Apache-2.0
/// @file
/// What a machine in real time is told before a run, and what it reports after it.
///
/// @satisfies SWR-PRT-070, SWR-PRT-073, SWR-PRT-081, SWR-PRT-085      Design: docs/design/posix_rt.md#machine
#ifndef MAMORI_PORTS_POSIX_RT_MACHINE_OPTIONS_HPP
#define MAMORI_PORTS_POSIX_RT_MACHINE_OPTIONS_HPP

#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/status.hpp"
#include "mamori/kernel/base/time.hpp"
#include "mamori/kernel/payload/bounded_string.hpp"
#include "mamori/kernel/record/event_log.hpp"
#include "mamori/ports/posix_rt/core_runner.hpp"
#include "mamori/ports/posix_rt/grid_watch.hpp"
#include "mamori/ports/posix_rt/mapped_file.hpp"
#include "mamori/ports/posix_rt/real_time_rights.hpp"
#include "mamori/ports/posix_rt/watchdog_device.hpp"

namespace mamori::ports::posix_rt {

/// Settings of a machine. Each default suits a system of a few milliseconds per major frame on a shared host.
struct MachineOptions {
    /// Disables the outputs permanently: at a signal, a crash, an expired watchdog, a finding of the schedule
    /// watch, an action outside windows that exceeds its budget, and at the end of each run. Called on any
    /// thread or in a signal handler; called again by another thread while a call has not returned: system
    /// calls and stores only, nothing that waits. Without a function, the system has no outputs.
    OutputGate outputs{};
    /// SCHED_FIFO priority of the threads that run the windows, kPriorityMin .. kPriorityMax. The windows run
    /// kPriorityStep below, the schedule watch kPriorityStep above, and the watchdog above that. The threads
    /// that run background windows are two steps below, and these windows three: at least
    /// kBackgroundPriorityMin for a table with such windows.
    int priority{80};
    /// Processor of core 0, 1, ...; empty: any processor. Must outlive the machine.
    Span<const int> processors{};
    /// Stack of each window thread whose window declares none by stack(...), and of each thread that runs
    /// windows and calls the devices [byte]: kThreadStackMin or more.
    std::size_t window_stack{kThreadStack};
    std::size_t runner_stack{std::size_t{1024U} * 1024U};
    /// From the start of the threads to the first major frame, > 0.
    Duration lead{50'000'000};
    /// When a window counts as overdue, and when a clock rate counts as wrong: see GridLimits. `lateness`
    /// must be below the lateness that the controlled robot tolerates.
    GridLimits watch{Duration{100'000'000}, Duration{10'000'000}, {Duration{1'000'000'000}, 5000}};
    /// The process ends (abort()) with closed outputs if the thread of the first core, or the schedule watch,
    /// does not run for this time. More than `lead`, two polls of the watch and two major frames together.
    Duration watchdog_timeout{1'000'000'000};
    /// Device that supervises the watchdog: open, and disarmed by its owner after the run; nullptr: none. It
    /// is served from the first window on until the last one. Its timeout must exceed the start and the stop
    /// of the system, with 1 s for work that hangs and the action_budget() of the table for each window whose
    /// actions hang. Must outlive the machine.
    WatchdogDevice* device{nullptr};
    /// File of a flight recorder that receives start, stop, signals, findings and crashes of each run;
    /// nullptr: none. Created if it does not exist. Must outlive the machine.
    const char* recorder{nullptr};
    std::size_t recorder_capacity{1024U};  ///< records, > 0
    /// Event log of the first core that is attached to the recorder; nullptr: none. Must outlive the machine.
    EventLog* event_log{nullptr};

    static constexpr int kPriorityStep = 5;
    static constexpr int kPriorityMin = kPriorityStep + 1;
    static constexpr int kBackgroundPriorityMin = 3 * kPriorityStep + 1;
    static constexpr int kPriorityMax = 99 - 2 * kPriorityStep;
};

/// Step of a run.
enum class MachineStep : std::uint8_t {
    kNone,
    kOptions,        ///< options or number of frames
    kRecorder,       ///< file of the flight recorder; get_system_error() gives the cause
    kSignals,        ///< another machine runs in this process
    kCrashHandlers,  ///< this process has CrashHandlers
    kWindowThreads,  ///< threads of the windows
    kStart,          ///< on_initialize, on_startup or on_activated of a component, its budget, or the table
    kWatch,          ///< thread of the schedule watch
    kWatchdog,       ///< thread of the watchdog
    kRunnerThreads,  ///< threads that run the windows
    kFrames,         ///< the major frames: the schedule watch closed the outputs
    kStop            ///< on_deactivated or on_shutdown of a component, its budget, or work that hangs
};

/// @return a sentence for the user; never nullptr.
const char* describe(MachineStep step) noexcept;

/// Result of a run.
struct MachineReport {
    MachineStep failed_step{MachineStep::kNone};         ///< first failure; kNone: run() returned kOk
    MappedFileError file_error{MappedFileError::kNone};  ///< of kRecorder
    /// Name of the first component with an action outside windows that exceeded the action_budget() of the
    /// table, and of this action, as "on_startup"; nullptr: none.
    const char* late_component{nullptr};
    const char* late_action{nullptr};
    int signal{0};               ///< that ended the run; 0: none
    Instant signalled{};         ///< its handler ran
    Duration until_closed{0};    ///< from the handler of this signal to the closed outputs
    GridFinding finding{};       ///< of the schedule watch
    OpeningCounts openings{};    ///< of all runs and cores: sums, and the worst lateness
    OpeningCounts background{};  ///< the same of the background windows, whose lateness contains preemption
    Duration longest_sample{0};  ///< of Devices::sample()
    Duration longest_apply{0};   ///< of Devices::apply()
    Right memory{};              ///< locked memory
    Right priority{};            ///< of all threads
    Right processor{};           ///< likewise
};

/// The sentence of the failed step, with component and action if the report names them.
using MachineReportText = BoundedString<255U>;
MachineReportText describe(const MachineReport& report) noexcept;

/// Records that a machine writes to its recorder have this source; their codes are MachineEvent.
inline constexpr std::uint16_t kMachineSource = 0xFFFFU;
enum class MachineEvent : std::uint16_t {
    kStarted = 1U,        ///< argument: number of cores
    kStopRequested = 2U,  ///< argument: signal, or 0 for request_stop()
    kOutputsClosed = 3U,  ///< argument: time since the handler of the signal [ns], or 0
    kWatchFinding = 4U,   ///< argument: GridFault
    kStopped = 5U,        ///< argument: Status
    kActionOverrun = 6U,  ///< argument: component, and 2^32 times its ComponentAction
};

}  // namespace mamori::ports::posix_rt

#endif  // MAMORI_PORTS_POSIX_RT_MACHINE_OPTIONS_HPP
