// SPDX-License-Identifier: Apache-2.0
// Goal: work that is back in time is counted, work that is not is cut off without its help, and nobody else
// suffers. Method: a real executive; components that take longer than the deadline or hang until the test
// lets them go. Nothing is asked of the speed of the machine: deadlines are long, and what takes too long
// waits for the clock itself.
#include "mamori/ports/posix_rt/guarded_host.hpp"

#include <gtest/gtest.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <string>
#include <thread>
#include <vector>

#include "mamori/kernel/run/executive.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/ports/posix_rt/crash_place.hpp"
#include "mamori/trace/verifies.hpp"
#include "mamori/verification/failed_check.hpp"
#include "support/actor.hpp"
#include "support/fake_clock.hpp"

namespace mamori::ports::posix_rt {
namespace {

using namespace verification;
using literals::operator""_ms;
using literals::operator""_s;

class Ear final : public ExecutionObserver {
  public:
    std::vector<std::string> heard;
    void on_budget_overrun(std::size_t window, std::size_t component, Instant) noexcept override {
        heard.push_back("window " + std::to_string(window) + " component " + std::to_string(component));
    }
    void on_late_release(std::size_t, Duration, Instant) noexcept override {}
};

/// Two windows of a frame of 10 s, which no machine is too slow for; budgets are as the test needs them.
class GuardedHostTest : public ::testing::Test {
  protected:
    void SetUp() override {
        ASSERT_EQ(host_.open(), Status::kOk);
        ASSERT_EQ(sut_.initialize(), Status::kOk);
        ASSERT_EQ(sut_.start(), Status::kOk);
        sut_.set_observer(&ear_);
    }
    void TearDown() override {
        first_.is_to_hang = false;
        while (host_.close() != Status::kOk) {
            std::this_thread::yield();
        }
    }
    void wait_until_back() const {
        while (!host_.has_returned(0U)) {
            std::this_thread::yield();
        }
    }

    Actor first_{"first"};
    Actor second_{"second"};
    Actor other_{"other"};
    SystemTable<2U, 3U, 3U, 0U> table_ =
        system(frame(10_s), window("guarded", 0_s, 5_s, budget(20_ms), run(first_, second_)),
               window("other", 5_s, 5_s, budget(5_s), run(other_)));
    const FrameClock clock_ = FrameClock::starting_in(0_ms);
    std::array<WindowThread, 2U> threads_;
    GuardedHost host_{threads_, clock_, {}};
    Ear ear_;
    ExecutiveFor<decltype(table_)> sut_{table_};
};

TEST_F(GuardedHostTest, WorkThatIsBackInTimeCompletesItsWindow) {
    verifies("SWR-PRT-003");

    EXPECT_EQ(sut_.run_window(1U, Instant{0}, host_), WindowOutcome::kCompleted);
    EXPECT_EQ(other_.out.get_sequence(), 1U);
    EXPECT_TRUE(host_.get_priority_right().is_granted) << "none was asked for";
    EXPECT_TRUE(host_.get_processor_right().is_granted);
}

TEST_F(GuardedHostTest, AComponentThatHangsIsNamedAndTheOtherWindowRuns) {
    verifies("SWR-PRT-003", Technique::kFaultInjection, Polarity::kViolation);
    first_.is_to_hang = true;

    EXPECT_EQ(sut_.run_window(0U, Instant{0}, host_), WindowOutcome::kOverrun);
    while (!first_.is_hanging) {
        std::this_thread::yield();
    }
    EXPECT_FALSE(host_.has_returned(0U));
    EXPECT_EQ(sut_.run_window(1U, Instant{0}, host_), WindowOutcome::kCompleted);
    EXPECT_EQ(sut_.run_window(0U, Instant{0}, host_), WindowOutcome::kOverrun);
    EXPECT_EQ(host_.close(), Status::kPreconditionNotMet) << "its thread is still out";

    EXPECT_TRUE(second_.starts.empty());
    EXPECT_EQ(ear_.heard, (std::vector<std::string>{"window 0 component 0", "window 0 component 0"}));
    EXPECT_EQ(first_.out.get_sequence(), 0U);
}

TEST_F(GuardedHostTest, WorkThatComesBackLateIsThrownAwayAndTheNextCycleCounts) {
    verifies("SWR-PRT-003", Technique::kFaultInjection, Polarity::kViolation);
    first_.is_to_hang = true;
    ASSERT_EQ(sut_.run_window(0U, Instant{0}, host_), WindowOutcome::kOverrun);
    first_.is_to_hang = false;
    wait_until_back();

    table_.windows[0].budget = 5_s;  // which no machine is too slow for
    EXPECT_EQ(sut_.run_window(0U, clock_.get_now(), host_), WindowOutcome::kCompleted);
    EXPECT_EQ(first_.out.get_sequence(), 1U);
    EXPECT_EQ(second_.out.get_sequence(), 1U);
}

TEST_F(GuardedHostTest, AStepThatEndsAfterTheDeadlineIsNotCountedThoughItCameBack) {
    verifies("SWR-PRT-003", Technique::kBoundaryValues, Polarity::kViolation);
    second_.clock = &clock_;
    second_.busy_until = clock_.get_now() + 500_ms;

    WindowOutcome outcome = sut_.run_window(0U, clock_.get_now(), host_);

    EXPECT_EQ(outcome, WindowOutcome::kOverrun);
    EXPECT_EQ(second_.out.get_sequence(), 0U);
    ASSERT_FALSE(ear_.heard.empty());
}

TEST_F(GuardedHostTest, ThreadsThatAreOpenAreNotOpenedAgain) {
    verifies("SWR-PRT-003", Technique::kErrorGuessing, Polarity::kViolation);
    GuardedHost another{threads_, clock_, {}};

    EXPECT_EQ(host_.open(), Status::kPreconditionNotMet);
    EXPECT_EQ(another.open(), Status::kPreconditionNotMet);
    ASSERT_EQ(host_.close(), Status::kOk);
    EXPECT_EQ(host_.close(), Status::kOk) << "nothing to end";
    EXPECT_EQ(another.open(), Status::kOk);
    EXPECT_EQ(another.close(), Status::kOk);
    EXPECT_EQ(host_.open(), Status::kOk);
}

/// One window whose thread notes on a signal where it is.
class WaitingThreadTest : public ::testing::Test {
  protected:
    static void note(int) {
        place_ = get_crash_place();
        ++noted_;
    }
    static void run_step(void*, std::size_t, std::size_t) noexcept {
        thread_ = ::gettid();
        stack_t stack{};
        static_cast<void>(::sigaltstack(nullptr, &stack));
        has_crash_stack_ = stack.ss_flags != SS_DISABLE;
    }
    std::size_t run_window(Instant deadline) {
        return host_.run_within({&run_step, nullptr, 0U, 0U, 0U, 1U, WindowHost::Pass::kExecute}, deadline);
    }

