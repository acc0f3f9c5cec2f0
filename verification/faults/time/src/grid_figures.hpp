// SPDX-License-Identifier: Apache-2.0
/// @file
/// What the rows of a grid say: whether it drifts, and how far a load shifts the start of its component. Pure
/// functions of what was written down.
#ifndef MAMORI_TIME_FAULTS_GRID_FIGURES_HPP
#define MAMORI_TIME_FAULTS_GRID_FIGURES_HPP

#include <cstdint>
#include <vector>

#include "grid.hpp"

namespace mamori::time_faults {

/// @return the middle one, the lower of two; 0 for none. @param[in] percent of the values that lie below, 0
/// .. 100.
std::int64_t calc_quantile(std::vector<std::int64_t> values, std::size_t percent = 50U);

/// A grid over a run [ns].
struct Drift {
    std::uint64_t frames{0U};
    /// Farthest that a planned instant lies from the first one plus a whole number of periods, and a frame
    /// that is missing counts as one period.
    std::int64_t planned_ns{0};
    std::int64_t first_median_ns{0};  ///< of the lateness of the wake-ups, in the first tenth of the frames
    std::int64_t last_median_ns{0};   ///< in the last tenth
    std::int64_t worst_ns{0};         ///< latest wake-up

    /// Nothing was planned off the grid, and wake-ups came no later at the end than at the begin, but for a
    /// tenth of the period: a grid that drifts is off by whole periods soon.
    bool is_steady() const noexcept {
        const std::int64_t shift = last_median_ns - first_median_ns;
        const std::int64_t limit = kGridPeriod.ns / 10;
        return planned_ns == 0 && shift <= limit && shift >= -limit;
    }
};
Drift calc_drift(const std::vector<GridRow>& rows);

/// Starts of one round [ns after the planned instant], with and without requests.
struct LoadRound {
    std::int64_t calm_ns{0};
    std::int64_t steady_ns{0};  ///< 1,000 requests per second
    std::int64_t burst_ns{0};   ///< as many, a hundred at a time
};

/// Shift of the median start, over rounds [ns].
struct Shift {
    std::int64_t median_ns{0};
    std::int64_t lowest_ns{0};
    std::int64_t highest_ns{0};

    /// Less than 1 % of the period, in either direction.
    bool is_small() const noexcept {
        return 100 * median_ns < kGridPeriod.ns && -100 * median_ns < kGridPeriod.ns;
    }
};
/// @return the middle of the differences within the rounds, never of times of different rounds.
/// @param[in] with the load to compare with `calm_ns`.
Shift calc_shift(const std::vector<LoadRound>& rounds, std::int64_t LoadRound::* with);

/// @return median time from the planned instant to the start of the component, over the frames in which it
/// ran [ns].
std::int64_t calc_median_start(const std::vector<GridRow>& rows);

}  // namespace mamori::time_faults

#endif  // MAMORI_TIME_FAULTS_GRID_FIGURES_HPP
