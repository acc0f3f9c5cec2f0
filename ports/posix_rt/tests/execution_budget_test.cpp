// SPDX-License-Identifier: Apache-2.0
// Goal: the budget of a background window is processor time of its thread: work that waits keeps it, work
// that
//       exhausts it is aborted before its deadline, and each instance of the window has it once.
// Method: work that computes for a processor time, waits, or computes until it is told to stop; deadlines are
//         minutes away.
#include <gtest/gtest.h>
#include <time.h>

#include <array>
#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

#include "mamori/ports/posix_rt/guarded_host.hpp"
#include "mamori/trace/verifies.hpp"

namespace mamori::ports::posix_rt {
namespace {

using namespace verification;
using literals::operator""_ms;
using literals::operator""_s;

class ExecutionBudgetTest : public ::testing::Test {
  protected:
    void SetUp() override {
        ASSERT_EQ(threads_[0].set_execution_budget(40_ms), Status::kOk);
        ASSERT_EQ(host_.open(), Status::kOk);
    }
    void TearDown() override {
        is_to_stop_ = true;
        while (host_.close() != Status::kOk) {
            std::this_thread::yield();
        }
    }

    /// Runs `count` steps, each of which computes for `time_` and then waits for `wait_`.
    std::size_t run(std::size_t count, Instant deadline) {
        return host_.run_within(
            {&ExecutionBudgetTest::step, this, 0U, 0U, 0U, count, WindowHost::Pass::kExecute}, deadline);
    }
    static void step(void* argument, std::size_t, std::size_t) noexcept {
        const ExecutionBudgetTest& test = *static_cast<ExecutionBudgetTest*>(argument);
        const Duration end = read_used() + test.time_;
        while (read_used() < end && !test.is_to_stop_) {
        }
        if (test.wait_ > Duration{0}) {
            std::this_thread::sleep_for(std::chrono::nanoseconds{test.wait_.ns});
        }
    }
    static Duration read_used() noexcept {
        timespec now{};
        static_cast<void>(clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now));
        return Duration{static_cast<std::int64_t>(now.tv_sec) * 1'000'000'000 + now.tv_nsec};
    }

