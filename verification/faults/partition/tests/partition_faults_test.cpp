// SPDX-License-Identifier: Apache-2.0
// Goal: a partition that is killed, stopped, floods or corrupts moves no window of the safety system and ends
// in the declared reaction, in time; nothing else does. Method: a short campaign by the clock;
// `assess_run()` decides from the evidence. The long run is the program `partition_faults`.
#include <gtest/gtest.h>

#include <algorithm>

#include "campaign.hpp"
#include "mamori/trace/verifies.hpp"
#include "mamori/verification/real_time_result.hpp"

namespace mamori::partition_faults {
namespace {

using verification::Polarity;
using verification::report_run;
using verification::Technique;
using verification::verifies;

constexpr CampaignRequest kRequest{8U, 20261122U, MAMORI_PARTITION_WORKER, {}};

TEST(PartitionFaultsTest, NoWindowMovesAndEachFaultEndsInItsReactionInTime) {
    verifies("SWR-PRT-018", Technique::kFaultInjection, Polarity::kViolation);

    const Verdict verdict = run(kRequest);

    const std::string facts = to_json(kRequest, verdict);
    RecordProperty("seed", static_cast<int>(kRequest.seed));
    EXPECT_TRUE(verdict.has_run || verdict.is_too_slow) << facts;
    if (!verdict.has_priority) {
        GTEST_SKIP() << "verdict=no-privilege: no fixed priority: any thread of the machine may hold up what "
                        "tells of stalls, or "
                        "the windows";
    }
    report_run(verification::assess_run(verdict.get_evidence()), facts);
}

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

TEST(PartitionFaultsTest, AVerdictThatIsNotWellIsPrintedWithItsPlan) {
    verifies("SWR-PRT-018", Technique::kFaultInjection, Polarity::kViolation);
    Verdict verdict;
    verdict.requested = 2U;
    verdict.outcomes = {Outcome::kTardy};
    verdict.has_run = true;

    const std::string text = to_json({2U, 5U, nullptr, {}}, verdict);
    EXPECT_NE(text.find("\"seed\": 5"), std::string::npos);
    EXPECT_NE(text.find("\"commit\": "), std::string::npos);
    EXPECT_NE(text.find("\"bound_ns\": 54000000"), std::string::npos);
    EXPECT_NE(text.find("\"verdict\": \"failed\""), std::string::npos);
    EXPECT_NE(text.find("\"outcome\": \"tardy\""), std::string::npos);
    EXPECT_NE(text.find("\"outcome\": \"not_reached\""), std::string::npos);
    verdict.outcomes = {Outcome::kInTime, Outcome::kInTime};
    EXPECT_EQ(to_json({2U, 5U, nullptr, {}}, verdict).find("\"plan\""), std::string::npos);
}

}  // namespace
}  // namespace mamori::partition_faults
