// SPDX-License-Identifier: Apache-2.0
/// @file
/// Records when no thread ran on a processor: a thread above all other threads there polls the clock. This
/// distinguishes host causes from the software under test.
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

/// A stall: from one poll of the clock to the next, much later one. A late poll: from its planned to its
/// actual instant.
struct Stall {
    Instant begin{};
    Instant end{};
};

/// Host activity during a run.
struct HostFigures {
    std::uint64_t stalls{0U};  ///< intervals between two polls longer than two steps
    Duration longest_stall{};
    Duration lost{};  ///< sum of the lateness of all polls
    std::uint64_t late_polls{0U};
    Duration run_delay{};        ///< the thread was ready but did not run (/proc/thread-self/schedstat)
    std::uint64_t steal_ms{0U};  ///< time that the hypervisor took (/proc/stat)
    std::uint64_t involuntary_switches{0U};  ///< of all threads of the process (getrusage)
};

/// Time lost between two instants: total length of the late polls in between.
/// @param[in] late_polls in the order of their instants.
Duration calc_loss(const std::vector<Stall>& late_polls, Instant begin, Instant end);

/// The first processor that this process may use. Threads whose stalls are recorded must run on the processor
/// of the polling thread.
int find_processor() noexcept;

/// Thread safety: every get_ function after stop(). Memory: heap, allocated in the constructor.
class StallWatch final {
  public:
    /// Polls every `step`; a gap longer than two steps is a stall.
    /// @param[in] late_poll_max capacity for polls that are late by half a step or more. Several in a row
    /// delay a window like a stall, although none of them is a stall.
    StallWatch(const ports::posix_rt::FrameClock& clock, Duration step, ports::posix_rt::ThreadPlace place,
               std::size_t late_poll_max = 0U);
    StallWatch(const StallWatch&) = delete;
    StallWatch& operator=(const StallWatch&) = delete;
    ~StallWatch() { stop(); }

    void stop();
    const std::vector<Stall>& get_stalls() const noexcept { return stalls_; }
    const std::vector<Stall>& get_late_polls() const noexcept { return late_polls_; }
    /// Figures of the time from the constructor to stop().
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
