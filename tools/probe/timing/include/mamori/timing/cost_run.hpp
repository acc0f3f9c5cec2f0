// SPDX-License-Identifier: Apache-2.0
/// @file
/// Runs a system in virtual time so that the cost of each single step can be told, for `mamori cost`. For
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

/// One core of the system. The executive is initialised and started by whoever calls, and stopped.
struct CostCore {
    Executive& executive;
    ports::virtual_time::VirtualHost& clock;
};

struct CostOptions {
    std::uint64_t cycles{1000U};  ///< major frames, > 0
    CountedCycles counted{};      ///< of these; the first one is below `cycles`
    /// True: by the clock, each window at its planned instant, with the rights of real time where they are
    /// granted. False: as fast as it goes, for a tool that counts.
    bool is_paced{false};
    std::string out;   ///< folder of the results; is made
    int priority{80};  ///< of SCHED_FIFO, 1 .. 99, when it is paced
    /// Writes table.json to the path that it is given; empty: the table without names. @return what is wrong.
    std::function<std::string(const std::string&)> save_table{};
    /// Asked when the run is over: what whoever reads the figures should know of it. Empty: nothing.
    std::function<std::vector<std::string>()> tell_notes{};
};

/// Runs the frames and writes table.json, steps.npy and run.json (docs/design/cost.md#files) into the folder,
/// each whole or not at all. mamori_counted_step() is called first for empty work, then for the reference
/// work, as often as run.json says, and then once for each row of steps.npy, in their order.
///
/// Calling context: the main thread of a program. Memory: heap; locked when it is paced.
/// @param[in] cores one per core of the table, in their order. @param[in] devices around the frames.
/// @return kWhole, kRefused (bad options) or kFailed; never kInterrupted: a signal ends the program, and
///         leaves nothing.
TimingResult run_cost(const std::vector<CostCore>& cores, ports::virtual_time::FrameDevices& devices,
                      const CostOptions& options);

}  // namespace mamori::timing

#endif  // MAMORI_TIMING_COST_RUN_HPP
