// SPDX-License-Identifier: Apache-2.0
/// @file
/// Linux's monotonic clock with the faults that a clock can have: it runs too fast or too slow, a sleep does
/// not end in time, a deadline does not come in time.
#ifndef MAMORI_TIME_FAULTS_FAULTY_TIME_HPP
#define MAMORI_TIME_FAULTS_FAULTY_TIME_HPP

#include <pthread.h>

#include <atomic>
#include <cstdint>
#include <vector>

#include "mamori/kernel/base/time.hpp"
#include "mamori/ports/posix_rt/time_source.hpp"

namespace mamori::time_faults {

/// What it shows never steps: a change of rate bends the line.
///
/// Thread safety: reading and waiting from any thread; the faults from one, which set_victim() names.
/// Memory:        heap, taken in the constructor.
class FaultyTime final : public ports::posix_rt::TimeSource {
  public:
    /// @param[in] change_max how often set_rate() will be called.
    explicit FaultyTime(std::size_t change_max);

    std::int64_t read_ns() const noexcept override;
    void wait_until(std::int64_t ns) const noexcept override;
    std::int64_t to_monotonic(std::int64_t ns) const noexcept override;

    /// The thread that the faults of timers meet. To be called before it uses the clock.
    void set_victim(pthread_t thread) noexcept { victim_ = thread; }
    /// @param[in] ppm beyond the true rate [1e-6], above -1,000,000; 0: the clock is right.
    void set_rate(std::int64_t ppm) noexcept;
    /// The next sleep of the victim ends so much later. @param[in] size 0: in time after all.
    void hold_sleep(Duration size) noexcept { sleep_hold_ns_.store(size.ns, std::memory_order_relaxed); }
    bool is_sleep_to_be_held() const noexcept { return sleep_hold_ns_.load(std::memory_order_relaxed) != 0; }
    /// The next deadline of a system call of the victim comes so much later.
    void hold_deadline(Duration size) noexcept {
        deadline_hold_ns_.store(size.ns, std::memory_order_relaxed);
    }

  private:
    /// A piece of the line, from `real_ns` on.
    struct Piece {
        std::int64_t real_ns{0};
        std::int64_t shown_ns{0};
        std::int64_t ppm{0};
    };
    const Piece& get_piece() const noexcept { return pieces_[last_.load(std::memory_order_acquire)]; }
    std::int64_t to_real(std::int64_t ns) const noexcept;
    bool is_victim() const noexcept { return pthread_equal(pthread_self(), victim_) != 0; }

    std::vector<Piece> pieces_;  ///< those up to last_ never change again
    std::atomic<std::size_t> last_{0U};
    pthread_t victim_{pthread_self()};
    mutable std::atomic<std::int64_t> sleep_hold_ns_{0};
    mutable std::atomic<std::int64_t> deadline_hold_ns_{0};
};

}  // namespace mamori::time_faults

#endif  // MAMORI_TIME_FAULTS_FAULTY_TIME_HPP
