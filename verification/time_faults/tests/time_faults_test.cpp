// SPDX-License-Identifier: Apache-2.0
// Goal: work that takes too long and windows that come too late are reported in time and under their names,
// and nothing else is. Method: a short run by the clock with faults at random places; reports are excused
// only while a thread above all others saw the machine stand still. The long run is the program
// `time_faults`.
#include "time_faults.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "mamori/verification/verifies.hpp"

namespace mamori::time_faults {
namespace {

using verification::Polarity;
using verification::Technique;
using verification::verifies;

constexpr Request kRequest{900U, 45U, 20261122U};

TEST(TimeFaultsTest, EachFaultIsReportedInATickUnderItsNameAndNoneIsInvented) {
    verifies("SWR-PRT-007", Technique::kFaultInjection, Polarity::kViolation);

    const Verdict verdict = run(kRequest);

    const std::string facts = to_json(kRequest, verdict);
    RecordProperty("seed", static_cast<int>(kRequest.seed));
    EXPECT_EQ(verdict.frames, kRequest.frame_count);
    if (!verdict.has_priority) {
        GTEST_SKIP() << "no fixed priority: any thread of the machine may hold up what tells of stalls, or "
                        "the windows";
    }
    EXPECT_TRUE(verdict.is_well()) << facts;
}

TEST(TimeFaultsTest, ARequestAlwaysGivesTheSameFaultsInsideItsLimits) {
    verifies("SWR-PRT-007", Technique::kBoundaryValues);
    const std::vector<Injection> first = make_injections({100'000U, 10'000U, 7U});
    const std::vector<Injection> second = make_injections({100'000U, 10'000U, 7U});
    const std::vector<Injection> other = make_injections({100'000U, 10'000U, 8U});
    const auto is_same = [](const Injection& a, const Injection& b) {
        return a.frame == b.frame && a.kind == b.kind && a.place == b.place && a.size == b.size;
    };

    EXPECT_TRUE(std::equal(first.begin(), first.end(), second.begin(), second.end(), is_same));
    EXPECT_FALSE(std::equal(first.begin(), first.end(), other.begin(), other.end(), is_same));
    for (std::size_t i = 0U; i < first.size(); ++i) {
        EXPECT_GE(first[i].size.ns, kTick.ns * 11 / 10);
        EXPECT_LT(first[i].size.ns, kTick.ns * 4);
        EXPECT_LT(first[i].frame, 100'000U);
        EXPECT_TRUE(i == 0U || first[i].frame >= first[i - 1U].frame + kDistance);
    }
    EXPECT_TRUE(make_injections({1U, 0U, 1U}).empty());
}

}  // namespace
}  // namespace mamori::time_faults
