// SPDX-License-Identifier: Apache-2.0
/// @file
/// Records when other programs used a processor: only windows at these times can be affected by them. The
/// evidence is the switch log of the timing report.
#ifndef MAMORI_VERIFICATION_OCCUPANCY_WATCH_HPP
#define MAMORI_VERIFICATION_OCCUPANCY_WATCH_HPP

#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>

#include "mamori/ports/posix_rt/frame_clock.hpp"
#include "mamori/timing/switch_log.hpp"
#include "mamori/verification/stall_watch.hpp"

namespace mamori::verification {

/// Thread safety: knows() from any thread, get_foreign() after stop(). Memory: heap, 64 MB of addresses
/// allocated in the constructor, so that it does not grow during a measurement.
class OccupancyWatch final {
  public:
    /// Starts immediately. @param[in] clock based on the monotonic clock of Linux; must outlive this object.
    /// @param[in] processor its number, 0, 1, ...
    OccupancyWatch(const ports::posix_rt::FrameClock& clock, int processor);
    OccupancyWatch(const OccupancyWatch&) = delete;
    OccupancyWatch& operator=(const OccupancyWatch&) = delete;
    ~OccupancyWatch() { stop(); }

    /// False if nothing is known: the kernel denies the events (root has them), it lost events, more occurred
    /// than the capacity, or this process is in a container and cannot see other programs.
    bool knows() const noexcept { return knows_.load(std::memory_order_relaxed); }
    /// Takes the remaining records and ends, within some milliseconds; a second call has no effect.
    void stop();
    /// Intervals from each context switch to a thread of another process or of the kernel, to the next
    /// switch, ordered by time.
    const std::vector<Stall>& get_foreign() const noexcept { return foreign_; }

  private:
    void follow();
    void take_slices();
    void take_batch();

    timing::SwitchLog log_{0U};
    std::vector<Stall> foreign_{};
    std::uint32_t own_;
    std::atomic<bool> knows_{false};
    std::atomic<bool> is_ending_{false};
    std::thread thread_{};
};

}  // namespace mamori::verification

#endif  // MAMORI_VERIFICATION_OCCUPANCY_WATCH_HPP
