// SPDX-License-Identifier: Apache-2.0
// Goal: each kill, hang and state change of a node is reported by the other node within its bound, and no
// fault is invented. Method: two systems in virtual time, seeded injections, a channel that delays and loses.
#include "two_nodes.hpp"

#include <gtest/gtest.h>

#include "mamori/trace/verifies.hpp"

namespace mamori::verification::notice {
namespace {

TEST(TwoNodesTest, EachInjectionIsReportedWithinItsBound) {
    verifies("SWR-NTC-011", Technique::kFaultInjection, Polarity::kViolation);
    for (const std::uint32_t seed : {1U, 2U, 3U}) {
        const Outcome outcome = run_two_nodes(20'000U, 20U, seed);

        std::uint32_t injected = 0U;
        for (const std::uint32_t count : outcome.injected) {
            injected += count;
        }
        EXPECT_EQ(injected, 20U) << "seed " << seed;
        EXPECT_EQ(outcome.missed, 0U) << "seed " << seed;
        EXPECT_EQ(outcome.invented, 0U) << "seed " << seed;
    }
}

TEST(TwoNodesTest, DelaysAndLossesWithinTheToleranceAreNoFault) {
    verifies("SWR-NTC-011", Technique::kStateTransition);
    const Outcome outcome = run_two_nodes(50'000U, 0U, 4U);

    EXPECT_EQ(outcome.invented, 0U);
    EXPECT_EQ(outcome.sent, 10'000U);
    EXPECT_GT(outcome.lost, 800U);
}

TEST(TwoNodesTest, NoticesOfOnePeriodProveANodeThatRuns) {
    verifies("ARC-009", Technique::kInterface);
    const Outcome outcome = run_two_nodes(5'000U, 0U, 5U);

    EXPECT_EQ(outcome.sent, 1'000U);
    EXPECT_EQ(outcome.invented, 0U);
}

TEST(TwoNodesTest, NoticesAloneShowEachFailureOfANode) {
    verifies("ARC-009", Technique::kFaultInjection, Polarity::kViolation);
    const Outcome outcome = run_two_nodes(10'000U, 10U, 6U);

    std::uint32_t injected = 0U;
    for (const std::uint32_t count : outcome.injected) {
        injected += count;
    }
    EXPECT_EQ(injected, 10U);
    EXPECT_EQ(outcome.missed, 0U);
}

}  // namespace
}  // namespace mamori::verification::notice
