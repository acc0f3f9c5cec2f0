// SPDX-License-Identifier: Apache-2.0
/// @file
/// Runs each step of selected cycles inside one function with a fixed name, so that a tool that counts per
/// function (callgrind) can separate the steps. Also reads the clock before and after each step, for a run
/// without the tool.
///
/// @satisfies SWR-TIM-030      Design: docs/design/cost.md#counting
#ifndef MAMORI_TIMING_COUNTING_HOST_HPP
#define MAMORI_TIMING_COUNTING_HOST_HPP

#include <cstddef>
#include <cstdint>
#include <vector>

#include "mamori/kernel/component/window_host.hpp"
#include "mamori/kernel/table/system_table.hpp"
#include "mamori/ports/posix_rt/frame_clock.hpp"
#include "mamori/timing/run_log.hpp"

/// The function that the tool counts; C linkage keeps its name. Runs step `step`, and always adds the same
/// few instructions.
extern "C" void mamori_counted_step(void (*run)(void* argument, std::size_t begin, std::size_t end) noexcept,
                                    void* argument, std::size_t step) noexcept;

namespace mamori::timing {

/// The counted major frames: `first`, `first + every`, ... The others run without counting.
struct CountedCycles {
    std::uint64_t first{0U};
    std::uint64_t every{1U};  ///< > 0

    constexpr bool has(std::uint64_t cycle) const noexcept {
        return cycle >= first && (cycle - first) % every == 0U;
    }
};

/// Platform host of one core in virtual time; forwards all calls to the inner host.
///
/// Calling context: that of the inner host, whose work runs and returns on the calling thread. Memory: heap,
/// in the constructor.
class CountingHost final : public WindowHost {
  public:
    /// @param[in] inner, log, clock, view must outlive it. The time line of `inner` begins with frame 0.
    /// @param[in] log receives a row for each counted step, in execution order.
    /// @param[in] clock reads the instants of the rows.
    /// @param[in] is_paced work waits until the clock reaches the time of `inner`: the run is then in real
    /// time, with the inputs of virtual time.
    CountingHost(WindowHost& inner, RunLog& log, const SystemView& view, CountedCycles cycles,
                 const ports::posix_rt::FrameClock& clock, bool is_paced)
        : inner_(inner),
          log_(log),
          view_(view),
          cycles_(cycles),
          clock_(clock),
          is_paced_(is_paced),
          pieces_(view.windows.size()) {}
    CountingHost(const CountingHost&) = delete;
    CountingHost& operator=(const CountingHost&) = delete;
    ~CountingHost() = default;

    Instant get_now() const noexcept override { return inner_.get_now(); }
    Instant get_step_end() const noexcept override { return inner_.get_step_end(); }
    std::size_t run_within(const Work& work, Instant deadline) noexcept override;
    bool has_returned(std::size_t window) const noexcept override { return inner_.has_returned(window); }

  private:
    /// Work of one counted window.
    struct Piece {
        const ports::posix_rt::FrameClock* clock{nullptr};
        Work work{};
        StepRow* rows{nullptr};
    };
    static void count(void* argument, std::size_t begin, std::size_t end) noexcept;

    WindowHost& inner_;
    RunLog& log_;
    const SystemView& view_;
    CountedCycles cycles_;
    const ports::posix_rt::FrameClock& clock_;
    bool is_paced_;
    std::vector<Piece> pieces_;
};

}  // namespace mamori::timing

#endif  // MAMORI_TIMING_COUNTING_HOST_HPP
