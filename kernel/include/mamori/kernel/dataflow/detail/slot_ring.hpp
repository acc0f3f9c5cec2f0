// SPDX-License-Identifier: Apache-2.0
/// @file
/// Exchange below FifoBuffer: a ring of shared words, in which writer and reader swap slot numbers, as in the
/// single word of a TripleBuffer. It holds no payload.
///
/// @satisfies SWR-BUF-002, SWR-BUF-003, SWR-BUF-004, SWR-BUF-008      Design: docs/design/data_flow.md#fifo
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

namespace mamori {

/// Behaviour of a write to a full buffer (OpenRTM buffer.write.full_policy). The policy "block" is omitted,
/// because nothing in the kernel waits.
enum class FullPolicy : std::uint8_t {
    kOverwrite,  ///< "overwrite": the oldest entry is overwritten
    kDoNothing,  ///< "do_nothing": the new entry is rejected
};

/// Result of a publication: kReplacedOldest under kOverwrite only, kRefused under kDoNothing only.
enum class Publication : std::uint8_t { kStored, kReplacedOldest, kRefused };

/// Order of up to kCapacity published slots. Slots are numbers 0 .. kSlotCount - 1: one always belongs to the
/// writer, one to the reader, and each word of the ring stores one.
///
/// Thread safety: one context calls the writer's members, another the reader's; no lock is necessary.
/// Time:          O(1), wait-free; a claim makes at most kTries attempts. Memory: kCapacity + 5 words, no
///                heap.
/// @tparam kCapacity maximum number of waiting entries, 1 .. 254. @tparam Word only tests specify another
///                   type.
template <std::size_t kCapacity, FullPolicy kFull, typename Word = std::atomic<std::uint32_t>>
class SlotRing final {
    static_assert(kCapacity >= 1U, "a FIFO needs room for at least one entry");
    static_assert(kCapacity <= 254U, "a FIFO has room for at most 254 entries: slot numbers are bytes");
    static_assert(Word::is_always_lock_free, "this machine has no lock-free exchange of a word");

  public:
    using Slot = std::uint8_t;
    static constexpr std::size_t kSlotCount = kCapacity + 2U;
    static constexpr int kTries = 4;

    constexpr SlotRing() noexcept : SlotRing(std::make_integer_sequence<Entry, kCapacity>{}) {}
    SlotRing(const SlotRing&) = delete;
    SlotRing& operator=(const SlotRing&) = delete;

    /// Writer: the slot that publish() publishes.
    Slot get_write_slot() const noexcept { return write_slot_; }

    /// Writer: appends the write slot and receives another, unless the ring is full and kFull is kDoNothing.
    /// With kOverwrite, a full ring returns the slot of its oldest entry.
    [[nodiscard]] Publication publish() noexcept {
        Word& cell = cells_[write_position_ % kCapacity];
        if constexpr (kFull == FullPolicy::kDoNothing) {
            if (is_full(cell.load(std::memory_order_relaxed))) {
                return Publication::kRefused;
            }
        }
        const std::uint32_t next = calc_sum(write_position_, 1U);
        announced_.store(static_cast<Entry>(next), std::memory_order_release);
        // Release: the reader sees the written value. Acquire: the reader has finished with the received
        // slot.
        const Entry before =
            cell.exchange(make_entry(write_position_, write_slot_), std::memory_order_acq_rel);
        write_position_ = next;
        write_slot_ = get_slot(before);
        return is_full(before) ? Publication::kReplacedOldest : Publication::kStored;
    }

    /// Writer: waiting entries, 0 .. kCapacity; too high by at most the entries that the reader takes
    /// meanwhile.
    std::uint32_t calc_level() const noexcept {
        return calc_level(write_position_, claimed_.load(std::memory_order_relaxed));
    }

    /// Reader: the slot that was claimed last; before the first claim(), a slot that was never published.
    Slot get_read_slot() const noexcept { return read_slot_; }

    /// Reader: swaps the read slot for the oldest entry.
    /// @return kOk; kPreconditionNotMet (no entry waits); kOutOfResources (kOverwrite only: the writer
    ///         replaced the entry in each of kTries attempts; the next call can claim the remaining entries).
    Status claim() noexcept {
        catch_up();
        for (int i = 0; i < kTries; ++i) {
            Word& cell = cells_[read_position_ % kCapacity];
            Entry entry = cell.load(std::memory_order_acquire);
            const std::uint32_t ahead = calc_distance(read_position_, get_position(entry));
            if (!is_full(entry) || ahead > kPositionCount / 2U) {
                return Status::kPreconditionNotMet;  // empty, or stale after a very long time
            }
            if (ahead == 0U &&
                cell.compare_exchange_strong(entry, Entry{read_slot_}, std::memory_order_acq_rel,
                                             std::memory_order_acquire)) {
                read_slot_ = get_slot(entry);
                read_position_ = calc_sum(read_position_, 1U);
                claimed_.store(read_position_, std::memory_order_relaxed);
                return Status::kOk;
            }
            // `entry` is of a later lap: continue with the oldest entry that remains then.
            read_position_ = calc_sum(get_position(entry), kPositionCount - kCapacity + 1U);
        }
        return Status::kOutOfResources;
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
    static constexpr std::uint32_t calc_level(std::uint32_t written, std::uint32_t read) noexcept {
        const std::uint32_t distance = calc_distance(read, written);
        return distance < kCapacity ? distance : static_cast<std::uint32_t>(kCapacity);
    }

    /// Skips entries that were overwritten since the last claim, after any time. The last announced entry may
    /// not be published yet, so the entry that it replaces may still be present.
    void catch_up() noexcept {
        if constexpr (kFull == FullPolicy::kOverwrite) {
            const std::uint32_t announced = announced_.load(std::memory_order_acquire);
            if (calc_distance(read_position_, announced) > kCapacity + 1U) {
                read_position_ = calc_sum(announced, kPositionCount - kCapacity - 1U);
            }
        }
    }

    std::array<Word, kCapacity> cells_;
    Word announced_{0U};  ///< position after the entry that the writer publishes or has published last
    std::atomic<std::uint32_t> claimed_{0U};  ///< copy of read_position_, for levels only
    std::uint32_t write_position_{0U};
    std::uint32_t read_position_{0U};
    Slot write_slot_{kCapacity};
    Slot read_slot_{kCapacity + 1U};
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_SLOT_RING_HPP
