// SPDX-License-Identifier: Apache-2.0
// Goal: the verdict of a run becomes that of its test. Method: results are intercepted before GoogleTest has
// them.
#include "mamori/verification/real_time_result.hpp"

#include <gtest/gtest-spi.h>

#include "mamori/trace/verifies.hpp"

namespace mamori::verification {
namespace {

TEST(RealTimeResultTest, AnInconclusiveRunIsSkippedWithItsFigureAndAFailedOneFails) {
    verifies("SWR-VER-023", Technique::kFaultInjection, Polarity::kViolation);
    ::testing::TestPartResultArray results;
    {
        const ::testing::ScopedFakeTestPartResultReporter reporter{&results};
        report_run({RunVerdict::kInconclusive, "7 stalls"}, "facts");
        report_run({RunVerdict::kFailed, "1 violations"}, "facts");
        report_run({RunVerdict::kPassed, ""}, "facts");  // and the property of this test is right again
    }
    RecordProperty("figure", "");

    ASSERT_EQ(results.size(), 2);
    EXPECT_TRUE(results.GetTestPartResult(0).skipped());
    EXPECT_STREQ(results.GetTestPartResult(0).message(), "verdict=inconclusive: 7 stalls");
    EXPECT_TRUE(results.GetTestPartResult(1).nonfatally_failed());
    EXPECT_STREQ(results.GetTestPartResult(1).message(), "Failed\n1 violations\nfacts");
}

}  // namespace
}  // namespace mamori::verification
