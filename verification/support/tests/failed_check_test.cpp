// SPDX-License-Identifier: Apache-2.0
// Goal: a death test passes only for the stated check. Method: death tests run programs that end in another
// way; the test expects their failures.
#include "mamori/verification/failed_check.hpp"

#include <gtest/gtest-spi.h>
#include <gtest/gtest.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>

#include "mamori/trace/verifies.hpp"

namespace mamori::verification {
namespace {

constexpr const char* kOtherText = "died but not with expected error";
constexpr const char* kOtherExit = "died but not with expected exit code";

void fail_check_12() {
    MAMORI_REQUIRE(12, false);
}

/// Prints the line of check 12; the program then raises `signal`, or continues to its end if `signal` is 0.
void print_check_12(int signal) {
    std::fprintf(stderr, "failed_check_test.cpp: check 12 failed\n");
    static_cast<void>(std::raise(signal));
    std::_Exit(0);
}

TEST(FailedCheckDeathTest, TheStatedCheckPasses) {
    verifies("SWR-VER-024", Technique::kInterface);
    EXPECT_CHECK_FAILS(fail_check_12(), "failed_check_test.cpp", 12);
    EXPECT_CHECK_FAILS(fail_check_12(), "tests/failed_check_test.cpp", 12) << "with its folder";
    EXPECT_CHECK_FAILS(
        {
            std::fprintf(stderr, "output of the program\n");
            fail_check_12();
        },
        "failed_check_test.cpp", 12);
}

TEST(FailedCheckDeathTest, ACheckWithAnotherNumberIsAFailure) {
    verifies("SWR-VER-024", Technique::kBoundaryValues, Polarity::kViolation);
    EXPECT_NONFATAL_FAILURE(EXPECT_CHECK_FAILS(fail_check_12(), "failed_check_test.cpp", 13), kOtherText);
    EXPECT_NONFATAL_FAILURE(EXPECT_CHECK_FAILS(fail_check_12(), "failed_check_test.cpp", 1), kOtherText);
    EXPECT_NONFATAL_FAILURE(EXPECT_CHECK_FAILS(fail_check_12(), "failed_check_test.cpp", 2), kOtherText);
}

TEST(FailedCheckDeathTest, ACheckOfAnotherFileIsAFailure) {
    verifies("SWR-VER-024", Technique::kEquivalenceClasses, Polarity::kViolation);
    EXPECT_NONFATAL_FAILURE(EXPECT_CHECK_FAILS(fail_check_12(), "failed_check.hpp", 12), kOtherText);
    EXPECT_NONFATAL_FAILURE(EXPECT_CHECK_FAILS(fail_check_12(), "check_test.cpp", 12), kOtherText);
    EXPECT_NONFATAL_FAILURE(EXPECT_CHECK_FAILS(fail_check_12(), "failed_check_test.c", 12), kOtherText);
    EXPECT_NONFATAL_FAILURE(EXPECT_CHECK_FAILS(fail_check_12(), "src/failed_check_test.cpp", 12), kOtherText);
    EXPECT_NONFATAL_FAILURE(EXPECT_CHECK_FAILS(fail_check_12(), "failed_check.test.cpp", 12), kOtherText);
}

TEST(FailedCheckDeathTest, AnotherEndIsAFailure) {
    verifies("SWR-VER-024", Technique::kFaultInjection, Polarity::kViolation);
    EXPECT_NONFATAL_FAILURE(EXPECT_CHECK_FAILS(static_cast<void>(0), "failed_check_test.cpp", 12),
                            "failed to die");
    EXPECT_NONFATAL_FAILURE(EXPECT_CHECK_FAILS(std::abort(), "failed_check_test.cpp", 12), kOtherText);
    EXPECT_NONFATAL_FAILURE(EXPECT_CHECK_FAILS(std::raise(SIGSEGV), "failed_check_test.cpp", 12), kOtherExit);
    EXPECT_NONFATAL_FAILURE(EXPECT_CHECK_FAILS(std::_Exit(12), "failed_check_test.cpp", 12), kOtherExit);
}

TEST(FailedCheckDeathTest, TheLineOfTheCheckWithAnotherExitIsAFailure) {
    verifies("SWR-VER-024", Technique::kErrorGuessing, Polarity::kViolation);
    EXPECT_CHECK_FAILS(print_check_12(SIGABRT), "failed_check_test.cpp", 12);
    EXPECT_NONFATAL_FAILURE(EXPECT_CHECK_FAILS(print_check_12(SIGKILL), "failed_check_test.cpp", 12),
                            kOtherExit);
    EXPECT_NONFATAL_FAILURE(EXPECT_CHECK_FAILS(print_check_12(0), "failed_check_test.cpp", 12), kOtherExit);
}

}  // namespace
}  // namespace mamori::verification
