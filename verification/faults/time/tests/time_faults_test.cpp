// SPDX-License-Identifier: Apache-2.0
// Goal: a request always gives the same faults, and the delay of a component is recorded for its cycle.
// Method: plans and records without a run; `verification.faults` executes the runs.
#include "time_faults.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "mamori/trace/verifies.hpp"

namespace mamori::time_faults {
namespace {

using verification::Technique;
using verification::verifies;

TEST(ComponentDelaysTest, ADelayBelongsToOneComponentAndOneFrame) {
    verifies("SWR-PRT-007", Technique::kBoundaryValues);
    ComponentDelays sut{2U, 9U};
    sut.set(0U, Instant{8'000'000}, Duration{100'000});
    sut.set(1U, Instant{9'000'000}, Duration{100'000});

    EXPECT_EQ(sut.get(0U, Instant{8'300'000}).ns, 100'000) << "the same frame";
    EXPECT_EQ(sut.get(0U, Instant{7'000'000}).ns, 0) << "another frame";
    EXPECT_EQ(sut.get(1U, Instant{8'000'000}).ns, 0) << "another component";
    EXPECT_EQ(sut.get(1U, Instant{9'000'000}).ns, 0) << "after the last frame";
}

TEST(TimeFaultsTest, TheRunnerIsDelayedForHalfOfItsLatenessAndForHalfABudgetAtLeast) {
    verifies("SWR-PRT-007", Technique::kBoundaryValues);
    EXPECT_TRUE(is_runner_delayed(Duration{100'000}, Duration{200'000}));
    EXPECT_FALSE(is_runner_delayed(Duration{99'999}, Duration{100'000}));
    EXPECT_FALSE(is_runner_delayed(Duration{100'000}, Duration{200'001}));
}

TEST(TimeFaultsTest, ARequestAlwaysGivesTheSameFaultsInsideItsLimits) {
    verifies("SWR-PRT-034", Technique::kBoundaryValues);
    const std::vector<Injection> first = make_injections({100'000U, 1'000U, 7U});
    const std::vector<Injection> second = make_injections({100'000U, 1'000U, 7U});
    const std::vector<Injection> other = make_injections({100'000U, 1'000U, 8U});
    const auto is_same = [](const Injection& a, const Injection& b) {
        return a.frame == b.frame && a.kind == b.kind && a.place == b.place && a.size == b.size &&
               a.ppm == b.ppm;
    };
    std::array<std::size_t, kKindCount> kinds{};

    EXPECT_TRUE(std::equal(first.begin(), first.end(), second.begin(), second.end(), is_same));
    EXPECT_FALSE(std::equal(first.begin(), first.end(), other.begin(), other.end(), is_same));
    for (std::size_t i = 0U; i < first.size(); ++i) {
        const bool is_clock = first[i].ppm != 0;
        ++kinds[static_cast<std::size_t>(first[i].kind)];
        EXPECT_GE(first[i].size.ns, kTick.ns * 11 / 10);
        EXPECT_LE(first[i].size.ns, is_clock ? kTick.ns * 25 : kTick.ns * 4);
        EXPECT_EQ(is_clock, first[i].kind == Kind::kFastClock || first[i].kind == Kind::kSlowClock);
        EXPECT_LT(first[i].frame, 100'000U);
        EXPECT_TRUE(i == 0U || first[i].frame >= first[i - 1U].frame + kDistance);
    }
    EXPECT_GT(*std::min_element(kinds.begin(), kinds.end()), 0U) << "each kind takes part";
    EXPECT_TRUE(make_injections({1U, 0U, 1U}).empty());
}

}  // namespace
}  // namespace mamori::time_faults
