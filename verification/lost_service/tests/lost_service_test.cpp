// SPDX-License-Identifier: Apache-2.0
// Goal: whatever keeps the service from the watchdog, the outputs are closed within a tick after its time,
// and not while it is served. Method: a run by the clock, a new watchdog and a loss at a random instant in
// each trial; excused is only what happened while a thread above all others saw the machine stand still. The
// long run is the program `lost_service`.
#include "lost_service.hpp"

#include <gtest/gtest.h>

#include "mamori/verification/verifies.hpp"

namespace mamori::lost_service {
namespace {

using verification::Polarity;
using verification::Technique;
using verification::verifies;

/// Whether the host alone keeps the run from being judged: what was injected was answered rightly, but it is
/// too little.
bool took_trials(const LossVerdict& verdict) {
    return !verdict.is_well() && verdict.by_host != 0U && verdict.answered == verdict.injected &&
           verdict.unanswered + verdict.late + verdict.early + verdict.invented == 0U;
}

TEST(LostServiceTest, OutputsAreClosedInTimeAfterEachLossAndNotBefore) {
    verifies("SWR-PRT-022", Technique::kFaultInjection, Polarity::kViolation);
    // A host that stalls takes trials away, which is no fault of the watchdog; what it leaves is judged in
    // each round.
    constexpr std::uint32_t kRoundsMax = 5U;
    LossRequest request{70U, 20261122U};
    LossRun run = run_losses(request);
    for (std::uint32_t round = 1U; round < kRoundsMax && run.has_priority && took_trials(run.verdict);
         ++round) {
        ++request.seed;
        run = run_losses(request);
    }

    const std::string facts = to_json(request, run);
    RecordProperty("seed", static_cast<int>(request.seed));
    EXPECT_EQ(run.verdict.requested, 60U);
    if (!run.has_priority) {
        GTEST_SKIP()
            << "no fixed priority: any thread of the machine may hold up the watchdog, or what tells "
               "of stalls";
    }
    EXPECT_TRUE(run.verdict.is_well()) << facts;
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
