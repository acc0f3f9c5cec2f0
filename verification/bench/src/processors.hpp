// SPDX-License-Identifier: Apache-2.0
/// @file
/// Keeps the threads of a benchmark on chosen processors.
#ifndef MAMORI_VERIFICATION_BENCH_PROCESSORS_HPP
#define MAMORI_VERIFICATION_BENCH_PROCESSORS_HPP

#include <pthread.h>
#include <sched.h>

#include <stdexcept>

namespace mamori::verification::bench {

/// Restricts `thread` to one processor.
inline void pin(pthread_t thread, int processor) {
    cpu_set_t set;
    CPU_ZERO(&set);
    CPU_SET(static_cast<unsigned>(processor), &set);
    if (pthread_setaffinity_np(thread, sizeof set, &set) != 0) {
        throw std::runtime_error("a thread could not be kept on one processor");
    }
}

/// Restores the processors of the calling thread at the end of a scope.
class KeptAffinity final {
  public:
    KeptAffinity() noexcept { sched_getaffinity(0, sizeof own_, &own_); }
    ~KeptAffinity() { sched_setaffinity(0, sizeof own_, &own_); }
    KeptAffinity(const KeptAffinity&) = delete;
    KeptAffinity& operator=(const KeptAffinity&) = delete;

    /// @return first processor >= `least` that the calling thread may use; CPU_SETSIZE if there is none.
    int find_processor(int least) const noexcept {
        while (least < CPU_SETSIZE && CPU_ISSET(static_cast<unsigned>(least), &own_) == 0) {
            ++least;
        }
        return least;
    }

  private:
    cpu_set_t own_{};
};

}  // namespace mamori::verification::bench

#endif  // MAMORI_VERIFICATION_BENCH_PROCESSORS_HPP
