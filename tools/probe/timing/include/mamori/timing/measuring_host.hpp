// SPDX-License-Identifier: Apache-2.0
/// @file
/// Reads the clocks before and after each step of a platform host. Otherwise, windows, budgets and
/// consequences are those of the inner host.
///
/// @satisfies SWR-TIM-001, SWR-TIM-042      Design: docs/design/timing.md#log
#ifndef MAMORI_TIMING_MEASURING_HOST_HPP
#define MAMORI_TIMING_MEASURING_HOST_HPP

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "mamori/kernel/component/window_host.hpp"
#include "mamori/ports/posix_rt/core_runner.hpp"
#include "mamori/timing/run_log.hpp"

namespace mamori::timing {

/// Host and listener of one core. Each step needs two readings of the clock, and at its end one each of the
/// CPU time and of the switches of its thread.
///
/// Calling context: that of the inner host. Memory: heap, in the constructor.
class MeasuringHost final : public WindowHost, public ports::posix_rt::OpeningObserver {
  public:
    /// @param[in] inner, log must outlive this object; if work hangs, all three must exist permanently.
    /// @param[in] window_count of the system table.
    /// @param[in] next also called before and after every window; nullptr: none. Its time before a window
    /// counts as lateness of the window.
    /// @param[in] switches of the processor; nullptr: none.
    MeasuringHost(WindowHost& inner, RunLog& log, std::size_t window_count,
                  ports::posix_rt::OpeningObserver* next, SwitchLog* switches = nullptr)
        : inner_(inner),
          log_(log),
          next_(next),
          switches_(switches),
          pieces_(window_count),
          threads_(window_count) {}
    MeasuringHost(const MeasuringHost&) = delete;
    MeasuringHost& operator=(const MeasuringHost&) = delete;
    ~MeasuringHost() = default;

    Instant get_now() const noexcept override { return inner_.get_now(); }
    Instant get_step_end() const noexcept override { return inner_.get_step_end(); }
    std::size_t run_within(const Work& work, Instant deadline) noexcept override;
    bool has_returned(std::size_t window) const noexcept override { return inner_.has_returned(window); }

    void before_opening(const FrameSchedule::Opening& opening, Instant woke) noexcept override;
    void after_opening(const FrameSchedule::Opening& opening, WindowOutcome outcome) noexcept override;

    /// @param[in] get_state called after each window while no work is outstanding; must outlive this object.
    /// The other windows have no state.
    void set_state_source(const std::function<std::size_t()>& get_state) noexcept { get_state_ = &get_state; }
    /// Reads the switches after the last window, for work that returned later. Without a switch log: nothing.
    void finish() noexcept;
    /// @return thread of a window; 0: it has not worked yet.
    std::uint32_t get_thread(std::size_t window) const noexcept {
        return threads_[window].load(std::memory_order_relaxed);
    }

  private:
    static constexpr Instant kNever{std::numeric_limits<std::int64_t>::min() / 2};
    /// Work of one measured window; it is passed again only after it has returned.
    struct Piece {
        const WindowHost* clock{nullptr};
        Work work{};
        StepRow* rows{nullptr};
        std::atomic<std::uint32_t>* thread{nullptr};
    };
    static void measure(void* argument, std::size_t begin, std::size_t end) noexcept;
    bool is_near_event(Instant now) const noexcept;
    void note_switches(const FrameSchedule::Opening& opening) noexcept;
    bool has_work_out() const noexcept;

    WindowHost& inner_;
    RunLog& log_;
    ports::posix_rt::OpeningObserver* next_;
    SwitchLog* switches_;
    std::vector<Piece> pieces_;
    std::vector<std::atomic<std::uint32_t>> threads_;
    Instant event_{kNever};  ///< end of the last window that was late or overran
    OpeningRow current_{};
    Instant last_release_{kNever};        ///< of the window before
    std::int64_t cpu_ns_{kNoInstant.ns};  ///< of the runner after the last reading; kNoInstant.ns: none yet
    const std::function<std::size_t()>* get_state_{nullptr};
};

}  // namespace mamori::timing

#endif  // MAMORI_TIMING_MEASURING_HOST_HPP
