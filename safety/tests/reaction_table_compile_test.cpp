// SPDX-License-Identifier: Apache-2.0
// Goal: an incomplete reaction table is refused by the compiler, which names the guilty fault.
// Method: the build's own compiler is run on one source, without and with a defect.
#include "compile_fail/compiler.hpp"
#include "mamori/trace/verifies.hpp"

namespace mamori::safety {
namespace {

using namespace verification;

rig::Compilation compile(const std::string& defect) {
    return rig::compile("reaction_table_source.cpp", defect);
}

TEST(ReactionTableCompileTest, CompleteTableCompiles) {
    verifies("SWR-FLT-004");

    const rig::Compilation result = compile("MAMORI_DEFECT_NONE");
    EXPECT_EQ(result.exit_status, 0) << result.messages;
    EXPECT_EQ(result.messages, "");
}

TEST(ReactionTableCompileTest, DeclaredFaultWithoutAReactionDoesNotCompileAndIsNamed) {
    verifies("SWR-FLT-004", Technique::kErrorGuessing, Polarity::kViolation);

    const rig::Compilation result = compile("MAMORI_DEFECT_MISSING_ROW");
    EXPECT_EQ(result.exit_status, 1) << result.messages;
    EXPECT_TRUE(result.names("declared fault without a reaction")) << result.messages;
    EXPECT_TRUE(result.names("Fault::kTorqueRunaway, 0")) << result.messages;
}

TEST(ReactionTableCompileTest, FaultWithTwoReactionsDoesNotCompileAndIsNamed) {
    verifies("SWR-FLT-004", Technique::kErrorGuessing, Polarity::kViolation);

    const rig::Compilation result = compile("MAMORI_DEFECT_DOUBLE_ROW");
    EXPECT_EQ(result.exit_status, 1) << result.messages;
    EXPECT_TRUE(result.names("declared fault with more than one reaction")) << result.messages;
    EXPECT_TRUE(result.names("Fault::kOverspeed, 2")) << result.messages;
}

TEST(ReactionTableCompileTest, RowWithAnUnknownFaultDoesNotCompile) {
    verifies("SWR-FLT-004", Technique::kErrorGuessing, Polarity::kViolation);

    const rig::Compilation result = compile("MAMORI_DEFECT_UNKNOWN_FAULT");
    EXPECT_EQ(result.exit_status, 1) << result.messages;
    EXPECT_TRUE(result.names("row with an unknown fault")) << result.messages;
}

TEST(ReactionTableCompileTest, RowThatLeavesNoTimeToReactDoesNotCompile) {
    verifies("SWR-FLT-004", Technique::kBoundaryValues, Polarity::kViolation);

    const rig::Compilation result = compile("MAMORI_DEFECT_NO_TIME");
    EXPECT_EQ(result.exit_status, 1) << result.messages;
    EXPECT_TRUE(result.names("no time to react")) << result.messages;
}

TEST(ReactionTableCompileTest, TableWithARowForEveryFaultInEveryModeCompiles) {
    verifies("SWR-FLT-011");

    EXPECT_EQ(compile("MAMORI_DEFECT_NONE").exit_status, 0);
}

TEST(ReactionTableCompileTest, ModeInWhichAFaultHasNoReactionIsNamedWithTheFault) {
    verifies("SWR-FLT-011", Technique::kErrorGuessing, Polarity::kViolation);

    const rig::Compilation result = compile("MAMORI_DEFECT_MODE_WITHOUT_ROW");
    EXPECT_EQ(result.exit_status, 1) << result.messages;
    EXPECT_TRUE(result.names("declared fault without a reaction")) << result.messages;
    EXPECT_TRUE(result.names("Fault::kOverspeed, 0")) << result.messages;
    EXPECT_TRUE(result.names("Mode::kManual")) << result.messages;
}

TEST(ReactionTableCompileTest, ModeInWhichAFaultHasTwoReactionsIsNamedWithTheFault) {
    verifies("SWR-FLT-011", Technique::kErrorGuessing, Polarity::kViolation);

    const rig::Compilation result = compile("MAMORI_DEFECT_MODE_WITH_TWO_ROWS");
    EXPECT_EQ(result.exit_status, 1) << result.messages;
    EXPECT_TRUE(result.names("declared fault with more than one reaction")) << result.messages;
    EXPECT_TRUE(result.names("Fault::kOverspeed, 2")) << result.messages;
    EXPECT_TRUE(result.names("Mode::kAutomatic")) << result.messages;
}

TEST(ReactionTableCompileTest, RowOfAnUnknownModeDoesNotCompile) {
    verifies("SWR-FLT-011", Technique::kBoundaryValues, Polarity::kViolation);

    const rig::Compilation result = compile("MAMORI_DEFECT_UNKNOWN_MODE");
    EXPECT_EQ(result.exit_status, 1) << result.messages;
    EXPECT_TRUE(result.names("with no mode or an unknown one")) << result.messages;
}

}  // namespace
}  // namespace mamori::safety
