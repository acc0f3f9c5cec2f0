// SPDX-License-Identifier: Apache-2.0
/// @file
/// The lower bound of a latest-value exchange: a sequence lock and two copies.
///
/// Source: H.-J. Boehm, "Can seqlocks get along with programming language memory models?", MSPC 2012
#ifndef MAMORI_VERIFICATION_BENCH_SEQLOCK_HPP
#define MAMORI_VERIFICATION_BENCH_SEQLOCK_HPP

#include <atomic>
#include <cstdint>

namespace mamori::verification::bench {

/// Latest value of one writer. As in common seqlocks, the copy itself is not atomic: the reader detects and
/// discards a torn copy.
template <typename T>
class Seqlock {
  public:
    void write(const T& value) noexcept {
        const std::uint32_t sequence = sequence_.load(std::memory_order_relaxed);
        sequence_.store(sequence + 1U, std::memory_order_relaxed);
        std::atomic_thread_fence(std::memory_order_release);
        value_ = value;
        sequence_.store(sequence + 2U, std::memory_order_release);
    }

    /// @return false if a write occurred during the copy; `value` is then undefined.
    bool try_read(T& value) const noexcept {
        const std::uint32_t before = sequence_.load(std::memory_order_acquire);
        value = value_;
        std::atomic_thread_fence(std::memory_order_acquire);
        return (before & 1U) == 0U && before == sequence_.load(std::memory_order_relaxed);
    }

  private:
    std::atomic<std::uint32_t> sequence_{0U};
    T value_{};
};

}  // namespace mamori::verification::bench

#endif  // MAMORI_VERIFICATION_BENCH_SEQLOCK_HPP
