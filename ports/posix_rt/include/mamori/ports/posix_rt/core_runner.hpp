// SPDX-License-Identifier: Apache-2.0
/// @file
/// Runs the windows of one core in real time. Each window starts at its planned instant of the schedule.
///
/// @satisfies SWR-PRT-005, SWR-PRT-006, SWR-PRT-007, SWR-PRT-038, SWR-PRT-043, SWR-PRT-047
///     Design: docs/design/posix_rt.md#grid
#ifndef MAMORI_PORTS_POSIX_RT_CORE_RUNNER_HPP
#define MAMORI_PORTS_POSIX_RT_CORE_RUNNER_HPP

#include <atomic>
#include <cstdint>
#include <limits>

#include "mamori/kernel/component/window_host.hpp"
#include "mamori/kernel/run/executive.hpp"
#include "mamori/kernel/run/frame_schedule.hpp"
#include "mamori/ports/posix_rt/frame_clock.hpp"

namespace mamori::ports::posix_rt {

/// Window instances so far, by outcome.
struct OpeningCounts {
    std::uint64_t opened{0U};    ///< all window instances
    std::uint64_t overran{0U};   ///< WindowOutcome::kOverrun
    std::uint64_t missed{0U};    ///< WindowOutcome::kMissed
    Duration worst_lateness{0};  ///< from the planned instant to the first reading of the clock after it
};

/// Receives a call before and after each window instance, for example to sample devices or to log times.
///
/// Calling context: the thread that runs the windows. No window of the core runs then, except work that was
/// aborted. Implementations must not block: their time delays the window and the windows after it.
class OpeningObserver {
  public:
    /// Called before the window starts. @param[in] woke first reading of the clock after the sleep.
    virtual void before_opening(const FrameSchedule::Opening& opening, Instant woke) noexcept = 0;
    /// Called after the window has ended or was skipped.
    virtual void after_opening(const FrameSchedule::Opening& opening, WindowOutcome outcome) noexcept = 0;

  protected:
    ~OpeningObserver() = default;
};

/// Whether the table states a publication margin, if it has a connection between two cores. A connection
/// without windows is rejected by initialize().
constexpr bool has_publication_margin(const SystemView& view) noexcept {
    bool leaves_core = false;
    for (const ConnectionRow& row : view.connections) {
        const bool is_joined = row.source_window != kNoIndex && row.sink_window != kNoIndex;
        leaves_core = leaves_core || (is_joined && view.windows[row.source_window].core !=
                                                       view.windows[row.sink_window].core);
    }
    return !leaves_core || view.publication_margin > Duration{0};
}

/// Thread safety: request_stop() from any thread or signal handler; the rest from the thread that runs the
///                windows, whose priority must be higher than that of the host's threads.
/// Memory:        none of its own; all references must outlive it.
class CoreRunner final {
  public:
    CoreRunner(Executive& executive, WindowHost& host, const FrameClock& clock) noexcept
        : executive_(executive), host_(host), clock_(clock) {}
    CoreRunner(const CoreRunner&) = delete;
    CoreRunner& operator=(const CoreRunner&) = delete;

    /// @param[in] observer must outlive the runner or be replaced; nullptr: none. Do not call while run()
    /// runs.
    void set_observer(OpeningObserver* observer) noexcept { observer_ = observer; }

    /// Runs all windows of the next `frame_count` major frames. The first major frame is the first one that
    /// begins now or later. Returns after the last window, or soon after request_stop(). Sleeps between
    /// windows. A late window does not shift later windows: the schedule fixes their instants. A table with a
    /// connection between two cores and without publication_margin(...) is a contract violation: in real
    /// time, execution times would decide which values the reader receives.
    /// @param[in] frame_count > 0. Each run ends at the end of the time line (292 years).
    void run(std::uint64_t frame_count) noexcept { run(frame_count, clock_.get_now()); }
    /// Like run(frame_count), but the first major frame is the first one that begins at `from` or later. If
    /// it has already begun, its windows are late.
    void run(std::uint64_t frame_count, Instant from) noexcept;
    /// Like run(frame_count), but returns only after request_stop().
    void run_until_stopped() noexcept { run(kAllFrames); }

    /// After the current window has ended, no window starts, neither in this run nor in later runs. run()
    /// returns when the start of the next window is due. One store to a lock-free variable:
    /// async-signal-safe.
    void request_stop() noexcept { request_stop_at(Instant{std::numeric_limits<std::int64_t>::min()}); }
    /// Prevents the start of windows whose planned start is at `instant` or later. Earlier windows still
    /// start.
    void request_stop_at(Instant instant) noexcept { stop_ns_.store(instant.ns, std::memory_order_relaxed); }
    /// Cancels a requested stop. Do not call while run() runs.
    void resume() noexcept { stop_ns_.store(kNoStop, std::memory_order_relaxed); }

    /// Counts over all calls of run(). Do not call while run() runs.
    const OpeningCounts& get_counts() const noexcept { return counts_; }

  private:
    static constexpr std::uint64_t kAllFrames = std::numeric_limits<std::uint64_t>::max();
    static constexpr std::int64_t kNoStop = std::numeric_limits<std::int64_t>::max();
    static_assert(std::atomic<std::int64_t>::is_always_lock_free);

    bool is_stopped_before(Instant release) const noexcept {
        return release.ns >= stop_ns_.load(std::memory_order_relaxed);
    }
    void open(const FrameSchedule::Opening& opening) noexcept;

    Executive& executive_;
    WindowHost& host_;
    const FrameClock& clock_;
    OpeningObserver* observer_{nullptr};
    OpeningCounts counts_{};
    std::atomic<std::int64_t> stop_ns_{kNoStop};
};

}  // namespace mamori::ports::posix_rt

#endif  // MAMORI_PORTS_POSIX_RT_CORE_RUNNER_HPP
