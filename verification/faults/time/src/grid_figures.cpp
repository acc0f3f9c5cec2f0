// SPDX-License-Identifier: Apache-2.0
#include "grid_figures.hpp"

#include <algorithm>
#include <cstdlib>

namespace mamori::time_faults {
namespace {

std::int64_t calc_median_lateness(const std::vector<GridRow>& rows, std::size_t first, std::size_t count) {
    std::vector<std::int64_t> lateness;
    for (std::size_t i = first; i < first + count; ++i) {
        lateness.push_back(rows[i].woke_ns - rows[i].planned_ns);
    }
    return calc_quantile(std::move(lateness));
}

}  // namespace

std::int64_t calc_quantile(std::vector<std::int64_t> values, std::size_t percent) {
    if (values.empty()) {
        return 0;
    }
    const auto place = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1U) * percent / 100U);
    std::nth_element(values.begin(), place, values.end());
    return *place;
}

Drift calc_drift(const std::vector<GridRow>& rows) {
    Drift drift;
    drift.frames = rows.size();
    for (std::size_t i = 0U; i < rows.size(); ++i) {
        const std::int64_t on_grid = rows[0].planned_ns + static_cast<std::int64_t>(i) * kGridPeriod.ns;
        drift.planned_ns = std::max(drift.planned_ns, std::abs(rows[i].planned_ns - on_grid));
        drift.worst_ns = std::max(drift.worst_ns, rows[i].woke_ns - rows[i].planned_ns);
    }
    const std::size_t tenth = (rows.size() + 9U) / 10U;
    drift.first_median_ns = calc_median_lateness(rows, 0U, tenth);
    drift.last_median_ns = calc_median_lateness(rows, rows.size() - tenth, tenth);
    return drift;
}

Shift calc_shift(const std::vector<LoadRound>& rounds, std::int64_t LoadRound::* with) {
    std::vector<std::int64_t> shifts;
    for (const LoadRound& round : rounds) {
        shifts.push_back(round.*with - round.calm_ns);
    }
    return {calc_quantile(shifts), calc_quantile(shifts, 0U), calc_quantile(shifts, 100U)};
}

std::int64_t calc_median_start(const std::vector<GridRow>& rows) {
    std::vector<std::int64_t> starts;
    for (const GridRow& row : rows) {
        if (row.started_ns != 0) {
            starts.push_back(row.started_ns - row.planned_ns);
        }
    }
    return calc_quantile(std::move(starts));
}

}  // namespace mamori::time_faults
