// SPDX-License-Identifier: Apache-2.0
/// @file
/// Runs a system in virtual time so that `mamori cost` can count the instructions of each single step. For
/// hosts: link mamori::timing into your program and offer
/// `cost --by count|clock --cycles N --first A --every K --out DIR`.
///
/// @satisfies SWR-TIM-030      Design: docs/design/cost.md#counting
#ifndef MAMORI_TIMING_COST_RUN_HPP
#define MAMORI_TIMING_COST_RUN_HPP

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "mamori/ports/virtual_time/frame_runner.hpp"
#include "mamori/timing/counting_host.hpp"
#include "mamori/timing/timing_run.hpp"

namespace mamori::timing {

/// One core of the system. The caller initialises, starts and stops the executive.
struct CostCore {
    Executive& executive;
    ports::virtual_time::VirtualHost& clock;
};

struct CostOptions {
    std::uint64_t cycles{1000U};  ///< major frames, > 0
    CountedCycles counted{};      ///< of these; `first` is below `cycles`
    /// True: in real time, each window at its planned instant, with the granted real-time privileges. False:
    /// as fast as possible, for a counting tool.
    bool is_paced{false};
    std::string out;   ///< folder of the results; is created
    int priority{80};  ///< of SCHED_FIFO, 1 .. 99, in real time only
    /// Writes table.json to the given path; empty: the table without names. @return the error, or empty.
    std::function<std::string(const std::string&)> save_table{};
    /// Called after the run; returns notes for the readers of the figures. Empty: none.
    std::function<std::vector<std::string>()> tell_notes{};
};

/// Runs the major frames and atomically writes table.json, steps.npy and run.json (docs/design/cost.md#files)
/// to the folder. First calls mamori_counted_step() for empty work, then for the reference work, as often as
/// run.json states. Then calls it once for each row of steps.npy, in the same order.
///
/// Calling context: the main thread of a program. Memory: heap; locked in real time.
/// @param[in] cores one per core of the table, in the same order. @param[in] devices around the major frames.
/// @return kWhole, kRefused (invalid options) or kFailed; never kInterrupted, because a signal ends the
/// program without results.
TimingResult run_cost(const std::vector<CostCore>& cores, Devices& devices, const CostOptions& options);

}  // namespace mamori::timing

#endif  // MAMORI_TIMING_COST_RUN_HPP
