// SPDX-License-Identifier: Apache-2.0
/// @file
/// Latest value from one writer to one reader, also on different cores. Of three slots, one belongs to the
/// writer, one to the reader, and a shared word stores the number of the third. Each side swaps its slot for
/// the slot in the shared word, so no slot ever has two owners and neither side ever waits. While the word
/// stores no new value, only the writer changes it, so the writer swaps with a load and a store.
///
/// @satisfies SWR-BUF-001, SWR-BUF-002, SWR-BUF-008, SWR-BUF-022, SWR-KRN-039
/// Design:   docs/design/data_flow.md#triple-buffer
#ifndef MAMORI_KERNEL_TRIPLE_BUFFER_HPP
#define MAMORI_KERNEL_TRIPLE_BUFFER_HPP

#include <array>
#include <atomic>
#include <cstdint>
#include <type_traits>

#include "mamori/kernel/base/assert.hpp"

namespace mamori {

/// Exchange of the latest T. `Word` is the type of the shared word; only tests specify another type.
///
/// Thread safety: one context calls the writer's members, another the reader's; no lock is necessary.
/// Time:          wait-free; one atomic exchange per update() that returns true and per publish() that
/// replaces
///                a value not taken yet; write(), take() and drop() also copy one T. Nothing blocks or
///                retries.
/// Memory:        three T and three bytes, constant-initialised; no heap.
template <typename T, typename Word = std::atomic<std::uint8_t>>
class TripleBuffer final {
    static_assert(std::is_trivially_copyable_v<T>,
                  "the payload of a TripleBuffer must be trivially copyable");
    static_assert(Word::is_always_lock_free, "this machine has no lock-free exchange of a byte");

  public:
    constexpr TripleBuffer() noexcept = default;
    TripleBuffer(const TripleBuffer&) = delete;
    TripleBuffer& operator=(const TripleBuffer&) = delete;

    /// Writer: the slot to fill before publish(). It contains an older value, not always the last one:
    /// overwrite all of it. The reference is valid until publish().
    T& get_write_slot() noexcept { return slots_[write_index_]; }

    /// Writer: makes the write slot the latest value. Replaces a published value that was not taken yet.
    void publish() noexcept {
        const auto entry = static_cast<std::uint8_t>(write_index_ | kFresh);
        // Acquire, with the exchange in update(): the reader has finished with the slot that it left here.
        std::uint8_t before = waiting_.load(std::memory_order_acquire);
        if ((before & kFresh) == 0U) {
            // The reader changes a fresh word only, so a store suffices. Release, with the exchange in
            // update(): the reader sees the written value.
            waiting_.store(entry, std::memory_order_release);
        } else {
            // Release and acquire: as above, if the reader has taken the value since the load.
            before = waiting_.exchange(entry, std::memory_order_acq_rel);
        }
        write_index_ = get_index(before);
    }

    /// Writer: get_write_slot(), copy and publish() in one call. @param[in] value copied once.
    void write(const T& value) noexcept {
        get_write_slot() = value;
        publish();
    }

    /// Reader: takes the latest value into the read slot. @return true when a value was published since the
    /// last update() that returned true; otherwise, the read slot is unchanged.
    [[nodiscard]] bool update() noexcept {
        // Relaxed: a value is accessed after the exchange only.
        if ((waiting_.load(std::memory_order_relaxed) & kFresh) == 0U) {
            return false;
        }
        // Only the reader clears kFresh, so the received value is fresh: that value or a newer one. Acquire,
        // with the store and the exchange in publish(): the reader sees the value. Release, with the load and
        // the exchange there: the reader has finished with the slot that it leaves here.
        read_index_ = get_index(waiting_.exchange(read_index_, std::memory_order_acq_rel));
        return true;
    }

    /// Reader: the value of the last update() that returned true; a value-initialised T before the first one,
    /// and after a drop(). The reference is valid until the next update() or drop().
    const T& get_read_slot() const noexcept { return slots_[read_index_]; }

    /// Reader: drops every value published until now; the read slot becomes a value-initialised T.
    void drop() noexcept {
        static_cast<void>(update());
        slots_[read_index_] = T{};
    }

    /// Reader: update() and a copy in one call. @param[out] value written only when there is a newer value.
    /// @return as update().
    [[nodiscard]] bool take(T& value) noexcept {
        const bool is_new = update();
        if (is_new) {
            value = get_read_slot();
        }
        return is_new;
    }

  private:
    static constexpr std::uint8_t kFresh = 4U;  ///< the waiting slot holds a value that was not taken yet

    /// Slot number in `entry`, 0 .. 2; any other number is memory corruption and a contract violation.
    static std::uint8_t get_index(std::uint8_t entry) noexcept {
        const auto index = static_cast<std::uint8_t>(entry & ~kFresh);
        MAMORI_INVARIANT(1, index < 3U);
        return index;
    }

    std::array<T, 3U> slots_{};
    Word waiting_{1U};              ///< index of the waiting slot, and kFresh
    std::uint8_t write_index_{0U};  ///< used by the writer only
    std::uint8_t read_index_{2U};   ///< used by the reader only
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_TRIPLE_BUFFER_HPP
