// SPDX-License-Identifier: Apache-2.0
/// @file
/// Records of a real-time run: each window instance and each step of a component, with its instants. All
/// memory is allocated before the run, so that a record costs two readings of the clock and a few stores.
///
/// @satisfies SWR-TIM-001, SWR-TIM-042      Design: docs/design/timing.md#log
#ifndef MAMORI_TIMING_RUN_LOG_HPP
#define MAMORI_TIMING_RUN_LOG_HPP

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "mamori/kernel/base/time.hpp"
#include "mamori/kernel/run/executive.hpp"
#include "mamori/timing/switch_log.hpp"

namespace mamori::timing {

/// Represents an instant that did not occur.
inline constexpr Instant kNoInstant{-1};

/// State of a system that does not report its state.
inline constexpr std::uint32_t kNoState = 0xFFFFFFFFU;

/// One window instance.
struct OpeningRow {
    Instant release{};  ///< planned
    Instant woke{};     ///< reading of the clock when the window was ready
    Instant closed{};   ///< window end
    std::size_t window{0U};
    WindowOutcome outcome{WindowOutcome::kCompleted};
    std::uint32_t state{kNoState};  ///< of the system after the window, index in TimingOptions::states
    ProcessorUse use{};             ///< from the planned instant to the end; 0 without a switch log
    Duration reading{0};            ///< from `closed` until the switches had been read
    // CPU time of the thread that runs the windows; kNoInstant.ns: not known.
    std::int64_t runner_cpu_ns{kNoInstant.ns};   ///< from the end of the reading before to `closed`
    std::int64_t reading_cpu_ns{kNoInstant.ns};  ///< during `reading`
};

/// One step of a component. The thread that does the work writes `start` and `end`, possibly long after the
/// window was aborted.
struct StepRow {
    Instant release{};  ///< of its window instance
    std::size_t component{0U};
    WindowHost::Pass pass{WindowHost::Pass::kExecute};
    std::atomic<std::int64_t> start_ns{kNoInstant.ns};  ///< kNoInstant: the step did not begin
    std::atomic<std::int64_t> end_ns{kNoInstant.ns};    ///< kNoInstant: the step has not returned
    // Of the thread during the step, written before `end_ns`. The waits between steps do not count.
    std::int64_t cpu_ns{0};
    std::uint32_t voluntary{0U};    ///< switches because the step waited
    std::uint32_t involuntary{0U};  ///< switches because another thread ran instead
};

/// Rows of one core.
///
/// Thread safety: the thread that runs the windows calls add_opening() and take_steps(); the thread that does
/// a step writes the other fields of its row; reading is permitted after the run. Memory: heap, all allocated
/// and touched in the constructor.
class RunLog final {
  public:
    /// @param[in] opening_count, step_count capacities; further rows are counted and lost.
    RunLog(std::size_t opening_count, std::size_t step_count)
        : openings_(opening_count), steps_(step_count) {}

    void add_opening(const OpeningRow& row) noexcept;
    /// Allocates rows for one piece of work: one row for `component` and for each following component.
    /// @return the first of `count` rows; nullptr if the capacity is exhausted.
    StepRow* take_steps(Instant release, std::size_t component, std::size_t count,
                        WindowHost::Pass pass) noexcept;

    Span<const OpeningRow> get_openings() const noexcept { return {openings_.data(), opening_count_}; }
    Span<const StepRow> get_steps() const noexcept { return {steps_.data(), step_count_}; }
    /// Number of rows that exceeded the capacity.
    std::uint64_t get_lost_count() const noexcept { return lost_count_; }

  private:
    std::vector<OpeningRow> openings_;
    std::vector<StepRow> steps_;
    std::size_t opening_count_{0U};
    std::size_t step_count_{0U};
    std::uint64_t lost_count_{0U};
};

}  // namespace mamori::timing

#endif  // MAMORI_TIMING_RUN_LOG_HPP
