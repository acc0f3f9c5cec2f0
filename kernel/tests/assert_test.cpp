// SPDX-License-Identifier: Apache-2.0
// Goal: a failed check reaches the application's handler with its location, prints one line afterwards, and
// never returns. Method: death tests, because the program must end; child processes whose standard error is
// full or closed.
#include "mamori/kernel/base/assert.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <pthread.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <thread>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/record/event_log.hpp"
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

/// Whether `status` is that of a halt by the trap instruction.
bool is_halt(int status) {
    return WIFSIGNALED(status) && (WTERMSIG(status) == SIGILL || WTERMSIG(status) == SIGTRAP);
}

/// Regular expression for the one line of a failed check. @param[in] condition as a regular expression.
std::string make_line(const std::string& condition, const std::string& file, int id) {
    return "mamori: failed check: '" + condition + "', [^\n]*" + file + ":[1-9][0-9]* [(]id " +
           std::to_string(id) + "[)]\n";
}
/// The same for this file and the condition `false`.
std::string make_line(int id) {
    return make_line("false", "assert_test[.]cpp", id);
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

    EXPECT_EXIT(MAMORI_ENSURE(1, false), is_halt, "^" + make_line(1) + "$");
}

TEST(AssertDeathTest, TheDefaultComesBackWithANullHandler) {
    verifies("SWR-KRN-003", Technique::kErrorGuessing, Polarity::kViolation);

    EXPECT_EXIT(
        {
            set_assertion_handler(&report_and_exit);
            set_assertion_handler(nullptr);
            MAMORI_INVARIANT(1, false);
        },
        is_halt, "^" + make_line(1) + "$");
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
        "^handler 5 returned;" + make_line(5) + "$");
}

TEST(AssertDeathTest, ACheckThatFailsInTheHandlerHaltsInsteadOfCallingItAgain) {
    verifies("SWR-KRN-003", Technique::kErrorGuessing, Polarity::kViolation);

    EXPECT_DEATH(
        {
            set_assertion_handler(&fail_again);
            MAMORI_REQUIRE(1, false);
        },
        "^handler 1;" + make_line(1) + "$");
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
    EXPECT_DEATH(fail_on_several_threads(&close_slowly_and_return),
                 "^outputs closed by check 1;" + make_line(1) + "$");
}

TEST(AssertDeathTest, LaterFailuresOfOtherThreadsEndTheProgramWhenTheHandlerHangs) {
    verifies("SWR-PRT-045", Technique::kErrorGuessing, Polarity::kViolation);
    EXPECT_DEATH(fail_on_several_threads(&hang), "^handler hangs;" + make_line(1) + "$");
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
        "^gate 7;handler 7;gate 8;" + make_line(7) + "$");
    EXPECT_DEATH(
        {
            set_assertion_gate(&print_gate);
            MAMORI_REQUIRE(7, false);
        },
        "^gate 7;" + make_line(7) + "$");
}

TEST(AssertDeathTest, AFailedCheckPrintsItsConditionItsLocationAndItsNumber) {
    verifies("SWR-KRN-042", Technique::kFaultInjection, Polarity::kViolation);
    std::array<int, 2U> numbers{};
    Span<int> span{numbers};
    std::array<Event, 1U> storage{};
    EventLog log{storage};

    EXPECT_EXIT(static_cast<void>(span[2U]), is_halt,
                "^" + make_line("index < size_", "base/span[.]hpp", 1) + "$");
    EXPECT_EXIT(static_cast<void>(log.get(0U)), is_halt,
                "^" + make_line("index < kept_count_", "src/record/event_log[.]cpp", 1) + "$");
    EXPECT_EXIT(static_cast<void>(calc_half(7)), is_halt,
                "^" + make_line("even % 2 == 0", "assert_test[.]cpp", 1) + "$");
}

TEST(AssertDeathTest, TheLineFollowsTheHandlerThatReturnsAndIsNotPrintedForOneThatEndsTheProgram) {
    verifies("SWR-KRN-042", Technique::kInterface, Polarity::kViolation);

    EXPECT_EXIT(
        {
            set_assertion_gate(&print_gate);
            set_assertion_handler(&report_and_return);
            MAMORI_REQUIRE(6, false);
        },
        is_halt, "^gate 6;handler 6 returned;" + make_line(6) + "$");
    EXPECT_EXIT(
        {
            set_assertion_handler(&report_and_exit);
            MAMORI_REQUIRE(6, false);
        },
        ::testing::ExitedWithCode(3), "line known$");
}

void print_condition(const AssertionRecord& record) noexcept {
    std::fprintf(stderr, "handler: %s", record.condition);
    std::_Exit(3);
}

TEST(AssertDeathTest, TheHandlerGetsTheSourceTextOfTheConditionOfEachKind) {
    verifies("SWR-KRN-042", Technique::kInterface, Polarity::kViolation);
    set_assertion_handler(&print_condition);
    const int errors = EINVAL;  // a macro in a condition keeps its name

    EXPECT_EXIT(MAMORI_REQUIRE(1, errors < EINVAL), ::testing::ExitedWithCode(3),
                "^handler: errors < EINVAL$");
    EXPECT_EXIT(MAMORI_ENSURE(2, errors < EINVAL), ::testing::ExitedWithCode(3),
                "^handler: errors < EINVAL$");
    EXPECT_EXIT(MAMORI_INVARIANT(3, errors < EINVAL), ::testing::ExitedWithCode(3),
                "^handler: errors < EINVAL$");
    set_assertion_handler(nullptr);
}

