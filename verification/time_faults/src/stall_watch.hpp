// SPDX-License-Identifier: Apache-2.0
/// @file
/// Tells when nobody ran on a processor: a thread above all others there that looks at the clock again and
/// again. What the machine does to a run is told apart from what the run does to itself.
#ifndef MAMORI_TIME_FAULTS_STALL_WATCH_HPP
#define MAMORI_TIME_FAULTS_STALL_WATCH_HPP

#include <atomic>
#include <thread>
#include <vector>

#include "mamori/ports/posix_rt/frame_clock.hpp"
#include "mamori/ports/posix_rt/real_time_rights.hpp"
#include "stall.hpp"

namespace mamori::time_faults {

/// Thread safety: get_stalls() after stop(). Memory: heap, taken in the constructor.
class StallWatch final {
  public:
    /// Looks every `step`; a gap longer than two of them is a stall.
    StallWatch(const ports::posix_rt::FrameClock& clock, Duration step, ports::posix_rt::ThreadPlace place);
    StallWatch(const StallWatch&) = delete;
    StallWatch& operator=(const StallWatch&) = delete;
    ~StallWatch() { stop(); }

    void stop();
    const std::vector<Stall>& get_stalls() const noexcept { return stalls_; }

  private:
    void watch(Duration step, ports::posix_rt::ThreadPlace place);

    const ports::posix_rt::FrameClock& clock_;
    std::vector<Stall> stalls_;
    std::atomic<bool> is_ending_{false};
    std::thread thread_;
};

}  // namespace mamori::time_faults

#endif  // MAMORI_TIME_FAULTS_STALL_WATCH_HPP
