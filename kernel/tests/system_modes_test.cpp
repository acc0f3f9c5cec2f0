// SPDX-License-Identifier: Apache-2.0
// Goal: a system goes from mode to mode in agreed steps, with the components, connections and parameters that
// its table declares. Method: the robot of support/mode_system.hpp, two cores run by hand.
#include <gtest/gtest.h>

#include <algorithm>

#include "mamori/trace/verifies.hpp"
#include "mamori/verification/failed_check.hpp"
#include "support/mode_system.hpp"

namespace mamori {
namespace {

using namespace testing_support;
using namespace verification;
using Steps = std::vector<ModeObserver::Step>;

class SystemModesTest : public ::testing::Test {
  protected:
    void SetUp() override { ASSERT_TRUE(sut_.begin()); }
    /// Asks in the frame before `frames`, and runs until the switch is over.
    void go(Command command) {
        ASSERT_EQ(sut_.modes.request(command), Status::kOk);
        sut_.run_frames(8);
    }

    Robot sut_;
};

TEST_F(SystemModesTest, OnlyTheComponentsOfTheFirstModeRunAfterTheStart) {
    verifies("SWR-MOD-004", Technique::kStateTransition);
    sut_.run_frames(3);

    EXPECT_EQ(sut_.modes.get_mode(), kIdle);
    EXPECT_EQ(sut_.get_active(), "monitor guard ");
    EXPECT_EQ(sut_.planner.cycle_count, 0);
    EXPECT_EQ(sut_.monitor.cycle_count, 3);
}

TEST_F(SystemModesTest, BothCoresTakeEachStepInItsFrame) {
    verifies("SWR-MOD-006");
    sut_.run_frames(2);
    ASSERT_EQ(sut_.modes.request(Command::kStart), Status::kOk);  // in frame 1
    sut_.run_frames(9);

    const Steps expected{{ModeStep::kLeave, kWork, 3}, {ModeStep::kEnter, kWork, 6}};
    EXPECT_EQ(sut_.observers[0].steps, expected);
    EXPECT_EQ(sut_.observers[1].steps, expected);
    EXPECT_EQ(sut_.modes.get_mode(), kWork);
    EXPECT_EQ(sut_.modes.get_step(), ModeStep::kNone);
    EXPECT_EQ(sut_.get_active(), "monitor planner viewer drive guard ");
}

TEST_F(SystemModesTest, TheFrameOfAStepIsTheTurnOfWhoLeavesOrEnters) {
    verifies("SWR-MOD-005", Technique::kBoundaryValues);
    go(Command::kStart);
    const std::int64_t planner_cycles = sut_.planner.cycle_count;
    ASSERT_EQ(sut_.modes.request(Command::kTeach), Status::kOk);
    sut_.run_frames(1);
    ASSERT_EQ(sut_.planner.cycle_count, planner_cycles + 1);
    sut_.run_frames(1);  // kLeave
    EXPECT_EQ(sut_.planner.cycle_count, planner_cycles + 1) << "it was deactivated in place of its cycle";
    EXPECT_EQ(sut_.get_active(), "monitor viewer drive guard ");
    sut_.run_frames(3);  // kEnter
    EXPECT_EQ(sut_.get_active(), "monitor viewer hand drive guard ");
    EXPECT_EQ(sut_.hand.cycle_count, 0) << "it was activated in place of its cycle";
    sut_.run_frames(1);
    EXPECT_EQ(sut_.hand.cycle_count, 1);
    EXPECT_EQ(sut_.monitor.cycle_count, 14) << "who stays does not miss a cycle";
}

TEST_F(SystemModesTest, ParametersChangeWithTheModeAndNeverInItsMiddle) {
    verifies("SWR-MOD-008");
    go(Command::kStart);
    EXPECT_EQ(sut_.planner.speed_at_start, 2.0) << "the set is there before on_activated";
    EXPECT_EQ(sut_.drive.speed_at_start, 2.0);
    sut_.drive.speeds.clear();
    go(Command::kTeach);

    EXPECT_EQ(sut_.drive.speeds, (std::vector<double>{2.0, 2.0, 2.0, 2.0, 0.5, 0.5, 0.5, 0.5}));
    EXPECT_EQ(sut_.planner.speed.get(), 0.5) << "also that of a component that does not run";
}

TEST_F(SystemModesTest, AnInputFollowsTheModeAndHasNoValueInBetween) {
    verifies("SWR-MOD-009");
    go(Command::kStart);
    sut_.drive.reads.clear();
    go(Command::kTeach);

    // Frame by frame: asked, planner leaves, two frames to agree, hand enters, hand runs before the drive.
    EXPECT_EQ(sut_.drive.reads, (std::vector<std::int64_t>{2004, -1, -1, -1, -1, 4001, 4002, 4003}));
    EXPECT_EQ(sut_.viewer.reads.back(), -1) << "its connection holds in \"work\" only";
}

TEST_F(SystemModesTest, NothingThatWasWrittenOnTheWayOutIsPublished) {
    verifies("SWR-MOD-009", Technique::kErrorGuessing, Polarity::kViolation);
    go(Command::kStart);
    go(Command::kStop);
    sut_.run_frames(3);

    EXPECT_EQ(sut_.modes.get_mode(), kIdle);
    for (const auto* part : {&sut_.planner, &sut_.drive, &sut_.viewer}) {
        EXPECT_GT(part->out.get_published(), 0) << part->get_name();
        EXPECT_FALSE(part->out.is_staged()) << part->get_name();
    }
}

TEST_F(SystemModesTest, AnOldValueOfASourceThatComesBackIsNotTaken) {
    verifies("SWR-MOD-009", Technique::kErrorGuessing, Polarity::kViolation);
    go(Command::kStart);
    go(Command::kTeach);
    sut_.drive.reads.clear();
    go(Command::kStart);

    EXPECT_EQ(sut_.drive.reads.back(), 2000 + sut_.planner.cycle_count);
    const auto first = std::find_if(sut_.drive.reads.begin() + 1, sut_.drive.reads.end(),
                                    [](std::int64_t value) { return value > 0; });
    EXPECT_EQ(*first, 2005) << "the planner had written 2004 when it left";
}

TEST_F(SystemModesTest, EveryTransitionLeadsToItsMode) {
    verifies("SWR-MOD-004", Technique::kStateTransition);
    const std::vector<std::pair<Command, std::size_t>> tour{
        {Command::kStart, kWork}, {Command::kTeach, kTeach}, {Command::kStart, kWork},
        {Command::kStop, kIdle},  {Command::kTeach, kTeach}, {Command::kStop, kIdle}};
    const std::vector<std::string> active{"monitor guard ", "monitor planner viewer drive guard ",
                                          "monitor viewer hand drive guard "};
    for (const auto& [command, mode] : tour) {
        go(command);
        EXPECT_EQ(sut_.modes.get_mode(), mode);
        EXPECT_EQ(sut_.get_active(), active[mode]);
    }
    EXPECT_EQ(sut_.modes.get_failure().cause, ModeFailureCause::kNone);
}

TEST_F(SystemModesTest, ARequestThatCannotBeServedIsRefused) {
    verifies("SWR-MOD-004", Technique::kInterface, Polarity::kViolation);
    EXPECT_EQ(sut_.modes.request(Command::kNobodys), Status::kBadParameter);
    EXPECT_EQ(sut_.modes.request(Command::kStop), Status::kPreconditionNotMet) << "not in this mode";
    ASSERT_EQ(sut_.modes.request(Command::kStart), Status::kOk);
    EXPECT_EQ(sut_.modes.request(Command::kTeach), Status::kPreconditionNotMet) << "another one waits";
    for (int frame = 0; frame < 6; ++frame) {
        sut_.run_frames(1);
        EXPECT_EQ(sut_.modes.request(Command::kTeach), Status::kPreconditionNotMet) << frame;
    }
    sut_.run_frames(1);
    EXPECT_EQ(sut_.modes.get_mode(), kWork);
    EXPECT_EQ(sut_.modes.request(Command::kTeach), Status::kOk);
}

TEST_F(SystemModesTest, TheSafeModeIsReachedFromEachFrameOfASwitch) {
    verifies("SWR-MOD-007", Technique::kStateTransition);
    for (std::int64_t frames = 0; frames < 9; ++frames) {
        Robot robot;
        ASSERT_TRUE(robot.begin());
        ASSERT_EQ(robot.modes.request(Command::kStart), Status::kOk);
        robot.run_frames(frames);
        ASSERT_EQ(robot.modes.request_safe_mode(), Status::kOk);
        robot.run_frames(9);

        EXPECT_EQ(robot.modes.get_mode(), kHalt) << frames;
        EXPECT_EQ(robot.get_active(), "monitor guard ") << frames;
        EXPECT_EQ(robot.modes.get_failure().cause, ModeFailureCause::kRequested);
        EXPECT_EQ(robot.modes.request(Command::kStart), Status::kPreconditionNotMet);
    }
}

TEST_F(SystemModesTest, OnlyAResetOfTheStoppedSystemLeavesTheSafeMode) {
    verifies("SWR-MOD-007", Technique::kStateTransition, Polarity::kViolation);
    ASSERT_EQ(sut_.modes.request_safe_mode(), Status::kOk);
    sut_.run_frames(9);
    EXPECT_EQ(sut_.modes.reset(), Status::kPreconditionNotMet);
    for (Executive* core : sut_.cores) {
        ASSERT_EQ(core->stop(), Status::kOk);
    }
    ASSERT_TRUE(sut_.start());
    sut_.run_frames(9);
    EXPECT_EQ(sut_.modes.get_mode(), kHalt) << "a restart alone is no reset";
    for (Executive* core : sut_.cores) {
        ASSERT_EQ(core->stop(), Status::kOk);
    }

    ASSERT_EQ(sut_.modes.reset(), Status::kOk);
    ASSERT_TRUE(sut_.start());
    go(Command::kStart);
    EXPECT_EQ(sut_.modes.get_mode(), kWork);
}

TEST_F(SystemModesTest, AStopInEachFrameOfASwitchEndsInTheSafeModeWhenTheSwitchWasUnderWay) {
    verifies("SWR-MOD-007", Technique::kFaultInjection, Polarity::kViolation);
    for (std::size_t stopped = 0U; stopped < 2U; ++stopped) {
        for (std::int64_t frames = 0; frames < 10; ++frames) {
            Robot robot;
            ASSERT_TRUE(robot.begin());
            ASSERT_EQ(robot.modes.request(Command::kStart), Status::kOk);
            robot.run_frames(frames);
            const bool is_under_way = robot.modes.get_step() != ModeStep::kNone;
            ASSERT_EQ(robot.cores[stopped]->stop(), Status::kOk);
            robot.run_frames(9);

            EXPECT_EQ(is_under_way, frames >= 1 && frames <= 6) << frames;
            EXPECT_EQ(robot.modes.get_mode(), is_under_way ? kHalt : kWork) << stopped << " " << frames;
            EXPECT_EQ(robot.modes.get_failure().cause,
                      is_under_way ? ModeFailureCause::kStopped : ModeFailureCause::kNone);
            ASSERT_EQ(robot.cores[1U - stopped]->stop(), Status::kOk);
            ASSERT_TRUE(robot.start());
        }
    }
}

TEST_F(SystemModesTest, BothCoresStoppedInASwitchStartAgainInTheSafeMode) {
    verifies("SWR-MOD-007", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_EQ(sut_.modes.request(Command::kStart), Status::kOk);
    sut_.run_frames(3);
    for (Executive* core : sut_.cores) {
        ASSERT_EQ(core->stop(), Status::kOk);
        ASSERT_EQ(core->stop(), Status::kOk) << "a second stop changes nothing";
    }
    EXPECT_EQ(sut_.modes.get_mode(), kHalt);
    ASSERT_TRUE(sut_.start());
    EXPECT_EQ(sut_.get_active(), "monitor guard ");
}

TEST_F(SystemModesTest, ACoreDoesNotStartIntoTheMiddleOfASwitch) {
    verifies("SWR-MOD-006", Technique::kStateTransition, Polarity::kViolation);
    ASSERT_EQ(sut_.core_1.stop(), Status::kOk);
    ASSERT_EQ(sut_.modes.request(Command::kStart), Status::kOk);
    static_cast<void>(sut_.run_core(0U));
    static_cast<void>(sut_.run_core(0U));

    EXPECT_EQ(sut_.core_1.start(), Status::kPreconditionNotMet);
    EXPECT_FALSE(sut_.core_1.get_context(1U).is_running());
}

TEST(SystemModesSetupTest, AnExecutiveWantsTheModesOfItsTable) {
    verifies("SWR-MOD-008", Technique::kInterface, Polarity::kViolation);
    Robot robot;
    Robot other;
    const testing_support::Untold<Robot::Table> untold{robot.table};
    ExecutiveFor<testing_support::Untold<Robot::Table>> without{untold};
    EXPECT_EQ(without.initialize(), Status::kPreconditionNotMet);
    ExecutiveFor<Robot::Table> foreign{robot.table, other.modes};
    EXPECT_EQ(foreign.initialize(), Status::kBadParameter);
    ExecutiveFor<Robot::Table> beyond{robot.table, robot.modes, kModeCoreMax};
    EXPECT_EQ(beyond.initialize(), Status::kBadParameter);
    ASSERT_TRUE(robot.begin());
}

TEST(SystemModesSetupTest, TheFirstModeNamesTheSetThatHoldsFirst) {
    verifies("SWR-MOD-002", Technique::kEquivalenceClasses);
    std::array<SystemModeRow, 2U> modes{};
    modes[0].name = "work";
    modes[1].name = "halt";
    SystemView view{};

    EXPECT_EQ(SystemModes{view}.prepare().get_value(), kNoConfigurationSet) << "a table without modes";
    view.modes.modes = modes;
    EXPECT_EQ(SystemModes{view}.prepare().get_value(), kNoConfigurationSet) << "a mode without a set";
    const std::array<ConfigurationSetRow, 2U> sets{{{"slow", 0U, 0U}, {"fast", 0U, 0U}}};
    view.configuration.sets = sets;
    modes[0].set = 1U;
    EXPECT_EQ(SystemModes{view}.prepare().get_value(), 1U);
}

TEST(SystemModesSetupTest, ARefusedFirstSetKeepsTheSystemFromStarting) {
    verifies("SWR-MOD-008", Technique::kFaultInjection, Polarity::kViolation);
    Robot robot;
    ASSERT_TRUE(robot.begin());
    ASSERT_EQ(robot.core_0.stop(), Status::kOk);
    ASSERT_EQ(robot.core_1.stop(), Status::kOk);
    ASSERT_EQ(robot.modes.get_configuration().activate_configuration_set(make_text("slow")), Status::kOk);
    robot.table.configuration.values[0] = to_scalar(99.0);  // memory is corrupted

    EXPECT_EQ(robot.core_0.start(), Status::kBadParameter);
    EXPECT_EQ(robot.planner.speed.get(), 1.0) << "no value of the set was switched";
}

TEST_F(SystemModesTest, TheModeIsGivenAsItsEnumerator) {
    verifies("SWR-MOD-010");
    EXPECT_EQ(sut_.modes.get_mode<RobotMode>(), RobotMode::kIdle);

    ASSERT_EQ(sut_.modes.request(Command::kTeach), Status::kOk);
    sut_.run_frames(20);

    EXPECT_EQ(sut_.modes.get_mode<RobotMode>(), RobotMode::kTeach);
    EXPECT_EQ(sut_.modes.get_mode(), static_cast<std::size_t>(RobotMode::kTeach));
}

TEST_F(SystemModesTest, AnotherEnumerationOfModesEndsInTheAssertion) {
    verifies("SWR-MOD-010", Technique::kInterface, Polarity::kViolation);
    enum class Lamp { kOff };
    sut_.table.modes.mode_enumeration = nullptr;
    const SystemModes names_only{make_view(sut_.table)};

    EXPECT_CHECK_FAILS(static_cast<void>(sut_.modes.get_mode<Lamp>()), "run/system_modes.hpp", 2);
    EXPECT_CHECK_FAILS(static_cast<void>(names_only.get_mode<RobotMode>()), "run/system_modes.hpp", 2);
}

}  // namespace
}  // namespace mamori
