// SPDX-License-Identifier: Apache-2.0
#include "mamori/verification/occupancy_watch.hpp"

#include <unistd.h>

#include <array>
#include <chrono>
#include <cstring>

namespace mamori::verification {
namespace {

using timing::Slice;

/// Capacity for intervals: more than a busy processor produces in half an hour.
constexpr std::size_t kIntervalMax = 4'000'000U;
/// Of 4 KiB: capacity for 65,536 switches, one second of a busy processor.
constexpr std::size_t kPages = 1024U;
constexpr std::chrono::milliseconds kPause{5};

/// In a PID namespace other than the first, the kernel reports all outside processes as 0, like an idle
/// processor.
bool is_in_first_name_space() noexcept {
    std::array<char, 32U> name{};
    return ::readlink("/proc/self/ns/pid", name.data(), name.size() - 1U) > 0 &&
           std::strcmp(name.data(), "pid:[4026531836]") == 0;
}

}  // namespace

OccupancyWatch::OccupancyWatch(const ports::posix_rt::FrameClock& clock, int processor)
    : own_(static_cast<std::uint32_t>(::getpid())) {
    if (!is_in_first_name_space() || !log_.open(processor, clock, kPages).is_granted) {
        return;
    }
    foreign_.reserve(kIntervalMax);
    knows_.store(true, std::memory_order_relaxed);
    thread_ = std::thread{[this] { follow(); }};
}

void OccupancyWatch::stop() {
    is_ending_.store(true, std::memory_order_relaxed);
    if (thread_.joinable()) {
        thread_.join();
        take_slices();
    }
}

void OccupancyWatch::follow() {
    while (!is_ending_.load(std::memory_order_relaxed)) {
        std::this_thread::sleep_for(kPause);
        take_slices();
    }
}

void OccupancyWatch::take_slices() {
    do {
        log_.read(timing::SwitchLog::kBatch);
        take_batch();
    } while (!log_.get_batch().empty());
    if (log_.get_lost_count() != 0U) {
        knows_.store(false, std::memory_order_relaxed);
    }
}

void OccupancyWatch::take_batch() {
    for (const Slice& slice : log_.get_batch()) {
        if (slice.process == 0U || slice.process == own_) {
            continue;  // the idle thread, or this program
        }
        if (foreign_.size() == kIntervalMax) {
            knows_.store(false, std::memory_order_relaxed);
            return;
        }
        foreign_.push_back({slice.begin, slice.end});
    }
}

}  // namespace mamori::verification
