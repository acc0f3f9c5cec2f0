// SPDX-License-Identifier: Apache-2.0
/// @file
/// Records when other programs had a processor, and so which windows they cannot have moved. The Linux kernel
/// writes each context switch (perf_event_open).
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
/// in the constructor, so that nothing grows during a measurement.
class OccupancyWatch final {
  public:
    /// Begins immediately. @param[in] clock of Linux's monotonic clock; must outlive this object.
    /// @param[in] processor its number, 0, 1, ...
    OccupancyWatch(const ports::posix_rt::FrameClock& clock, int processor);
    OccupancyWatch(const OccupancyWatch&) = delete;
    OccupancyWatch& operator=(const OccupancyWatch&) = delete;
    ~OccupancyWatch();

    /// False when nothing is known: the kernel denies the events (root has them, and the 4 MiB of locked
    /// memory), it lost some, more came than the capacity, or this process is in a container and cannot see
    /// other programs.
    bool knows() const noexcept { return knows_.load(std::memory_order_relaxed); }
    /// Takes the remaining records and ends, within some milliseconds; a second call does nothing.
    void stop();
    /// From each context switch to a thread of another process or of the kernel, to the next switch; in the
    /// order of their instants. Before the first recorded switch another process counts as running.
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
