// SPDX-License-Identifier: Apache-2.0
/// @file
/// Part of an executive that runs one window instance under its budget. Not for users.
///
/// @satisfies SWR-KRN-021, SWR-KRN-022, SWR-KRN-023, SWR-KRN-032, SWR-KRN-033, SWR-KRN-034, SWR-KRN-041
/// Design:   docs/design/kernel.md#parts-of-the-executive, docs/design/kernel.md#windows
#ifndef MAMORI_KERNEL_WINDOW_RUNNER_HPP
#define MAMORI_KERNEL_WINDOW_RUNNER_HPP

#include <cstddef>

#include "mamori/kernel/run/detail/core_state.hpp"
#include "mamori/kernel/run/detail/data_flow.hpp"
#include "mamori/kernel/run/detail/mode_follower.hpp"
#include "mamori/kernel/run/window_outcome.hpp"

namespace mamori::detail {

/// Thread safety: as Executive.
/// Time:          O(components + connections + ports) of the window. Nothing blocks beyond actions and
///                platform host.
/// Memory:        that of ModeFollower.
class WindowRunner final {
  public:
    constexpr WindowRunner(const CoreState& core, SystemModes* modes) noexcept : modes_(core, modes) {}
    WindowRunner(const WindowRunner&) = delete;
    WindowRunner& operator=(const WindowRunner&) = delete;

    ModeFollower& get_modes() noexcept { return modes_; }
    const ModeFollower& get_modes() const noexcept { return modes_; }
    DataFlow& get_data_flow() noexcept { return modes_.get_data_flow(); }
    CoreState& get_core() noexcept { return modes_.get_core(); }

    /// Chooses the first pass of each window. Call again after a change of the observer or introspection.
    void prepare_work() noexcept;

    /// Runs one instance of the window of a running context. The core state has the planned start.
    /// @param[in] start measured start of the window instance.
    [[gnu::always_inline]] WindowOutcome open(const WindowRow& row, WindowState& state, Instant start,
                                              WindowHost& host) noexcept;

    /// Readmits a window whose work was aborted once this work has returned, and discards what it wrote.
    /// @return whether the context is idle.
    bool readmit(WindowState& state) noexcept;

  private:
    bool may_open(WindowState& state, Instant start, WindowHost& host) noexcept;
    void begin_cycle(const WindowRow& row, WindowState& state, Instant start, Instant deadline,
                     WindowHost& host) noexcept;
    std::size_t end_cycle(const WindowRow& row, WindowState& state, std::size_t executed_count,
                          Instant deadline, WindowHost& host) noexcept;
    void show_steps(const WindowState& state, std::size_t executed_count) noexcept;
    void end_overrun(WindowState& state, std::size_t component, WindowHost& host) noexcept;
    void report_overrun(std::size_t window, std::size_t component, Instant now) noexcept;
    void stop_late(WindowState& state, Instant start, WindowHost& host) noexcept;
    static void stop_steps(void* argument, std::size_t first, std::size_t end) noexcept;

    ModeFollower modes_;
};

// open() runs in each window instance and has one caller: inlined, it costs no memory and fewer instructions.
inline WindowOutcome WindowRunner::open(const WindowRow& row, WindowState& state, Instant start,
                                        WindowHost& host) noexcept {
    const CoreState& core = get_core();
    const Instant release = core.release;
    if (core.observer != nullptr && start > release) {
        core.observer->on_late_release(state.get_window(), start - release, start);
    }
    state.release = release;
    if ((state.context.is_busy() || state.is_stop_due) && !may_open(state, start, host)) {
        return state.context.is_running() ? WindowOutcome::kOverrun : WindowOutcome::kStopped;
    }
    // A window that starts late keeps its budget, but not beyond its planned end.
    const Instant end = release + row.length;
    if (start > end) {
        return WindowOutcome::kMissed;
    }
    const Instant deadline = start + row.budget < end ? start + row.budget : end;
    std::size_t responsible = kNoIndex;
    if (modes_.is_used()) {
        responsible = modes_.open_window(state, deadline, host);
    }
    const bool is_due = responsible == kNoIndex && state.context.take_turn();
    if (is_due) {
        begin_cycle(row, state, start, deadline, host);
        const std::size_t executed_count = host.run_within(state.first_pass, deadline);
        responsible = end_cycle(row, state, executed_count, deadline, host);
    }
    if (modes_.is_used() && responsible == kNoIndex) {
        responsible = modes_.close_window(state, deadline, host);
    }
    if (responsible != kNoIndex) {
        end_overrun(state, responsible, host);
        return WindowOutcome::kOverrun;
    }
    if (!is_due) {
        return WindowOutcome::kNotDue;
    }
    if (row.has_outputs) {
        get_data_flow().publish_outputs(row, state.held_modes, end);
    }
    return WindowOutcome::kCompleted;
}

/// The part of a cycle before its first pass.
inline void WindowRunner::begin_cycle(const WindowRow& row, WindowState& state, Instant start,
                                      Instant deadline, WindowHost& host) noexcept {
    const CoreState& core = get_core();
    const Status begun = state.context.begin_cycle(core.release);
    MAMORI_INVARIANT(1, begun == Status::kOk);
    if (row.latch_count != 0U) {
        get_data_flow().latch_inputs(row, state.held_modes);
    }
    if (state.is_observed) {
        const Instant last_step_end = modes_.get_last_step_end();
        state.step_observer.host = &host;
        state.step_observer.deadline = deadline;
        state.step_observer.step_start = last_step_end > start ? last_step_end : start;
    }
}

/// The part of a cycle after its first pass, of which `executed_count` components completed.
/// @return the component that exhausted the budget; kNoIndex: the cycle is complete.
inline std::size_t WindowRunner::end_cycle(const WindowRow& row, WindowState& state,
                                           std::size_t executed_count, Instant deadline,
                                           WindowHost& host) noexcept {
    std::size_t finished_count = executed_count;
    if (row.has_second_pass && executed_count == row.component_count) {
        finished_count =
            host.run_within({get_core().parts.second_pass, &state.context, state.get_window(),
                             row.first_component, 0U, row.component_count, WindowHost::Pass::kStateUpdate},
                            deadline);
    }
    const bool is_complete = finished_count == row.component_count;
    if (is_complete) {
        state.context.end_cycle();
    } else {
        state.context.abandon(finished_count);
    }
    if (row.latch_count != 0U) {
        get_data_flow().mark_inputs_read(row, state.context, executed_count);
    }
    if (get_core().introspection != nullptr) {
        show_steps(state, executed_count);
    }
    return is_complete ? kNoIndex : row.first_component + finished_count;
}

}  // namespace mamori::detail

#endif  // MAMORI_KERNEL_WINDOW_RUNNER_HPP
