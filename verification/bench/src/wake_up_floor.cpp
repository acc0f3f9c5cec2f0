// SPDX-License-Identifier: Apache-2.0
/// @file
/// Lower bound of the wake-up case: two seqlocks, each with a reader that a futex wakes.
#include <linux/futex.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>

#include "catalogue.hpp"
#include "seqlock.hpp"
#include "wake_up_pair.hpp"

namespace mamori::verification::bench {
namespace {

/// Seqlock with notification: the reader waits for a newer value.
class RungSeqlock final {
  public:
    explicit RungSeqlock(const char* /*name*/) noexcept {}

    void post(const Message<64U>& message) noexcept {
        lock_.write(message);
        bell_.fetch_add(1U, std::memory_order_release);
        syscall(SYS_futex, &bell_, FUTEX_WAKE_PRIVATE, 1, nullptr, nullptr, 0);
    }

    Message<64U> await() noexcept {
        while (bell_.load(std::memory_order_acquire) == heard_) {
            syscall(SYS_futex, &bell_, FUTEX_WAIT_PRIVATE, heard_, nullptr, nullptr, 0);
        }
        ++heard_;
        Message<64U> message{};
        while (!lock_.try_read(message)) {
        }
        return message;
    }

  private:
    Seqlock<Message<64U>> lock_;
    std::atomic<std::uint32_t> bell_{0U};
    std::uint32_t heard_{0U};  ///< of the reader
};

}  // namespace

void add_wake_up_floor(std::vector<Case>& wake_ups) {
    wake_ups[0].candidates.push_back({"seqlock + futex", &make_subject<WakeUpPair<RungSeqlock>>});
}

}  // namespace mamori::verification::bench
