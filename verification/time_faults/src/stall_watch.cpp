// SPDX-License-Identifier: Apache-2.0
#include "stall_watch.hpp"

namespace mamori::time_faults {
namespace {

/// More stalls than this in one run: the machine is of no use, and the last ones are not kept.
constexpr std::size_t kRoom = 1'000'000U;

}  // namespace

StallWatch::StallWatch(const ports::posix_rt::FrameClock& clock, Duration step,
                       ports::posix_rt::ThreadPlace place)
    : clock_(clock) {
    stalls_.reserve(kRoom);
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
    Instant before = clock_.get_now();
    while (!is_ending_.load(std::memory_order_relaxed)) {
        clock_.wait_until(before + step);
        const Instant now = clock_.get_now();
        if (now - before > step + step && stalls_.size() < kRoom) {
            stalls_.push_back({before, now});
        }
        before = now;
    }
}

}  // namespace mamori::time_faults