TEST(AssertDeathTest, ALongConditionAndALongPathAreShortenedAndNumbersAreComplete) {
    verifies("SWR-KRN-042", Technique::kBoundaryValues, Polarity::kViolation);
    const std::string path(300U, 'p');
    const std::string condition(300U, 'c');

    EXPECT_EXIT(
        detail::fail_assertion((path + "/end.cpp").c_str(), 4294967295U, 4294967295U, condition.c_str()),
        is_halt, "^mamori: failed check: 'c{200}', p{192}/end[.]cpp:4294967295 [(]id 4294967295[)]\n$");
    EXPECT_EXIT(detail::fail_assertion("a.cpp", 0U, 10U, nullptr), is_halt,
                "^mamori: failed check: '', a[.]cpp:10 [(]id 0[)]\n$");
}

TEST(AssertDeathTest, FailuresOfSeveralThreadsPrintOneLine) {
    verifies("SWR-KRN-042", Technique::kErrorGuessing, Polarity::kViolation);

    EXPECT_EXIT(
        {
            std::atomic<bool> may_fail{false};
            const auto wait_and_fail = [&may_fail] {
                while (!may_fail) {
                }
                MAMORI_REQUIRE(1, false);
            };
            std::thread first{wait_and_fail};
            std::thread second{wait_and_fail};
            may_fail = true;
            first.join();
            second.join();
        },
        is_halt, "^" + make_line(1) + "$");
}

/// @return status of a process that runs `act` with `output` as its standard error.
template <typename Act>
int run_with_standard_error(int output, const Act& act) {
    const pid_t child = ::fork();
    if (child == 0) {
        static_cast<void>(::dup2(output, STDERR_FILENO));
        act();
        ::_exit(1);
    }
    int status = 0;
    EXPECT_EQ(::waitpid(child, &status, 0), child);
    return status;
}

TEST(AssertTest, TheLineContainsNothingAfterItsNewline) {
    verifies("SWR-KRN-042", Technique::kBoundaryValues, Polarity::kViolation);
    std::array<int, 2U> ends{};
    ASSERT_EQ(::pipe(ends.data()), 0);
    const auto fail = [] { detail::fail_assertion("a.cpp", 1U, 2U, "false"); };

    EXPECT_TRUE(is_halt(run_with_standard_error(ends[1], fail)));
    ASSERT_EQ(::close(ends[1]), 0);
    std::array<char, 100U> text{};
    const std::string expected = "mamori: failed check: 'false', a.cpp:2 (id 1)\n";
    EXPECT_EQ(::read(ends[0], text.data(), text.size() - 1U), static_cast<ssize_t>(expected.size()));
    EXPECT_STREQ(text.data(), expected.c_str());
    ASSERT_EQ(::close(ends[0]), 0);
}

TEST(AssertTest, AStandardErrorThatIsFullOrClosedDoesNotKeepTheProgramFromItsHalt) {
    verifies("SWR-KRN-042", Technique::kFaultInjection, Polarity::kViolation);
    std::array<int, 2U> ends{};
    ASSERT_EQ(::pipe(ends.data()), 0);
    ASSERT_EQ(::fcntl(ends[1], F_SETFL, O_NONBLOCK), 0);
    while (::write(ends[1], "x", 1U) == 1) {
    }
    ASSERT_EQ(::fcntl(ends[1], F_SETFL, 0), 0);
    const auto fail = [] { MAMORI_REQUIRE(1, false); };

    EXPECT_TRUE(is_halt(run_with_standard_error(ends[1], fail))) << "a full pipe";
    ASSERT_EQ(::close(ends[0]), 0);
    EXPECT_TRUE(is_halt(run_with_standard_error(ends[1], fail))) << "a pipe without a reader";
    ASSERT_EQ(::close(ends[1]), 0);
    EXPECT_TRUE(is_halt(run_with_standard_error(STDERR_FILENO, [] {
        static_cast<void>(::close(STDERR_FILENO));
        MAMORI_REQUIRE(1, false);
    })));
}

TEST(AssertDeathTest, ACancelledThreadHaltsTheProgramAsWell) {
    verifies("SWR-KRN-042", Technique::kErrorGuessing, Polarity::kViolation);

    EXPECT_EXIT(std::thread{[] {
                    static_cast<void>(::pthread_cancel(::pthread_self()));
                    MAMORI_REQUIRE(1, false);
                }}.join(),
                is_halt, "^" + make_line(1) + "$");
}

TEST(AssertTest, ACheckThatHoldsPrintsNothing) {
    verifies("SWR-KRN-042");
    ::testing::internal::CaptureStderr();

    MAMORI_REQUIRE(1, calc_half(8) == 4);

    EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace mamori
