// SPDX-License-Identifier: Apache-2.0
// Goal: the log shows who ran on a processor around a lost window, and nothing else is kept.
// Method: threads of the test and a child process use one processor in turn. Without the privilege to record
// switches, only the refusal is tested.
#include "mamori/timing/switch_log.hpp"

#include <gtest/gtest.h>
#include <sched.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <thread>

#include "mamori/ports/posix_rt/real_time_rights.hpp"
#include "mamori/trace/verifies.hpp"
#include "thread_list.hpp"

namespace mamori::timing {
namespace {

using ports::posix_rt::FrameClock;
using ports::posix_rt::set_processor;
using namespace verification;
using std::chrono::milliseconds;

int find_processor() {
    cpu_set_t set;
    CPU_ZERO(&set);
    static_cast<void>(sched_getaffinity(0, sizeof set, &set));
    int processor = 0;
    while (!CPU_ISSET(static_cast<std::size_t>(processor), &set)) {
        ++processor;
    }
    return processor;
}

/// Uses this much CPU time.
void work(milliseconds length) {
    timespec now{};
    do {
        static_cast<void>(clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now));
    } while (now.tv_sec == 0 && now.tv_nsec < std::chrono::nanoseconds{length}.count());
}

class SwitchLogTest : public ::testing::Test {
  protected:
    /// Runs `act` on the processor of the log in a thread that counts as the runner.
    template <typename Act>
    void run(const Act& act) {
        std::thread{[&] {
            static_cast<void>(set_processor(pthread_self(), processor_));
            sut_.take_runner();
            act();
        }}.join();
    }
    /// Reads and keeps the switches each millisecond, as between windows. @return the sums until the end.
    template <typename IsDone>
    ProcessorUse follow(const IsDone& is_done) {
        ProcessorUse sum;
        Instant begin = clock_.get_now();
        for (bool is_last = false; !is_last;) {
            is_last = is_done();
            std::this_thread::sleep_for(milliseconds{1});
            const Instant now = clock_.get_now();
            sut_.read();
            const ProcessorUse use = sut_.calc_use(begin, now, 0U);
            sut_.settle(true);
            sum.own = sum.own + use.own;
            sum.outside = sum.outside + use.outside;
            begin = now;
        }
        return sum;
    }
    bool open() { return sut_.open(processor_, clock_).is_granted; }

