// SPDX-License-Identifier: Apache-2.0
// Goal: whatever keeps the service from the watchdog, the outputs are closed within a tick after its time,
// and not while it is served. Method: a run by the clock, a new watchdog and a loss at a random instant in
// each trial; `assess_run()` decides from the evidence. The long run is the program `lost_service`.
#include "lost_service.hpp"

#include <gtest/gtest.h>

#include "mamori/trace/verifies.hpp"
#include "mamori/verification/real_time_result.hpp"

namespace mamori::lost_service {
namespace {

using verification::assess_run;
using verification::Polarity;
using verification::report_run;
using verification::Technique;
using verification::verifies;

TEST(LostServiceTest, OutputsAreClosedInTimeAfterEachLossAndNotBefore) {
    verifies("SWR-PRT-022", Technique::kFaultInjection, Polarity::kViolation);
    constexpr LossRequest kRequest{70U, 20261122U};

    const LossRun run = run_losses(kRequest);

    const std::string facts = to_json(kRequest, run);
    RecordProperty("seed", static_cast<int>(kRequest.seed));
    EXPECT_EQ(run.verdict.requested, 60U);
    if (!run.has_priority) {
        GTEST_SKIP() << "verdict=no-privilege: no fixed priority: any thread of the machine may hold up the "
                        "watchdog, or what tells "
                        "of stalls";
    }
    report_run(assess_run(run.get_evidence()), facts);
}

TEST(LostServiceTest, ARunAfterAnotherIsAWholeOne) {
    verifies("SWR-PRT-022", Technique::kEquivalenceClasses);
    for (std::uint64_t seed = 1U; seed <= 2U; ++seed) {
        const LossVerdict verdict = run_losses({7U, seed}).verdict;
        EXPECT_EQ(verdict.requested, 6U) << seed;
        EXPECT_GT(verdict.answered, 0U) << seed;
    }
}

}  // namespace
}  // namespace mamori::lost_service
