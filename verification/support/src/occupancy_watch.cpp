// SPDX-License-Identifier: Apache-2.0
#include "mamori/verification/occupancy_watch.hpp"

#include <linux/perf_event.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <chrono>
#include <cstring>
#include <ctime>

namespace mamori::verification {
namespace {

/// Room for more than a second of exchanges at 60,000 in one; it is emptied every few milliseconds.
constexpr std::size_t kRingSize = std::size_t{4U} << 20U;
constexpr std::chrono::milliseconds kPause{5};

std::size_t get_page_size() noexcept {
    return static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

/// @return a descriptor; -1: refused.
int open_exchanges(int processor) noexcept {
    perf_event_attr what{};
    what.size = sizeof(what);
    what.type = PERF_TYPE_SOFTWARE;
    what.config = PERF_COUNT_SW_DUMMY;
    what.sample_type = PERF_SAMPLE_TID | PERF_SAMPLE_TIME;
    what.sample_id_all = 1U;
    what.context_switch = 1U;
    what.use_clockid = 1U;
    what.clockid = CLOCK_MONOTONIC;
    return static_cast<int>(::syscall(SYS_perf_event_open, &what, -1, processor, -1, PERF_FLAG_FD_CLOEXEC));
}

}  // namespace

/// As the kernel writes an exchange of threads of a whole processor, with the samples asked for.
struct OccupancyWatch::Record {
    perf_event_header header;
    std::uint32_t other_process;
    std::uint32_t other_thread;
    std::uint32_t process;
    std::uint32_t thread;
    std::uint64_t time_ns;
};

OccupancyWatch::OccupancyWatch(const ports::posix_rt::FrameClock& clock, int processor)
    : clock_(clock), descriptor_(open_exchanges(processor)), own_(::getpid()) {
    if (descriptor_ < 0) {
        return;
    }
    void* const memory =
        ::mmap(nullptr, get_page_size() + kRingSize, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor_, 0);
    if (memory == MAP_FAILED) {
        return;
    }
    ring_ = static_cast<std::byte*>(memory);
    knows_ = true;
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
        take_what_came();
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
        // A record may begin at the end of the ring and go on at its beginning, in pieces of 8 bytes.
        for (std::size_t at = 0U; at < sizeof(record); at += sizeof(std::uint64_t)) {
            std::memcpy(reinterpret_cast<std::byte*>(&record) + at, records + (tail + at) % kRingSize,
                        sizeof(std::uint64_t));
        }
        if (record.header.type == PERF_RECORD_SWITCH_CPU_WIDE) {
            take(record);
        } else if (record.header.type == PERF_RECORD_LOST) {
            knows_ = false;
        }
        tail += record.header.size;
    }
    __atomic_store_n(&page.data_tail, tail, __ATOMIC_RELEASE);
}

void OccupancyWatch::take(const Record& record) {
    const Instant at{static_cast<std::int64_t>(record.time_ns) - clock_.get_epoch_ns()};
    if (is_foreign_) {
        foreign_.push_back({since_, at});
    }
    const bool is_coming = (record.header.misc & PERF_RECORD_MISC_SWITCH_OUT) == 0U;
    // 0 is the processor at rest.
    is_foreign_ = is_coming && record.process != 0U && record.process != static_cast<std::uint32_t>(own_);
    since_ = at;
}

}  // namespace mamori::verification
