// SPDX-License-Identifier: Apache-2.0
/// @file
/// Reads the clock before and after each step of a platform host. Otherwise, windows, budgets and
/// consequences are those of the inner host.
///
/// @satisfies SWR-TIM-001      Design: docs/design/timing.md#log
#ifndef MAMORI_TIMING_MEASURING_HOST_HPP
#define MAMORI_TIMING_MEASURING_HOST_HPP

#include <cstddef>
#include <vector>

#include "mamori/kernel/component/window_host.hpp"
#include "mamori/ports/posix_rt/core_runner.hpp"
#include "mamori/timing/run_log.hpp"

namespace mamori::timing {

/// Host and listener of one core. Each step needs two additional readings of the clock.
///
/// Calling context: that of the inner host. Memory: heap, in the constructor.
class MeasuringHost final : public WindowHost, public ports::posix_rt::OpeningObserver {
  public:
    /// @param[in] inner, log must outlive this object; if work hangs, all three must exist permanently.
    /// @param[in] window_count of the system table.
    /// @param[in] next also called before and after every window; nullptr: none. Its time before a window
    /// counts as lateness of the window.
    MeasuringHost(WindowHost& inner, RunLog& log, std::size_t window_count,
                  ports::posix_rt::OpeningObserver* next)
        : inner_(inner), log_(log), next_(next), pieces_(window_count) {}
    MeasuringHost(const MeasuringHost&) = delete;
    MeasuringHost& operator=(const MeasuringHost&) = delete;
    ~MeasuringHost() = default;

    Instant get_now() const noexcept override { return inner_.get_now(); }
    Instant get_step_end() const noexcept override { return inner_.get_step_end(); }
    std::size_t run_within(const Work& work, Instant deadline) noexcept override;
    bool has_returned(std::size_t window) const noexcept override { return inner_.has_returned(window); }

    void before_opening(const FrameSchedule::Opening& opening, Instant woke) noexcept override;
    void after_opening(const FrameSchedule::Opening& opening, WindowOutcome outcome) noexcept override;

  private:
    /// Work of one measured window; it is passed again only after it has returned.
    struct Piece {
        const WindowHost* clock{nullptr};
        Work work{};
        StepRow* rows{nullptr};
    };
    static void measure(void* argument, std::size_t begin, std::size_t end) noexcept;

    WindowHost& inner_;
    RunLog& log_;
    ports::posix_rt::OpeningObserver* next_;
    std::vector<Piece> pieces_;
    OpeningRow current_{};
};

}  // namespace mamori::timing

#endif  // MAMORI_TIMING_MEASURING_HOST_HPP
