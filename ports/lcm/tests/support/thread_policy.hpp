// SPDX-License-Identifier: Apache-2.0
// Scheduling of the other threads of this process, which a transport and liblcm started.
#ifndef MAMORI_PORTS_LCM_THREAD_POLICY_HPP
#define MAMORI_PORTS_LCM_THREAD_POLICY_HPP

#include <sched.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <filesystem>
#include <string>

namespace lcm_sample {

/// Gives the calling thread a real-time priority until the end of the scope.
class RealTimeScope final {
  public:
    RealTimeScope() {
        const sched_param priority{10};
        is_granted_ = ::sched_setscheduler(0, SCHED_FIFO, &priority) == 0;
    }
    RealTimeScope(const RealTimeScope&) = delete;
    RealTimeScope& operator=(const RealTimeScope&) = delete;
    ~RealTimeScope() {
        const sched_param priority{};
        static_cast<void>(::sched_setscheduler(0, SCHED_OTHER, &priority));
    }
    bool is_granted() const { return is_granted_; }

  private:
    bool is_granted_{false};
};

struct OtherThreads {
    int count{0};
    int real_time{0};
};
inline OtherThreads count_other_threads() {
    OtherThreads threads{};
    for (const auto& entry : std::filesystem::directory_iterator("/proc/self/task")) {
        const pid_t id = std::stoi(entry.path().filename().string());
        if (id != static_cast<pid_t>(::syscall(SYS_gettid))) {
            ++threads.count;
            threads.real_time += ::sched_getscheduler(id) == SCHED_OTHER ? 0 : 1;
        }
    }
    return threads;
}

}  // namespace lcm_sample

#endif  // MAMORI_PORTS_LCM_THREAD_POLICY_HPP
