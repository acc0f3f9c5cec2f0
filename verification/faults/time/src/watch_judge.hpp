// SPDX-License-Identifier: Apache-2.0
/// @file
/// Holds the findings of the grid watch against what the runner and the clock were made to do: each hang and
/// each wrong rate must have its finding in time, and each finding its reason. Pure functions of what was
/// written down.
#ifndef MAMORI_TIME_FAULTS_WATCH_JUDGE_HPP
#define MAMORI_TIME_FAULTS_WATCH_JUDGE_HPP

#include <cstdint>
#include <vector>

#include "mamori/kernel/base/time.hpp"
#include "mamori/ports/posix_rt/grid_watch.hpp"
#include "mamori/verification/stall_watch.hpp"

namespace mamori::time_faults {

using verification::calc_longest_loss;
using verification::calc_loss;
using verification::overlaps;
using verification::Stall;

/// The runner did not do what was due.
struct Hold {
    Instant due{};
    Instant end{};
};

/// The clock ran at a wrong rate.
struct ClockFault {
    Instant begin{};
    Instant end{};
    std::int64_t ppm{0};
};

/// A finding, latched until it was reset.
struct Found {
    ports::posix_rt::GridFinding finding{};
    Instant cleared{ports::posix_rt::GridBeat::kNever};
};

/// What was declared to the watch.
struct WatchBounds {
    Duration overdue{};  ///< from the instant that is due to the finding
    Duration rate{};     ///< from the first wrong rate to the finding
};

/// All lists in the order of their instants.
struct WatchCourse {
    std::vector<Hold> holds{};
    std::vector<ClockFault> clock_faults{};
    std::vector<Found> found{};
};

struct WatchVerdict {
    std::uint64_t holds{0U};
    std::uint64_t clock_faults{0U};
    std::uint64_t holds_seen{0U};
    std::uint64_t clock_faults_seen{0U};
    std::uint64_t masked{0U};         ///< while an earlier finding was still latched: nothing to be seen
    std::uint64_t misnamed{0U};       ///< found as something else
    std::uint64_t unseen{0U};         ///< not found
    std::uint64_t tardy{0U};          ///< found after its bound, while the machine ran
    std::uint64_t tardy_by_host{0U};  ///< likewise, while the machine stood still
    std::uint64_t invented{0U};       ///< found without a fault, while the machine ran
    std::uint64_t by_host{0U};        ///< found without a fault, while the machine stood still
    std::vector<std::int64_t> overdue_ns{};  ///< from the instant that was due to the finding
    std::vector<std::int64_t> rate_ns{};     ///< from the first wrong rate to the finding
    std::vector<ports::posix_rt::GridFinding> unexplained{};  ///< those that were invented

    bool is_well() const noexcept { return misnamed + unseen + tardy + invented == 0U; }
};

WatchVerdict judge_watch(const WatchBounds& bounds, const WatchCourse& course,
                         const std::vector<Stall>& stalls);

}  // namespace mamori::time_faults

#endif  // MAMORI_TIME_FAULTS_WATCH_JUDGE_HPP
