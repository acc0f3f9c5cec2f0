// SPDX-License-Identifier: Apache-2.0
/// @file
/// A loop of 1 kHz and a background window of 50 ms on one core, with random execution times and caused
/// overruns: run in real time, compared with virtual time, and with the same loop alone.
#ifndef MAMORI_VERIFICATION_BACKGROUND_SYSTEM_HPP
#define MAMORI_VERIFICATION_BACKGROUND_SYSTEM_HPP

#include <cstdint>

namespace mamori::verification {

/// Result of one run in real time and of the same frames in virtual time.
struct BackgroundResult {
    bool has_run{false};        ///< both machines ended with kOk
    bool is_realtime{false};    ///< fixed priorities were granted
    bool are_equal{false};      ///< the trace hashes of both classes
    std::uint64_t caused{0U};   ///< overruns that the planner caused
    std::uint64_t counted{0U};  ///< overruns of the background window in the report of the machine
    std::uint64_t named{0U};    ///< calls of the observer that name the planner
    std::uint64_t other{0U};    ///< overruns and skipped windows of the loop, skipped background windows
    double lateness_us{0.0};    ///< 99th percentile of the start of the loop's component [us]
    double background_us{0.0};  ///< worst lateness of the background window [us]
};

/// @param[in] frames 1 .. 10'000, of 50 ms, after those of earlier calls. @param[in] processor of both
/// classes; -1: any.
BackgroundResult run_with_background(std::uint64_t frames, int processor);

/// Runs the loop alone. @return 99th percentile of the start of its component [us]; negative: no run.
double run_alone(std::uint64_t frames, int processor);

}  // namespace mamori::verification

#endif  // MAMORI_VERIFICATION_BACKGROUND_SYSTEM_HPP
