// SPDX-License-Identifier: Apache-2.0
// Goal: what an input gives around a switch of modes depends on the plan alone: not on the order of rows, not
// on where source and sink run, and never on a value of another mode. Method: a watcher and a planner that
// feed one drive, in one window or two, directly and through a crossing.
#include <gtest/gtest.h>

#include "mamori/kernel/table/system_check.hpp"
#include "mamori/trace/verifies.hpp"
#include "support/mode_system.hpp"

namespace mamori {
namespace {

using namespace testing_support;
using namespace verification;
using Values = std::vector<std::int64_t>;

struct ModeInputTest : ::testing::Test {
    TroublePlan plan{};
    ModeHost host;
    Part watcher{"watcher", 1, host, plan};
    Part planner{"planner", 2, host, plan};
    Part drive{"drive", 3, host, plan};
    Crossing<std::int64_t> from_watcher;
    Crossing<std::int64_t> from_planner;

    /// What the drive reads in six frames; the safe mode is asked for before frame 2 and due in frame 3.
    template <typename... Parts>
    Values read_around_the_safe_step(const Parts&... connections) {
        const auto table = system(
            frame(1000_ns), window("first", 0_ns, 400_ns, budget(300_ns), run(watcher, planner)),
            window("second", 400_ns, 500_ns, budget(400_ns), run(drive)), connections...,
            system_mode("work", runs(watcher, planner, drive)), safe_mode("halt", runs(watcher, drive)));
        EXPECT_EQ(check(make_view(table)).rule, Rule::kNone);
        SystemModes modes{make_view(table)};
        ExecutiveFor<std::decay_t<decltype(table)>> sut{table, modes};
        EXPECT_EQ(sut.initialize(), Status::kOk);
        EXPECT_EQ(sut.start(), Status::kOk);
        for (std::int64_t number = 0; number < 6; ++number) {
            if (number == 2) {
                EXPECT_EQ(modes.request_safe_mode(), Status::kOk);
            }
            for (std::size_t w = 0U; w < 2U; ++w) {
                host.now = Instant{number * 1000 + static_cast<std::int64_t>(w) * 400};
                EXPECT_EQ(sut.run_window(w, host.now, host), WindowOutcome::kCompleted);
            }
        }
        return drive.reads;
    }
};

TEST_F(ModeInputTest, AValueOfTheNewModeCountsFromTheFrameOfTheStepOn) {
    verifies("SWR-MOD-009", Technique::kBoundaryValues);
    EXPECT_EQ(read_around_the_safe_step(connect(planner.out, drive.in, only_in("work"), any_age()),
                                        connect(watcher.out, drive.in, only_in("halt"), any_age())),
              (Values{2001, 2002, 2003, 1004, 1005, 1006}));
}

TEST_F(ModeInputTest, ItIsTheSameInTheOtherOrderOfTheTable) {
    verifies("SWR-MOD-009", Technique::kBoundaryValues);
    EXPECT_EQ(read_around_the_safe_step(connect(watcher.out, drive.in, only_in("halt"), any_age()),
                                        connect(planner.out, drive.in, only_in("work"), any_age())),
              (Values{2001, 2002, 2003, 1004, 1005, 1006}));
}

TEST_F(ModeInputTest, ItIsTheSameThroughCrossings) {
    verifies("SWR-MOD-009", Technique::kBoundaryValues);
    EXPECT_EQ(read_around_the_safe_step(
                  connect(planner.out, drive.in, through(from_planner), only_in("work"), any_age()),
                  connect(watcher.out, drive.in, through(from_watcher), only_in("halt"), any_age())),
              (Values{2001, 2002, 2003, 1004, 1005, 1006}));
}

TEST_F(ModeInputTest, AnInputDoesNotCountValuesThatAConnectionOfAnotherModeLoses) {
    verifies("SWR-KRN-054", Technique::kBoundaryValues);
    const auto table =
        system(frame(1000_ns), window("first", 0_ns, 400_ns, budget(300_ns), run(watcher, planner)),
               window("second", 400_ns, 500_ns, budget(400_ns), run(drive)),
               connect(planner.out, drive.in, only_in("work"), any_age()),
               connect(watcher.out, drive.in, only_in("halt"), any_age()),
               system_mode("work", runs(watcher, planner, drive)), safe_mode("halt", runs(watcher, drive)));
    SystemModes modes{make_view(table)};
    ExecutiveFor<std::decay_t<decltype(table)>> sut{table, modes};
    ASSERT_EQ(sut.initialize(), Status::kOk);
    ASSERT_EQ(sut.start(), Status::kOk);
    planner.cycle_time = 400_ns;

    EXPECT_EQ(sut.run_window(0U, host.now, host), WindowOutcome::kOverrun);

    EXPECT_EQ(watcher.out.get_lost_count() + planner.out.get_lost_count(), 2U);
    EXPECT_EQ(count_latest(drive.in).lost, 1U) << "that of the planner";
}

TEST(ModeInputValueTest, AnInputWithoutValueReadsAsAFreshOne) {
    verifies("SWR-MOD-009", Technique::kErrorGuessing, Polarity::kViolation);
    Robot robot;
    ASSERT_TRUE(robot.begin());
    for (const Command command : {Command::kStart, Command::kTeach}) {
        ASSERT_EQ(robot.modes.request(command), Status::kOk);
        robot.run_frames(9);
        EXPECT_EQ(robot.viewer.in.has_value(), command == Command::kStart);
    }

    EXPECT_EQ(robot.get_state(robot.viewer), LifecycleState::kActive) << "it stays, without its connection";
    EXPECT_EQ(robot.viewer.in.read(), 0);
}

}  // namespace
}  // namespace mamori
