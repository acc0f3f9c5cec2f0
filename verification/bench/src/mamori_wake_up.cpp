// SPDX-License-Identifier: Apache-2.0
/// @file
/// Mamori in the wake-up case: the platform host of the real-time port passes a message as work to the thread
/// of a window and waits for its completion until a deadline. An operation is one round trip: two wake-ups.
#include <pthread.h>
#include <sched.h>

#include <array>
#include <stdexcept>

#include "catalogue.hpp"
#include "mamori/ports/posix_rt/guarded_host.hpp"

namespace mamori::verification::bench {
namespace {

using ports::posix_rt::FrameClock;
using ports::posix_rt::GuardedHost;
using ports::posix_rt::WindowThread;

class WindowHandOver final : public Subject {
  public:
    WindowHandOver() {
        if (host_.open() != Status::kOk) {
            throw std::runtime_error("no thread for a window");
        }
    }
    /// The work is a copy, so it has ended when run() returns.
    ~WindowHandOver() override { static_cast<void>(host_.close()); }
    WindowHandOver(const WindowHandOver&) = delete;
    WindowHandOver& operator=(const WindowHandOver&) = delete;

    std::uint64_t run(std::uint64_t count) override {
        cpu_set_t own;
        sched_getaffinity(0, sizeof own, &own);
        if (!ports::posix_rt::set_processor(pthread_self(), processor_).is_granted) {
            throw std::runtime_error("a thread could not be kept on one processor");
        }
        const WindowHost::Work work{&copy, this, 0U, 0U, 0U, 1U, WindowHost::Pass::kExecute};
        std::uint64_t sum = 0U;
        for (std::uint64_t i = 0U; i < count; ++i) {
            there_ = values_[i];
            static_cast<void>(host_.run_within(work, clock_.get_now() + kPatience));
            sum += back_[0];
        }
        sched_setaffinity(0, sizeof own, &own);
        return sum;
    }

  private:
    static constexpr Duration kPatience{10'000'000'000};

    static void copy(void* argument, std::size_t, std::size_t) noexcept {
        WindowHandOver& self = *static_cast<WindowHandOver*>(argument);
        self.back_ = self.there_;
    }

    WrittenValues<64U> values_;
    Message<64U> there_{};
    Message<64U> back_{};
    int processor_{sched_getcpu()};
    const FrameClock clock_{FrameClock::starting_in(Duration{0})};
    std::array<WindowThread, 1U> threads_;
    GuardedHost host_{threads_, clock_, {0, processor_}};
};

}  // namespace

void add_mamori_wake_up(std::vector<Case>& wake_ups) {
    wake_ups[0].candidates.push_back({"mamori window thread", &make_subject<WindowHandOver>});
}

}  // namespace mamori::verification::bench
