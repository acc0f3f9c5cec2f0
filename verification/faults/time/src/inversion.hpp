// SPDX-License-Identifier: Apache-2.0
/// @file
/// An attempt at priority inversion: a thread without priority holds a plain mutex. A thread of middle
/// priority keeps it from running while a component of high priority waits for the mutex.
#ifndef MAMORI_TIME_FAULTS_INVERSION_HPP
#define MAMORI_TIME_FAULTS_INVERSION_HPP

#include <semaphore.h>

#include <atomic>
#include <cstdint>
#include <mutex>
#include <thread>

#include "mamori/ports/posix_rt/frame_clock.hpp"

namespace mamori::time_faults {

/// Thread safety: prepare(), is_prepared() and attempt() from one thread; get_mutex() is for the component.
/// Memory:        two threads, all on one processor.
class Inversion final {
  public:
    /// @param[in] clock must outlive it. @param[in] priority of the middle thread: below that of the
    /// component.
    Inversion(const ports::posix_rt::FrameClock& clock, int priority, int processor);
    Inversion(const Inversion&) = delete;
    Inversion& operator=(const Inversion&) = delete;
    ~Inversion();

    /// The low thread takes the mutex as soon as it runs. Repeated calls have no effect.
    void prepare() noexcept;
    bool is_prepared() const noexcept { return is_held_.load(std::memory_order_acquire); }
    /// The low thread may release the mutex, but the middle thread computes until `end`.
    void attempt(Instant end) noexcept;

    /// A plain mutex, without priority inheritance. This is the fault.
    std::mutex& get_mutex() noexcept { return mutex_; }

  private:
    void hold() noexcept;
    void compute() noexcept;

    const ports::posix_rt::FrameClock& clock_;
    std::mutex mutex_;
    sem_t to_take_{};
    sem_t to_give_{};
    sem_t to_compute_{};
    std::atomic<std::int64_t> end_ns_{0};
    std::atomic<bool> is_held_{false};
    std::atomic<bool> is_ending_{false};
    bool is_asked_{false};
    std::thread low_;
    std::thread middle_;
};

}  // namespace mamori::time_faults

#endif  // MAMORI_TIME_FAULTS_INVERSION_HPP
