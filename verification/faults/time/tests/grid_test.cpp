// SPDX-License-Identifier: Apache-2.0
// Goal: the grid of a system that runs by the clock does not drift, and may be looked at from outside
// meanwhile. Method: short runs; nothing is asked of the speed of the machine. The long ones are the program
// `grid_times`.
#include "grid.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "grid_figures.hpp"
#include "introspection_load.hpp"
#include "mamori/trace/verifies.hpp"
#include "mamori/verification/stall_watch.hpp"

namespace mamori::time_faults {
namespace {

using verification::verifies;

class GridTest : public ::testing::Test {
  protected:
    static void SetUpTestSuite() {
        load_ = std::make_unique<IntrospectionLoad>(grid_.get_introspection());
        ASSERT_EQ(grid_.open(), Status::kOk);
    }
    static void TearDownTestSuite() {
        load_.reset();
        grid_.close();
    }
    static Grid grid_;
    static std::unique_ptr<IntrospectionLoad> load_;
};
Grid GridTest::grid_;
std::unique_ptr<IntrospectionLoad> GridTest::load_;

TEST_F(GridTest, PlannedInstantsAreWholePeriodsApartAndNoWakeUpComesBeforeThem) {
    verifies("SWR-PRT-038");
    const std::vector<GridRow> rows = grid_.run(300U);

    ASSERT_EQ(rows.size(), 300U);
    EXPECT_EQ(calc_drift(rows).planned_ns, 0);
    for (const GridRow& row : rows) {
        EXPECT_GE(row.woke_ns, row.planned_ns);
        EXPECT_TRUE(row.started_ns == 0 || row.started_ns >= row.woke_ns);
    }
}

TEST_F(GridTest, TurnsWithAndWithoutRequestsEachHaveTheirStart) {
    verifies("SWR-PRT-039");
    const auto clock = ports::posix_rt::FrameClock::starting_in(Duration{0});
    verification::StallWatch stalls{clock, Duration{50'000}, {98, verification::find_processor()}};
    // The thread of the load has no priority: a busy host may give it no time.
    for (int repeats = 0; repeats <= 2 && load_->get_request_count() == 0U; ++repeats) {
        const std::vector<LoadRound> rounds = run_load_rounds(grid_, *load_, 3U, 100U);

        EXPECT_EQ(rounds.size(), 3U);
        for (const LoadRound& round : rounds) {
            EXPECT_GT(round.calm_ns, 0);
            EXPECT_GT(round.steady_ns, 0);
            EXPECT_GT(round.burst_ns, 0);
        }
    }
    stalls.stop();
    if (load_->get_request_count() == 0U) {
        ASSERT_GT(stalls.get_figures().stalls, 0U) << "no request on a host without a stall";
        GTEST_SKIP() << "verdict=inconclusive: no request, " << stalls.get_figures().stalls << " stalls";
    }
}

}  // namespace
}  // namespace mamori::time_faults
