// SPDX-License-Identifier: Apache-2.0
// Goal: a failure of a second thread does not end the process while the first one closes the outputs, and a
// handler that hangs does not keep the process alive. Method: processes in which the handler of one thread
// takes long and another thread fails meanwhile, by a check and by a crash. Their parent checks the actions.
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <functional>
#include <new>
#include <thread>

#include "mamori/kernel/base/assert.hpp"
#include "mamori/ports/posix_rt/crash_handlers.hpp"
#include "mamori/ports/posix_rt/frame_clock.hpp"
#include "mamori/ports/posix_rt/guarded_host.hpp"
#include "mamori/ports/posix_rt/software_watchdog.hpp"
#include "mamori/trace/verifies.hpp"

namespace mamori::ports::posix_rt {
namespace {

using namespace verification;
using literals::operator""_ms;

constexpr int kHandled = 7;  ///< exit status of a process whose handler has returned

/// Data that parent and child share.
struct Shared {
    std::atomic<bool> is_in_handler{false};
    std::atomic<int> handled{0};   ///< failed checks whose handler has returned
    std::atomic<int> closings{0};  ///< by the plan of a crash
};
Shared* g_shared = nullptr;

void sleep_for(Duration time) {
    const FrameClock clock = FrameClock::starting_in(0_ms);
    clock.wait_until(Instant{0} + time);
}

void wait_for(const std::atomic<bool>& flag) {
    while (!flag) {
        sleep_for(1_ms);
    }
}

void close_slowly(const AssertionRecord&) noexcept {
    g_shared->is_in_handler = true;
    sleep_for(200_ms);
    ++g_shared->handled;
    ::_exit(kHandled);
}

void close_slowly_and_return(const AssertionRecord&) noexcept {
    g_shared->is_in_handler = true;
    sleep_for(200_ms);
    ++g_shared->handled;
}

void hang(const AssertionRecord&) noexcept {
    g_shared->is_in_handler = true;
    sleep_for(Duration{60'000'000'000});
}

void close_by_plan(void*) noexcept {
    ++g_shared->closings;
}

void hang_by_plan(void*) noexcept {
    g_shared->is_in_handler = true;
    sleep_for(Duration{60'000'000'000});
}

void close_slowly_by_plan(void*) noexcept {
    g_shared->is_in_handler = true;
    sleep_for(200_ms);
    ++g_shared->closings;
}

void fail() {
    volatile bool holds = false;
    MAMORI_INVARIANT(1, holds);
}

void crash() {
    static_cast<void>(::raise(SIGSEGV));
}

class FailureOrderTest : public ::testing::Test {
  protected:
    FailureOrderTest() {
        void* const memory =
            ::mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
        EXPECT_NE(memory, MAP_FAILED);
        g_shared = new (memory) Shared{};
    }
    ~FailureOrderTest() override { static_cast<void>(::munmap(g_shared, sizeof(Shared))); }

    /// @return status of a process that runs `act`.
    static int run(const std::function<void()>& act) {
        const pid_t child = ::fork();
        if (child == 0) {
            const rlimit no_core{0U, 0U};
            static_cast<void>(::setrlimit(RLIMIT_CORE, &no_core));
            act();
            ::_exit(1);
        }
        int status = 0;
        EXPECT_EQ(::waitpid(child, &status, 0), child);
        return status;
    }
    /// A process with crash handlers: `first` fails, and `second` while the first one is handled.
    static int run_both(void (*first)(), void (*second)(), AssertionHandler handler,
                        void (*close)(void*) noexcept = &close_by_plan) {
        return run([=] {
            CrashHandlers handlers;
            if (handlers.install({close, nullptr, {}, 0U, FrameClock::starting_in(0_ms)}) != Status::kOk) {
                ::_exit(2);
            }
            set_assertion_handler(handler);
            std::thread one{first};
            wait_for(g_shared->is_in_handler);
            std::thread two{second};
            one.join();
            two.join();
        });
    }
    static void expect_handled(int status) {
        EXPECT_TRUE(WIFEXITED(status)) << "ended by signal " << WTERMSIG(status);
        EXPECT_EQ(WEXITSTATUS(status), kHandled);
        EXPECT_EQ(g_shared->handled, 1);
    }
};

TEST_F(FailureOrderTest, FailedCheckOfASecondThreadWaitsForTheHandlerOfTheFirst) {
    verifies("SWR-PRT-045", Technique::kFaultInjection, Polarity::kViolation);
    expect_handled(run_both(&fail, &fail, &close_slowly));
    EXPECT_EQ(g_shared->closings, 0);
}

TEST_F(FailureOrderTest, CrashOfASecondThreadClosesTheOutputsAtOnceAndWaitsForTheHandlerOfTheFirst) {
    verifies("SWR-PRT-045", Technique::kFaultInjection, Polarity::kViolation);
    expect_handled(run_both(&fail, &crash, &close_slowly));
    EXPECT_EQ(g_shared->closings, 1);
}

TEST_F(FailureOrderTest, HandlerThatReturnsEndsTheWaitOfACrash) {
    verifies("SWR-PRT-045", Technique::kFaultInjection, Polarity::kViolation);
    const FrameClock clock = FrameClock::starting_in(0_ms);
    const int status = run_both(&fail, &crash, &close_slowly_and_return);
    EXPECT_TRUE(WIFSIGNALED(status));
    EXPECT_EQ(WTERMSIG(status), SIGSEGV) << "the crash ends the process";
    EXPECT_EQ(g_shared->handled, 1);
    EXPECT_EQ(g_shared->closings, 1);
    EXPECT_GE(clock.get_now(), Instant{0} + 200_ms);
}

TEST_F(FailureOrderTest, FailedCheckWaitsForTheCrashOfAnotherThreadWithoutItsOwnHandler) {
    verifies("SWR-PRT-045", Technique::kFaultInjection, Polarity::kViolation);
    const int status = run_both(&crash, &fail, &close_slowly, &close_slowly_by_plan);
    EXPECT_TRUE(WIFSIGNALED(status));
    EXPECT_EQ(WTERMSIG(status), SIGSEGV);
    EXPECT_EQ(g_shared->closings, 1);
    EXPECT_EQ(g_shared->handled, 0);
}

TEST_F(FailureOrderTest, CrashOfASecondThreadWaitsForTheCrashOfTheFirst) {
    verifies("SWR-PRT-045", Technique::kFaultInjection, Polarity::kViolation);
    const int status =
        run_both(&crash, [] { static_cast<void>(::raise(SIGBUS)); }, nullptr, &close_slowly_by_plan);
    EXPECT_TRUE(WIFSIGNALED(status));
    EXPECT_EQ(WTERMSIG(status), SIGSEGV) << "of the first";
    EXPECT_EQ(g_shared->closings, 1);
}

TEST_F(FailureOrderTest, CrashOfASecondThreadEndsTheProcessIfTheCrashOfTheFirstHangs) {
    verifies("SWR-PRT-045", Technique::kFaultInjection, Polarity::kViolation);
    const FrameClock clock = FrameClock::starting_in(0_ms);
    const int status = run_both(&crash, [] { static_cast<void>(::raise(SIGBUS)); }, nullptr, &hang_by_plan);
    EXPECT_TRUE(WIFSIGNALED(status)) << "the hang would end by itself after a minute";
    EXPECT_EQ(WTERMSIG(status), SIGBUS) << "of the second";
    EXPECT_GE(clock.get_now(), Instant{0} + 1000_ms);
}

TEST_F(FailureOrderTest, HandlerThatHangsDelaysTheEndByOneSecondOnly) {
    verifies("SWR-PRT-045", Technique::kBoundaryValues, Polarity::kViolation);
    for (void (*const second)() : {&fail, &crash}) {
        g_shared->is_in_handler = false;
        const FrameClock clock = FrameClock::starting_in(0_ms);
        const int status = run_both(&fail, second, &hang);
        EXPECT_TRUE(WIFSIGNALED(status)) << "the hang would end by itself after a minute";
        EXPECT_GE(clock.get_now(), Instant{0} + 1000_ms)
            << "not before the wait for the first thread has timed out";
        EXPECT_LT(clock.get_now(), Instant{0} + 50'000_ms);
    }
    EXPECT_EQ(g_shared->handled, 0);
    EXPECT_EQ(g_shared->closings, 2);
}

TEST_F(FailureOrderTest, CheckThatFailsInTheHandlerEndsTheProcessAtOnce) {
    verifies("SWR-PRT-045", Technique::kErrorGuessing, Polarity::kViolation);
    const int status = run_both(
        &fail, [] {},
        [](const AssertionRecord&) noexcept {
            g_shared->is_in_handler = true;
            fail();
            ++g_shared->handled;
        });
    EXPECT_TRUE(WIFSIGNALED(status));
    EXPECT_EQ(g_shared->handled, 0);
    EXPECT_EQ(g_shared->closings, 1);
}

TEST_F(FailureOrderTest, FailedCheckWithCrashHandlersPrintsItsLineOnceAndClosesTheOutputs) {
    verifies("SWR-KRN-042", Technique::kInterface, Polarity::kViolation);
    EXPECT_EXIT(
        {
            CrashHandlers handlers;
            if (handlers.install({&close_by_plan, nullptr, {}, 0U, FrameClock::starting_in(0_ms)}) ==
                Status::kOk) {
                fail();
            }
        },
        ::testing::KilledBySignal(SIGILL),
        "^mamori: failed check: 'holds', [^\n]*failure_order_test[.]cpp:[0-9]+ [(]id 1[)]\n$");
    EXPECT_EQ(g_shared->closings, 1);
}

/// Functions of the real-time port that install the failure gate.
void open_host() {
    static std::array<WindowThread, 1U> threads;
    static const FrameClock clock = FrameClock::starting_in(0_ms);
    static GuardedHost host{threads, clock, {}};
    static_cast<void>(host.open());
}

void open_watchdog() {
    static const FrameClock clock = FrameClock::starting_in(0_ms);
    static SoftwareWatchdog watchdog{clock, {0_ms, 1_ms}, {&close_by_plan, nullptr, false}};
    static_cast<void>(watchdog.open({}));
}

TEST_F(FailureOrderTest, WaitingThreadOfAHighPriorityLeavesTheProcessorToTheHandler) {
    verifies("SWR-PRT-045", Technique::kFaultInjection, Polarity::kViolation);
    std::atomic<bool> has_privilege{false};
    std::thread{[&] { has_privilege = set_priority(pthread_self(), 80).is_granted; }}.join();
    if (!has_privilege) {
        GTEST_SKIP()
            << "verdict=no-privilege: this host grants no fixed priority (CAP_SYS_NICE or ulimit -r)";
    }
    const auto compute_and_exit = [](const AssertionRecord&) noexcept {
        g_shared->is_in_handler = true;
        const FrameClock clock = FrameClock::starting_in(0_ms);
        while (clock.get_now() < Instant{0} + 100_ms) {
        }
        ++g_shared->handled;
        ::_exit(kHandled);
    };
    for (void (*const open)() : {&open_host, &open_watchdog}) {
        g_shared->is_in_handler = false;
        g_shared->handled = 0;
        expect_handled(run([open, compute_and_exit] {
            static_cast<void>(set_processor(pthread_self(), sched_getcpu()));
            open();
            set_assertion_handler(compute_and_exit);
            std::thread two{[] {
                static_cast<void>(set_priority(pthread_self(), 80));
                wait_for(g_shared->is_in_handler);
                fail();
            }};
            fail();
        }));
    }
}

}  // namespace
}  // namespace mamori::ports::posix_rt
