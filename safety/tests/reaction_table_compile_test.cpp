// SPDX-License-Identifier: Apache-2.0
// Goal: an incomplete reaction table is refused by the compiler, which names the guilty fault.
// Method: the build's own compiler is run on one source, without and with a defect.
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <string>

#include "mamori/verification/verifies.hpp"

namespace mamori::safety {
namespace {

using verification::Polarity;
using verification::Technique;
using verification::verifies;

struct Compilation {
    int exit_status;
    std::string messages;
};

Compilation compile(const std::string& defect) {
    const std::string root{MAMORI_SOURCE_FOLDER};
    const std::string command = "LC_ALL=C '" MAMORI_COMPILER "' -std=c++17 -fsyntax-only -Wno-unused -D" +
                                defect + " -I'" + root + "/kernel/include' -I'" + root +
                                "/safety/include' '" + root +
                                "/safety/tests/compile_fail/reaction_table_source.cpp' 2>&1";
    Compilation result{-1, {}};
    std::FILE* const output = popen(command.c_str(), "r");
    if (output == nullptr) {
        return result;
    }
    std::array<char, 512U> line{};
    while (std::fgets(line.data(), static_cast<int>(line.size()), output) != nullptr) {
        result.messages += line.data();
    }
    const int status = pclose(output);
    result.exit_status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    return result;
}

bool names(const Compilation& compilation, const std::string& text) {
    return compilation.messages.find(text) != std::string::npos;
}

TEST(ReactionTableCompileTest, CompleteTableCompiles) {
    verifies("SWR-FLT-004");

    const Compilation result = compile("MAMORI_DEFECT_NONE");
    EXPECT_EQ(result.exit_status, 0) << result.messages;
    EXPECT_EQ(result.messages, "");
}

TEST(ReactionTableCompileTest, DeclaredFaultWithoutAReactionDoesNotCompileAndIsNamed) {
    verifies("SWR-FLT-004", Technique::kErrorGuessing, Polarity::kViolation);

    const Compilation result = compile("MAMORI_DEFECT_MISSING_ROW");
    EXPECT_EQ(result.exit_status, 1) << result.messages;
    EXPECT_TRUE(names(result, "declared fault without a reaction")) << result.messages;
    EXPECT_TRUE(names(result, "Fault::kTorqueRunaway, 0")) << result.messages;
}

TEST(ReactionTableCompileTest, FaultWithTwoReactionsDoesNotCompileAndIsNamed) {
    verifies("SWR-FLT-004", Technique::kErrorGuessing, Polarity::kViolation);

    const Compilation result = compile("MAMORI_DEFECT_DOUBLE_ROW");
    EXPECT_EQ(result.exit_status, 1) << result.messages;
    EXPECT_TRUE(names(result, "declared fault with more than one reaction")) << result.messages;
    EXPECT_TRUE(names(result, "Fault::kOverspeed, 2")) << result.messages;
}

TEST(ReactionTableCompileTest, RowWithAnUnknownFaultDoesNotCompile) {
    verifies("SWR-FLT-004", Technique::kErrorGuessing, Polarity::kViolation);

    const Compilation result = compile("MAMORI_DEFECT_UNKNOWN_FAULT");
    EXPECT_EQ(result.exit_status, 1) << result.messages;
    EXPECT_TRUE(names(result, "row with an unknown fault")) << result.messages;
}

TEST(ReactionTableCompileTest, RowThatLeavesNoTimeToReactDoesNotCompile) {
    verifies("SWR-FLT-004", Technique::kBoundaryValues, Polarity::kViolation);

    const Compilation result = compile("MAMORI_DEFECT_NO_TIME");
    EXPECT_EQ(result.exit_status, 1) << result.messages;
    EXPECT_TRUE(names(result, "no time to react")) << result.messages;
}

TEST(ReactionTableCompileTest, TableWithARowForEveryFaultInEveryModeCompiles) {
    verifies("SWR-FLT-011");

    EXPECT_EQ(compile("MAMORI_DEFECT_NONE").exit_status, 0);
}

TEST(ReactionTableCompileTest, ModeInWhichAFaultHasNoReactionIsNamedWithTheFault) {
    verifies("SWR-FLT-011", Technique::kErrorGuessing, Polarity::kViolation);

    const Compilation result = compile("MAMORI_DEFECT_MODE_WITHOUT_ROW");
    EXPECT_EQ(result.exit_status, 1) << result.messages;
    EXPECT_TRUE(names(result, "declared fault without a reaction")) << result.messages;
    EXPECT_TRUE(names(result, "Fault::kOverspeed, 0")) << result.messages;
    EXPECT_TRUE(names(result, "Mode::kManual")) << result.messages;
}

TEST(ReactionTableCompileTest, ModeInWhichAFaultHasTwoReactionsIsNamedWithTheFault) {
    verifies("SWR-FLT-011", Technique::kErrorGuessing, Polarity::kViolation);

    const Compilation result = compile("MAMORI_DEFECT_MODE_WITH_TWO_ROWS");
    EXPECT_EQ(result.exit_status, 1) << result.messages;
    EXPECT_TRUE(names(result, "declared fault with more than one reaction")) << result.messages;
    EXPECT_TRUE(names(result, "Fault::kOverspeed, 2")) << result.messages;
    EXPECT_TRUE(names(result, "Mode::kAutomatic")) << result.messages;
}

TEST(ReactionTableCompileTest, RowOfAnUnknownModeDoesNotCompile) {
    verifies("SWR-FLT-011", Technique::kBoundaryValues, Polarity::kViolation);

    const Compilation result = compile("MAMORI_DEFECT_UNKNOWN_MODE");
    EXPECT_EQ(result.exit_status, 1) << result.messages;
    EXPECT_TRUE(names(result, "with no mode or an unknown one")) << result.messages;
}

}  // namespace
}  // namespace mamori::safety
