// SPDX-License-Identifier: Apache-2.0
/// @file
/// Runs a system in real time for a number of major frames and writes the measurements for `mamori timing`.
/// For hosts: link mamori::timing into your program and offer `timing --cycles N --out DIR [--requests]`.
///
/// @satisfies SWR-PRT-084, SWR-TIM-002, SWR-TIM-003, SWR-TIM-005, SWR-TIM-041, SWR-TIM-046
/// Design:   docs/design/timing.md#measured-run
#ifndef MAMORI_TIMING_TIMING_RUN_HPP
#define MAMORI_TIMING_TIMING_RUN_HPP

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "mamori/kernel/run/executive.hpp"
#include "mamori/kernel/run/introspection.hpp"
#include "mamori/ports/posix_rt/core_runner.hpp"
#include "mamori/ports/posix_rt/guarded_host.hpp"

namespace mamori::timing {

/// One core of the system. The caller initialises, starts and stops the executive.
struct TimedCore {
    Executive& executive;
    /// One per window of the system table, with static storage: see WindowThread.
    Span<ports::posix_rt::WindowThread> threads;
    /// Devices before and after the windows of this core; nullptr: none.
    ports::posix_rt::OpeningObserver* devices{nullptr};
};

/// A state of the whole system, for example of its supervisor.
struct SystemState {
    std::string name;
    /// The system does its task. Leaving such a state is a finding of `mamori timing`.
    bool is_operating{false};
};

struct TimingOptions {
    std::uint64_t cycles{60000U};  ///< major frames, > 0
    std::string out;               ///< folder of the results; is created
    /// Of SCHED_FIFO for runner threads; window threads get 10 less. Runners and windows of background
    /// windows are below them.
    int priority{80};
    /// Writes table.json to the given path; empty: the table without names. @return the error, or empty.
    std::function<std::string(const std::string&)> save_table{};
    /// Called after the run; returns notes for the readers of the times. Empty: none.
    std::function<std::vector<std::string>()> tell_notes{};
    /// Called after the run; returns errors of the system itself, for example that it left its operating
    /// state. Each text is a finding of `mamori timing`. Empty: none.
    std::function<std::vector<std::string>()> tell_findings{};
    /// States that `get_state` can return. Empty: the system has none.
    std::vector<SystemState> states{};
    /// @return index in `states`. Called by the thread of each core after each of its windows, so several
    /// cores call it concurrently; must be quick and must not block. Not called while work of the core is
    /// outstanding.
    std::function<std::size_t()> get_state{};
    /// Alternates blocks of major frames: without requests from outside, with 1,000 requests per second, and
    /// with as many in bursts of a hundred. Rejected without `introspection`.
    bool with_requests{false};
    /// Introspection of the executives; nullptr: none. Must outlive the run.
    const Introspection* introspection{nullptr};
};

/// Outcome of a run.
enum class TimingOutcome : std::uint8_t {
    kWhole,        ///< all frames, all files written
    kInterrupted,  ///< ended by SIGINT or SIGTERM: existing data is written and marked as partial
    kRefused,      ///< invalid options, fewer processors than cores, or not enough memory; nothing ran
    kFailed,       ///< no threads available, or a file could not be written or removed
};

struct TimingResult {
    TimingOutcome outcome{TimingOutcome::kRefused};
    std::string message;  ///< what is wrong, where, and how to fix it; empty on success
};

/// Exit status of the program for `mamori timing`: 0, 130, 2, 1 in the order of TimingOutcome.
int get_exit_status(TimingOutcome outcome) noexcept;

/// Runs all cores in parallel, each on its own processor, and writes table.json, openings.npy, steps.npy,
/// window_use.npy, step_use.npy, slices.npy and run.json (docs/design/timing.md#files) to the folder. SIGINT
/// and SIGTERM end the run early; during writing they are ignored. A handler of SIGCONT is replaced during
/// the run, and the default action applies afterwards. After the last window, outstanding work has at most
/// one second to return.
///
/// Calling context: the main thread of a program, once per process. Work that hangs permanently keeps its
/// memory. Memory: heap, locked if the process has the privilege; about 80 bytes per window instance and 60
/// per step, and 20 MB per core.
/// @param[in] cores one per core of the table, in the same order.
TimingResult run_timing(const std::vector<TimedCore>& cores, const TimingOptions& options);

}  // namespace mamori::timing

#endif  // MAMORI_TIMING_TIMING_RUN_HPP