    static inline std::atomic<int> noted_{0};
    static inline CrashPlace place_{};
    static inline std::atomic<pid_t> thread_{0};
    static inline std::atomic<bool> has_crash_stack_{false};
    const FrameClock clock_ = FrameClock::starting_in(0_ms);
    std::array<WindowThread, 1U> threads_;
    GuardedHost host_{threads_, clock_, {}};
};

TEST_F(WaitingThreadTest, ASignalDoesNotEndTheWaitAndFindsNoComponent) {
    verifies("SWR-PRT-003", Technique::kFaultInjection, Polarity::kViolation);
    struct sigaction action{};
    struct sigaction before{};
    action.sa_handler = &note;  // without SA_RESTART: the wait ends early
    ASSERT_EQ(sigaction(SIGUSR1, &action, &before), 0);
    ASSERT_EQ(host_.open(), Status::kOk);
    for (int i = 1; i <= 3; ++i) {
        ASSERT_EQ(run_window(clock_.get_now() + 600_s), 1U);
        ASSERT_EQ(::syscall(SYS_tgkill, ::getpid(), thread_.load(), SIGUSR1), 0);
        while (noted_ < i) {
            std::this_thread::yield();
        }
        EXPECT_EQ(place_.window, CrashPlace::kNone);
        EXPECT_EQ(place_.component, CrashPlace::kNone);
    }
    EXPECT_EQ(host_.close(), Status::kOk);
    ASSERT_EQ(sigaction(SIGUSR1, &before, nullptr), 0);
}

TEST_F(WaitingThreadTest, AThreadThatIsStartedAgainHasACrashStackAgain) {
    verifies("SWR-PRT-026", Technique::kStateTransition);
    for (int i = 0; i < 3; ++i) {
        ASSERT_EQ(host_.open(), Status::kOk);
        has_crash_stack_ = false;
        ASSERT_EQ(run_window(clock_.get_now() + 600_s), 1U);
        EXPECT_TRUE(has_crash_stack_) << i;
        ASSERT_EQ(host_.close(), Status::kOk);
    }
}

TEST_F(WaitingThreadTest, WorkNeedsAnOpenThreadThatHasReturned) {
    verifies("SWR-PRT-003", Technique::kInterface, Polarity::kViolation);
    EXPECT_CHECK_FAILS(static_cast<void>(run_window(Instant{})), "guarded_host.cpp", 5);
    EXPECT_CHECK_FAILS(
        {
            static_cast<void>(host_.open());
            const auto hang = [](void*, std::size_t, std::size_t) noexcept {
                for (;;) {
                    static_cast<void>(::pause());
                }
            };
            static_cast<void>(
                host_.run_within({hang, nullptr, 0U, 0U, 0U, 1U, WindowHost::Pass::kExecute}, Instant{}));
            static_cast<void>(run_window(Instant{}));
        },
        "guarded_host.cpp", 5);
}

TEST_F(WaitingThreadTest, AStepThatEndsAtTheDeadlineIsInTime) {
    verifies("SWR-PRT-003", Technique::kBoundaryValues);
    FakeClock source{0};
    source.monotonic_offset_ns = get_monotonic_clock().read_ns() + 600'000'000'000;  // no deadline passes
    const FrameClock clock = FrameClock::starting_in(0_ms, source);
    source.now_ns = 5'000;
    GuardedHost host{threads_, clock, {}};
    ASSERT_EQ(host.open(), Status::kOk);
    const WindowHost::Work work{&run_step, nullptr, 0U, 0U, 0U, 1U, WindowHost::Pass::kExecute};
    EXPECT_EQ(host.run_within(work, Instant{5'000}), 1U);
    EXPECT_EQ(host.run_within(work, Instant{4'999}), 0U);
    EXPECT_EQ(host.close(), Status::kOk);
}

TEST_F(WaitingThreadTest, RightsAreThoseOfTheThreadsOfTheHost) {
    verifies("SWR-PRT-002", Technique::kFaultInjection, Polarity::kViolation);
    GuardedHost elsewhere{threads_, clock_, {0, 100'000}};
    ASSERT_EQ(elsewhere.open(), Status::kOk);
    EXPECT_TRUE(elsewhere.get_priority_right().is_granted);
    EXPECT_FALSE(elsewhere.get_processor_right().is_granted);
    EXPECT_EQ(elsewhere.get_processor_right().system_error, EINVAL);
    ASSERT_EQ(elsewhere.close(), Status::kOk);

    const std::array<WindowRow, 1U> rows{};
    GuardedHost without{threads_, rows, 1U, clock_, {0, 100'000}};
    ASSERT_EQ(without.open(), Status::kOk) << "no window is on its core";
    for (const Right& right : {without.get_priority_right(), without.get_processor_right()}) {
        EXPECT_TRUE(right.is_granted);
        EXPECT_EQ(right.system_error, 0);
    }
    EXPECT_EQ(without.close(), Status::kOk);
}

struct Gate {
    std::atomic<bool> is_closed{false};
    std::atomic<bool> is_reached{false};
};
Status wait_for(Gate& gate, ContextHandle) noexcept {
    gate.is_reached = true;
    while (gate.is_closed) {
        std::this_thread::yield();
    }
    return Status::kOk;
}

TEST(GuardedFunctionTest, ASystemWindowThatHangsIsNamedAndTheOtherWindowRuns) {
    verifies("SWR-KRN-097", Technique::kFaultInjection, Polarity::kViolation);
    Gate gate;
    SystemFunction<&wait_for> function{"function", gate};
    Actor other{"other"};
    auto table = system(frame(10_s), system_window("call", 0_s, 5_s, budget(20_ms), function),
                        window("other", 5_s, 5_s, budget(5_s), run(other)));
    const FrameClock clock = FrameClock::starting_in(0_ms);
    std::array<WindowThread, 2U> threads;
    GuardedHost host{threads, clock, {}};
    Ear ear;
    ExecutiveFor executive{table};
    ASSERT_EQ(host.open(), Status::kOk);
    ASSERT_EQ(executive.initialize(), Status::kOk);
    ASSERT_EQ(executive.start(), Status::kOk);
    executive.set_observer(&ear);

    gate.is_closed = true;
    EXPECT_EQ(executive.run_window(0U, Instant{0}, host), WindowOutcome::kOverrun);
    while (!gate.is_reached) {
        std::this_thread::yield();
    }
    EXPECT_EQ(executive.run_window(1U, Instant{0}, host), WindowOutcome::kCompleted);
    EXPECT_EQ(ear.heard, (std::vector<std::string>{"window 0 component 0"}));

    gate.is_closed = false;
    while (!host.has_returned(0U)) {
        std::this_thread::yield();
    }
    table.windows[0].budget = 5_s;
    EXPECT_EQ(executive.run_window(0U, clock.get_now(), host), WindowOutcome::kCompleted);
    ASSERT_EQ(host.close(), Status::kOk);
}

}  // namespace
}  // namespace mamori::ports::posix_rt
