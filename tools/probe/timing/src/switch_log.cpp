// SPDX-License-Identifier: Apache-2.0
#include "mamori/timing/switch_log.hpp"

#include <linux/perf_event.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

namespace mamori::timing {
namespace {

using ports::posix_rt::FrameClock;
using ports::posix_rt::Right;

/// Linux reads the rest of the structure as "not requested".
perf_event_attr make_request() noexcept {
    perf_event_attr request{};
    request.size = sizeof request;
    request.type = PERF_TYPE_SOFTWARE;
    request.config = PERF_COUNT_SW_DUMMY;
    request.sample_type = PERF_SAMPLE_TID | PERF_SAMPLE_TIME;
    request.sample_id_all = 1U;
    request.context_switch = 1U;
    request.use_clockid = 1U;
    request.clockid = CLOCK_MONOTONIC;
    return request;
}

std::size_t get_page_size() noexcept {
    return static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

}  // namespace

SwitchLog::SwitchLog(std::size_t capacity, std::size_t batch) : kept_(capacity) {
    batch_.slices.resize(batch);
    previous_.slices.resize(batch);
}

SwitchLog::~SwitchLog() {
    if (ring_ != nullptr) {
        static_cast<void>(munmap(ring_, ring_size_));
        static_cast<void>(close(file_));
    }
}

Right SwitchLog::open(int processor, const FrameClock& clock, std::size_t page_max) noexcept {
    perf_event_attr request = make_request();
    last_ = clock.get_now();
    const long file = syscall(SYS_perf_event_open, &request, -1, processor, -1, PERF_FLAG_FD_CLOEXEC);
    if (file < 0) {
        return {false, errno};
    }
    int refusal = 0;
    for (std::size_t pages = page_max; pages >= kPageMin; pages /= 2U) {
        ring_size_ = (pages + 1U) * get_page_size();
        void* const ring =
            mmap(nullptr, ring_size_, PROT_READ | PROT_WRITE, MAP_SHARED, static_cast<int>(file), 0);
        if (ring != MAP_FAILED) {
            ring_ = ring;
            data_ = static_cast<const char*>(ring) + get_page_size();
            data_mask_ = pages * get_page_size() - 1U;
            file_ = static_cast<int>(file);
            epoch_ns_ = clock.get_epoch_ns();
            process_ = static_cast<std::uint32_t>(getpid());
            return {true, 0};
        }
        refusal = errno;
    }
    static_cast<void>(close(static_cast<int>(file)));
    return {false, refusal};
}

void SwitchLog::take_runner() noexcept {
    runner_ = static_cast<std::uint32_t>(gettid());
}

void SwitchLog::read(std::size_t record_max) noexcept {
    std::swap(batch_.slices, previous_.slices);
    previous_.count = batch_.count;
    previous_.is_stored = batch_.is_stored;
    batch_.count = 0U;
    batch_.is_stored = false;
    if (ring_ == nullptr) {
        return;
    }
    auto& page = *static_cast<perf_event_mmap_page*>(ring_);
    const std::uint64_t head = __atomic_load_n(&page.data_head, __ATOMIC_ACQUIRE);
    std::uint64_t position = page.data_tail;
    for (std::size_t i = 0U; i < record_max && position < head; ++i) {
        const std::uint64_t word = load_word(position);
        perf_event_header header{};
        std::memcpy(&header, &word, sizeof header);
        if (header.size < sizeof header) {
            position = head;  // not a record: the rest cannot be read
            has_gap_ = true;
            break;
        }
        if (header.type == PERF_RECORD_LOST) {
            lost_count_ += load_word(position + 16U);
            has_gap_ = true;
        } else if (header.type == PERF_RECORD_SWITCH_CPU_WIDE) {
            read_record(position, header.misc);
        }
        position += header.size;
    }
    __atomic_store_n(&page.data_tail, position, __ATOMIC_RELEASE);
}

/// Words: header, the other thread, the thread that leaves or comes, time. A thread that ends has no number
/// when it leaves.
void SwitchLog::read_record(std::uint64_t position, std::uint32_t misc) noexcept {
    const std::uint64_t ids = load_word(position + 16U);
    const auto thread = static_cast<std::uint32_t>(ids >> 32U);
    const auto process = static_cast<std::uint32_t>(ids);
    const Instant now{static_cast<std::int64_t>(load_word(position + 24U)) - epoch_ns_};
    if ((misc & PERF_RECORD_MISC_SWITCH_OUT) == 0U) {
        coming_ = {now, now, thread, process, false};
        return;
    }
    Slice slice{last_, now, thread, process, (misc & PERF_RECORD_MISC_SWITCH_OUT_PREEMPT) != 0U};
    if (thread == kUnknownThread) {
        slice.thread = coming_.thread;
        slice.process = coming_.process;
    }
    if (has_gap_) {
        slice.thread = slice.process = kUnknownThread;
    } else if (slice.process == process_) {
        note_own(slice.thread, false);
    }
    add_slice(slice);
}

/// Records have multiples of 8 bytes, so a word does not cross the end of the buffer.
std::uint64_t SwitchLog::load_word(std::uint64_t position) const noexcept {
    std::uint64_t word = 0U;
    std::memcpy(&word, data_ + (position & data_mask_), sizeof word);
    return word;
}

/// After a lost slice, the next one begins at the end of the last stored one and has an unknown thread.
void SwitchLog::add_slice(const Slice& slice) noexcept {
    if (batch_.count == batch_.slices.size()) {
        ++lost_count_;
        has_gap_ = true;
        return;
    }
    batch_.slices[batch_.count] = slice;
    ++batch_.count;
    last_ = slice.end;
    has_gap_ = false;
}

ProcessorUse SwitchLog::calc_use(Instant from, Instant to, std::uint32_t window_thread) const noexcept {
    ProcessorUse use;
    Duration longest{0};
    for (std::size_t i = 0U; i < batch_.count; ++i) {
        const Slice& slice = batch_.slices[i];
        const Duration time = std::min(slice.end, to) - std::max(slice.begin, from);
        const bool is_of_window = slice.thread == runner_ || slice.thread == window_thread;
        if (time.ns <= 0 || slice.process == 0U || slice.thread == kUnknownThread || is_of_window) {
            continue;
        }
        Duration& sum = slice.process == process_ ? use.own : use.outside;
        sum = sum + time;
        if (time > longest) {
            longest = time;
            use.thread = slice.thread;
        }
    }
    return use;
}

void SwitchLog::settle(bool is_kept) noexcept {
    if (is_kept) {
        store(previous_);
        store(batch_);
    }
}

void SwitchLog::store(Batch& batch) noexcept {
    if (batch.is_stored) {
        return;
    }
    batch.is_stored = true;
    for (std::size_t i = 0U; i < batch.count; ++i) {
        const Slice& slice = batch.slices[i];
        if (slice.process == process_) {
            note_own(slice.thread, true);
        }
        if (kept_count_ == kept_.size()) {
            ++lost_count_;
            continue;
        }
        kept_[kept_count_] = slice;
        ++kept_count_;
    }
}

/// Reads the priority when the thread is seen first, because it can end soon, and at kept switches, because
/// the priority can change. A thread that has ended keeps the last one.
void SwitchLog::note_own(std::uint32_t thread, bool is_kept) noexcept {
    std::size_t index = 0U;
    while (index < own_count_ && own_[index].thread != thread) {
        ++index;
    }
    const bool is_first = index == own_count_;
    if (index == own_.size() || thread == kUnknownThread || !(is_first || is_kept)) {
        return;
    }
    sched_param parameters{};
    const bool is_there = sched_getparam(static_cast<pid_t>(thread), &parameters) == 0;
    if (is_first) {
        own_[index] = {thread};
        ++own_count_;
    }
    own_[index].priority =
        std::max(own_[index].priority, is_there ? parameters.sched_priority : kUnknownPriority);
}

}  // namespace mamori::timing
