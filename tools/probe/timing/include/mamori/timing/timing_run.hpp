// SPDX-License-Identifier: Apache-2.0
/// @file
/// Runs a system in real time for a number of frames and writes what was measured, for `mamori timing`. For
/// hosts: link mamori::timing into your program and offer `timing --cycles N --out DIR`.
///
/// @satisfies SWR-TIM-002, SWR-TIM-003, SWR-TIM-005      Design: docs/design/timing.md#measured-run
#ifndef MAMORI_TIMING_TIMING_RUN_HPP
#define MAMORI_TIMING_TIMING_RUN_HPP

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "mamori/kernel/run/executive.hpp"
#include "mamori/ports/posix_rt/core_runner.hpp"
#include "mamori/ports/posix_rt/guarded_host.hpp"

namespace mamori::timing {

/// One core of the system. The executive is initialised and started by whoever calls, and stopped.
struct TimedCore {
    Executive& executive;
    /// One per window of the system table, static storage: see WindowThread.
    Span<ports::posix_rt::WindowThread> threads;
    /// Devices around the windows of this core; nullptr: none.
    ports::posix_rt::OpeningObserver* devices{nullptr};
};

struct TimingOptions {
    std::uint64_t cycles{60000U};  ///< major frames, > 0
    std::string out;               ///< folder of the results; is made
    int priority{80};  ///< of SCHED_FIFO for the threads that wait; those of the windows get 10 less
    /// Writes table.json to the path that it is given; empty: the table without names. @return what is wrong.
    std::function<std::string(const std::string&)> save_table{};
    /// Asked when the run is over: what whoever reads the times should know of it. Empty: nothing.
    std::function<std::vector<std::string>()> tell_notes{};
    /// Asked when the run is over: what the system itself did wrong, for example that it left its operating
    /// state. Each text is a finding of `mamori timing`. Empty: nothing.
    std::function<std::vector<std::string>()> tell_findings{};
};

/// How a run ended.
enum class TimingOutcome : std::uint8_t {
    kWhole,        ///< all frames, all files written
    kInterrupted,  ///< by SIGINT or SIGTERM: what there was is written, and marked as partial
    kRefused,      ///< bad options, fewer processors than cores, or not enough memory; nothing ran
    kFailed,       ///< no threads to be had, or a file could not be written or removed
};

struct TimingResult {
    TimingOutcome outcome{TimingOutcome::kRefused};
    std::string message;  ///< what is wrong, where, and what to do; empty when nothing is
};

/// Exit status that `mamori timing` expects of the program: 0, 130, 2, 1 in the order of TimingOutcome.
int get_exit_status(TimingOutcome outcome) noexcept;

/// Runs all cores at once, each on a processor of its own, and writes table.json, openings.npy, steps.npy and
/// run.json (docs/design/timing.md#files) into the folder. SIGINT and SIGTERM end it early, and are not
/// heard while it writes. Work that is still out when the windows are over is waited for, a second at most.
///
/// Calling context: the main thread of a program, once per process; work that hangs for ever keeps its
/// memory. Memory: heap, locked if the process has the right; about 30 bytes per opening and 40 per step.
/// @param[in] cores one per core of the table, in their order.
TimingResult run_timing(const std::vector<TimedCore>& cores, const TimingOptions& options);

}  // namespace mamori::timing

#endif  // MAMORI_TIMING_TIMING_RUN_HPP
