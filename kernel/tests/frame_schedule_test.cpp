// SPDX-License-Identifier: Apache-2.0
// Goal: windows open at their instants, in order, whatever their periods are.
// Method: schedules of harmonic and non-harmonic periods against a list that is made by counting every
// nanosecond.
#include "mamori/kernel/run/frame_schedule.hpp"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "mamori/trace/verifies.hpp"

namespace mamori {
namespace {

using namespace verification;

using Openings = std::vector<std::pair<std::size_t, std::int64_t>>;

struct Plan {
    std::array<WindowRow, 3U> rows{};
    SystemView view{};

    explicit Plan(std::int64_t frame) {
        view.frame = Duration{frame};
        view.windows = rows;
    }
    void place(std::size_t window, std::int64_t offset, std::int64_t period, std::size_t core = 0U) {
        rows[window].offset = Duration{offset};
        rows[window].period = Duration{period};
        rows[window].core = core;
    }
    Openings list(std::size_t core, std::int64_t start, std::size_t count) const {
        Openings openings;
        FrameSchedule sut{view, core, Instant{start}};
        for (std::size_t i = 0U; i < count; ++i) {
            openings.emplace_back(sut.get_next().window, sut.get_next().release.ns);
            sut.advance();
        }
        return openings;
    }
    /// The same by looking at every nanosecond.
    Openings count_out(std::size_t core, std::int64_t start, std::size_t count) const {
        Openings openings;
        for (std::int64_t now = start; openings.size() < count; ++now) {
            for (std::size_t w = 0U; w < rows.size(); ++w) {
                const std::int64_t since = now - rows[w].offset.ns;
                if (rows[w].core == core && since >= 0 && since % rows[w].period.ns == 0) {
                    openings.emplace_back(w, now);
                }
            }
        }
        return openings;
    }
};

TEST(FrameScheduleTest, HarmonicPeriodsOpenInOrderOverTheEndOfTheFrame) {
    verifies("SWR-KRN-027");
    Plan plan{80};
    plan.place(0U, 0, 10);
    plan.place(1U, 12, 40);
    plan.place(2U, 5, 20);

    EXPECT_EQ(plan.list(0U, 0, 40U), plan.count_out(0U, 0, 40U));
}

TEST(FrameScheduleTest, PeriodsWithoutACommonMultipleBelowTheFrameOpenInOrder) {
    verifies("SWR-KRN-027", Technique::kEquivalenceClasses);
    Plan plan{60};
    plan.place(0U, 1, 12);
    plan.place(1U, 3, 15);
    plan.place(2U, 7, 20);

    EXPECT_EQ(plan.list(0U, 0, 40U), plan.count_out(0U, 0, 40U));
}

TEST(FrameScheduleTest, AScheduleBeginsWithTheFirstOpeningThatIsNotBeforeItsStart) {
    verifies("SWR-KRN-027", Technique::kBoundaryValues);
    Plan plan{40};
    plan.place(0U, 5, 10);
    plan.place(1U, 0, 20);
    plan.place(2U, 3, 40);
    for (std::int64_t start = 0; start < 81; ++start) {
        EXPECT_EQ(plan.list(0U, start, 9U), plan.count_out(0U, start, 9U)) << "start " << start;
    }
}

TEST(FrameScheduleTest, EachCoreSeesItsOwnWindowsAndACoreWithoutAnyNeverOpensOne) {
    verifies("SWR-KRN-027", Technique::kEquivalenceClasses);
    Plan plan{40};
    plan.place(0U, 5, 10, 0U);
    plan.place(1U, 0, 20, 1U);
    plan.place(2U, 3, 40, 1U);

    EXPECT_EQ(plan.list(0U, 0, 9U), plan.count_out(0U, 0, 9U));
    EXPECT_EQ(plan.list(1U, 0, 9U), plan.count_out(1U, 0, 9U));
    FrameSchedule empty{plan.view, 2U, Instant{0}};
    empty.advance();
    EXPECT_EQ(empty.get_next().window, kNoIndex);
}

}  // namespace
}  // namespace mamori
