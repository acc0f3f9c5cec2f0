// SPDX-License-Identifier: Apache-2.0
/// @file
/// Tells when nobody ran on a processor: a thread above all others there that looks at the clock again and
/// again. What the machine does to a run is told apart from what the run does to itself.
#ifndef MAMORI_VERIFICATION_STALL_WATCH_HPP
#define MAMORI_VERIFICATION_STALL_WATCH_HPP

#include <atomic>
#include <thread>
#include <vector>

#include "mamori/ports/posix_rt/frame_clock.hpp"
#include "mamori/ports/posix_rt/real_time_rights.hpp"

namespace mamori::verification {

/// From one look at the clock to the next, much later one.
struct Stall {
    Instant begin{};
    Instant end{};
};

/// Whether a stall lies, in part, within the two instants. @param[in] stalls in the order of their instants.
bool overlaps(const std::vector<Stall>& stalls, Instant begin, Instant end);

/// The first processor that this process may use: threads whose stalls are watched must be on that of the
/// watch.
int find_processor() noexcept;

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

}  // namespace mamori::verification

#endif  // MAMORI_VERIFICATION_STALL_WATCH_HPP
