// SPDX-License-Identifier: Apache-2.0
/// @file
/// Order of the slots of a FIFO that overwrites its oldest entry when it is full: a ring of shared words, in
/// which writer and reader swap slot numbers. It holds no payload.
///
/// @satisfies SWR-BUF-002, SWR-BUF-003, SWR-BUF-004, SWR-BUF-006, SWR-BUF-008, SWR-BUF-021, SWR-BUF-022
/// Design:   docs/design/data_flow.md#overwriting
#ifndef MAMORI_KERNEL_SLOT_RING_HPP
#define MAMORI_KERNEL_SLOT_RING_HPP

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

#include "mamori/kernel/base/assert.hpp"
#include "mamori/kernel/base/status.hpp"
#include "mamori/kernel/dataflow/detail/core_line.hpp"

namespace mamori::detail {

/// Order of up to kCapacity published slots. Slots are numbers 0 .. kSlotCount - 1: one always belongs to the
/// writer, one to the reader, and each word of the ring stores one. A word without a waiting entry belongs to
/// the writer, a word with a waiting entry to the side that exchanges it first.
///
/// Thread safety: one context calls the writer's members, another the reader's; no lock is necessary. The
///                counts can be read from anywhere.
/// Time:          O(1), wait-free; an atomic exchange per overwritten and per claimed entry. A claim makes at
///                most kTries attempts.
/// Memory:        kCapacity words and two groups of words, each on its own cache line; no heap.
/// @tparam kCapacity maximum number of waiting entries, 1 .. 254. @tparam Word only tests specify another
///                   type.
template <std::size_t kCapacity, typename Word>
class SlotRing final {
    static_assert(Word::is_always_lock_free, "this machine has no lock-free exchange of a word");

  public:
    using Slot = std::uint8_t;
    static constexpr std::size_t kSlotCount = kCapacity + 2U;
    static constexpr int kTries = 5;

    constexpr SlotRing() noexcept : SlotRing(std::make_integer_sequence<Entry, kCapacity>{}) {}
    SlotRing(const SlotRing&) = delete;
    SlotRing& operator=(const SlotRing&) = delete;

    /// Writer: the slot that publish() publishes.
    Slot get_write_slot() const noexcept { return writer_.slot; }

    /// Writer: appends the write slot and receives another: of the oldest entry, which is counted as lost,
    /// when kCapacity entries wait.
    void publish() noexcept {
        Word& cell = cells_[writer_.position % kCapacity];
        const Entry entry = make_entry(writer_.position, writer_.slot);
        raise_high_water_mark();
        writer_.position = calc_sum(writer_.position, 1U);
        // Release, with the acquire in catch_up(): the reader sees all words stored before.
        writer_.announced.store(static_cast<Entry>(writer_.position), std::memory_order_release);
        // Acquire, with the exchange in claim(): the reader has finished with the slot that it left here.
        Entry before = cell.load(std::memory_order_acquire);
        if (is_full(before)) {
            // Release: as below. Acquire: as above, if the reader has taken the entry since the load.
            before = cell.exchange(entry, std::memory_order_acq_rel);
        } else {
            // The reader changes a word with a waiting entry only, so a store suffices. Release, with the
            // acquires in claim(): the reader sees the written entry and the announced position.
            cell.store(entry, std::memory_order_release);
        }
        writer_.slot = get_slot(before);
        if (is_full(before)) {
            count_up(writer_.lost_count);
        }
    }

    /// Reader: the slot that was claimed last; before the first claim(), a slot that was never published.
    Slot get_read_slot() const noexcept { return reader_.slot; }

    /// Reader: swaps the read slot for the oldest entry. The exchange is necessary: reader and writer must
    /// agree on the owner of the entry, and loads and stores cannot decide that.
    /// @return kOk; kPreconditionNotMet (no entry waits); kOutOfResources (the writer replaced the entry in
    ///         each of kTries attempts; the next call can claim the remaining entries).
    Status claim() noexcept {
        // The first attempt is for a reader that no entry has passed; it needs no other shared word.
        for (int i = 0; i < kTries; ++i) {
            Word& cell = cells_[reader_.position % kCapacity];
            // Acquire, with the store and the exchange in publish(): the reader sees the written entry.
            Entry entry = cell.load(std::memory_order_acquire);
            if (!is_full(entry)) {
                return Status::kPreconditionNotMet;
            }
            // Release, with the acquires in publish(): the reader has finished with the slot that it leaves
            // here. The load above has acquired the same entry. On failure, acquire: `entry` is a later one,
            // and the reader sees the entries before it.
            if (get_position(entry) == reader_.position &&
                cell.compare_exchange_strong(entry, Entry{reader_.slot}, std::memory_order_release,
                                             std::memory_order_acquire)) {
                reader_.slot = get_slot(entry);
                reader_.position = calc_sum(reader_.position, 1U);
                // Relaxed: for levels only. The words of the ring pass the slots on.
                reader_.claimed.store(reader_.position, std::memory_order_relaxed);
                return Status::kOk;
            }
            if (i == 0) {
                catch_up();
            } else if (calc_distance(reader_.position, get_position(entry)) > kPositionCount / 2U) {
                return Status::kPreconditionNotMet;  // stale after a very long time
            } else {
                // `entry` is of a later lap: continue with the oldest entry that remains then.
                reader_.position = calc_sum(get_position(entry), kPositionCount - kCapacity + 1U);
            }
        }
        return Status::kOutOfResources;
    }

