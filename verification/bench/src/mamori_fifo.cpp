// SPDX-License-Identifier: Apache-2.0
/// @file
/// Mamori in the FIFO case: the FIFO of a queue between two cores, with both policies of a full queue.
#include "catalogue.hpp"
#include "fifo_pair.hpp"
#include "mamori/kernel/dataflow/fifo_buffer.hpp"

namespace mamori::verification::bench {
namespace {

template <std::size_t kSize, FullPolicy kFull>
using Fifo = FifoBuffer<Message<kSize>, kFifoCapacity, kFull, EmptyPolicy::kDoNothing>;

template <std::size_t kSize>
class RejectingFifo final {
  public:
    bool try_push(const Message<kSize>& message) noexcept { return fifo_.push(message) == Status::kOk; }
    bool try_pop(Message<kSize>& message) noexcept { return fifo_.pop(message) == Status::kOk; }

  private:
    Fifo<kSize, FullPolicy::kDoNothing> fifo_;
};

/// An overwriting queue accepts every entry. A counter of read entries, whose cost is part of the result,
/// keeps the writer from overwriting unread ones. The reader publishes the counter every few entries, because
/// an exchange waits for all earlier stores, including the store of a word that the other processor polls.
template <std::size_t kSize>
class OverwritingFifo final {
  public:
    bool try_push(const Message<kSize>& message) noexcept {
        if (written_ - seen_read_ == kFifoCapacity) {
            seen_read_ = shared_read_.load(std::memory_order_acquire);
            if (written_ - seen_read_ == kFifoCapacity) {
                return false;
            }
        }
        static_cast<void>(fifo_.push(message));
        ++written_;
        return true;
    }
    bool try_pop(Message<kSize>& message) noexcept {
        if (fifo_.pop(message) != Status::kOk) {
            return false;
        }
        if (++read_ % kSharedEvery == 0U) {
            shared_read_.store(read_, std::memory_order_release);
        }
        return true;
    }

  private:
    static constexpr std::uint64_t kSharedEvery{16U};

    Fifo<kSize, FullPolicy::kOverwrite> fifo_;
    alignas(64) std::uint64_t written_{0U};  ///< used by the writer only
    std::uint64_t seen_read_{0U};            ///< used by the writer only
    alignas(64) std::atomic<std::uint64_t> shared_read_{0U};
    std::uint64_t read_{0U};  ///< used by the reader only
};

template <std::size_t kSize>
using RejectingPair = FifoPair<kSize, RejectingFifo<kSize>>;
template <std::size_t kSize>
using OverwritingPair = FifoPair<kSize, OverwritingFifo<kSize>>;

}  // namespace

void add_mamori_fifo(std::vector<Case>& fifos) {
    add_to_fifos<RejectingPair>(fifos, "mamori FIFO");
    add_to_fifos<OverwritingPair>(fifos, "mamori FIFO, overwriting");
}

}  // namespace mamori::verification::bench
