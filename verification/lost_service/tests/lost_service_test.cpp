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

TEST(LostServiceTest, OutputsAreClosedInTimeAfterEachLossAndNotBefore) {
    verifies("SWR-PRT-022", Technique::kFaultInjection, Polarity::kViolation);
    constexpr LossRequest kRequest{70U, 20261122U};

    const LossRun run = run_losses(kRequest);

    const std::string facts = to_json(kRequest, run);
    RecordProperty("seed", static_cast<int>(kRequest.seed));
    EXPECT_EQ(run.verdict.requested, 60U);
    if (!run.has_priority) {
        GTEST_SKIP()
            << "no fixed priority: any thread of the machine may hold up the watchdog, or what tells "
               "of stalls";
    }
    EXPECT_TRUE(run.verdict.is_well()) << facts;
}

}  // namespace
}  // namespace mamori::lost_service
