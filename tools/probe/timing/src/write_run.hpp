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
#include "mamori/timing/run_log.hpp"

namespace mamori::timing {

/// What run.json tells beside the rows.
struct RunFacts {
    std::uint64_t asked_cycles{0U};
    std::uint64_t run_cycles{0U};
    bool is_partial{false};
    Duration frame{};
    Duration reference{};  ///< see measure_reference()
    ports::posix_rt::Right priority{};
    ports::posix_rt::Right processor{};
    ports::posix_rt::Right memory{};
    std::vector<std::string> notes{};     ///< of the application
    std::vector<std::string> findings{};  ///< likewise
};

/// What run.json of a cost run tells beside the rows.
struct CostFacts {
    std::uint64_t cycles{0U};
    CountedCycles counted{};
    bool is_paced{false};
    Duration frame{};
    std::size_t calibration_count{1U};  ///< calls of each of the two pieces of work before the first row
    Duration empty{};                   ///< least time of counted work that does nothing
    Duration reference{};               ///< median time of the reference work, counted
    ports::posix_rt::Right priority{};
    ports::posix_rt::Right processor{};
    ports::posix_rt::Right memory{};
    std::string compiler{};
    std::string flags{};
    std::string c_library{};
    std::vector<std::string> notes{};  ///< of the application
};

/// Takes the files of an earlier run away, so that none can pass for one of this run.
/// @return empty when done, else one sentence with the path and the cause.
std::string remove_files(const std::string& folder);

/// Writes openings.npy, steps.npy and run.json, each whole or not at all, run.json last: a folder with it is
/// complete. Rows of all cores, in the order of their planned instants.
/// @return empty when done, else one sentence with the path and the cause.
std::string write_run(const std::string& folder, const std::vector<const RunLog*>& logs,
                      const RunFacts& facts);

/// Writes steps.npy and run.json of a cost run, likewise. Rows in the order in which the steps ran.
/// @return empty when done, else one sentence with the path and the cause.
std::string write_cost(const std::string& folder, const RunLog& log, const CostFacts& facts);

}  // namespace mamori::timing

#endif  // MAMORI_TIMING_WRITE_RUN_HPP
