// SPDX-License-Identifier: Apache-2.0
/// @file
/// The monotonic clock of Linux with injected faults: it runs too fast or too slow, a sleep ends late, a
/// deadline comes late.
#ifndef MAMORI_TIME_FAULTS_FAULTY_TIME_HPP
#define MAMORI_TIME_FAULTS_FAULTY_TIME_HPP

#include <pthread.h>

#include <atomic>
#include <cstdint>
#include <vector>

#include "mamori/kernel/base/time.hpp"
#include "mamori/ports/posix_rt/time_source.hpp"

namespace mamori::time_faults {

/// The shown time never steps: a change of rate changes only its slope.
///
/// Thread safety: reading and waiting from any thread; faults only from the thread that set_victim() names.
/// Memory:        heap, allocated in the constructor.
class FaultyTime final : public ports::posix_rt::TimeSource {
  public:
    /// @param[in] change_max maximum number of calls of set_rate().
    explicit FaultyTime(std::size_t change_max);

    std::int64_t read_ns() const noexcept override;
    void wait_until(std::int64_t ns) const noexcept override;
    std::int64_t to_monotonic(std::int64_t ns) const noexcept override;

    /// The thread that timer faults affect. Call before that thread uses the clock.
    void set_victim(pthread_t thread) noexcept { victim_ = thread; }
    /// @param[in] ppm deviation from the true rate [1e-6], above -1,000,000; 0: correct clock.
    void set_rate(std::int64_t ppm) noexcept;
    /// The next sleep of the victim ends later by `size`. @param[in] size 0: cancels the fault.
    void hold_sleep(Duration size) noexcept { sleep_hold_ns_.store(size.ns, std::memory_order_relaxed); }
    bool is_sleep_to_be_held() const noexcept { return sleep_hold_ns_.load(std::memory_order_relaxed) != 0; }
    /// The next deadline of a system call of the victim comes later by `size`.
    void hold_deadline(Duration size) noexcept {
        deadline_hold_ns_.store(size.ns, std::memory_order_relaxed);
    }

  private:
    /// A section of the line, from `real_ns` on.
    struct Piece {
        std::int64_t real_ns{0};
        std::int64_t shown_ns{0};
        std::int64_t ppm{0};
    };
    const Piece& get_piece() const noexcept { return pieces_[last_.load(std::memory_order_acquire)]; }
    std::int64_t to_real(std::int64_t ns) const noexcept;
    bool is_victim() const noexcept { return pthread_equal(pthread_self(), victim_) != 0; }

    std::vector<Piece> pieces_;  ///< sections up to last_ never change again
    std::atomic<std::size_t> last_{0U};
    pthread_t victim_{pthread_self()};
    mutable std::atomic<std::int64_t> sleep_hold_ns_{0};
    mutable std::atomic<std::int64_t> deadline_hold_ns_{0};
};

}  // namespace mamori::time_faults

#endif  // MAMORI_TIME_FAULTS_FAULTY_TIME_HPP
