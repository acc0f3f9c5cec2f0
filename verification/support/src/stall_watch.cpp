// SPDX-License-Identifier: Apache-2.0
#include "mamori/verification/stall_watch.hpp"

#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <string>

namespace mamori::verification {
namespace {

/// Capacity for stalls of one run; later ones are not recorded.
constexpr std::size_t kRoom = 1'000'000U;

/// The first stall that ends at `begin` or later.
auto find_first(const std::vector<Stall>& stalls, Instant begin) {
    return std::lower_bound(stalls.begin(), stalls.end(), begin,
                            [](const Stall& stall, Instant at) { return stall.end < at; });
}

/// Time that the calling thread was ready but did not run; 0 if the kernel does not count it.
Duration read_run_delay() {
    std::ifstream file{"/proc/thread-self/schedstat"};
    std::int64_t ran = 0;
    std::int64_t waited = 0;
    file >> ran >> waited;
    return Duration{file ? waited : 0};
}

/// Time that the hypervisor took from all processors [ms]; 0 if the kernel does not count it.
std::uint64_t read_steal_ms() {
    constexpr int kStealColumn = 8;  // the label of the row is column 0
    constexpr std::uint64_t kMilliseconds = 1000U;
    std::ifstream file{"/proc/stat"};
    std::string field;
    for (int column = 0; column < kStealColumn; ++column) {
        file >> field;
    }
    std::uint64_t ticks = 0U;
    file >> ticks;
    return file ? ticks * kMilliseconds / static_cast<std::uint64_t>(::sysconf(_SC_CLK_TCK)) : 0U;
}

std::uint64_t read_involuntary_switches() {
    struct rusage usage{};
    return ::getrusage(RUSAGE_SELF, &usage) == 0 ? static_cast<std::uint64_t>(usage.ru_nivcsw) : 0U;
}

}  // namespace

Duration calc_loss(const std::vector<Stall>& late_polls, Instant begin, Instant end) {
    Duration loss{0};
    for (auto look = find_first(late_polls, begin); look != late_polls.end() && look->begin < end; ++look) {
        loss = loss + (std::min(look->end, end) - std::max(look->begin, begin));
    }
    return loss;
}

int find_processor() noexcept {
    cpu_set_t set;
    CPU_ZERO(&set);
    if (sched_getaffinity(0, sizeof(set), &set) == 0) {
        for (int processor = 0; processor < CPU_SETSIZE; ++processor) {
            if (CPU_ISSET(static_cast<std::size_t>(processor), &set)) {
                return processor;
            }
        }
    }
    return 0;
}

StallWatch::StallWatch(const ports::posix_rt::FrameClock& clock, Duration step,
                       ports::posix_rt::ThreadPlace place, std::size_t late_poll_max)
    : clock_(clock), late_poll_max_(late_poll_max) {
    stalls_.reserve(kRoom);
    late_polls_.reserve(late_poll_max);
    thread_ = std::thread{[this, step, place] { watch(step, place); }};
}

void StallWatch::stop() {
    is_ending_.store(true, std::memory_order_relaxed);
    if (thread_.joinable()) {
        thread_.join();
    }
}

void StallWatch::watch(Duration step, ports::posix_rt::ThreadPlace place) {
    static_cast<void>(ports::posix_rt::set_priority(pthread_self(), place.priority));
    static_cast<void>(ports::posix_rt::set_processor(pthread_self(), place.processor));
    const Duration half{step.ns / 2};
    const Duration run_delay = read_run_delay();
    const std::uint64_t steal_ms = read_steal_ms();
    const std::uint64_t switches = read_involuntary_switches();
    Instant before = clock_.get_now();
    while (!is_ending_.load(std::memory_order_relaxed)) {
        const Instant planned = before + step;
        clock_.wait_until(planned);
        const Instant now = clock_.get_now();
        if (now - before > step + step && stalls_.size() < kRoom) {
            stalls_.push_back({before, now});
            figures_.longest_stall = std::max(figures_.longest_stall, now - before);
        }
        if (now - planned >= half) {
            figures_.lost = figures_.lost + (now - planned);
            ++figures_.late_polls;
            if (late_polls_.size() < late_poll_max_) {
                late_polls_.push_back({planned, now});
            }
        }
        before = now;
    }
    figures_.stalls = stalls_.size();
    figures_.run_delay = read_run_delay() - run_delay;
    figures_.steal_ms = read_steal_ms() - steal_ms;
    figures_.involuntary_switches = read_involuntary_switches() - switches;
}

}  // namespace mamori::verification
