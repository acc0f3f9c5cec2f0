// SPDX-License-Identifier: Apache-2.0
/// @file
/// Bounded first-in first-out buffer from one writer to one reader, also on different cores, with the buffer
/// policies of OpenRTM data ports. It counts rejected entries, overwritten entries and empty reads.
///
/// @satisfies SWR-BUF-003, SWR-BUF-004, SWR-BUF-005, SWR-BUF-006, SWR-BUF-008, SWR-BUF-021, SWR-BUF-022
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
#include "mamori/kernel/dataflow/detail/core_line.hpp"
#include "mamori/kernel/dataflow/detail/index_ring.hpp"
#include "mamori/kernel/dataflow/detail/slot_ring.hpp"

namespace mamori {

/// Behaviour of a write to a full buffer (OpenRTM buffer.write.full_policy). The policy "block" is omitted,
/// because nothing in the kernel waits.
enum class FullPolicy : std::uint8_t {
    kOverwrite,  ///< "overwrite": the oldest entry is overwritten
    kDoNothing,  ///< "do_nothing": the new entry is rejected
};

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
/// Time:          wait-free; push() and pop() copy one T. With kOverwrite, an atomic exchange per overwritten
///                and per read entry; with kDoNothing, none. Nothing blocks.
/// Memory:        kCapacity + 2 payloads, constant-initialised; no heap. What different sides write is on
///                different cache lines. Counters wrap at 2^32.
template <typename T, std::size_t kCapacity, FullPolicy kFull = FullPolicy::kOverwrite,
          EmptyPolicy kEmpty = EmptyPolicy::kReadback, typename Word = std::atomic<std::uint32_t>>
class FifoBuffer final {
    static_assert(std::is_trivially_copyable_v<T>, "the payload of a FifoBuffer must be trivially copyable");
    static_assert(kCapacity >= 1U, "a FIFO needs room for at least one entry");
    static_assert(kCapacity <= 254U, "a FIFO has room for at most 254 entries: slot numbers are bytes");

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
        const Status status = reserve();
        if (status == Status::kOk) {
            ring_.publish();
        }
        return status;
    }

    /// Writer: get_write_slot(), copy and publish() in one call; a rejected entry is not copied.
    /// @return as publish().
    Status push(const T& value) noexcept {
        const Status status = reserve();
        if (status == Status::kOk) {
            get_write_slot() = value;
            ring_.publish();
        }
        return status;
    }

    /// Reader: removes the oldest entry from the queue and holds it as the front until drop() or pop(). The
    /// writer cannot overwrite a held entry. No effect while an entry is held.
    /// @return kOk; kPreconditionNotMet (empty); kOutOfResources (kFull is kOverwrite and the writer was
    ///         faster in SlotRing::kTries attempts: call again).
    Status peek() noexcept {
        if (reader_.is_held) {
            return Status::kOk;
        }
        const Status status = ring_.claim();
        if (status == Status::kOk) {
            reader_.is_held = true;
            reader_.has_front = true;
        }
        return status;
    }

    /// Reader: the entry that is held or was held last; a value-initialised T before the first entry. The
    /// reference is valid until the next peek() or pop() that removes an entry.
    const T& get_front() const noexcept { return slots_[ring_.get_read_slot()]; }

    /// Reader: releases the held entry. A call without a held entry is a contract violation.
    void drop() noexcept {
        MAMORI_REQUIRE(1, reader_.is_held);
        reader_.is_held = false;
    }

    /// Reader: peek(), copy and drop() in one call. @param[out] value written on kOk only.
    /// @return kOk (with kReadback also when no entry waits: the entry that was read last, counted as empty
    ///         read); kPreconditionNotMet (no entry waits, counted as empty read, and kEmpty is kDoNothing or
    ///         no entry was ever taken); kOutOfResources (as peek()).
    Status pop(T& value) noexcept {
        Status status = peek();
        if (status == Status::kPreconditionNotMet) {
            const std::uint32_t count = get_empty_read_count();
            reader_.empty_read_count.store(count + 1U, std::memory_order_relaxed);
            if (kEmpty == EmptyPolicy::kReadback && reader_.has_front) {
                status = Status::kOk;
            }
        }
        if (status == Status::kOk) {
            value = get_front();
            reader_.is_held = false;
        }
        return status;
    }

    /// Maximum number of entries that have waited, 0 .. kCapacity. Never too low; too high by at most the
    /// entries that the reader takes during publish().
    std::uint32_t get_high_water_mark() const noexcept { return ring_.get_high_water_mark(); }
    /// Number of rejected entries (kFull is kDoNothing).
    std::uint32_t get_rejected_count() const noexcept {
        return kFull == FullPolicy::kDoNothing ? ring_.get_lost_count() : 0U;
    }
    /// Number of entries overwritten before they were read (kFull is kOverwrite).
    std::uint32_t get_overwritten_count() const noexcept {
        return kFull == FullPolicy::kOverwrite ? ring_.get_lost_count() : 0U;
    }
    /// Number of pop() calls that found no waiting entry.
    std::uint32_t get_empty_read_count() const noexcept {
        return reader_.empty_read_count.load(std::memory_order_relaxed);
    }

  private:
    using Ring = std::conditional_t<kFull == FullPolicy::kOverwrite, detail::SlotRing<kCapacity, Word>,
                                    detail::IndexRing<kCapacity, Word>>;
    struct alignas(std::uint32_t) alignas(detail::kCoreLineSize) ReaderSide {
        std::atomic<std::uint32_t> empty_read_count{0U};  ///< a load and a store count: it has one writer
        bool is_held{false};                              ///< the front was peeked and not yet dropped
        bool has_front{false};                            ///< an entry was taken at least once
    };

    /// Writer: looks for room for one more entry; an overwriting ring always has room.
    Status reserve() noexcept {
        if constexpr (kFull == FullPolicy::kDoNothing) {
            return ring_.reserve();
        }
        return Status::kOk;
    }

    Ring ring_;
    ReaderSide reader_;
    alignas(T) alignas(detail::kCoreLineSize) std::array<T, kCapacity + 2U> slots_{};
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_FIFO_BUFFER_HPP