    /// Maximum number of entries that have waited; see FifoBuffer.
    std::uint32_t get_high_water_mark() const noexcept {
        return writer_.high_water_mark.load(std::memory_order_relaxed);
    }
    /// Number of overwritten entries.
    std::uint32_t get_lost_count() const noexcept {
        return writer_.lost_count.load(std::memory_order_relaxed);
    }

  private:
    /// An entry is a slot number, a flag that the entry waits to be read, and its position in the stream.
    using Entry = typename Word::value_type;
    static constexpr std::uint32_t kSlotBits = 8U;
    static constexpr std::uint32_t kFullMark = 1U << kSlotBits;
    /// Positions are modulo this number, a multiple of the capacity: position % capacity is the word index.
    static constexpr std::uint32_t kPositionCount =
        (std::numeric_limits<Entry>::max() >> (kSlotBits + 1U)) / kCapacity * kCapacity;
    static_assert(kPositionCount >= 4U * (kCapacity + 1U), "the word is too small for this capacity");

    template <Entry... kIndices>
    constexpr explicit SlotRing(std::integer_sequence<Entry, kIndices...>) noexcept
        : cells_{{Word(kIndices)...}} {}

    static constexpr Entry make_entry(std::uint32_t position, Slot slot) noexcept {
        return static_cast<Entry>((position << (kSlotBits + 1U)) | kFullMark | slot);
    }
    static constexpr bool is_full(Entry entry) noexcept { return (entry & kFullMark) != 0U; }
    static constexpr std::uint32_t get_position(Entry entry) noexcept { return entry >> (kSlotBits + 1U); }
    /// Slot number in `entry`. An invalid number is memory corruption and a contract violation.
    static Slot get_slot(Entry entry) noexcept {
        const auto slot = static_cast<Slot>(entry & (kFullMark - 1U));
        MAMORI_INVARIANT(1, slot < kSlotCount);
        return slot;
    }
    static constexpr std::uint32_t calc_sum(std::uint32_t position, std::uint32_t count) noexcept {
        return (position + count) % kPositionCount;
    }
    static constexpr std::uint32_t calc_distance(std::uint32_t from, std::uint32_t to) noexcept {
        return (to + kPositionCount - from) % kPositionCount;
    }

    /// Each counter has one writer, so a load and a store suffice.
    static void count_up(std::atomic<std::uint32_t>& count) noexcept {
        count.store(count.load(std::memory_order_relaxed) + 1U, std::memory_order_relaxed);
    }

    /// Writer, before a publication: the copy of the reader's position never gives too low a level.
    void raise_high_water_mark() noexcept {
        if (calc_level() > writer_.high_water_mark.load(std::memory_order_relaxed)) {
            // Relaxed: for levels only.
            writer_.seen_claimed = reader_.claimed.load(std::memory_order_relaxed);
            if (calc_level() > writer_.high_water_mark.load(std::memory_order_relaxed)) {
                writer_.high_water_mark.store(calc_level(), std::memory_order_relaxed);
            }
        }
    }
    /// Entries that wait after the next publication, by the copy of the reader's position.
    std::uint32_t calc_level() const noexcept {
        const std::uint32_t distance = calc_distance(writer_.seen_claimed, writer_.position);
        return distance < kCapacity ? distance + 1U : static_cast<std::uint32_t>(kCapacity);
    }

    /// Reader: skips entries that were overwritten since the last claim, after any time. The last announced
    /// entry may not be published yet, so the entry that it replaces may still be present.
    void catch_up() noexcept {
        // Acquire, with the release in publish(): the words of all entries before the announced one are seen.
        const std::uint32_t announced = writer_.announced.load(std::memory_order_acquire);
        if (calc_distance(reader_.position, announced) > kCapacity + 1U) {
            reader_.position = calc_sum(announced, kPositionCount - kCapacity - 1U);
        }
    }

    struct alignas(Word) alignas(kCoreLineSize) WriterSide {
        Word announced{0U};  ///< position after the entry that the writer publishes or has published last
        std::uint32_t position{0U};      ///< the same, for the writer only
        std::uint32_t seen_claimed{0U};  ///< copy of ReaderSide::claimed, for the writer only
        std::atomic<std::uint32_t> high_water_mark{0U};
        std::atomic<std::uint32_t> lost_count{0U};
        Slot slot{kCapacity};
    };
    struct alignas(Word) alignas(kCoreLineSize) ReaderSide {
        std::atomic<std::uint32_t> claimed{0U};  ///< position after the last claimed entry, for levels
        std::uint32_t position{0U};              ///< the same, for the reader only
        Slot slot{kCapacity + 1U};
    };

    WriterSide writer_;
    ReaderSide reader_;
    alignas(Word) alignas(kCoreLineSize) std::array<Word, kCapacity> cells_;
};

}  // namespace mamori::detail

#endif  // MAMORI_KERNEL_SLOT_RING_HPP
