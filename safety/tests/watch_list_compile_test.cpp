// SPDX-License-Identifier: Apache-2.0
// Goal: the compiler rejects limits without meaning, names the row and says how to correct it.
// Method: the build's own compiler is run on one source, without and with a defect.
#include <gtest/gtest.h>

#include "compile_fail/compiler.hpp"
#include "mamori/trace/verifies.hpp"

namespace mamori::safety {
namespace {

using namespace verification;

void expect_rejected(const std::string& defect, const std::string& fault, const std::string& remedy) {
    const rig::Compilation result = rig::compile("watch_list_source.cpp", defect);
    EXPECT_EQ(result.exit_status, 1) << result.messages;
    EXPECT_TRUE(result.names(fault)) << result.messages;
    EXPECT_TRUE(result.names(remedy)) << result.messages;
}

TEST(WatchListCompileTest, ValidLimitsCompile) {
    verifies("SWR-SUP-041");
    const rig::Compilation result = rig::compile("watch_list_source.cpp", "MAMORI_DEFECT_NONE");

    EXPECT_EQ(result.exit_status, 0) << result.messages;
}

TEST(WatchListCompileTest, AComponentOfNoWindowIsRejectedWithItsRow) {
    verifies("SWR-SUP-041", Technique::kInterface, Polarity::kViolation);
    expect_rejected("MAMORI_DEFECT_UNKNOWN_COMPONENT", "WatchFault::kComponentNotInTable, 1",
                    "remove the row");
}

TEST(WatchListCompileTest, AComponentWithTwoRowsIsRejected) {
    verifies("SWR-SUP-041", Technique::kInterface, Polarity::kViolation);
    expect_rejected("MAMORI_DEFECT_TWICE", "WatchFault::kComponentTwice, 1", "keep one");
}

TEST(WatchListCompileTest, AliveLimitsOutOfRangeAreRejected) {
    verifies("SWR-SUP-041", Technique::kBoundaryValues, Polarity::kViolation);
    expect_rejected("MAMORI_DEFECT_ALIVE", "WatchFault::kAliveLimits, 1",
                    "1 <= late_cycles <= expired_cycles");
}

TEST(WatchListCompileTest, DeadlineLimitsOutOfRangeAreRejected) {
    verifies("SWR-SUP-041", Technique::kBoundaryValues, Polarity::kViolation);
    expect_rejected("MAMORI_DEFECT_DEADLINE", "WatchFault::kDeadlineLimits, 1", "longest > 0");
}

}  // namespace
}  // namespace mamori::safety
