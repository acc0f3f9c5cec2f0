// SPDX-License-Identifier: Apache-2.0
/// @file
/// Order of the slots of a FIFO that rejects an entry when it is full: a ring with one index per side.
/// Neither side changes the index of the other, so loads and stores suffice. It holds no payload.
///
/// @satisfies SWR-BUF-002, SWR-BUF-003, SWR-BUF-004, SWR-BUF-006, SWR-BUF-008, SWR-BUF-021, SWR-BUF-022
/// Design:   docs/design/data_flow.md#rejecting
/// Source:   L. Lamport, "Specifying Concurrent Program Modules", TOPLAS 5 (1983)
#ifndef MAMORI_KERNEL_INDEX_RING_HPP
#define MAMORI_KERNEL_INDEX_RING_HPP

#include <atomic>
#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/assert.hpp"
#include "mamori/kernel/base/status.hpp"
#include "mamori/kernel/dataflow/detail/core_line.hpp"

namespace mamori::detail {

/// Ring of kCapacity + 2 slots: the slot before the next entry belongs to the reader, the slot after the last
/// entry to the writer. Each side keeps a copy of the index of the other and loads the index only when the
/// copy does not suffice.
///
/// Thread safety: one context calls the writer's members, another the reader's; no lock is necessary. The
///                counts can be read from anywhere.
/// Time:          O(1), wait-free, no atomic exchange. Memory: four groups of words, each on its own cache
///                line; no heap.
/// @tparam kCapacity maximum number of waiting entries, 1 .. 254. @tparam Word only tests specify another
///                   type.
template <std::size_t kCapacity, typename Word>
class IndexRing final {
    static_assert(Word::is_always_lock_free, "this machine has no lock-free load and store of a word");

  public:
    using Index = typename Word::value_type;
    static constexpr Index kSlotCount = static_cast<Index>(kCapacity + 2U);

    constexpr IndexRing() noexcept = default;
    IndexRing(const IndexRing&) = delete;
    IndexRing& operator=(const IndexRing&) = delete;

    /// Writer: the slot that publish() publishes.
    Index get_write_slot() const noexcept { return writer_.index; }

    /// Writer: looks for room for one more entry.
    /// @return kOk; kOutOfResources (kCapacity entries wait; counted as lost).
    Status reserve() noexcept {
        std::uint32_t level = calc_level();
        // The mark is at most kCapacity: below it, the copy suffices.
        if (level > writer_.high_water_mark.load(std::memory_order_relaxed)) {
            // Acquire, with the release in claim(): the reader has finished with every slot before its own,
            // so the writer may fill it again.
            writer_.seen_read = check(reader_.read.load(std::memory_order_acquire));
            level = calc_level();
            if (level > kCapacity) {
                const std::uint32_t lost = writer_.lost_count.load(std::memory_order_relaxed);
                writer_.lost_count.store(lost + 1U, std::memory_order_relaxed);
                return Status::kOutOfResources;
            }
            if (level > writer_.high_water_mark.load(std::memory_order_relaxed)) {
                writer_.high_water_mark.store(level, std::memory_order_relaxed);
            }
        }
        return Status::kOk;
    }

    /// Writer, after a reserve() that returned kOk: appends the write slot and receives the next one.
    void publish() noexcept {
        writer_.index = calc_next(writer_.index);
        // Release, with the acquire in claim(): the reader sees the written entry.
        writer_.written.store(writer_.index, std::memory_order_release);
    }

    /// Reader: the slot that was claimed last; before the first claim(), a slot that was never published.
    Index get_read_slot() const noexcept { return reader_.slot; }

    /// Reader: moves on to the oldest entry and returns the previous slot to the writer.
    /// @return kOk; kPreconditionNotMet (no entry waits).
    Status claim() noexcept {
        const Index oldest = calc_next(reader_.slot);
        if (oldest == reader_.seen_written) {
            // Acquire, with the release in publish(): all entries before this index are written.
            reader_.seen_written = check(writer_.written.load(std::memory_order_acquire));
            if (oldest == reader_.seen_written) {
                return Status::kPreconditionNotMet;
            }
        }
        reader_.slot = oldest;
        // Release, with the acquire in reserve(): the reader no longer uses the slots before this one.
        reader_.read.store(oldest, std::memory_order_release);
        return Status::kOk;
    }

    /// Maximum number of entries that have waited; see FifoBuffer.
    std::uint32_t get_high_water_mark() const noexcept {
        return writer_.high_water_mark.load(std::memory_order_relaxed);
    }
    /// Number of rejected entries.
    std::uint32_t get_lost_count() const noexcept {
        return writer_.lost_count.load(std::memory_order_relaxed);
    }

  private:
    /// A shared index has its line for itself: while the other core reads it, its owner works on the next
    /// line.
    struct WriterSide {
        alignas(Word) alignas(kCoreLineSize) Word written{0U};  ///< index of the write slot, for the reader
        alignas(Word) alignas(kCoreLineSize) Index index{0U};   ///< the same, for the writer only
        Index seen_read{kSlotCount - 1U};  ///< copy of ReaderSide::read, for the writer only
        std::atomic<std::uint32_t> high_water_mark{0U};
        std::atomic<std::uint32_t> lost_count{0U};
    };
    struct ReaderSide {
        alignas(Word) alignas(kCoreLineSize) Word read{kSlotCount - 1U};   ///< index of the read slot
        alignas(Word) alignas(kCoreLineSize) Index slot{kSlotCount - 1U};  ///< the same, for the reader only
        Index seen_written{0U};  ///< copy of WriterSide::written, for the reader only
    };

    static constexpr Index calc_next(Index index) noexcept {
        return index == kSlotCount - 1U ? Index{0U} : static_cast<Index>(index + 1U);
    }
    /// An index beyond the last slot is memory corruption and a contract violation.
    static Index check(Index index) noexcept {
        MAMORI_INVARIANT(1, index < kSlotCount);
        return index;
    }
    /// Entries that wait after the next publication, by the copy of the reader's index: never too few.
    std::uint32_t calc_level() const noexcept {
        const std::uint32_t index = writer_.index;
        const std::uint32_t read = writer_.seen_read;
        return index > read ? index - read : index + kSlotCount - read;
    }

    WriterSide writer_;
    ReaderSide reader_;
};

}  // namespace mamori::detail

#endif  // MAMORI_KERNEL_INDEX_RING_HPP