    const FrameClock clock_ = FrameClock::starting_in(0_ms);
    std::array<WindowThread, 1U> threads_;
    GuardedHost host_{threads_, clock_, {}};
    Duration time_{};
    Duration wait_{};
    std::atomic<bool> is_to_stop_{false};
    const Instant deadline_ = clock_.get_now() + 600_s;
};

TEST_F(ExecutionBudgetTest, WorkThatWaitsKeepsItsProcessorTime) {
    verifies("SWR-PRT-080", Technique::kBoundaryValues);
    time_ = 5_ms;
    wait_ = 60_ms;

    EXPECT_EQ(run(2U, deadline_), 2U);
}

TEST_F(ExecutionBudgetTest, WorkThatHangsIsAbortedBeforeItsDeadline) {
    verifies("SWR-PRT-080", Technique::kFaultInjection, Polarity::kViolation);
    time_ = 600_s;

    EXPECT_EQ(run(2U, deadline_), 0U);

    EXPECT_LT(clock_.get_now(), deadline_);
    EXPECT_FALSE(host_.has_returned(0U));
}

TEST_F(ExecutionBudgetTest, AStepThatReturnsAfterItHasExhaustedTheBudgetIsNotInTime) {
    verifies("SWR-PRT-080", Technique::kBoundaryValues, Polarity::kViolation);
    time_ = 30_ms;
    EXPECT_EQ(run(2U, deadline_), 1U);
}

TEST_F(ExecutionBudgetTest, AllPassesOfAnInstanceShareTheBudget) {
    verifies("SWR-PRT-080", Technique::kBoundaryValues, Polarity::kViolation);
    time_ = 30_ms;
    EXPECT_EQ(run(1U, deadline_), 1U);
    EXPECT_EQ(run(1U, deadline_), 0U) << "10 ms are left";
}

TEST_F(ExecutionBudgetTest, TheNextInstanceHasTheWholeBudget) {
    verifies("SWR-PRT-080", Technique::kBoundaryValues);
    time_ = 30_ms;
    EXPECT_EQ(run(1U, deadline_), 1U);
    EXPECT_EQ(run(1U, deadline_ + 1_s), 1U);
}

TEST_F(ExecutionBudgetTest, ANewThreadHasTheWholeBudgetAlsoForTheSameDeadline) {
    verifies("SWR-PRT-080", Technique::kStateTransition);
    time_ = 30_ms;
    EXPECT_EQ(run(1U, deadline_), 1U);
    EXPECT_EQ(run(1U, deadline_ + 1_s), 1U);
    ASSERT_EQ(host_.close(), Status::kOk);
    ASSERT_EQ(host_.open(), Status::kOk);
    EXPECT_EQ(run(2U, deadline_ + 1_s), 1U) << "40 ms, not those of the thread before";
}

TEST_F(ExecutionBudgetTest, TheShortestBudgetIsExhaustedByTheFirstStep) {
    verifies("SWR-PRT-080", Technique::kBoundaryValues, Polarity::kViolation);
    ASSERT_EQ(host_.close(), Status::kOk);
    ASSERT_EQ(threads_[0].set_execution_budget(Duration{1}), Status::kOk);
    ASSERT_EQ(host_.open(), Status::kOk);
    EXPECT_EQ(run(2U, deadline_), 0U);
}

/// Does not advance, and notes each deadline that a guard waits for.
class LookClock final : public TimeSource {
  public:
    std::int64_t read_ns() const noexcept override { return 0; }
    void wait_until(std::int64_t) const noexcept override {}
    std::int64_t to_monotonic(std::int64_t ns) const noexcept override {
        looks.push_back(Instant{ns});
        return get_monotonic_clock().read_ns() + ns;
    }
    mutable std::vector<Instant> looks;
};

TEST(ExecutionLookTest, TheGuardLooksWhenTheBudgetCanBeExhausted) {
    verifies("SWR-PRT-080", Technique::kBoundaryValues);
    constexpr Instant kDeadline = Instant{} + 600_s;
    for (const Duration budget : {Duration{0}, 1_s}) {
        const LookClock source;
        const FrameClock clock = FrameClock::starting_in(0_ms, source);
        std::array<WindowThread, 1U> threads;
        ASSERT_EQ(threads[0].set_execution_budget(budget), Status::kOk);
        GuardedHost host{threads, clock, {}};
        ASSERT_EQ(host.open(), Status::kOk);
        const auto step = [](void*, std::size_t, std::size_t) noexcept {
            std::this_thread::sleep_for(std::chrono::milliseconds{20});
        };
        EXPECT_EQ(host.run_within({step, nullptr, 0U, 0U, 0U, 1U, WindowHost::Pass::kExecute}, kDeadline),
                  1U);
        ASSERT_FALSE(source.looks.empty());
        EXPECT_LE(source.looks[0], budget == Duration{0} ? kDeadline : Instant{} + budget);
        EXPECT_GT(source.looks[0], budget == Duration{0} ? kDeadline - Duration{1} : Instant{} + 500_ms);
        // The step waits, so another look comes only if the host stalls for longer than the budget.
        EXPECT_LE(source.looks.size(), 100U);
        EXPECT_TRUE(budget != Duration{0} || source.looks.size() == 1U);
        EXPECT_EQ(host.close(), Status::kOk);
    }
}

TEST_F(ExecutionBudgetTest, TheDeadlineHoldsInAddition) {
    verifies("SWR-PRT-080", Technique::kFaultInjection, Polarity::kViolation);
    wait_ = 100_ms;
    const Instant deadline = clock_.get_now() + 20_ms;

    EXPECT_EQ(run(1U, deadline), 0U);

    EXPECT_GE(clock_.get_now(), deadline);
}

TEST_F(ExecutionBudgetTest, ABudgetIsNotNegativeAndSetBeforeTheThreadRuns) {
    verifies("SWR-PRT-080", Technique::kInterface, Polarity::kViolation);
    WindowThread thread;
    EXPECT_EQ(thread.set_execution_budget(Duration{-1}), Status::kBadParameter);
    EXPECT_EQ(thread.set_execution_budget(Duration{0}), Status::kOk);
    EXPECT_EQ(threads_[0].set_execution_budget(1_ms), Status::kPreconditionNotMet);
}

}  // namespace
}  // namespace mamori::ports::posix_rt
