// SPDX-License-Identifier: Apache-2.0
/// @file
/// Lower bound of the FIFO case: a ring with two indices, each on its own cache line with a copy of the
/// other.
///
/// Source: L. Lamport, "Specifying Concurrent Program Modules", TOPLAS 1983; the copies: P. Lee et al., "A
///         lock-free, cache-efficient multi-core synchronization mechanism", ICNP 2009
#include "catalogue.hpp"
#include "fifo_pair.hpp"

namespace mamori::verification::bench {
namespace {

template <std::size_t kSize>
class LamportRing final {
  public:
    bool try_push(const Message<kSize>& message) noexcept {
        const std::uint64_t written = written_.load(std::memory_order_relaxed);
        if (written - seen_read_ == kFifoCapacity) {
            seen_read_ = read_.load(std::memory_order_acquire);
            if (written - seen_read_ == kFifoCapacity) {
                return false;
            }
        }
        slots_[written % kFifoCapacity] = message;
        written_.store(written + 1U, std::memory_order_release);
        return true;
    }
    bool try_pop(Message<kSize>& message) noexcept {
        const std::uint64_t read = read_.load(std::memory_order_relaxed);
        if (read == seen_written_) {
            seen_written_ = written_.load(std::memory_order_acquire);
            if (read == seen_written_) {
                return false;
            }
        }
        message = slots_[read % kFifoCapacity];
        read_.store(read + 1U, std::memory_order_release);
        return true;
    }

  private:
    alignas(64) std::atomic<std::uint64_t> written_{0U};
    std::uint64_t seen_read_{0U};  ///< used by the writer only
    alignas(64) std::atomic<std::uint64_t> read_{0U};
    std::uint64_t seen_written_{0U};  ///< used by the reader only
    alignas(64) std::array<Message<kSize>, kFifoCapacity> slots_{};
};

template <std::size_t kSize>
using LamportPair = FifoPair<kSize, LamportRing<kSize>>;

}  // namespace

void add_fifo_floor(std::vector<Case>& fifos) {
    add_to_fifos<LamportPair>(fifos, "padded Lamport ring");
}

}  // namespace mamori::verification::bench
