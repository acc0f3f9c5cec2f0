// SPDX-License-Identifier: Apache-2.0
// Goal: with real threads and random execution times, the data of a loop of 1 kHz and of a background window
//       on one core are those of virtual time, and each overrun of the background window is named.
// Method: one run of both machines. Without fixed priorities, or if the host delays a window by more than its
//         length, the test is inconclusive.
#include <gtest/gtest.h>

#include "background_system.hpp"
#include "mamori/trace/verifies.hpp"

namespace mamori::verification {
namespace {

TEST(BackgroundTest, DataInRealTimeAreThoseOfVirtualTime) {
    verifies("SWR-PRT-082", Technique::kBackToBack, Polarity::kViolation);
    const BackgroundResult result = run_with_background(40U, -1);

    ASSERT_TRUE(result.has_run);
    if (!result.is_realtime || result.other != 0U) {
        GTEST_SKIP() << "verdict=inconclusive: priorities " << result.is_realtime
                     << ", other overruns or skipped windows " << result.other;
    }
    EXPECT_TRUE(result.are_equal);
    EXPECT_EQ(result.caused, 6U);
    EXPECT_EQ(result.counted, result.caused);
    EXPECT_EQ(result.named, result.caused);
}

}  // namespace
}  // namespace mamori::verification
