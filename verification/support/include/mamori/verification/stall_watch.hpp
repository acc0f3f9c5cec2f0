// SPDX-License-Identifier: Apache-2.0
/// @file
/// Records when no thread ran on a processor: a thread above all others there polls the clock. Host causes
/// are thus distinguished from the software under test.
#ifndef MAMORI_VERIFICATION_STALL_WATCH_HPP
#define MAMORI_VERIFICATION_STALL_WATCH_HPP

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <thread>
#include <vector>

#include "mamori/ports/posix_rt/frame_clock.hpp"
#include "mamori/ports/posix_rt/real_time_rights.hpp"

namespace mamori::verification {

/// From one poll of the clock to the next, much later one; for a late poll, from its planned instant to its
/// actual one.
struct Stall {
    Instant begin{};
    Instant end{};
};

/// What the host did during a run.
struct HostFigures {
    std::uint64_t stalls{0U};  ///< the watch was away for longer than two of its steps
    Duration longest_stall{};
    Duration lost{};  ///< sum of what the polls of the watch were late by
    std::uint64_t late_polls{0U};
    Duration run_delay{};        ///< the watch was ready and did not run (/proc/thread-self/schedstat)
    std::uint64_t steal_ms{0U};  ///< time that the hypervisor took (/proc/stat)
    std::uint64_t involuntary_switches{0U};  ///< of all threads of the process (getrusage)
};

/// Time lost between two instants: the sum of the parts of late polls within.
/// @param[in] late_polls in the order of their instants.
Duration calc_loss(const std::vector<Stall>& late_polls, Instant begin, Instant end);

/// The first processor that this process may use: threads whose stalls are watched must be on that of the
/// watch.
int find_processor() noexcept;

/// Thread safety: every get_ function after stop(). Memory: heap, taken in the constructor.
class StallWatch final {
  public:
    /// Polls every `step`; a gap longer than two steps is a stall.
    /// @param[in] late_poll_max capacity for polls that are late by half a step or more: several in a row
    /// delay
    ///                          a window like a stall, and none of them is one.
    StallWatch(const ports::posix_rt::FrameClock& clock, Duration step, ports::posix_rt::ThreadPlace place,
               std::size_t late_poll_max = 0U);
    StallWatch(const StallWatch&) = delete;
    StallWatch& operator=(const StallWatch&) = delete;
    ~StallWatch() { stop(); }

    void stop();
    const std::vector<Stall>& get_stalls() const noexcept { return stalls_; }
    const std::vector<Stall>& get_late_polls() const noexcept { return late_polls_; }
    /// Of the time from the constructor to stop().
    const HostFigures& get_figures() const noexcept { return figures_; }

  private:
    void watch(Duration step, ports::posix_rt::ThreadPlace place);

    const ports::posix_rt::FrameClock& clock_;
    std::vector<Stall> stalls_;
    std::vector<Stall> late_polls_;
    std::size_t late_poll_max_;
    HostFigures figures_{};
    std::atomic<bool> is_ending_{false};
    std::thread thread_;
};

}  // namespace mamori::verification

#endif  // MAMORI_VERIFICATION_STALL_WATCH_HPP
