// SPDX-License-Identifier: Apache-2.0
// Goal: a system of 100 components, 4 rates and 2 cores moves the same values in every build.
// Method: 20,000 cycles of its fastest rate are compared with a pinned hash. No window may overrun. The
// queues of slow readers must have lost values, because otherwise the run would not test them.
#include <gtest/gtest.h>

#include "mamori/trace/verifies.hpp"
#include "scale_system.hpp"

namespace mamori::verification::integration {
namespace {

TEST(ScaleTest, AHundredComponentsAtFourRatesOnTwoCoresGiveThePinnedHash) {
    verifies("SWR-INS-006", Technique::kBackToBack);
    const ScaleResult result = run_scale(20'000U / kCyclesPerFrame, true);

    EXPECT_EQ(result.trace_hash, 0x9C6680ACA52B6F7DU);
    EXPECT_EQ(result.overrun_count, 0U);
    EXPECT_GT(result.lost_count, 0U);
    EXPECT_GT(result.row_count, 0U);
}

}  // namespace
}  // namespace mamori::verification::integration
