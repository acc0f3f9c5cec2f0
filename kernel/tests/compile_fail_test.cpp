// SPDX-License-Identifier: Apache-2.0
// Goal: the compiler refuses what could not work, and its message names the rule that is broken.
// Method: each case in compile_fail/ is compiled twice by the compiler of this build: as it is, which must
// succeed (so the case breaks nothing else), and with MAMORI_BREAK, which must fail with the expected words.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <string>

#include "mamori/verification/verifies.hpp"

namespace mamori {
namespace {

using verification::Polarity;
using verification::Technique;
using verification::verifies;

struct Compilation {
    bool has_succeeded{false};
    std::string output;
};

Compilation compile(const std::string& name, const std::string& option) {
    const std::string command = std::string("'") + MAMORI_TEST_COMPILER +
                                "' -std=c++17 -fsyntax-only -fno-exceptions -fno-rtti -Wall -Werror " +
                                option + " -I'" + MAMORI_TEST_INCLUDE + "' '" + MAMORI_TEST_CASES + "/" +
                                name + ".cpp' 2>&1";
    Compilation result;
    FILE* pipe = popen(command.c_str(), "r");
    if (pipe == nullptr) {
        result.output = "cannot run: " + command;
        return result;
    }
    std::array<char, 4096> buffer{};
    while (std::fgets(buffer.data(), static_cast<int>(buffer.size()), pipe) != nullptr) {
        result.output += buffer.data();
    }
    const int status = pclose(pipe);
    // A compiler that could not be found or that crashed is no refusal.
    if (!WIFEXITED(status) || WEXITSTATUS(status) > 1) {
        ADD_FAILURE() << "the compiler did not do its work: " << command << "\n" << result.output;
    }
    result.has_succeeded = WIFEXITED(status) && WEXITSTATUS(status) == 0;
    return result;
}

/// The case compiles as it is, and its broken form is refused with `expected` in the message.
void expect_refused(const std::string& name, const std::string& expected) {
    const Compilation control = compile(name, "");
    const Compilation broken = compile(name, "-DMAMORI_BREAK");

    ASSERT_TRUE(control.has_succeeded) << control.output;
    EXPECT_FALSE(broken.has_succeeded);
    EXPECT_NE(broken.output.find(expected), std::string::npos) << "expected: " << expected << "\n"
                                                               << broken.output;
}

TEST(CompileFailTest, AConnectionOfTwoPayloadTypesIsRefused) {
    verifies("SWR-KRN-018", Technique::kInterface, Polarity::kViolation);
    expect_refused("payload_mismatch", "connect() joins ports of one payload type");
}

TEST(CompileFailTest, AMandatoryInputWithoutASourceIsRefused) {
    verifies("SWR-KRN-018", Technique::kInterface, Polarity::kViolation);
    expect_refused("input_not_connected", "kInputNotConnected");
}

TEST(CompileFailTest, ASecondWriterOfAnInputIsRefused) {
    verifies("SWR-KRN-018", Technique::kInterface, Polarity::kViolation);
    expect_refused("two_writers", "kInputHasTwoWriters");
}

TEST(CompileFailTest, AComponentInTwoWindowsIsRefused) {
    verifies("SWR-KRN-018", Technique::kInterface, Polarity::kViolation);
    expect_refused("component_in_two_windows", "kComponentInTwoPlaces");
}

TEST(CompileFailTest, OverlappingWindowsAreRefused) {
    verifies("SWR-KRN-018", Technique::kInterface, Polarity::kViolation);
    expect_refused("windows_overlap", "kWindowsOverlap");
}

TEST(CompileFailTest, AWindowOutsideTheFrameIsRefused) {
    verifies("SWR-KRN-018", Technique::kInterface, Polarity::kViolation);
    expect_refused("window_outside_frame", "kWindowOutsideFrame");
}

TEST(CompileFailTest, ABudgetOverItsWindowIsRefused) {
    verifies("SWR-KRN-018", Technique::kInterface, Polarity::kViolation);
    expect_refused("budget_over_window", "kBudgetExceedsWindow");
}

TEST(CompileFailTest, AConnectionOfAComponentThatNoWindowRunsIsRefused) {
    verifies("SWR-KRN-018", Technique::kInterface, Polarity::kViolation);
    expect_refused("unknown_component", "kPortOfUnknownComponent");
}

TEST(CompileFailTest, AMemberThatIsNoPortIsRefused) {
    verifies("SWR-KRN-018", Technique::kInterface, Polarity::kViolation);
    expect_refused("port_is_no_port", "names members that are ports");
}

TEST(CompileFailTest, APayloadWithoutAFieldListIsRefused) {
    verifies("SWR-KRN-005", Technique::kInterface, Polarity::kViolation);
    expect_refused("payload_without_fields", "MAMORI_FIELDS");
}

TEST(CompileFailTest, AStatusThatIsDroppedIsRefused) {
    verifies("SWR-KRN-001", Technique::kInterface, Polarity::kViolation);
    expect_refused("status_ignored", "nodiscard");
}

}  // namespace
}  // namespace mamori
