// SPDX-License-Identifier: Apache-2.0
/// @file
/// The wake-up case: two threads on one processor exchange messages. Each sleeps until the message of the
/// other thread arrives. An operation is one round trip: two wake-ups.
///
/// @satisfies SWR-BEN-001      Design: docs/design/bench.md#method
#ifndef MAMORI_VERIFICATION_BENCH_WAKE_UP_PAIR_HPP
#define MAMORI_VERIFICATION_BENCH_WAKE_UP_PAIR_HPP

#include <thread>

#include "processors.hpp"
#include "subject.hpp"

namespace mamori::verification::bench {

/// Both threads stay on the processor of the caller, so that a wake-up is a thread switch without migration.
/// @tparam Mailbox created with a unique name. One thread calls post(message), another await(), which sleeps
/// until there is a message.
template <typename Mailbox>
class WakeUpPair final : public Subject {
  public:
    WakeUpPair() : echo_([this] { echo(); }) {}
    ~WakeUpPair() override {
        there_.post(Message<64U>{kStop});
        echo_.join();
    }
    WakeUpPair(const WakeUpPair&) = delete;
    WakeUpPair& operator=(const WakeUpPair&) = delete;

    std::uint64_t run(std::uint64_t count) override {
        const KeptAffinity affinity;
        const int processor = sched_getcpu();
        pin(pthread_self(), processor);
        pin(echo_.native_handle(), processor);
        std::uint64_t sum = 0U;
        for (std::uint64_t i = 0U; i < count; ++i) {
            there_.post(values_[i]);
            sum += back_.await()[0];
        }
        return sum;
    }

  private:
    static constexpr std::uint64_t kStop = 2U;  ///< a first word that does not occur in values

    void echo() {
        for (Message<64U> message = there_.await(); message[0] != kStop; message = there_.await()) {
            back_.post(message);
        }
    }

    WrittenValues<64U> values_;
    Mailbox there_{"bench_there"};
    Mailbox back_{"bench_back"};
    std::thread echo_;
};

}  // namespace mamori::verification::bench

#endif  // MAMORI_VERIFICATION_BENCH_WAKE_UP_PAIR_HPP
