// SPDX-License-Identifier: Apache-2.0
// Goal: a table that leaves an assumption unchecked is refused by the compiler, which names it.
// Method: the build's own compiler is run on one source, without and with a defect; the rules of a row are
// called directly.
#include <array>
#include <limits>

#include "compile_fail/compiler.hpp"
#include "mamori/safety/assumptions/assumption_table.hpp"
#include "mamori/trace/verifies.hpp"

namespace mamori::safety {
namespace {

using namespace verification;

constexpr const char* kSource = "assumption_table_source.cpp";

TEST(AssumptionTableCompileTest, CompleteTableCompiles) {
    verifies("SWR-AOU-002");

    const rig::Compilation result = rig::compile(kSource, "MAMORI_DEFECT_NONE");
    EXPECT_EQ(result.exit_status, 0) << result.messages;
    EXPECT_EQ(result.messages, "");
}

TEST(AssumptionTableCompileTest, DeclaredAssumptionWithoutACheckDoesNotCompileAndIsNamed) {
    verifies("SWR-AOU-002", Technique::kErrorGuessing, Polarity::kViolation);

    const rig::Compilation result = rig::compile(kSource, "MAMORI_DEFECT_MISSING_ROW");
    EXPECT_EQ(result.exit_status, 1) << result.messages;
    EXPECT_TRUE(result.names("declared assumption without a check")) << result.messages;
    EXPECT_TRUE(result.names("Assumption::kBudget, 0")) << result.messages;
}

TEST(AssumptionTableCompileTest, AssumptionWithTwoChecksDoesNotCompileAndIsNamed) {
    verifies("SWR-AOU-002", Technique::kErrorGuessing, Polarity::kViolation);

    const rig::Compilation result = rig::compile(kSource, "MAMORI_DEFECT_DOUBLE_ROW");
    EXPECT_EQ(result.exit_status, 1) << result.messages;
    EXPECT_TRUE(result.names("declared assumption with more than one check")) << result.messages;
    EXPECT_TRUE(result.names("Assumption::kTickSource, 2")) << result.messages;
}

TEST(AssumptionTableCompileTest, RowOfNoUseDoesNotCompile) {
    verifies("SWR-AOU-002", Technique::kErrorGuessing, Polarity::kViolation);

    for (const char* const defect :
         {"MAMORI_DEFECT_UNKNOWN", "MAMORI_DEFECT_NO_CHECK", "MAMORI_DEFECT_NO_TIME"}) {
        const rig::Compilation result = rig::compile(kSource, defect);
        EXPECT_EQ(result.exit_status, 1) << defect;
        EXPECT_TRUE(result.names("row with an unknown assumption")) << result.messages;
    }
}

TEST(AssumptionTableCompileTest, RowThatNobodyWroteIsOfNoAssumption) {
    verifies("SWR-AOU-002", Technique::kInterface, Polarity::kViolation);
    constexpr std::array kFresh{AssumptionRow{}};

    EXPECT_EQ(kFresh[0].assumption, std::numeric_limits<AssumptionIndex>::max())
        << "more than a table can have";
    EXPECT_EQ(kFresh[0].assumption, kNoAssumption);
    EXPECT_EQ(kFresh[0].within, Duration{0});
    EXPECT_FALSE(are_rows_valid(kFresh, kNoAssumption));
}

TEST(AssumptionTableCompileTest, EachRuleOfARowIsJudged) {
    verifies("SWR-AOU-002", Technique::kBoundaryValues, Polarity::kViolation);
    class Check final : public AssumptionCheck {
      public:
        SelfTestStatus check() noexcept override { return SelfTestStatus::kPassed; }
    } check;
    const std::array good{AssumptionRow{1U, "", &check, Duration{1}}};
    std::array row{good};

    EXPECT_TRUE(are_rows_valid(good, 2U));
    EXPECT_FALSE(are_rows_valid(good, 1U));
    row[0].check = nullptr;
    EXPECT_FALSE(are_rows_valid(row, 2U));
    row = good;
    row[0].within = Duration{0};
    EXPECT_FALSE(are_rows_valid(row, 2U));
    EXPECT_EQ(count_rows(good, 1U), 1U);
    EXPECT_EQ(count_rows(good, 0U), 0U);
}

}  // namespace
}  // namespace mamori::safety
