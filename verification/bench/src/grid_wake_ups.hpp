// SPDX-License-Identifier: Apache-2.0
/// @file
/// Wake-ups of the real-time port on a schedule of 1 kHz: the time from each planned instant to the first
/// reading of the clock. The result is a distribution, so it is measured separately from the batches of the
/// other cases.
///
/// @satisfies SWR-BEN-009      Design: docs/design/bench.md#grid
#ifndef MAMORI_VERIFICATION_BENCH_GRID_WAKE_UPS_HPP
#define MAMORI_VERIFICATION_BENCH_GRID_WAKE_UPS_HPP

#include <cstdint>
#include <vector>

namespace mamori::verification::bench {

/// How the runner wakes up.
struct GridRequest {
    std::uint32_t cycles{0U};  ///< > 0
    int priority{80};          ///< of SCHED_FIFO, 2 .. 99
    int processor{0};
};

/// Runs a system with one window and one idle component, all on one processor, in locked memory. Call once
/// per process.
/// @return lateness of each wake-up [ns], in the order of the cycles.
/// @throw std::runtime_error with the reason if the host denies the priority or the processor.
std::vector<std::int64_t> measure_grid(const GridRequest& request);

}  // namespace mamori::verification::bench

#endif  // MAMORI_VERIFICATION_BENCH_GRID_WAKE_UPS_HPP
