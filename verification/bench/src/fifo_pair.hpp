// SPDX-License-Identifier: Apache-2.0
/// @file
/// The FIFO case: a thread on one processor writes entries at maximum rate, and a thread on another processor
/// reads them. An operation is kFifoEntries entries, so that the shortest batch is long compared with a
/// wake-up.
///
/// @satisfies SWR-BUF-020      Design: docs/design/bench.md#method
#ifndef MAMORI_VERIFICATION_BENCH_FIFO_PAIR_HPP
#define MAMORI_VERIFICATION_BENCH_FIFO_PAIR_HPP

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>

#include "processors.hpp"
#include "subject.hpp"

namespace mamori::verification::bench {

/// Capacity of each queue of the FIFO case [entries].
inline constexpr std::size_t kFifoCapacity{64U};
/// Entries of one operation.
inline constexpr std::uint64_t kFifoEntries{256U};

/// The reader sleeps between two runs, so that it does not disturb the other subjects.
/// @tparam Queue try_push(message) and try_pop(message) return false when the queue is full or empty.
template <std::size_t kSize, typename Queue>
class FifoPair final : public Subject {
  public:
    FifoPair() {
        const int first = affinity_.find_processor(0);
        const int second = affinity_.find_processor(first + 1);
        if (second >= CPU_SETSIZE) {
            throw std::runtime_error("the two threads of a FIFO need two processors");
        }
        writer_processor_ = first;
        reader_ = std::thread([this] { read(); });
        pin(reader_.native_handle(), second);
    }
    ~FifoPair() override {
        request(kStop);
        reader_.join();
    }
    FifoPair(const FifoPair&) = delete;
    FifoPair& operator=(const FifoPair&) = delete;

    std::uint64_t run(std::uint64_t count) override {
        const KeptAffinity affinity;
        pin(pthread_self(), writer_processor_);
        is_done_.store(false, std::memory_order_relaxed);
        const std::uint64_t entries = count * kFifoEntries;
        request(entries);
        for (std::uint64_t i = 0U; i < entries; ++i) {
            while (!queue_.try_push(values_[i])) {
            }
        }
        while (!is_done_.load(std::memory_order_acquire)) {
        }
        return sum_;
    }

  private:
    static constexpr std::uint64_t kNone = 0U;
    static constexpr std::uint64_t kStop = ~std::uint64_t{0U};

    void request(std::uint64_t count) {
        {
            const std::lock_guard<std::mutex> lock(mutex_);
            requested_ = count;
        }
        is_requested_.notify_one();
    }
    std::uint64_t await_request() {
        std::unique_lock<std::mutex> lock(mutex_);
        is_requested_.wait(lock, [this] { return requested_ != kNone; });
        return std::exchange(requested_, kNone);
    }
    void read() {
        Message<kSize> message{};
        for (std::uint64_t count = await_request(); count != kStop; count = await_request()) {
            std::uint64_t sum = 0U;
            for (std::uint64_t i = 0U; i < count; ++i) {
                while (!queue_.try_pop(message)) {
                }
                touch(message);
                sum += message[0];
            }
            sum_ = sum;
            is_done_.store(true, std::memory_order_release);
        }
    }

    WrittenValues<kSize> values_;
    KeptAffinity affinity_;
    int writer_processor_{0};
    std::mutex mutex_;
    std::condition_variable is_requested_;
    std::uint64_t requested_{kNone};
    alignas(64) Queue queue_;
    alignas(64) std::atomic<bool> is_done_{false};
    std::uint64_t sum_{0U};
    std::thread reader_;
};

}  // namespace mamori::verification::bench

#endif  // MAMORI_VERIFICATION_BENCH_FIFO_PAIR_HPP
