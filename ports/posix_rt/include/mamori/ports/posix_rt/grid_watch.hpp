// SPDX-License-Identifier: Apache-2.0
/// @file
/// Independent schedule monitor. A thread that neither the runner nor its guard nor their timers can delay.
/// It closes the outputs if a window does not start or end in time, or if the rate of the clock is wrong.
///
/// @satisfies SWR-PRT-031, SWR-PRT-033, SWR-PRT-034, SWR-PRT-040, SWR-PRT-041, SWR-PRT-083
///     Design: docs/design/posix_rt.md#watch
#ifndef MAMORI_PORTS_POSIX_RT_GRID_WATCH_HPP
#define MAMORI_PORTS_POSIX_RT_GRID_WATCH_HPP

#include <pthread.h>

#include <atomic>
#include <cstdint>
#include <limits>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/status.hpp"
#include "mamori/kernel/run/frame_schedule.hpp"
#include "mamori/kernel/table/system_table.hpp"
#include "mamori/ports/posix_rt/core_runner.hpp"
#include "mamori/ports/posix_rt/frame_clock.hpp"
#include "mamori/ports/posix_rt/rate_check.hpp"
#include "mamori/ports/posix_rt/real_time_rights.hpp"
#include "mamori/ports/posix_rt/time_source.hpp"

namespace mamori::ports::posix_rt {

/// Due time of the next action of the runner of one core. The runner advances this atomic instant at each
/// start and end of a window. For a background window, the due time is later by the difference of its length
/// and its budget, because other windows can preempt it and its runner for this time.
///
/// Thread safety: get_due() from any thread; the rest from the thread that runs the windows, expect() and
///                rest() also before and after it runs them. Time: O(windows) per window instance, no lock,
///                no system call.
class GridBeat final : public OpeningObserver {
  public:
    /// Nothing is due.
    static constexpr Instant kNever{std::numeric_limits<std::int64_t>::max()};

    /// @param[in] view of the system table; must outlive it. @param[in] core core of the runner.
    /// @param[in] inner further observer, which is called first, so that its time counts as time of the
    ///            runner; nullptr: none.
    GridBeat(const SystemView& view, std::size_t core, OpeningObserver* inner = nullptr) noexcept
        : view_(view), core_(core), inner_(inner) {}
    GridBeat(const GridBeat&) = delete;
    GridBeat& operator=(const GridBeat&) = delete;
    ~GridBeat() = default;

    /// Requires that the first window at `from` or later starts in time. Detects a runner that never starts
    /// its first window.
    void expect(Instant from) noexcept;
    /// Nothing is due until the next window start: the run has ended, or was stopped deliberately.
    void rest() noexcept { due_ns_.store(kNever.ns, std::memory_order_release); }
    Instant get_due() const noexcept { return Instant{due_ns_.load(std::memory_order_acquire)}; }

    /// The due time becomes the planned end of the window.
    void before_opening(const FrameSchedule::Opening& opening, Instant woke) noexcept override;
    /// The due time becomes the planned start of the next window.
    void after_opening(const FrameSchedule::Opening& opening, WindowOutcome outcome) noexcept override;

  private:
    SystemView view_;
    std::size_t core_;
    OpeningObserver* inner_;
    std::atomic<std::int64_t> due_ns_{kNever.ns};
};

enum class GridFault : std::uint8_t {
    kNone,
    kOverdue,    ///< a window did not start or end in time
    kFastClock,  ///< the frame clock is too fast relative to the reference
    kSlowClock   ///< the frame clock is too slow, or stopped
};

/// The first violation found.
struct GridFinding {
    GridFault fault{GridFault::kNone};
    std::size_t core{kNoIndex};  ///< for kOverdue: index of the beat
    Instant due{};               ///< for kOverdue: due time
    Instant seen{};              ///< frame clock at the poll that found the violation
};

struct GridLimits {
    /// Permitted time after the due time, >= 0.
    Duration lateness{};
    /// Time between two polls, > 0. An overdue action is found within `lateness` + `period` + wake-up time of
    /// the watch after its due time.
    Duration period{};
    RateLimits rate{};
};

/// Evaluates beats and clocks at each poll. Its only state is that of the clock comparison.
///
/// Thread safety: none. Time: O(beats). Memory: refers to the beats.
class GridCheck final {
  public:
    /// @param[in] beats one per supervised core; must outlive it. @param[in] limits in their ranges.
    GridCheck(Span<const GridBeat> beats, const GridLimits& limits) noexcept;

