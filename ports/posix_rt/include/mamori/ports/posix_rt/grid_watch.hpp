// SPDX-License-Identifier: Apache-2.0
/// @file
/// A second pair of eyes: a thread that neither the runner nor its guard nor their timers can hold up, which
/// sees that a window did not open or was not over when it should, or that the clock runs at a wrong rate,
/// and closes the outputs.
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

/// What the runner of one core must have done next, and by when: an atomic instant that it moves on with each
/// opening and each end of a window. A background window may be later by its length without its budget: so
/// long may other windows preempt it and its runner.
///
/// Thread safety: get_due() from any thread; the rest from the thread that runs the windows, expect() and
///                rest() also before and after it does. Time: O(windows) per opening, no lock, no system
///                call.
class GridBeat final : public OpeningObserver {
  public:
    /// Nothing is due.
    static constexpr Instant kNever{std::numeric_limits<std::int64_t>::max()};

    /// @param[in] view of the system table; must outlive it. @param[in] core whose runner it listens to.
    /// @param[in] inner a further listener, which is called first, so that its time counts as the runner's;
    ///            nullptr: none.
    GridBeat(const SystemView& view, std::size_t core, OpeningObserver* inner = nullptr) noexcept
        : view_(view), core_(core), inner_(inner) {}
    GridBeat(const GridBeat&) = delete;
    GridBeat& operator=(const GridBeat&) = delete;
    ~GridBeat() = default;

    /// The first window at `from` or later must open in time. For a runner that may never come to its first
    /// one.
    void expect(Instant from) noexcept;
    /// Nothing is due until the next opening: the run is over, or stopped on purpose.
    void rest() noexcept { due_ns_.store(kNever.ns, std::memory_order_release); }
    Instant get_due() const noexcept { return Instant{due_ns_.load(std::memory_order_acquire)}; }

    /// The window must be over at its planned close.
    void before_opening(const FrameSchedule::Opening& opening, Instant woke) noexcept override;
    /// The next one must open at its planned instant.
    void after_opening(const FrameSchedule::Opening& opening, WindowOutcome outcome) noexcept override;

  private:
    SystemView view_;
    std::size_t core_;
    OpeningObserver* inner_;
    std::atomic<std::int64_t> due_ns_{kNever.ns};
};

enum class GridFault : std::uint8_t {
    kNone,
    kOverdue,    ///< a window did not open, or was not over, when it was due
    kFastClock,  ///< the clock of the frames runs too fast beside the reference
    kSlowClock   ///< too slow, or it stands still
};

/// What was found first.
struct GridFinding {
    GridFault fault{GridFault::kNone};
    std::size_t core{kNoIndex};  ///< of kOverdue: place of its beat
    Instant due{};               ///< of kOverdue
    Instant seen{};              ///< frame clock at the look that found it
};

struct GridLimits {
    /// From the instant at which something is due until it counts as overdue, >= 0.
    Duration lateness{};
    /// From one look to the next, > 0. What is overdue is found within `lateness` + `period` after it was
    /// due, and the wake-up of the watch.
    Duration period{};
    RateLimits rate{};
};

/// Judges, look by look. Pure but for what it remembers of the clocks.
///
/// Thread safety: none. Time: O(beats). Memory: refers to the beats.
class GridCheck final {
  public:
    /// @param[in] beats one per core that is watched; must outlive it. @param[in] limits in their ranges.
    GridCheck(Span<const GridBeat> beats, const GridLimits& limits) noexcept;

    /// @param[in] pair both clocks, read before this call: a beat that comes in between is in time.
    /// @return what is wrong, the rate of the clock first, since nothing else can be judged without it; or
    ///         kNone.
    GridFinding look(const ClockPair& pair) noexcept;
    /// Whole spans since the last finding, 0 when there was none yet.
    std::uint32_t get_sound_spans() const noexcept { return rate_.get_sound_spans(); }

  private:
    Span<const GridBeat> beats_;
    Duration lateness_;
    RateCheck rate_;
};

/// Closes the outputs of the application.
struct OutputGate {
    /// Called on the thread of the watch, once for each finding that is latched. Must not block: whoever it
    /// would wait for may be what hangs.
    void (*close)(void* argument) noexcept {nullptr};
    void* argument{nullptr};
};

/// The thread that looks. A finding is latched and closes the outputs once; only reset() ends that.
///
/// Thread safety: open(), close(), reset() and get_finding() from one thread; is_latched() and
///                get_look_count() from any.
/// Time:          one wake-up of its thread per period, O(beats) each; it takes no lock that anyone else has.
/// Memory:        none of its own but the thread's stack, taken in open().
class GridWatch final {
  public:
    /// @param[in] beats one per core; must outlive it. @param[in] clock of the frames; must outlive it.
    /// @param[in] reference must outlive it; whose rate `clock` should have. @param[in] gate with a function.
    /// @param[in] place priority above that of the runners, and where there is one, a processor of its own.
    GridWatch(Span<const GridBeat> beats, const FrameClock& clock, const ClockReading& reference,
              const GridLimits& limits, const OutputGate& gate, ThreadPlace place) noexcept;
    GridWatch(const GridWatch&) = delete;
    GridWatch& operator=(const GridWatch&) = delete;
    ~GridWatch() = default;

    /// Starts the thread. @return kOk; kPreconditionNotMet (open already); kOutOfResources (no more threads);
    ///         kBadParameter (the calling thread has a fixed priority that the watch is not above: the watch
    ///         could not run while this thread hangs).
    Status open() noexcept;
    /// Ends the thread within a period; a finding stays latched. Nothing happens when it is not open.
    void close() noexcept;

    bool is_latched() const noexcept { return is_latched_.load(std::memory_order_acquire); }
    /// @return the latched finding; kNone without one.
    GridFinding get_finding() const noexcept { return is_latched() ? finding_ : GridFinding{}; }
    /// Watches anew after a finding. Whether the outputs open again is the caller's decision.
    /// @return kOk; kPreconditionNotMet (nothing is latched, or something was wrong less than a whole span of
    ///         the rate limits ago).
    Status reset() noexcept;

    /// Looks so far; stands still when the watch itself does. For whoever services a hardware watchdog.
    std::uint64_t get_look_count() const noexcept { return look_count_.load(std::memory_order_relaxed); }
    /// Priority and processor of the thread, as open() got them.
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
    std::atomic<bool> is_sound_{false};  ///< of what is latched: nothing was wrong for a span
    std::atomic<bool> is_ending_{false};
    bool is_open_{false};
};

}  // namespace mamori::ports::posix_rt

#endif  // MAMORI_PORTS_POSIX_RT_GRID_WATCH_HPP
