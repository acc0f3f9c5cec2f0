// SPDX-License-Identifier: Apache-2.0
#include "mamori/verification/occupancy_watch.hpp"

#include <linux/perf_event.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstring>
#include <ctime>

namespace mamori::verification {
namespace {

/// [bytes] Two records of 32 bytes for each context switch: capacity for 65,536 switches, one second of a
/// busy processor. The ring is emptied every few milliseconds.
constexpr std::size_t kRingSize = std::size_t{4U} << 20U;
/// Capacity for intervals: more than a busy processor produces in half an hour.
constexpr std::size_t kStretchMax = 4'000'000U;
constexpr std::chrono::milliseconds kPause{5};

std::size_t get_page_size() noexcept {
    return static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

/// @return a descriptor; -1 if denied.
int open_exchanges(int processor) noexcept {
    perf_event_attr what{};
    what.size = sizeof(what);
    what.type = PERF_TYPE_SOFTWARE;
    what.config = PERF_COUNT_SW_DUMMY;
    what.read_format = PERF_FORMAT_LOST;
    what.sample_type = PERF_SAMPLE_TID | PERF_SAMPLE_TIME;
    what.sample_id_all = 1U;
    what.context_switch = 1U;
    what.use_clockid = 1U;
    what.clockid = CLOCK_MONOTONIC;
    return static_cast<int>(::syscall(SYS_perf_event_open, &what, -1, processor, -1, PERF_FLAG_FD_CLOEXEC));
}

/// In a PID namespace other than the first, the kernel reports all outside processes as 0, like an idle
/// processor.
bool is_in_first_name_space() noexcept {
    std::array<char, 32U> name{};
    return ::readlink("/proc/self/ns/pid", name.data(), name.size() - 1U) > 0 &&
           std::strcmp(name.data(), "pid:[4026531836]") == 0;
}

/// @return true if the kernel lost no record.
bool has_lost_nothing(int descriptor) noexcept {
    std::array<std::uint64_t, 2U> value_and_lost{};
    return ::read(descriptor, value_and_lost.data(), sizeof(value_and_lost)) == sizeof(value_and_lost) &&
           value_and_lost[1U] == 0U;
}

}  // namespace

/// Record of a context switch on a complete processor, in the format of the kernel, with the requested
/// samples.
struct OccupancyWatch::Record {
    perf_event_header header;
    std::uint32_t other_process;
    std::uint32_t other_thread;
    std::uint32_t process;
    std::uint32_t thread;
    std::uint64_t time_ns;
};

OccupancyWatch::OccupancyWatch(const ports::posix_rt::FrameClock& clock, int processor)
    : clock_(clock), own_(::getpid()), since_(clock.get_now()) {
    if (!is_in_first_name_space()) {
        return;
    }
    descriptor_ = open_exchanges(processor);
    if (descriptor_ < 0) {
        return;
    }
    void* const memory =
        ::mmap(nullptr, get_page_size() + kRingSize, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor_, 0);
    if (memory == MAP_FAILED) {
        return;
    }
    ring_ = static_cast<std::byte*>(memory);
    foreign_.reserve(kStretchMax);
    knows_.store(true, std::memory_order_relaxed);
    thread_ = std::thread{[this] { follow(); }};
}

OccupancyWatch::~OccupancyWatch() {
    stop();
    if (ring_ != nullptr) {
        static_cast<void>(::munmap(ring_, get_page_size() + kRingSize));
    }
    if (descriptor_ >= 0) {
        static_cast<void>(::close(descriptor_));
    }
}

void OccupancyWatch::stop() {
    is_ending_.store(true, std::memory_order_relaxed);
    if (thread_.joinable()) {
        thread_.join();
        static_cast<void>(::ioctl(descriptor_, PERF_EVENT_IOC_DISABLE, 0));
        take_what_came();
        end_stretch(clock_.get_now());
        if (!has_lost_nothing(descriptor_)) {
            knows_.store(false, std::memory_order_relaxed);
        }
    }
}

void OccupancyWatch::follow() {
    while (!is_ending_.load(std::memory_order_relaxed)) {
        std::this_thread::sleep_for(kPause);
        take_what_came();
    }
}

void OccupancyWatch::take_what_came() {
    auto& page = *reinterpret_cast<perf_event_mmap_page*>(ring_);
    const std::byte* const records = ring_ + page.data_offset;
    const std::uint64_t head = __atomic_load_n(&page.data_head, __ATOMIC_ACQUIRE);
    std::uint64_t tail = page.data_tail;
    while (tail < head) {
        Record record{};
        // A record may continue from the end of the ring to its beginning, in pieces of 8 bytes.
        for (std::size_t at = 0U; at < sizeof(record); at += sizeof(std::uint64_t)) {
            std::memcpy(reinterpret_cast<std::byte*>(&record) + at, records + (tail + at) % kRingSize,
                        sizeof(std::uint64_t));
        }
        if (record.header.type == PERF_RECORD_SWITCH_CPU_WIDE) {
            take(record);
        }
        tail += record.header.size;
    }
    __atomic_store_n(&page.data_tail, tail, __ATOMIC_RELEASE);
}

void OccupancyWatch::take(const Record& record) {
    const Instant at{static_cast<std::int64_t>(record.time_ns) - clock_.get_epoch_ns()};
    end_stretch(at);
    const bool is_coming = (record.header.misc & PERF_RECORD_MISC_SWITCH_OUT) == 0U;
    // 0 is the idle processor.
    is_foreign_ = is_coming && record.process != 0U && record.process != static_cast<std::uint32_t>(own_);
    since_ = at;
}

void OccupancyWatch::end_stretch(Instant at) {
    if (!is_foreign_) {
        return;
    }
    is_foreign_ = false;
    if (foreign_.size() == kStretchMax) {
        knows_.store(false, std::memory_order_relaxed);
        return;
    }
    foreign_.push_back({since_, at});
}

}  // namespace mamori::verification
