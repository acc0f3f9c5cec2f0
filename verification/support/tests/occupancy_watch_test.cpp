// SPDX-License-Identifier: Apache-2.0
// Goal: other processes on a processor are recorded, threads of this process are not. Method: first a child
// computes on the processor of the test, then the test itself, above all ordinary programs.
#include "mamori/verification/occupancy_watch.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "mamori/ports/posix_rt/real_time_rights.hpp"
#include "mamori/trace/verifies.hpp"
#include "mamori/verification/run_delay.hpp"

namespace mamori::verification {
namespace {

using ports::posix_rt::FrameClock;

constexpr Duration kWork{20'000'000};

void compute_until(const FrameClock& clock, Instant end) {
    while (clock.get_now() < end) {
    }
}

TEST(OccupancyWatchTest, AnotherProcessOnTheProcessorIsSeenAndOurOwnThreadsAreNot) {
    verifies("SWR-PRT-018", Technique::kBoundaryValues);
    const FrameClock clock = FrameClock::starting_in(Duration{0});
    const int processor = find_processor();
    OccupancyWatch watch{clock, processor};
    if (!watch.knows()) {
        GTEST_SKIP() << "verdict=no-privilege: the kernel does not tell this process who runs";
    }
    ASSERT_TRUE(ports::posix_rt::set_processor(pthread_self(), processor).is_granted);
    const Instant begin = clock.get_now();
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
        compute_until(clock, clock.get_now() + kWork);
        ::_exit(0);
    }
    ASSERT_EQ(::waitpid(child, nullptr, 0), child);
    const Instant between = clock.get_now();
    const bool has_priority = ports::posix_rt::set_priority(pthread_self(), 50).is_granted;
    RunDelayMeter meter;
    static_cast<void>(meter.take());
    Instant alone{};
    Instant end{};
    Duration delayed = kWork;
    for (int repeats = 0; repeats <= 2 && delayed >= Duration{kWork.ns / 4}; ++repeats) {
        alone = clock.get_now();
        compute_until(clock, alone + kWork);
        delayed = meter.take();
        end = clock.get_now();
    }
    static_cast<void>(ports::posix_rt::set_priority(pthread_self(), 0));
    watch.stop();

    ASSERT_TRUE(watch.knows());
    const std::vector<Stall>& foreign = watch.get_foreign();
    EXPECT_GE(calc_loss(foreign, begin, between), Duration{kWork.ns / 4});
    for (std::size_t i = 1U; i < foreign.size(); ++i) {
        EXPECT_LE(foreign[i - 1U].end, foreign[i].begin);
    }
    if (!has_priority) {
        GTEST_SKIP() << "verdict=no-privilege: no fixed priority: any thread of the host may run beside the "
                        "one that must be alone";
    }
    if (calc_loss(foreign, alone, end) > Duration{kWork.ns / 4}) {
        // If this thread was ready but did not run, a program of higher priority was running.
        ASSERT_GE(delayed, Duration{kWork.ns / 4}) << "another program was seen, and no delay";
        GTEST_SKIP() << "verdict=inconclusive: run delay " << delayed.ns << " ns";
    }
}

TEST(OccupancyWatchTest, AProcessorThatIsNotThereIsNotWatched) {
    verifies("SWR-PRT-018", Technique::kErrorGuessing, Polarity::kViolation);
    const FrameClock clock = FrameClock::starting_in(Duration{0});
    OccupancyWatch watch{clock, 1'000'000};
    EXPECT_FALSE(watch.knows());
    watch.stop();
    EXPECT_TRUE(watch.get_foreign().empty());
}

}  // namespace
}  // namespace mamori::verification
