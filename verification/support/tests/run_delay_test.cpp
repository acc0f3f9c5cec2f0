// SPDX-License-Identifier: Apache-2.0
// Goal: a ready thread that does not run has a delay, a sleeping thread has none. Method: a thread of higher
// priority on the same processor.
#include "mamori/verification/run_delay.hpp"

#include <gtest/gtest.h>

#include <thread>

#include "mamori/ports/posix_rt/frame_clock.hpp"
#include "mamori/ports/posix_rt/real_time_rights.hpp"
#include "mamori/trace/verifies.hpp"
#include "mamori/verification/stall_watch.hpp"

namespace mamori::verification {
namespace {

using ports::posix_rt::FrameClock;
using ports::posix_rt::set_priority;
using ports::posix_rt::set_processor;

TEST(RunDelayTest, OnlyAThreadThatIsReadyAndDoesNotRunIsDelayed) {
    verifies("SWR-VER-022", Technique::kEquivalenceClasses);
    constexpr Duration kWork{20'000'000};
    const FrameClock clock = FrameClock::starting_in(Duration{0});
    const int processor = find_processor();
    Duration asleep{-1};
    Duration delayed{-1};
    bool has_priority = false;
    std::thread thread{[&] {
        RunDelayMeter sut;
        has_priority =
            combine(set_processor(pthread_self(), processor), set_priority(pthread_self(), 94)).is_granted;
        static_cast<void>(sut.take());
        clock.wait_until(clock.get_now() + kWork);
        asleep = sut.take();
        const Instant begin = clock.get_now() + kWork;
        std::thread rival{[&] {
            static_cast<void>(set_priority(pthread_self(), 95));
            clock.wait_until(begin);
            while (clock.get_now() < begin + kWork) {
            }
        }};
        clock.wait_until(begin - Duration{kWork.ns / 2});  // until then the rival takes its priority
        const Instant end = begin + kWork + kWork;
        while (clock.get_now() < end) {
        }
        delayed = sut.take();
        rival.join();
    }};
    thread.join();
    if (!has_priority || delayed == Duration{0}) {
        GTEST_SKIP() << "verdict=no-privilege: no fixed priority, or the kernel does not count the delay: "
                     << has_priority << ' ' << delayed.ns;
    }
    RecordProperty("delayed_ns", std::to_string(delayed.ns));
    EXPECT_LT(asleep, Duration{kWork.ns / 2});
    EXPECT_GE(delayed, Duration{kWork.ns / 2});
}

}  // namespace
}  // namespace mamori::verification
