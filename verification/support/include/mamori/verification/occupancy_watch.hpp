// SPDX-License-Identifier: Apache-2.0
/// @file
/// Tells when other programs had a processor: what they can have moved in a run is told apart from what they
/// cannot. The kernel itself writes each exchange of threads down (perf_event_open).
#ifndef MAMORI_VERIFICATION_OCCUPANCY_WATCH_HPP
#define MAMORI_VERIFICATION_OCCUPANCY_WATCH_HPP

#include <sys/types.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <thread>
#include <vector>

#include "mamori/ports/posix_rt/frame_clock.hpp"
#include "mamori/verification/stall_watch.hpp"

namespace mamori::verification {

/// Thread safety: knows() from any thread, get_foreign() after stop(). Memory: heap, 64 MB of addresses taken
/// in the constructor, so that nothing grows beside what is measured.
class OccupancyWatch final {
  public:
    /// Begins at once. @param[in] clock of Linux's monotonic clock; must outlive this object.
    /// @param[in] processor its number, 0, 1, ...
    OccupancyWatch(const ports::posix_rt::FrameClock& clock, int processor);
    OccupancyWatch(const OccupancyWatch&) = delete;
    OccupancyWatch& operator=(const OccupancyWatch&) = delete;
    ~OccupancyWatch();

    /// False when nothing is known: the kernel refuses (it has no such events, or this process no right to
    /// those of a processor and to 4 MiB of locked memory: root has both), it lost some of what it wrote,
    /// more came than there is room for, or this process is in a container, from where other programs look
    /// like nobody.
    bool knows() const noexcept { return knows_.load(std::memory_order_relaxed); }
    /// Takes what is left and ends, within some milliseconds; once more does nothing.
    void stop();
    /// From each exchange that gave the processor to a thread of another process, one of the kernel included,
    /// to the next exchange; in the order of their instants. Until the first exchange that is seen another
    /// process counts as there.
    const std::vector<Stall>& get_foreign() const noexcept { return foreign_; }

  private:
    struct Record;
    void follow();
    void take_what_came();
    void take(const Record& record);
    void end_stretch(Instant at);

    const ports::posix_rt::FrameClock& clock_;
    std::vector<Stall> foreign_{};
    std::byte* ring_{nullptr};  ///< a page of the kernel's, and its records
    int descriptor_{-1};
    pid_t own_;
    std::atomic<bool> knows_{false};
    bool is_foreign_{true};
    Instant since_;
    std::atomic<bool> is_ending_{false};
    std::thread thread_{};
};

}  // namespace mamori::verification

#endif  // MAMORI_VERIFICATION_OCCUPANCY_WATCH_HPP
