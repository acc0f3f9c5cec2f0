// SPDX-License-Identifier: Apache-2.0
/// @file
/// The files of a timing run: docs/design/timing_run.md#files.
#ifndef MAMORI_TIMING_WRITE_RUN_HPP
#define MAMORI_TIMING_WRITE_RUN_HPP

#include <cstdint>
#include <string>
#include <vector>

#include "mamori/ports/posix_rt/real_time_rights.hpp"
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

}  // namespace mamori::timing

#endif  // MAMORI_TIMING_WRITE_RUN_HPP
