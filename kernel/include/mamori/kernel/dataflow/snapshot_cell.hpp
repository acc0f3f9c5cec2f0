// SPDX-License-Identifier: Apache-2.0
/// @file
/// A value that one writer updates and any context can read. The writer ignores the readers, so a read cannot
/// delay it. The status of a read reports that the writer was faster.
///
/// @satisfies SWR-BUF-007, SWR-BUF-008      Design: docs/design/data_flow.md#snapshots
/// Source:   H.-J. Boehm, "Can seqlocks get along with programming language memory models?", MSPC 2012
#ifndef MAMORI_KERNEL_SNAPSHOT_CELL_HPP
#define MAMORI_KERNEL_SNAPSHOT_CELL_HPP

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "mamori/kernel/base/status.hpp"

namespace mamori {

/// Copy of one T with a sequence number that is odd during a write. `Word` is the unit of copying; only tests
/// specify another type.
///
/// Thread safety: one context writes; any number of contexts read, at any time.
/// Time:          write() is wait-free and O(sizeof(T)); try_read() makes at most kTries such copies.
/// Memory:        one T and two words, constant-initialised; each call needs one T of stack; no heap.
template <typename T, typename Word = std::atomic<std::uintptr_t>>
class SnapshotCell final {
    static_assert(std::is_trivially_copyable_v<T>,
                  "the payload of a SnapshotCell must be trivially copyable");
    static_assert(Word::is_always_lock_free, "this machine has no lock-free load and store of a word");

  public:
    /// Maximum number of copies per try_read().
    static constexpr int kTries = 3;

    constexpr SnapshotCell() noexcept = default;
    SnapshotCell(const SnapshotCell&) = delete;
    SnapshotCell& operator=(const SnapshotCell&) = delete;

    /// Writer: makes `value` visible to the readers. After an aborted write, no value is readable until the
    /// next write.
    void write(const T& value) noexcept {
        std::array<Unit, kWordCount> copy{};
        __builtin_memcpy(copy.data(), &value, sizeof(T));
        sequence_ |= 1U;
        shared_sequence_.store(sequence_, std::memory_order_relaxed);
        for (std::size_t i = 0U; i < kWordCount; ++i) {
            // Release: a context that reads this word also reads the odd number.
            words_[i].store(copy[i], std::memory_order_release);
        }
        // The number after the maximum is 2, because 0 means that no value was ever written.
        sequence_ = sequence_ == kLastOdd ? Unit{2U} : static_cast<Unit>(sequence_ + 1U);
        shared_sequence_.store(sequence_, std::memory_order_release);
    }

    /// Reader: copies the value that was written last. @param[out] value written on kOk only.
    /// @return kOk; kPreconditionNotMet (no value was ever written); kOutOfResources (a write overlapped each
    ///         of kTries attempts: call again).
    Status try_read(T& value) const noexcept {
        for (int i = 0; i < kTries; ++i) {
            const Unit before = shared_sequence_.load(std::memory_order_acquire);
            if (before == 0U) {
                return Status::kPreconditionNotMet;
            }
            std::array<Unit, kWordCount> copy{};
            for (std::size_t word = 0U; word < kWordCount; ++word) {
                copy[word] = words_[word].load(std::memory_order_acquire);
            }
            // The acquire loads above order this load after them.
            const Unit after = shared_sequence_.load(std::memory_order_relaxed);
            if (before == after && before % 2U == 0U) {
                // As bytes: a payload with default member initialisers is trivially copyable nevertheless.
                __builtin_memcpy(static_cast<void*>(&value), copy.data(), sizeof(T));
                return Status::kOk;
            }
        }
        return Status::kOutOfResources;
    }

  private:
    using Unit = typename Word::value_type;
    static constexpr Unit kLastOdd = std::numeric_limits<Unit>::max();
    static constexpr std::size_t kWordCount = (sizeof(T) + sizeof(Unit) - 1U) / sizeof(Unit);

    std::array<Word, kWordCount> words_{};
    Word shared_sequence_{0U};
    Unit sequence_{0U};  ///< used by the writer only
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_SNAPSHOT_CELL_HPP