    const int processor_ = find_processor();
    FrameClock clock_ = FrameClock::starting_in(Duration{0});
    SwitchLog sut_{1U << 18U};
};

TEST_F(SwitchLogTest, ThreadsOfTheProgramAndOfOthersAreToldApart) {
    verifies("SWR-TIM-042");
    if (!open()) {
        GTEST_SKIP() << "verdict=not-shown: this host does not permit to record switches";
    }
    std::atomic<std::uint32_t> rival{0U};
    pid_t child = 0;
    Duration own{0};
    Duration outside{0};
    run([&] {
        std::atomic<bool> is_done{false};
        std::thread thread{[&] {
            rival = static_cast<std::uint32_t>(gettid());
            work(milliseconds{20});
            is_done = true;
        }};
        own = follow([&is_done] { return is_done.load(); }).own;
        thread.join();
        child = fork();
        if (child == 0) {
            work(milliseconds{20});
            _exit(0);
        }
        outside = follow([child] { return waitpid(child, nullptr, WNOHANG) == child; }).outside;
    });

    EXPECT_GE(own, Duration{15'000'000});
    EXPECT_GE(outside, Duration{15'000'000});
    bool has_rival = false;
    bool has_child = false;
    Instant before{};
    for (const Slice& slice : sut_.get_kept()) {
        has_rival =
            has_rival || (slice.thread == rival && slice.process == static_cast<std::uint32_t>(getpid()));
        has_child = has_child || slice.process == static_cast<std::uint32_t>(child);
        EXPECT_GE(slice.begin, before);
        EXPECT_GE(slice.end, slice.begin);
        before = slice.begin;
    }
    EXPECT_TRUE(has_rival);
    EXPECT_TRUE(has_child);
    const std::vector<NamedThread> named = list_threads({&sut_});
    const auto found = std::find_if(named.begin(), named.end(),
                                    [&rival](const NamedThread& one) { return one.thread == rival; });
    ASSERT_NE(found, named.end());
    EXPECT_EQ(found->kind, ThreadKind::kOwn);
}

TEST_F(SwitchLogTest, RunnerAndWindowThreadDoNotCountAsOthers) {
    verifies("SWR-TIM-042", Technique::kEquivalenceClasses);
    if (!open()) {
        GTEST_SKIP() << "verdict=not-shown: this host does not permit to record switches";
    }
    std::atomic<std::uint32_t> worker{0U};
    ProcessorUse use;
    run([&] {
        sut_.read();
        const Instant begin = clock_.get_now();
        std::thread{[&worker] {
            worker = static_cast<std::uint32_t>(gettid());
            work(milliseconds{20});
        }}.join();
        sut_.read();
        use = sut_.calc_use(begin, clock_.get_now(), worker);
    });

    EXPECT_LT(use.own, Duration{10'000'000}) << "of 20 ms; other threads of the test may run for a moment";
}

TEST_F(SwitchLogTest, ThreadOfTheProgramThatHasEndedIsStillOneOfTheProgram) {
    verifies("SWR-TIM-042", Technique::kErrorGuessing, Polarity::kViolation);
    if (!open()) {
        GTEST_SKIP() << "verdict=not-shown: this host does not permit to record switches";
    }
    std::atomic<std::uint32_t> seen{0U};
    std::atomic<std::uint32_t> unseen{0U};
    run([&] {
        std::atomic<bool> is_over{false};
        std::thread known{[&] {
            static_cast<void>(ports::posix_rt::set_priority(pthread_self(), 2));
            seen = static_cast<std::uint32_t>(gettid());
            while (!is_over.load()) {
                std::this_thread::sleep_for(milliseconds{1});
            }
        }};
        while (seen == 0U) {
            std::this_thread::sleep_for(milliseconds{1});
        }
        std::this_thread::sleep_for(milliseconds{2});
        sut_.read();
        sut_.settle(false);
        is_over = true;
        known.join();
        std::thread{[&unseen] {
            unseen = static_cast<std::uint32_t>(gettid());
            work(milliseconds{2});
        }}.join();
        sut_.read();
        sut_.settle(true);
    });

    const std::vector<NamedThread> named = list_threads({&sut_});
    const auto find = [&named](std::uint32_t id) {
        return std::find_if(named.begin(), named.end(),
                            [id](const NamedThread& one) { return one.thread == id; });
    };
    ASSERT_NE(find(seen), named.end());
    EXPECT_EQ(find(seen)->kind, ThreadKind::kOwn);
    EXPECT_NE(find(seen)->priority, kUnknownPriority) << "it was read while the thread existed";
    ASSERT_NE(find(unseen), named.end());
    EXPECT_EQ(find(unseen)->kind, ThreadKind::kOwn);
    EXPECT_EQ(find(unseen)->priority, kUnknownPriority);
    EXPECT_EQ(find(unseen)->name, "");
}

TEST_F(SwitchLogTest, EachReadingHasALimitAndTheNextOneReadsTheRest) {
    verifies("SWR-TIM-042", Technique::kBoundaryValues);
    if (!open()) {
        GTEST_SKIP() << "verdict=not-shown: this host does not permit to record switches";
    }
    std::array<std::size_t, 3U> kept{};
    run([&] {
        for (int i = 0; i < 20; ++i) {
            std::this_thread::sleep_for(milliseconds{1});
        }
        const std::array<std::size_t, 3U> limits{0U, 10U, 1U << 20U};
        for (std::size_t i = 0U; i < limits.size(); ++i) {
            sut_.read(limits[i]);
            sut_.settle(true);
            kept[i] = sut_.get_kept().size();
        }
    });

    EXPECT_EQ(kept[0], 0U);
    EXPECT_GT(kept[1], 0U);
    EXPECT_LE(kept[1], 10U) << "at most one slice of each record";
    EXPECT_GE(kept[2], 20U);
    EXPECT_EQ(sut_.get_lost_count(), 0U);
    for (std::size_t i = 1U; i < sut_.get_kept().size(); ++i) {
        EXPECT_EQ(sut_.get_kept()[i].begin, sut_.get_kept()[i - 1U].end) << "nothing is missing in between";
    }
}

TEST_F(SwitchLogTest, OnlyTheSlicesAroundAnEventAreKept) {
    verifies("SWR-TIM-042", Technique::kEquivalenceClasses);
    if (!open()) {
        GTEST_SKIP() << "verdict=not-shown: this host does not permit to record switches";
    }
    const auto rest = [] { std::this_thread::sleep_for(milliseconds{2}); };
    std::array<Instant, 5U> begins{};
    std::array<Instant, 5U> ends{};
    run([&] {
        for (std::size_t i = 0U; i < ends.size(); ++i) {
            rest();
            begins[i] = clock_.get_now();
            sut_.read();
            ends[i] = clock_.get_now();
            sut_.settle(i == 2U);
        }
    });

    ASSERT_FALSE(sut_.get_kept().empty());
    EXPECT_GT(sut_.get_kept()[0].end, begins[0]) << "the call before the event is kept as well";
    EXPECT_LT(sut_.get_kept()[sut_.get_kept().size() - 1U].end, ends[2]);
}

TEST_F(SwitchLogTest, SlicesBeyondTheCapacityAreCounted) {
    verifies("SWR-TIM-042", Technique::kBoundaryValues, Polarity::kViolation);
    SwitchLog small{1U};
    if (!small.open(processor_, clock_).is_granted) {
        GTEST_SKIP() << "verdict=not-shown: this host does not permit to record switches";
    }
    run([&] {
        for (int i = 0; i < 5; ++i) {
            std::this_thread::sleep_for(milliseconds{2});
        }
        small.read();
        small.settle(true);
    });

    EXPECT_EQ(small.get_kept().size(), 1U);
    EXPECT_GT(small.get_lost_count(), 0U);
}

TEST_F(SwitchLogTest, LostSlicesBecomeOneOfAnUnknownThreadThatIsNotCounted) {
    verifies("SWR-TIM-042", Technique::kBoundaryValues, Polarity::kViolation);
    SwitchLog small{100U, 1U};
    if (!small.open(processor_, clock_).is_granted) {
        GTEST_SKIP() << "verdict=not-shown: this host does not permit to record switches";
    }
    ProcessorUse use;
    run([&] {
        for (int i = 0; i < 3; ++i) {
            const Instant begin = clock_.get_now();
            std::this_thread::sleep_for(milliseconds{2});
            std::this_thread::sleep_for(milliseconds{2});
            small.read();
            use = small.calc_use(begin, clock_.get_now(), 0U);
            small.settle(true);
        }
    });

    const Span<const Slice> kept = small.get_kept();
    ASSERT_EQ(kept.size(), 3U);
    EXPECT_GT(small.get_lost_count(), 0U);
    EXPECT_NE(kept[0].thread, kUnknownThread);
    for (std::size_t i = 1U; i < kept.size(); ++i) {
        EXPECT_EQ(kept[i].thread, kUnknownThread);
        EXPECT_EQ(kept[i].begin, kept[i - 1U].end) << "the lost slices are part of it";
    }
    EXPECT_EQ(use.own + use.outside, Duration{0});
    EXPECT_EQ(use.thread, 0U);
}

TEST_F(SwitchLogTest, RefusedLogTellsWhyAndStaysEmpty) {
    verifies("SWR-TIM-042", Technique::kErrorGuessing, Polarity::kViolation);
    const ports::posix_rt::Right right = sut_.open(1 << 20, clock_);

    EXPECT_FALSE(right.is_granted);
    EXPECT_NE(right.system_error, 0);
    EXPECT_FALSE(sut_.is_open());
    run([&] {
        sut_.read();
        sut_.settle(true);
    });
    EXPECT_TRUE(sut_.get_kept().empty());
    EXPECT_EQ(sut_.calc_use(Instant{0}, Instant{1'000'000'000}, 0U).own, Duration{0});
}

TEST(ContinuationTest, EachContinuationOfTheProgramIsNoted) {
    verifies("SWR-TIM-042", Technique::kFaultInjection);
    watch_continuations();
    const auto clock = FrameClock::starting_in(Duration{0});
    ASSERT_EQ(raise(SIGCONT), 0);
    ASSERT_EQ(raise(SIGCONT), 0);

    const std::vector<std::int64_t> instants = end_continuations();

    ASSERT_EQ(instants.size(), 2U);
    EXPECT_GE(instants[0], clock.get_epoch_ns());
    EXPECT_GE(instants[1], instants[0]);
    ASSERT_EQ(raise(SIGCONT), 0);
    EXPECT_EQ(end_continuations().size(), 2U) << "nothing is noted after the end";
}

}  // namespace
}  // namespace mamori::timing
