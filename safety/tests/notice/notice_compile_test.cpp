// SPDX-License-Identifier: Apache-2.0
// Goal: the compiler rejects descriptions of nodes and limits of notices without meaning.
// Method: the build's own compiler is run on one source, without and with a defect.
#include <gtest/gtest.h>

#include "compile_fail/compiler.hpp"
#include "mamori/trace/verifies.hpp"

namespace mamori::safety {
namespace {

using namespace verification;

void expect_rejected(const std::string& defect, const std::string& remedy) {
    const rig::Compilation result = rig::compile("notice_source.cpp", defect);
    EXPECT_EQ(result.exit_status, 1) << result.messages;
    EXPECT_TRUE(result.names(remedy)) << defect << '\n' << result.messages;
}

TEST(NoticeCompileTest, ValidNodeAndLimitsCompile) {
    verifies("SWR-NTC-003");
    const rig::Compilation result = rig::compile("notice_source.cpp", "MAMORI_DEFECT_NONE");

    EXPECT_EQ(result.exit_status, 0) << result.messages;
}

TEST(NoticeCompileTest, NodeWithoutMeaningIsRejectedWithARemedy) {
    verifies("SWR-NTC-003", Technique::kBoundaryValues, Polarity::kViolation);
    expect_rejected("MAMORI_DEFECT_NO_FRAME", "the major frame of the node must be longer than 0");
    expect_rejected("MAMORI_DEFECT_NO_PERIOD", "specify n >= 1");
    expect_rejected("MAMORI_DEFECT_LONG_PERIOD", "specify fewer major frames");
    expect_rejected("MAMORI_DEFECT_NAME", "each component needs a name of the system table");
    expect_rejected("MAMORI_DEFECT_NO_NAME", "each component needs a name of the system table");
    expect_rejected("MAMORI_DEFECT_TOO_MANY", "a notice reports 1 to 256 components");
    expect_rejected("MAMORI_DEFECT_NO_COMPONENT", "a notice reports 1 to 256 components");
}

TEST(NoticeCompileTest, LimitsOutOfRangeAreRejectedWithARemedy) {
    verifies("SWR-NTC-003", Technique::kBoundaryValues, Polarity::kViolation);
    expect_rejected("MAMORI_DEFECT_LIMITS", "specify 1 <= late_periods < silent_periods, start_periods >= 3");
    expect_rejected("MAMORI_DEFECT_START", "specify 1 <= late_periods < silent_periods, start_periods >= 3");
}

}  // namespace
}  // namespace mamori::safety
