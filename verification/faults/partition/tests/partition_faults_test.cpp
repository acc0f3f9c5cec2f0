// SPDX-License-Identifier: Apache-2.0
// Goal: a request always gives the same faults, within their limits. Method: plans without a run;
// `verification.faults` executes the runs.
#include <gtest/gtest.h>

#include <algorithm>

#include "campaign.hpp"
#include "mamori/trace/verifies.hpp"

namespace mamori::partition_faults {
namespace {

using verification::Technique;
using verification::verifies;

TEST(PartitionFaultsTest, ARequestAlwaysGivesTheSameFaultsInsideTheirLimits) {
    verifies("SWR-PRT-018", Technique::kBoundaryValues);
    const std::vector<Fault> first = make_plan({1000U, 7U, nullptr, {}});
    const std::vector<Fault> second = make_plan({1000U, 7U, nullptr, {}});
    const std::vector<Fault> other = make_plan({1000U, 8U, nullptr, {}});
    const auto is_same = [](const Fault& a, const Fault& b) {
        return a.kind == b.kind && a.wait == b.wait && a.hold == b.hold;
    };

    EXPECT_TRUE(std::equal(first.begin(), first.end(), second.begin(), second.end(), is_same));
    EXPECT_FALSE(std::equal(first.begin(), first.end(), other.begin(), other.end(), is_same));
    for (std::size_t kind = 0U; kind < kKindCount; ++kind) {
        EXPECT_EQ(std::count_if(first.begin(), first.end(),
                                [kind](const Fault& fault) { return fault.kind == static_cast<Kind>(kind); }),
                  250);
    }
    for (const Fault& fault : first) {
        EXPECT_GE(fault.wait, 20_ms);
        EXPECT_LT(fault.wait, 120_ms);
        EXPECT_GE(fault.hold, 0_ms);
        EXPECT_LT(fault.hold, 30_ms);
    }
}

}  // namespace
}  // namespace mamori::partition_faults
