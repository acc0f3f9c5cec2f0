// SPDX-License-Identifier: Apache-2.0
/// @file
/// Bounded first-in first-out buffer from one writer to one reader, also on different cores, with the buffer
/// policies of OpenRTM data ports. It counts rejected entries, overwritten entries and empty reads.
///
/// @satisfies SWR-BUF-003, SWR-BUF-004, SWR-BUF-005, SWR-BUF-006, SWR-BUF-008
/// Design:   docs/design/data_flow.md#fifo
/// Source:   OpenRTM-aist, buffer.write.full_policy and buffer.read.empty_policy of a data port
#ifndef MAMORI_KERNEL_FIFO_BUFFER_HPP
#define MAMORI_KERNEL_FIFO_BUFFER_HPP

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "mamori/kernel/base/assert.hpp"
#include "mamori/kernel/base/status.hpp"
#include "mamori/kernel/dataflow/detail/slot_ring.hpp"

namespace mamori {

/// Behaviour of a read from an empty buffer (OpenRTM buffer.read.empty_policy). The policy "block" is
/// omitted, because nothing in the kernel waits.
enum class EmptyPolicy : std::uint8_t {
    kReadback,   ///< "readback": returns the entry that was read last
    kDoNothing,  ///< "do_nothing": the read is rejected
};

/// Queue of up to kCapacity entries (1 .. 254). The default policies are those of OpenRTM. `Word` is the type
/// of the shared words; only tests specify another type.
///
/// Thread safety: one context calls the writer's members, another the reader's; no lock is necessary. The
///                counters can be read from anywhere.
/// Time:          wait-free; push() and pop() copy one T. Nothing blocks.
/// Memory:        kCapacity + 2 payloads, constant-initialised; no heap. Counters wrap at 2^32.
template <typename T, std::size_t kCapacity, FullPolicy kFull = FullPolicy::kOverwrite,
          EmptyPolicy kEmpty = EmptyPolicy::kReadback, typename Word = std::atomic<std::uint32_t>>
class FifoBuffer final {
    static_assert(std::is_trivially_copyable_v<T>, "the payload of a FifoBuffer must be trivially copyable");

  public:
    constexpr FifoBuffer() noexcept = default;
    FifoBuffer(const FifoBuffer&) = delete;
    FifoBuffer& operator=(const FifoBuffer&) = delete;

    /// Writer: the slot to fill before publish(). It contains an older value: overwrite all of it. The
    /// reference is valid until publish().
    T& get_write_slot() noexcept { return slots_[ring_.get_write_slot()]; }

    /// Writer: appends the write slot.
    /// @return kOk; kOutOfResources (kFull is kDoNothing and kCapacity entries wait; counted as rejected).
    Status publish() noexcept {
        const Publication outcome = ring_.publish();
        if (outcome == Publication::kRefused) {
            count_up(rejected_count_);
            return Status::kOutOfResources;
        }
        if (outcome == Publication::kReplacedOldest) {
            count_up(overwritten_count_);
        }
        const std::uint32_t level = ring_.calc_level();
        if (level > high_water_mark_.load(std::memory_order_relaxed)) {
            high_water_mark_.store(level, std::memory_order_relaxed);
        }
        return Status::kOk;
    }

    /// Writer: get_write_slot(), copy and publish() in one call. @return as publish().
    Status push(const T& value) noexcept {
        get_write_slot() = value;
        return publish();
    }

    /// Reader: removes the oldest entry from the queue and holds it as the front until drop() or pop(). The
    /// writer cannot overwrite a held entry. No effect while an entry is held.
    /// @return kOk; kPreconditionNotMet (empty); kOutOfResources (kFull is kOverwrite and the writer was
    ///         faster in SlotRing::kTries attempts: call again).
    Status peek() noexcept {
        if (is_held_) {
            return Status::kOk;
        }
        const Status status = ring_.claim();
        is_held_ = status == Status::kOk;
        has_front_ = has_front_ || is_held_;
        return status;
    }

    /// Reader: the entry that is held or was held last; a value-initialised T before the first entry. The
    /// reference is valid until the next peek() or pop() that removes an entry.
    const T& get_front() const noexcept { return slots_[ring_.get_read_slot()]; }

    /// Reader: releases the held entry. A call without a held entry is a contract violation.
    void drop() noexcept {
        MAMORI_REQUIRE(1, is_held_);
        is_held_ = false;
    }

    /// Reader: peek(), copy and drop() in one call. @param[out] value written on kOk only.
    /// @return kOk (with kReadback also when no entry waits: the entry that was read last, counted as empty
    ///         read); kPreconditionNotMet (no entry waits, counted as empty read, and kEmpty is kDoNothing or
    ///         no entry was ever taken); kOutOfResources (as peek()).
    Status pop(T& value) noexcept {
        Status status = peek();
        if (status == Status::kPreconditionNotMet) {
            count_up(empty_read_count_);
            if (kEmpty == EmptyPolicy::kReadback && has_front_) {
                status = Status::kOk;
            }
        }
        if (status == Status::kOk) {
            value = get_front();
            is_held_ = false;
        }
        return status;
    }

    /// Maximum number of entries that have waited, 0 .. kCapacity. Never too low; too high by at most the
    /// entries that the reader takes during publish().
    std::uint32_t get_high_water_mark() const noexcept { return get(high_water_mark_); }
    /// Number of rejected entries (kFull is kDoNothing).
    std::uint32_t get_rejected_count() const noexcept { return get(rejected_count_); }
    /// Number of entries overwritten before they were read (kFull is kOverwrite).
    std::uint32_t get_overwritten_count() const noexcept { return get(overwritten_count_); }
    /// Number of pop() calls that found no waiting entry.
    std::uint32_t get_empty_read_count() const noexcept { return get(empty_read_count_); }

  private:
    using Count = std::atomic<std::uint32_t>;

    static std::uint32_t get(const Count& count) noexcept { return count.load(std::memory_order_relaxed); }
    /// Each counter has one writer, so a load and a store suffice.
    static void count_up(Count& count) noexcept { count.store(get(count) + 1U, std::memory_order_relaxed); }

    SlotRing<kCapacity, kFull, Word> ring_;
    std::array<T, kCapacity + 2U> slots_{};
    Count high_water_mark_{0U};
    Count rejected_count_{0U};
    Count overwritten_count_{0U};
    Count empty_read_count_{0U};
    bool is_held_{false};    ///< reader only: the front was peeked and not yet dropped
    bool has_front_{false};  ///< reader only: an entry was taken at least once
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_FIFO_BUFFER_HPP
