// SPDX-License-Identifier: Apache-2.0
#include "mamori/verification/stall_watch.hpp"

#include <sched.h>

#include <algorithm>

namespace mamori::verification {
namespace {

/// More stalls than this in one run: the machine is of no use, and the last ones are not kept.
constexpr std::size_t kRoom = 1'000'000U;

/// The first stall that ends at `begin` or later.
auto find_first(const std::vector<Stall>& stalls, Instant begin) {
    return std::lower_bound(stalls.begin(), stalls.end(), begin,
                            [](const Stall& stall, Instant at) { return stall.end < at; });
}

}  // namespace

bool overlaps(const std::vector<Stall>& stalls, Instant begin, Instant end) {
    const auto first = find_first(stalls, begin);
    return first != stalls.end() && first->begin <= end;
}

Duration calc_loss(const std::vector<Stall>& late_looks, Instant begin, Instant end) {
    Duration loss{0};
    for (auto look = find_first(late_looks, begin); look != late_looks.end() && look->begin < end; ++look) {
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
                       ports::posix_rt::ThreadPlace place, std::size_t late_look_max)
    : clock_(clock), late_look_max_(late_look_max) {
    stalls_.reserve(kRoom);
    late_looks_.reserve(late_look_max);
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
    Instant before = clock_.get_now();
    while (!is_ending_.load(std::memory_order_relaxed)) {
        const Instant planned = before + step;
        clock_.wait_until(planned);
        const Instant now = clock_.get_now();
        if (now - before > step + step && stalls_.size() < kRoom) {
            stalls_.push_back({before, now});
        }
        if (now - planned >= half && late_looks_.size() < late_look_max_) {
            late_looks_.push_back({planned, now});
        }
        before = now;
    }
}

}  // namespace mamori::verification
