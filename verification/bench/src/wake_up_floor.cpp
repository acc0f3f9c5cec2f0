// SPDX-License-Identifier: Apache-2.0
/// @file
/// Floor of the wake-up case: two threads on one processor hand a message to and fro through two seqlocks and
/// wake each other with a futex. An operation is one round trip: two wake-ups.
#include <linux/futex.h>
#include <pthread.h>
#include <sched.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <stdexcept>
#include <thread>

#include "catalogue.hpp"
#include "seqlock.hpp"

namespace mamori::verification::bench {
namespace {

/// Seqlock with a bell: the reader waits until something newer is there.
class Mailbox {
  public:
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

/// A wake-up on one processor is a switch and no journey: both threads of the pair stay where the caller is.
void pin(pthread_t thread, int processor) {
    cpu_set_t set;
    CPU_ZERO(&set);
    CPU_SET(static_cast<unsigned>(processor), &set);
    if (pthread_setaffinity_np(thread, sizeof set, &set) != 0) {
        throw std::runtime_error("a thread could not be kept on one processor");
    }
}

class SeqlockFutex final : public Subject {
  public:
    SeqlockFutex() : echo_([this] { echo(); }) {}
    ~SeqlockFutex() override {
        there_.post(Message<64U>{kStop});
        echo_.join();
    }
    SeqlockFutex(const SeqlockFutex&) = delete;
    SeqlockFutex& operator=(const SeqlockFutex&) = delete;

    std::uint64_t run(std::uint64_t count) override {
        cpu_set_t own;
        sched_getaffinity(0, sizeof own, &own);
        const int processor = sched_getcpu();
        pin(pthread_self(), processor);
        pin(echo_.native_handle(), processor);
        std::uint64_t sum = 0U;
        for (std::uint64_t i = 0U; i < count; ++i) {
            there_.post(values_[i]);
            sum += back_.await()[0];
        }
        sched_setaffinity(0, sizeof own, &own);
        return sum;
    }

  private:
    static constexpr std::uint64_t kStop = 2U;  ///< a first word that no value has

    void echo() noexcept {
        for (Message<64U> message = there_.await(); message[0] != kStop; message = there_.await()) {
            back_.post(message);
        }
    }

    WrittenValues<64U> values_;
    Mailbox there_;
    Mailbox back_;
    std::thread echo_;
};

}  // namespace

void add_wake_up_floor(std::vector<Case>& wake_ups) {
    wake_ups[0].candidates.push_back({"seqlock + futex", &make_subject<SeqlockFutex>});
}

}  // namespace mamori::verification::bench
