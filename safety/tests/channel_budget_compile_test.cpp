// SPDX-License-Identifier: Apache-2.0
// Goal: a channel over its budget is refused by the compiler, which says why and how to mend it.
// Method: the build's own compiler is run on one source, without and with a defect.
#include "compile_fail/compiler.hpp"
#include "mamori/trace/verifies.hpp"

namespace mamori::safety {
namespace {

using namespace verification;

void expect_refused(const char* defect, const char* fault, const char* advice) {
    const rig::Compilation result = rig::compile("channel_budget_source.cpp", defect);
    EXPECT_EQ(result.exit_status, 1) << result.messages;
    EXPECT_TRUE(result.names(fault)) << result.messages;
    EXPECT_TRUE(result.names(advice)) << result.messages;
}

TEST(ChannelBudgetCompileTest, ChannelsWithinTheirBudgetCompile) {
    verifies("SWR-E2E-024");

    const rig::Compilation result = rig::compile("channel_budget_source.cpp", "MAMORI_DEFECT_NONE");
    EXPECT_EQ(result.exit_status, 0) << result.messages;
    EXPECT_EQ(result.messages, "");
}

TEST(ChannelBudgetCompileTest, ChannelOverItsBudgetDoesNotCompileAndSaysHowFar) {
    verifies("SWR-E2E-024", Technique::kErrorGuessing, Polarity::kViolation);

    // 16 bytes at 1 kHz and a bit error probability of 0.01: the budget of 1e-9 per hour goes 111 times into
    // the bound.
    expect_refused("MAMORI_DEFECT_BUDGET", "BudgetFault::kBudget, 123", "send shorter or fewer frames");
}

TEST(ChannelBudgetCompileTest, ListProfileAboveFourteenBytesDoesNotCompile) {
    verifies("SWR-E2E-024", Technique::kBoundaryValues, Polarity::kViolation);

    expect_refused("MAMORI_DEFECT_LIST", "BudgetFault::kShortDistance", "send at most 14 bytes");
}

TEST(ChannelBudgetCompileTest, FramesOfUnknownStrengthDoNotCompile) {
    verifies("SWR-E2E-024", Technique::kBoundaryValues, Polarity::kViolation);

    expect_refused("MAMORI_DEFECT_LENGTH", "BudgetFault::kUnknownLength", "take profile 7");
}

TEST(ChannelBudgetCompileTest, UnsoundChannelsDoNotCompile) {
    verifies("SWR-E2E-024", Technique::kErrorGuessing, Polarity::kViolation);

    expect_refused("MAMORI_DEFECT_CHANNEL", "BudgetFault::kChannel", "is_sound<...>()");
}

TEST(ChannelBudgetCompileTest, UsesOutOfRangeDoNotCompile) {
    verifies("SWR-E2E-024", Technique::kBoundaryValues, Polarity::kViolation);

    expect_refused("MAMORI_DEFECT_USE", "BudgetFault::kUse", "give rate_hz > 0");
}

}  // namespace
}  // namespace mamori::safety
