// SPDX-License-Identifier: Apache-2.0
// Goal: a grid that drifts, and a load that shifts the start, are told from ones that do not. Method: rows
// made by hand, on both sides of each limit.
#include "grid_figures.hpp"

#include <gtest/gtest.h>

#include "mamori/trace/verifies.hpp"

namespace mamori::time_faults {
namespace {

using verification::Polarity;
using verification::Technique;
using verification::verifies;

/// A hundred frames whose plan is off by `planned` and whose wake-up is late by `late` nanoseconds, more in
/// each frame.
std::vector<GridRow> make_rows(std::int64_t planned, std::int64_t late) {
    std::vector<GridRow> rows;
    for (std::int64_t i = 0; i < 100; ++i) {
        const std::int64_t at = 7'000 + i * (kGridPeriod.ns + planned);
        rows.push_back({at, at + 5'000 + i * late, at + 6'000});
    }
    return rows;
}

TEST(GridFiguresTest, AGridWithoutDriftIsSteadyWhateverItsLateness) {
    verifies("SWR-PRT-038");
    const Drift drift = calc_drift(make_rows(0, 0));

    EXPECT_EQ(drift.frames, 100U);
    EXPECT_EQ(drift.planned_ns, 0);
    EXPECT_EQ(drift.first_median_ns, 5'000);
    EXPECT_EQ(drift.last_median_ns, 5'000);
    EXPECT_EQ(drift.worst_ns, 5'000);
    EXPECT_TRUE(drift.is_steady());
}

TEST(GridFiguresTest, APlanThatIsOffByANanosecondPerFrameOrLacksOneDrifts) {
    verifies("SWR-PRT-038", Technique::kFaultInjection, Polarity::kViolation);
    EXPECT_EQ(calc_drift(make_rows(1, 0)).planned_ns, 99);
    EXPECT_EQ(calc_drift(make_rows(-1, 0)).planned_ns, 99);
    EXPECT_FALSE(calc_drift(make_rows(1, 0)).is_steady());
    std::vector<GridRow> rows = make_rows(0, 0);
    rows.erase(rows.begin() + 50);
    EXPECT_EQ(calc_drift(rows).planned_ns, kGridPeriod.ns);
}

TEST(GridFiguresTest, WakeUpsThatComeLaterAndLaterDriftFromATenthOfThePeriodOn) {
    verifies("SWR-PRT-038", Technique::kBoundaryValues, Polarity::kViolation);
    Drift drift;
    drift.first_median_ns = 3'000;
    for (const std::int64_t sign : {1, -1}) {
        drift.last_median_ns = 3'000 + sign * 100'000;
        EXPECT_TRUE(drift.is_steady());
        drift.last_median_ns = 3'000 + sign * 100'001;
        EXPECT_FALSE(drift.is_steady());
    }
    const Drift late = calc_drift(make_rows(0, 2'000));
    EXPECT_EQ(late.last_median_ns - late.first_median_ns, 90 * 2'000);
    EXPECT_FALSE(late.is_steady());
}

TEST(GridFiguresTest, TheShiftIsTheMiddleOfTheDifferencesWithinTheRounds) {
    verifies("SWR-PRT-039");
    const std::vector<LoadRound> rounds{
        {50'000, 52'000, 50'000}, {90'000, 91'000, 95'000}, {10'000, 9'000, 40'000}};

    const Shift steady = calc_shift(rounds, &LoadRound::steady_ns);
    EXPECT_EQ(steady.median_ns, 1'000);
    EXPECT_EQ(steady.lowest_ns, -1'000);
    EXPECT_EQ(steady.highest_ns, 2'000);
    EXPECT_EQ(calc_shift(rounds, &LoadRound::burst_ns).median_ns, 5'000);
    EXPECT_TRUE(steady.is_small());
}

TEST(GridFiguresTest, AShiftOfOnePercentOfThePeriodIsNotSmall) {
    verifies("SWR-PRT-039", Technique::kBoundaryValues, Polarity::kViolation);
    EXPECT_TRUE((Shift{9'999, 0, 20'000}).is_small());
    EXPECT_FALSE((Shift{10'000, 0, 20'000}).is_small());
    EXPECT_TRUE((Shift{-9'999, -20'000, 0}).is_small());
    EXPECT_FALSE((Shift{-10'000, -20'000, 0}).is_small());
}

TEST(GridFiguresTest, FramesInWhichTheComponentDidNotRunHaveNoStart) {
    verifies("SWR-PRT-039", Technique::kErrorGuessing);
    std::vector<GridRow> rows = make_rows(0, 0);
    rows[3].started_ns = 0;

    EXPECT_EQ(calc_median_start(rows), 6'000);
    EXPECT_EQ(calc_median_start({}), 0);
}

}  // namespace
}  // namespace mamori::time_faults