    /// @param[in] pair both clocks, read before this call, so that a beat after the reading counts as in
    /// time.
    /// @return the violation, or kNone. A wrong clock rate has priority, because the other checks depend on
    ///         the clock.
    GridFinding look(const ClockPair& pair) noexcept;
    /// Complete spans since the last finding; 0 if there was no finding yet.
    std::uint32_t get_sound_spans() const noexcept { return rate_.get_sound_spans(); }

  private:
    Span<const GridBeat> beats_;
    Duration lateness_;
    RateCheck rate_;
};

/// Closes the outputs of the application.
struct OutputGate {
    /// Called on the thread of the watch, once per latched finding. Must not block: the thread that it waits
    /// for could be the hanging one.
    void (*close)(void* argument) noexcept {nullptr};
    void* argument{nullptr};
};

/// Thread that polls a GridCheck. A finding is latched and closes the outputs once. Only reset() clears it.
///
/// Thread safety: open(), close(), reset() and get_finding() from one thread; is_latched() and
///                get_look_count() from any.
/// Time:          one wake-up of its thread per period, O(beats) each; it shares no lock with other threads.
/// Memory:        only the stack of the thread, allocated in open().
class GridWatch final {
  public:
    /// @param[in] beats one per core; must outlive it. @param[in] clock of the frames; must outlive it.
    /// @param[in] reference clock with the correct rate; must outlive it.
    /// @param[in] gate `close` not nullptr.
    /// @param[in] place priority above that of the runners; preferably a separate processor.
    GridWatch(Span<const GridBeat> beats, const FrameClock& clock, const ClockReading& reference,
              const GridLimits& limits, const OutputGate& gate, ThreadPlace place) noexcept;
    GridWatch(const GridWatch&) = delete;
    GridWatch& operator=(const GridWatch&) = delete;
    ~GridWatch() = default;

    /// Starts the thread. @return kOk; kPreconditionNotMet (open already); kOutOfResources (no more threads);
    ///         kBadParameter (priority not above the fixed priority of the calling thread: the watch could
    ///         not run while this thread hangs).
    Status open() noexcept;
    /// Ends the thread within one period. A finding stays latched. If the watch is not open, the call has no
    /// effect.
    void close() noexcept;

    bool is_latched() const noexcept { return is_latched_.load(std::memory_order_acquire); }
    /// @return the latched finding; kNone without one.
    GridFinding get_finding() const noexcept { return is_latched() ? finding_ : GridFinding{}; }
    /// Clears the finding and resumes monitoring. The caller decides whether to open the outputs again.
    /// @return kOk; kPreconditionNotMet (no finding is latched, or the last violation is less than a complete
    ///         span of the rate limits ago).
    Status reset() noexcept;

    /// Polls so far. Stops increasing if the watch hangs: check it before the service of a hardware watchdog.
    std::uint64_t get_look_count() const noexcept { return look_count_.load(std::memory_order_relaxed); }
    /// Result of the request for priority and processor in open().
    Right get_right() const noexcept { return right_; }

  private:
    static void* serve(void* argument) noexcept;
    void watch() noexcept;
    void look() noexcept;

    const FrameClock& clock_;
    const ClockReading& reference_;
    Duration period_;
    OutputGate gate_;
    ThreadPlace place_;
    GridCheck check_;
    GridFinding finding_{};
    Right right_{};
    pthread_t thread_{};
    std::atomic<std::uint64_t> look_count_{0U};
    std::atomic<bool> is_latched_{false};
    std::atomic<bool> is_sound_{false};  ///< no violation for a span after the latched one
    std::atomic<bool> is_ending_{false};
    bool is_open_{false};
};

}  // namespace mamori::ports::posix_rt

#endif  // MAMORI_PORTS_POSIX_RT_GRID_WATCH_HPP
