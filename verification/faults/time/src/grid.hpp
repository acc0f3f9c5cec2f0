// SPDX-License-Identifier: Apache-2.0
/// @file
/// A system with one window of 1 kHz that runs by the clock and writes down, frame by frame, when its window
/// was planned, when its runner woke and when its component began. Drift, and what a load from outside does
/// to the start, are figured from such rows.
#ifndef MAMORI_TIME_FAULTS_GRID_HPP
#define MAMORI_TIME_FAULTS_GRID_HPP

#include <cstdint>
#include <vector>

#include "mamori/kernel/base/time.hpp"
#include "mamori/kernel/run/introspection.hpp"

namespace mamori::time_faults {

inline constexpr Duration kGridPeriod{1'000'000};

/// One frame. Instants of CLOCK_MONOTONIC [ns].
struct GridRow {
    std::int64_t planned_ns{0};
    std::int64_t woke_ns{0};     ///< first reading of the clock after the sleep of the runner
    std::int64_t started_ns{0};  ///< begin of the component; 0: it did not run in this frame
};

/// The system, once per process. Calling context: one thread, which gets a fixed priority and one processor.
class Grid final {
  public:
    /// Asks for the rights and starts the threads. @return kOk; or what the host or the executive refused.
    Status open();
    /// Runs the next `frame_count` frames. @return one row for each, in their order.
    std::vector<GridRow> run(std::uint64_t frame_count);
    void close();

    /// What tools may look at, in any thread.
    const Introspection& get_introspection() const noexcept;
    /// Whether a fixed priority and a processor were granted to all threads of the system.
    bool has_priority() const noexcept { return has_priority_; }

  private:
    bool has_priority_{false};
};

}  // namespace mamori::time_faults

#endif  // MAMORI_TIME_FAULTS_GRID_HPP
