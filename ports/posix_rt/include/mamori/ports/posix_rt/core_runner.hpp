// SPDX-License-Identifier: Apache-2.0
/// @file
/// Runs the windows of one core in real time: each opens at its place on the fixed grid of the frame.
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

/// What became of the openings so far.
struct OpeningCounts {
    std::uint64_t opened{0U};    ///< all of them
    std::uint64_t overran{0U};   ///< WindowOutcome::kOverrun
    std::uint64_t missed{0U};    ///< WindowOutcome::kMissed
    Duration worst_lateness{0};  ///< from the planned instant to the first reading of the clock after it
};

/// Listens to a runner, opening by opening: devices that are sampled before a window, a log of its times.
///
/// Calling context: the thread that runs the windows, when nothing of the core's windows is under way but
/// work that was cut off. Implementations must not block; their time delays what comes after.
class OpeningObserver {
  public:
    /// The runner is awake and has read the clock. @param[in] woke first reading of the clock after the
    /// sleep.
    virtual void before_opening(const FrameSchedule::Opening& opening, Instant woke) noexcept = 0;
    /// The window is over, or did not open.
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

    /// @param[in] observer must outlive the runner or be replaced; nullptr: none. Not while run() is under
    /// way.
    void set_observer(OpeningObserver* observer) noexcept { observer_ = observer; }

    /// Opens every window whose place lies in the next `frame_count` frames, from the first frame on that
    /// begins now or later; returns after the last, or soon after request_stop(). Sleeps in between. An
    /// opening that comes late moves no later one: its instants are those of the grid.
    /// A table with a connection between two cores and without publication_margin(...) is a contract
    /// violation: in real time, execution times would decide which values the reader receives.
    /// @param[in] frame_count > 0, any. The time line ends after 292 years, and every run ends with it.
    void run(std::uint64_t frame_count) noexcept { run(frame_count, clock_.get_now()); }
    /// The same from the first frame on that begins at `from` or later. A frame that has begun is late.
    void run(std::uint64_t frame_count, Instant from) noexcept;
    /// The same without an end of its own: returns after request_stop().
    void run_until_stopped() noexcept { run(kAllFrames); }

    /// No window starts once the current one has ended, in this run and in later ones. The run returns when
    /// the start of the next window is due. One store to a lock-free word: async-signal-safe.
    void request_stop() noexcept { request_stop_at(Instant{std::numeric_limits<std::int64_t>::min()}); }
    /// The same for windows whose planned start is at `instant` or later; earlier ones still start.
    void request_stop_at(Instant instant) noexcept { stop_ns_.store(instant.ns, std::memory_order_relaxed); }
    /// Takes back a stop that was requested. Not while run() is under way.
    void resume() noexcept { stop_ns_.store(kNoStop, std::memory_order_relaxed); }

    /// Of all calls of run() so far. To be asked while none is under way.
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
