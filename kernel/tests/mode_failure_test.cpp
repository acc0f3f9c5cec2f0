// SPDX-License-Identifier: Apache-2.0
// Goal: whatever goes wrong in a switch of modes, at whichever of its steps, the system ends in its safe
// mode, latched, and says what went wrong where. Method: every transition, every component that leaves or
// enters, every kind of trouble, enumerated and counted; hanging actions really hang, on a stack of their
// own.
#include <gtest/gtest.h>

#include <array>

#include "mamori/trace/verifies.hpp"
#include "support/mode_system.hpp"

namespace mamori {
namespace {

using namespace testing_support;
using namespace verification;

struct Transition {
    std::size_t source;
    Command command;
    std::size_t target;
};
constexpr std::array<Transition, 6U> kTransitions{{{kIdle, Command::kStart, kWork},
                                                   {kIdle, Command::kTeach, kTeach},
                                                   {kWork, Command::kTeach, kTeach},
                                                   {kWork, Command::kStop, kIdle},
                                                   {kTeach, Command::kStart, kWork},
                                                   {kTeach, Command::kStop, kIdle}}};
constexpr std::int64_t kLongEnough = 16;

std::array<Part*, 6U> get_parts(Robot& robot) {
    return {&robot.monitor, &robot.planner, &robot.viewer, &robot.hand, &robot.drive, &robot.guard};
}

bool runs_in(const Robot& robot, std::size_t part, std::size_t mode) {
    return (robot.table.component_rows[part].modes & to_mask(mode)) != 0U;
}

/// Brings a fresh robot into the mode that the transition leaves.
void bring_to(Robot& robot, std::size_t mode) {
    ASSERT_TRUE(robot.begin());
    if (mode != kIdle) {
        ASSERT_EQ(robot.modes.request(mode == kWork ? Command::kStart : Command::kTeach), Status::kOk);
        robot.run_frames(8);
    }
    ASSERT_EQ(robot.modes.get_mode(), mode);
}

/// The one end of every switch that fails.
void expect_safe_end(Robot& robot, const ModeFailure& expected, const Part* hanging) {
    EXPECT_EQ(robot.modes.get_mode(), kHalt);
    EXPECT_EQ(robot.modes.get_step(), ModeStep::kNone);
    EXPECT_EQ(robot.modes.get_failure().cause, expected.cause);
    EXPECT_EQ(robot.modes.get_failure().step, expected.step);
    EXPECT_EQ(robot.modes.get_failure().component, expected.component);
    const std::size_t dead_core =
        hanging == nullptr ? 2U : robot.table.component_rows[expected.component].window;
    for (std::size_t i = 0U; i < 6U; ++i) {
        const Part& part = *get_parts(robot)[i];
        const bool is_active = robot.get_state(part) == LifecycleState::kActive;
        // Nobody can be called in a window in which somebody hangs; nobody runs there either.
        if (robot.table.component_rows[i].window != dead_core) {
            EXPECT_EQ(is_active, runs_in(robot, i, kHalt)) << part.get_name();
        }
        EXPECT_GE(part.out.get_published(), 0) << "on_deactivated wrote into " << part.get_name();
    }
    EXPECT_EQ(robot.modes.request(Command::kStart), Status::kPreconditionNotMet);
    // The core without the hanging component goes on, so does its own one as soon as it returns.
    std::array<std::int64_t, 6U> cycles{};
    for (std::size_t i = 0U; i < 6U; ++i) {
        cycles[i] = get_parts(robot)[i]->cycle_count;
    }
    robot.run_frames(3);
    EXPECT_EQ(robot.monitor.cycle_count, cycles[0] + (dead_core == 0U ? 0 : 3));
    EXPECT_EQ(robot.guard.cycle_count, cycles[5] + (dead_core == 1U ? 0 : 3));
    for (std::size_t i = 1U; i < 5U; ++i) {
        EXPECT_EQ(get_parts(robot)[i]->cycle_count, cycles[i]) << "does not run in the safe mode";
    }
    EXPECT_EQ(robot.modes.get_mode(), kHalt);
}

/// One run: `trouble` in the component `part` when `transition` calls it.
void run_trouble(const Transition& transition, std::size_t part, bool is_entering, Trouble trouble) {
    Robot robot;
    bring_to(robot, transition.source);
    robot.plan = {get_parts(robot)[part], is_entering, trouble};
    ASSERT_EQ(robot.modes.request(transition.command), Status::kOk);
    robot.run_frames(kLongEnough);

    const ModeFailure expected{
        trouble == Trouble::kRefusal ? ModeFailureCause::kRefused : ModeFailureCause::kOverrun,
        is_entering ? ModeStep::kEnter : ModeStep::kLeave, part};
    const std::size_t core = robot.table.component_rows[part].window;
    ASSERT_EQ(robot.observers[core].failures.size(), 1U);
    EXPECT_EQ(robot.observers[core].failures[0].component, part);
    EXPECT_TRUE(robot.observers[1U - core].failures.empty());
    if (trouble != Trouble::kRefusal) {
        ASSERT_FALSE(robot.observers[core].overruns.empty());
        EXPECT_EQ(robot.observers[core].overruns.front(), part);
    }
    const bool hangs = trouble == Trouble::kHang;
    EXPECT_EQ(robot.hosts[core].hanging.size(), hangs ? 1U : 0U);
    expect_safe_end(robot, expected, hangs ? get_parts(robot)[part] : nullptr);
    if (hangs) {
        EXPECT_EQ(robot.observers[core].overruns.back(), part) << "it is named in each frame";
        // It returns after all: too late for its mode, and its window lives again.
        robot.hosts[core].release_hanging();
        robot.run_frames(3);
        expect_safe_end(robot, expected, nullptr);
    }
}

TEST(ModeFailureEnumerationTest, EachActionThatFailsOrHangsEndsInTheSafeMode) {
    verifies("SWR-MOD-007", Technique::kFaultInjection, Polarity::kViolation);
    int count = 0;
    for (const Transition& transition : kTransitions) {
        const Robot robot;
        for (std::size_t part = 0U; part < 6U; ++part) {
            const bool was = runs_in(robot, part, transition.source);
            const bool will = runs_in(robot, part, transition.target);
            for (const Trouble trouble : {Trouble::kRefusal, Trouble::kDelay, Trouble::kHang}) {
                if (was != will) {
                    SCOPED_TRACE(testing::Message()
                                 << transition.source << "->" << transition.target << " part " << part
                                 << " trouble " << static_cast<int>(trouble));
                    run_trouble(transition, part, will, trouble);
                    ++count;
                }
            }
        }
    }
    // Idle to work and back three components each, to teach and back three, between the two two: 16 actions.
    EXPECT_EQ(count, 16 * 3);
}

TEST(ModeFailureEnumerationTest, ARefusedSetEndsInTheSafeModeBeforeAnybodyEnters) {
    verifies("SWR-MOD-007", Technique::kFaultInjection, Polarity::kViolation);
    int count = 0;
    for (const Transition& transition : kTransitions) {
        Robot robot;
        bring_to(robot, transition.source);
        for (Scalar& value : robot.table.configuration.values) {
            value = to_scalar(99.0);  // memory is corrupted
        }
        const double speed = robot.drive.speed.get();
        ASSERT_EQ(robot.modes.request(transition.command), Status::kOk);
        robot.run_frames(kLongEnough);
        if (transition.target == kIdle) {
            EXPECT_EQ(robot.modes.get_mode(), kIdle) << "it has no set";
            continue;
        }
        ++count;
        expect_safe_end(robot, {ModeFailureCause::kParameters, ModeStep::kEnter, kNoIndex}, nullptr);
        EXPECT_EQ(robot.drive.speed.get(), speed);
        for (const auto& observer : robot.observers) {
            ASSERT_EQ(observer.refused_sets.size(), 1U) << "each core finds it for itself";
            EXPECT_EQ(observer.refused_sets[0].rule, ConfigurationRule::kValueOutsideConstraint);
        }
    }
    EXPECT_EQ(count, 4);
}

TEST(ModeFailureEnumerationTest, AWindowThatMissesItsStepEndsInTheSafeMode) {
    verifies("SWR-MOD-007", Technique::kFaultInjection, Polarity::kViolation);
    int count = 0;
    for (const Transition& transition : kTransitions) {
        for (std::size_t core = 0U; core < 2U; ++core) {
            Robot robot;
            bring_to(robot, transition.source);
            ASSERT_EQ(robot.modes.request(transition.command), Status::kOk);
            robot.run_frames(4);  // left, and about to enter
            Part& victim = core == 0U ? robot.monitor : robot.guard;
            victim.cycle_time = Duration{1'000'000};
            robot.run_frames(1);
            victim.cycle_time = Duration{0};
            robot.run_frames(kLongEnough);

            ++count;
            const std::size_t first = robot.table.windows[core].first_component;
            expect_safe_end(robot, {ModeFailureCause::kNoTurn, ModeStep::kEnter, first}, nullptr);
        }
    }
    EXPECT_EQ(count, 12);
}

TEST(ModeFailureEnumerationTest, AWindowThatIsStoppedEndsInTheSafeMode) {
    verifies("SWR-MOD-007", Technique::kFaultInjection, Polarity::kViolation);
    int count = 0;
    for (std::size_t core = 0U; core < 2U; ++core) {
        for (std::int64_t frames = 0; frames < 5; ++frames) {
            Robot robot;
            bring_to(robot, kIdle);
            ASSERT_EQ(robot.modes.request(Command::kStart), Status::kOk);
            robot.run_frames(frames);
            ASSERT_EQ(robot.cores[core]->get_context(core).stop(Instant{}), Status::kOk);
            robot.run_frames(kLongEnough);

            ++count;
            EXPECT_EQ(robot.modes.get_failure().cause, ModeFailureCause::kNoTurn) << frames;
            EXPECT_EQ(robot.modes.get_failure().step, frames < 2 ? ModeStep::kLeave : ModeStep::kEnter);
            EXPECT_EQ(robot.modes.get_mode(), kHalt);
        }
    }
    EXPECT_EQ(count, 10);
}

TEST(ModeFailureEnumerationTest, AnotherCoreGoesOnWhenTheLeadComesNoMore) {
    verifies("SWR-MOD-006", Technique::kFaultInjection, Polarity::kViolation);
    Robot robot;
    bring_to(robot, kIdle);
    ASSERT_EQ(robot.modes.request(Command::kStart), Status::kOk);
    robot.run_frames(5);  // core 1 has entered
    for (int frame = 0; frame < 12; ++frame) {
        static_cast<void>(robot.run_core(1U));
    }

    EXPECT_EQ(robot.modes.get_failure().cause, ModeFailureCause::kLate);
    EXPECT_EQ(robot.modes.get_step(), ModeStep::kSafe) << "it waits for the core that is missing";
    EXPECT_EQ(robot.get_state(robot.drive), LifecycleState::kInactive);
}

TEST(ModeFailureEnumerationTest, ASecondTroubleOnTheWayToTheSafeModeChangesNothing) {
    verifies("SWR-MOD-007", Technique::kFaultInjection, Polarity::kViolation);
    int count = 0;
    for (const Trouble trouble : {Trouble::kRefusal, Trouble::kDelay, Trouble::kHang}) {
        for (std::size_t part = 1U; part < 5U; ++part) {
            Robot robot;
            bring_to(robot, kWork);
            if (!runs_in(robot, part, kWork)) {
                continue;
            }
            robot.plan = {get_parts(robot)[part], false, trouble};
            ASSERT_EQ(robot.modes.request_safe_mode(), Status::kOk);
            robot.run_frames(kLongEnough);

            ++count;
            const std::size_t core = robot.table.component_rows[part].window;
            ASSERT_EQ(robot.observers[core].failures.size(), 1U) << "the second one is told all the same";
            EXPECT_EQ(robot.observers[core].failures[0].step, ModeStep::kSafe);
            EXPECT_EQ(robot.modes.get_failure().cause, ModeFailureCause::kRequested) << "the first one stays";
            EXPECT_EQ(robot.modes.get_mode(), kHalt);
            robot.hosts[core].release_hanging();
            robot.run_frames(2);
            EXPECT_EQ(robot.get_active(), "monitor guard ") << part << " " << static_cast<int>(trouble);
        }
    }
    EXPECT_EQ(count, 9);
}

TEST(ModeFailureEnumerationTest, ACoreThatFallsBehindEndsInTheSafeMode) {
    verifies("SWR-MOD-006", Technique::kFaultInjection, Polarity::kViolation);
    int count = 0;
    for (std::size_t late = 0U; late < 2U; ++late) {
        for (std::int64_t begins = 1; begins < 7; ++begins) {
            Robot robot;
            bring_to(robot, kIdle);
            ASSERT_EQ(robot.modes.request(Command::kStart), Status::kOk);
            robot.run_frames(begins);
            for (int frame = 0; frame < 6; ++frame) {
                static_cast<void>(robot.run_core(1U - late));
            }
            for (int frame = 0; frame < 6; ++frame) {
                static_cast<void>(robot.run_core(late));
            }
            robot.run_frames(kLongEnough);

            ++count;
            EXPECT_EQ(robot.modes.get_mode(),
                      robot.modes.get_failure().cause == ModeFailureCause::kLate ? kHalt : kWork);
            EXPECT_EQ(robot.get_active(), robot.modes.get_mode() == kHalt
                                              ? "monitor guard "
                                              : "monitor planner viewer drive guard ");
            EXPECT_EQ(robot.observers[0].steps.back().step, robot.observers[1].steps.back().step);
        }
    }
    EXPECT_EQ(count, 12);
}

}  // namespace
}  // namespace mamori
