// SPDX-License-Identifier: Apache-2.0
/// @file
/// The files of a timing run: docs/design/timing.md#files.
#ifndef MAMORI_TIMING_WRITE_RUN_HPP
#define MAMORI_TIMING_WRITE_RUN_HPP

#include <cstdint>
#include <string>
#include <vector>

#include "mamori/ports/posix_rt/real_time_rights.hpp"
#include "mamori/timing/counting_host.hpp"
#include "mamori/timing/introspection_load.hpp"
#include "mamori/timing/run_log.hpp"
#include "mamori/timing/switch_log.hpp"
#include "mamori/timing/timing_run.hpp"
#include "thread_list.hpp"

namespace mamori::timing {

/// Switches of one core.
struct CoreSwitches {
    const SwitchLog* log{nullptr};
    ports::posix_rt::Right right{};
    int processor{0};
    std::vector<std::uint32_t> window_threads{};  ///< per window of the table; 0: none
};

struct SwitchFacts {
    std::vector<CoreSwitches> cores{};  ///< empty: no log
    std::vector<NamedThread> threads{};
    std::vector<Instant> continued{};  ///< the process was stopped until then
};

/// Content of run.json except the rows.
struct RunFacts {
    std::uint64_t asked_cycles{0U};
    std::uint64_t run_cycles{0U};
    bool is_partial{false};
    Duration frame{};
    Duration reference{};  ///< see measure_reference()
    ports::posix_rt::Right priority{};
    ports::posix_rt::Right processor{};
    ports::posix_rt::Right memory{};
    std::uint64_t block_cycles{0U};  ///< major frames of one pace of requests; 0: a run without requests
    std::uint64_t request_count{0U};
    std::vector<Pace> paces{};            ///< of each block, from major frame 0 on
    std::vector<std::string> notes{};     ///< of the application
    std::vector<std::string> findings{};  ///< likewise
    SwitchFacts switches{};
    std::vector<SystemState> states{};
};

/// Content of run.json of a cost run except the rows.
struct CostFacts {
    std::uint64_t cycles{0U};
    CountedCycles counted{};
    bool is_paced{false};
    Duration frame{};
    std::size_t calibration_count{1U};  ///< calls of each of the two pieces of work before the first row
    Duration empty{};                   ///< minimum time of empty counted work
    Duration reference{};               ///< median time of the counted reference work
    ports::posix_rt::Right priority{};
    ports::posix_rt::Right processor{};
    ports::posix_rt::Right memory{};
    std::string compiler{};
    std::string flags{};
    std::string c_library{};
    std::vector<std::string> notes{};  ///< of the application
};

/// Removes the files of an earlier run, so that none of them counts for this run.
/// @return empty on success, otherwise one sentence with the path and the cause.
std::string remove_files(const std::string& folder);

/// Atomically writes openings.npy, steps.npy, window_use.npy, step_use.npy, slices.npy and run.json; run.json
/// is last and marks a complete folder. Contains the rows of all cores, ordered by planned instant.
/// @return empty on success, otherwise one sentence with the path and the cause.
std::string write_run(const std::string& folder, const std::vector<const RunLog*>& logs,
                      const RunFacts& facts);

/// Atomically writes steps.npy and run.json of a cost run. Rows are in execution order.
/// @return empty on success, otherwise one sentence with the path and the cause.
std::string write_cost(const std::string& folder, const RunLog& log, const CostFacts& facts);

}  // namespace mamori::timing

#endif  // MAMORI_TIMING_WRITE_RUN_HPP
