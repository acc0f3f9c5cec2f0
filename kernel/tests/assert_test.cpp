// SPDX-License-Identifier: Apache-2.0
// Goal: a failed check reaches the application's handler with its place and never comes back.
// Method: death tests, since the program must not go on.
#include "mamori/kernel/base/assert.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <thread>

#include "mamori/trace/verifies.hpp"

namespace mamori {
namespace {

using namespace verification;

void report_and_exit(const AssertionRecord& record) noexcept {
    const char* name = std::strrchr(record.file, '/');
    std::fprintf(stderr, "handler: %s id %u line %s", name == nullptr ? record.file : name + 1,
                 static_cast<unsigned>(record.id), record.line > 0U ? "known" : "unknown");
    std::_Exit(3);
}

void report_and_return(const AssertionRecord& record) noexcept {
    std::fprintf(stderr, "handler %u returned;", static_cast<unsigned>(record.id));
}

void fail_again(const AssertionRecord& record) noexcept {
    std::fprintf(stderr, "handler %u;", static_cast<unsigned>(record.id));
    MAMORI_REQUIRE(record.id + 1U, false);
}

/// Whether `status` is that of a halt without any output: the trap instruction is the only evidence.
bool is_halt(int status) {
    return WIFSIGNALED(status) && (WTERMSIG(status) == SIGILL || WTERMSIG(status) == SIGTRAP);
}

constexpr int calc_half(int even) {
    MAMORI_REQUIRE(1, even % 2 == 0);
    return even / 2;
}

TEST(AssertTest, ACheckThatHoldsDoesNothing) {
    verifies("SWR-KRN-003");
    int evaluations = 0;

    MAMORI_REQUIRE(1, ++evaluations > 0);
    MAMORI_ENSURE(2, ++evaluations > 0);
    MAMORI_INVARIANT(3, ++evaluations > 0);

    EXPECT_EQ(evaluations, 3);
}

TEST(AssertTest, AChecksConditionIsEvaluatedAtCompileTimeInAConstant) {
    verifies("SWR-KRN-003", Technique::kInterface);
    constexpr int kHalf = calc_half(8);

    EXPECT_EQ(kHalf, 4);
}

TEST(AssertDeathTest, AFailedCheckHandsFileAndIdToTheHandler) {
    verifies("SWR-KRN-003", Technique::kFaultInjection, Polarity::kViolation);

    EXPECT_EXIT(
        {
            set_assertion_handler(&report_and_exit);
            MAMORI_REQUIRE(42, false);
        },
        ::testing::ExitedWithCode(3), "handler: assert_test.cpp id 42 line known");
}

TEST(AssertDeathTest, AFailedCheckHaltsWithoutAHandler) {
    verifies("SWR-KRN-003", Technique::kFaultInjection, Polarity::kViolation);

    EXPECT_EXIT(MAMORI_ENSURE(1, false), is_halt, "^$");
}

TEST(AssertDeathTest, TheDefaultComesBackWithANullHandler) {
    verifies("SWR-KRN-003", Technique::kErrorGuessing, Polarity::kViolation);

    EXPECT_EXIT(
        {
            set_assertion_handler(&report_and_exit);
            set_assertion_handler(nullptr);
            MAMORI_INVARIANT(1, false);
        },
        is_halt, "^$");
}

TEST(AssertDeathTest, AHandlerThatReturnsDoesNotLetTheProgramGoOn) {
    verifies("SWR-KRN-003", Technique::kFaultInjection, Polarity::kViolation);

    EXPECT_DEATH(
        {
            set_assertion_handler(&report_and_return);
            MAMORI_REQUIRE(5, false);
            std::fprintf(stderr, "went on");
            std::_Exit(0);
        },
        "^handler 5 returned;$");
}

TEST(AssertDeathTest, ACheckThatFailsInTheHandlerHaltsInsteadOfCallingItAgain) {
    verifies("SWR-KRN-003", Technique::kErrorGuessing, Polarity::kViolation);

    EXPECT_DEATH(
        {
            set_assertion_handler(&fail_again);
            MAMORI_REQUIRE(1, false);
        },
        "^handler 1;$");
}

std::atomic<bool> handler_runs{false};

void close_slowly(const AssertionRecord& record) noexcept {
    handler_runs = true;
    std::this_thread::sleep_for(std::chrono::milliseconds{150});
    std::fprintf(stderr, "outputs closed by check %u;", static_cast<unsigned>(record.id));
    std::_Exit(3);
}

void close_slowly_and_return(const AssertionRecord& record) noexcept {
    handler_runs = true;
    std::this_thread::sleep_for(std::chrono::milliseconds{150});
    std::fprintf(stderr, "outputs closed by check %u;", static_cast<unsigned>(record.id));
}

void hang(const AssertionRecord&) noexcept {
    handler_runs = true;
    std::fprintf(stderr, "handler hangs;");
    for (;;) {
        std::this_thread::sleep_for(std::chrono::milliseconds{10});
    }
}

/// A check fails on one thread, and others fail while its handler runs.
void fail_on_several_threads(AssertionHandler handler) {
    set_assertion_handler(handler);
    std::thread first{[] { MAMORI_REQUIRE(1, false); }};
    while (!handler_runs) {
        std::this_thread::yield();
    }
    std::thread second{[] { MAMORI_REQUIRE(2, false); }};
    std::thread third{[] { MAMORI_REQUIRE(3, false); }};
    first.join();
    second.join();
    third.join();
}

TEST(AssertDeathTest, LaterFailuresOfOtherThreadsWaitUntilTheHandlerHasClosedTheOutputs) {
    verifies("SWR-PRT-045", Technique::kFaultInjection, Polarity::kViolation);
    EXPECT_EXIT(fail_on_several_threads(&close_slowly), ::testing::ExitedWithCode(3),
                "^outputs closed by check 1;$");
    EXPECT_DEATH(fail_on_several_threads(&close_slowly_and_return), "^outputs closed by check 1;$");
}

TEST(AssertDeathTest, LaterFailuresOfOtherThreadsEndTheProgramWhenTheHandlerHangs) {
    verifies("SWR-PRT-045", Technique::kErrorGuessing, Polarity::kViolation);
    EXPECT_DEATH(fail_on_several_threads(&hang), "^handler hangs;$");
}

void print_gate(const AssertionRecord& record) noexcept {
    std::fprintf(stderr, "gate %u;", static_cast<unsigned>(record.id));
}

TEST(AssertDeathTest, AGateTakesEachRecordBeforeTheHandlerAndDoesTheWaiting) {
    verifies("SWR-PRT-045", Technique::kInterface, Polarity::kViolation);
    EXPECT_DEATH(
        {
            set_assertion_gate(&print_gate);
            set_assertion_handler(&fail_again);
            MAMORI_REQUIRE(7, false);
        },
        "^gate 7;handler 7;gate 8;$");
    EXPECT_DEATH(
        {
            set_assertion_gate(&print_gate);
            MAMORI_REQUIRE(7, false);
        },
        "^gate 7;$");
}

}  // namespace
}  // namespace mamori
