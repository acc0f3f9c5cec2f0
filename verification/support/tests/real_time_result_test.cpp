// SPDX-License-Identifier: Apache-2.0
// Goal: an inconclusive result of a run is that of its test. Method: the result is intercepted before
// GoogleTest has it.
#include "mamori/verification/real_time_result.hpp"

#include <gtest/gtest-spi.h>

#include "mamori/trace/verifies.hpp"

namespace mamori::verification {
namespace {

TEST(RealTimeResultTest, AnInconclusiveRunIsSkippedWithItsFigure) {
    verifies("SWR-VER-023", Technique::kFaultInjection, Polarity::kViolation);
    ::testing::TestPartResultArray results;
    {
        const ::testing::ScopedFakeTestPartResultReporter reporter{&results};
        report_inconclusive("7 stalls");
    }
    RecordProperty("verdict", "");  // of this test
    RecordProperty("figure", "");

    ASSERT_EQ(results.size(), 1);
    EXPECT_TRUE(results.GetTestPartResult(0).skipped());
    EXPECT_STREQ(results.GetTestPartResult(0).message(), "verdict=inconclusive: 7 stalls");
}

}  // namespace
}  // namespace mamori::verification
