// SPDX-License-Identifier: Apache-2.0
// Goal: corners of the modes that the measurement of MC/DC found untested: nobody who listens, frames that a
// core misses, rows that only a tool could have made, calls that no executive makes. Method: the robot of
// support/mode_system.hpp, and tables built or broken at run time.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "mamori/kernel/dataflow/queue_in_port.hpp"
#include "mamori/kernel/table/system_check.hpp"
#include "mamori/trace/verifies.hpp"
#include "mamori/verification/failed_check.hpp"
#include "support/fake_host.hpp"
#include "support/mode_system.hpp"

namespace mamori {
namespace {

using namespace testing_support;
using namespace verification;

constexpr std::int64_t kLongEnough = 16;

bool has_finding(const SystemView& view, Rule rule, std::size_t element) {
    std::array<Finding, 64U> findings{};
    const std::size_t count = check_all(view, findings);
    return std::any_of(findings.begin(), findings.begin() + static_cast<std::ptrdiff_t>(count),
                       [&](const Finding& found) { return found.rule == rule && found.element == element; });
}

TEST(ModeCornerTest, AFailureNeedsNobodyWhoListens) {
    verifies("SWR-MOD-007", Technique::kFaultInjection, Polarity::kViolation);
    SpyObserver plain;  // hears what every observer must hear, and nothing about modes
    for (ExecutionObserver* observer :
         {static_cast<ExecutionObserver*>(nullptr), static_cast<ExecutionObserver*>(&plain)}) {
        Robot robot;
        for (Executive* core : robot.cores) {
            core->set_observer(observer);
        }
        ASSERT_TRUE(robot.begin());
        for (auto& value : robot.table.configuration.values) {
            value = to_scalar(99.0);  // memory is corrupted: both sets are refused
        }
        ASSERT_EQ(robot.modes.request(Command::kStart), Status::kOk);
        robot.run_frames(kLongEnough);

        EXPECT_EQ(robot.modes.get_failure().cause, ModeFailureCause::kParameters);
        EXPECT_EQ(robot.modes.get_mode(), kHalt);
        EXPECT_EQ(robot.planner.speed.get(), 1.0);
    }
}

TEST(ModeCornerTest, ACoreThatMissesTheFrameOfAStepSaysSoAndTakesNoPartInIt) {
    verifies("SWR-MOD-006", Technique::kFaultInjection, Polarity::kViolation);
    struct Case {
        std::int64_t frame;
        ModeStep step;
    };
    for (const Case& missed : {Case{3, ModeStep::kLeave}, Case{6, ModeStep::kEnter}}) {
        for (std::size_t core = 0U; core < 2U; ++core) {
            Robot robot;
            ASSERT_TRUE(robot.begin());
            robot.run_frames(2);
            ASSERT_EQ(robot.modes.request(Command::kStart), Status::kOk);
            robot.run_frames(missed.frame - 2);
            static_cast<void>(robot.run_core(1U - core));
            robot.miss_frame(core);
            robot.run_frames(kLongEnough);

            EXPECT_EQ(robot.modes.get_failure().cause, ModeFailureCause::kLate);
            EXPECT_EQ(robot.modes.get_failure().step, missed.step);
            EXPECT_EQ(robot.modes.get_mode(), kHalt);
            EXPECT_EQ(robot.get_active(), "monitor guard ");
            const Part& own = core == 0U ? robot.planner : robot.drive;
            EXPECT_EQ(own.speed_at_start, 0.0) << "nobody was activated on the late core";
        }
    }
}

TEST(ModeCornerTest, AComponentThatHangsInItsCycleKeepsItsWindowFromTheStep) {
    verifies("SWR-MOD-007", Technique::kFaultInjection, Polarity::kViolation);
    Robot robot;
    ASSERT_TRUE(robot.begin());
    robot.hosts[1].aside = ModeHost::Aside::kEverything;
    robot.run_frames(2);
    ASSERT_EQ(robot.modes.request(Command::kStart), Status::kOk);
    robot.run_frames(1);
    robot.guard.hangs_in_cycle = true;
    // In the frame before the step, so that the window is blocked in the frame of the step.
    const std::int64_t cycles = robot.guard.cycle_count;
    robot.frames[1] = 2;
    static_cast<void>(robot.run_core(1U));
    ASSERT_EQ(robot.hosts[1].hanging.size(), 1U);
    ASSERT_EQ(robot.guard.cycle_count, cycles + 1);
    robot.run_frames(kLongEnough);

    EXPECT_EQ(robot.modes.get_failure().cause, ModeFailureCause::kNoTurn);
    EXPECT_EQ(robot.modes.get_failure().component, 5U) << "the one that hangs is named";
    EXPECT_EQ(robot.modes.get_mode(), kHalt);
    robot.guard.hangs_in_cycle = false;
    robot.hosts[1].release_hanging();
}

TEST(ModeCornerTest, WhoLeavesTakesItsTimeFromTheWindowAndNotFromTheNextComponent) {
    verifies("SWR-MOD-005", Technique::kBoundaryValues);
    Robot robot;
    SpyObserver observer;
    observer.records[0].set_limits(Duration{0}, Duration{49});
    robot.core_0.set_observer(&observer);
    robot.plan = {&robot.planner, false, Trouble::kDelay, Duration{50}};
    ASSERT_TRUE(robot.begin());
    ASSERT_EQ(robot.modes.request(Command::kStart), Status::kOk);
    robot.run_frames(8);
    ASSERT_EQ(robot.modes.request(Command::kStop), Status::kOk);
    robot.run_frames(8);

    EXPECT_EQ(observer.take_seen(1U), std::vector<std::uint32_t>{ExecutionRecord::kWithin});
    EXPECT_EQ(robot.modes.get_mode(), kIdle);
}

TEST(ModeCornerTest, AnOldRefusalIsNotHeldAgainstAComponent) {
    verifies("SWR-MOD-007", Technique::kErrorGuessing);
    Robot robot;
    ASSERT_TRUE(robot.begin());
    ASSERT_EQ(robot.modes.request(Command::kStart), Status::kOk);
    robot.run_frames(8);
    robot.plan = {&robot.planner, false, Trouble::kRefusal};
    ASSERT_EQ(robot.modes.request(Command::kStop), Status::kOk);
    robot.run_frames(kLongEnough);
    ASSERT_EQ(robot.modes.get_failure().cause, ModeFailureCause::kRefused);
    for (Executive* core : robot.cores) {
        ASSERT_EQ(core->stop(), Status::kOk);
    }
    ASSERT_EQ(robot.modes.reset(), Status::kOk);
    robot.plan = {};
    ASSERT_TRUE(robot.start());
    for (const Command command : {Command::kStart, Command::kStop}) {
        ASSERT_EQ(robot.modes.request(command), Status::kOk);
        robot.run_frames(8);
    }

    EXPECT_EQ(robot.modes.get_failure().cause, ModeFailureCause::kNone);
    EXPECT_EQ(robot.modes.get_mode(), kIdle);
}

TEST(ModeCornerTest, NothingIsTakenAfterAFailureNorFromAModeThatIsGone) {
    verifies("SWR-MOD-004", Technique::kErrorGuessing, Polarity::kViolation);
    Robot failing;
    ASSERT_TRUE(failing.begin());
    ASSERT_EQ(failing.modes.request_safe_mode(), Status::kOk);
    EXPECT_EQ(failing.modes.get_step(), ModeStep::kNone) << "no core has seen it yet";
    EXPECT_EQ(failing.modes.request(Command::kStart), Status::kPreconditionNotMet);

    Robot late;
    ASSERT_TRUE(late.begin());
    ASSERT_EQ(late.modes.request(Command::kStart), Status::kOk);
    // As if a switch had come to its end between the two looks of the request.
    late.table.modes.transitions[0].source = kTeach;
    late.run_frames(kLongEnough);
    EXPECT_EQ(late.modes.get_mode(), kIdle);
    EXPECT_EQ(late.modes.get_failure().cause, ModeFailureCause::kNone);
}

TEST(ModeCornerTest, ACoreThatHasNotJoinedDecidesNothing) {
    verifies("SWR-MOD-006", Technique::kInterface, Polarity::kViolation);
    Robot robot;
    ASSERT_EQ(robot.modes.request(Command::kStart), Status::kOk);

    EXPECT_EQ(robot.modes.begin_frame(0U, 5).get_step(), ModeStep::kNone);
    robot.modes.leave(0U);
    EXPECT_EQ(robot.modes.request(Command::kTeach), Status::kPreconditionNotMet) << "the request still waits";
    ASSERT_TRUE(robot.begin());
    robot.run_frames(8);
    EXPECT_EQ(robot.modes.get_mode(), kWork);
}

TEST(ModeCornerTest, ModesOfOtherRowsOverTheSameComponentsAreForeign) {
    verifies("SWR-MOD-008", Technique::kInterface, Polarity::kViolation);
    Robot robot;
    SystemView view = make_view(robot.table);
    view.modes = {};
    SystemModes others{view};
    ExecutiveFor<Robot::Table> foreign{robot.table, others};

    EXPECT_EQ(foreign.initialize(), Status::kBadParameter);
}

TEST(ModeCornerTest, ModesCannotCountMoreSetsThanAPlanCanName) {
    verifies("SWR-MOD-001", Technique::kBoundaryValues, Polarity::kViolation);
    const std::vector<ConfigurationSetRow> rows(ModePlan::kIndexMax + 1U);
    SystemView view{};
    view.configuration.sets = {rows.data(), rows.size() - 1U};
    const SystemModes fits{view};
    EXPECT_EQ(fits.get_mode(), 0U);
    view.configuration.sets = {rows.data(), rows.size()};

    EXPECT_CHECK_FAILS(SystemModes{view}, "system_modes.hpp", 1);
}

struct SmallParts {
    TroublePlan plan{};
    ModeHost host;
    Part first{"first", 1, host, plan};
    Part second{"second", 2, host, plan};
    Part stranger{"stranger", 3, host, plan};
};

TEST(ModeCornerTest, NamesThatDoNotExistAreFoundInATableMadeAtRunTime) {
    verifies("SWR-MOD-003", Technique::kInterface, Polarity::kViolation);
    SmallParts p;
    const auto table = system(
        frame(1000_ns), window("all", 0_ns, 400_ns, budget(300_ns), run(p.first, p.second)),
        connect(p.first.out, p.second.in, only_in("nowhere", "work"), any_age()),
        connect(p.stranger.out, p.first.in, any_age()), connect(p.second.out, p.stranger.in, any_age()),
        system_mode(nullptr, runs(p.first, p.second)), system_mode("work", runs(p.first)),
        safe_mode("halt", runs(p.first)), mode_transition(nullptr, Command::kStart, "work"),
        mode_transition("work", Command::kStop, "void"));
    const SystemView view = make_view(table);

    EXPECT_TRUE(has_finding(view, Rule::kModeRowInvalid, 0U));
    EXPECT_EQ(view.modes.connection_modes[0].mode, kNoIndex);
    EXPECT_EQ(view.connections[0].get_modes(), 0U) << "\"work\" does not run the reader";
    EXPECT_EQ(view.connections[1].get_modes(), kEveryMode) << "its source is in no mode that one could ask";
    EXPECT_EQ(view.connections[2].get_modes(), kEveryMode);
    EXPECT_EQ(view.modes.transitions[0].source, kNoIndex);
    EXPECT_EQ(view.modes.transitions[0].target, 1U);
    EXPECT_EQ(view.modes.transitions[1].target, kNoIndex);
}

TEST(ModeCornerTest, TheThirtyThirdModeIsRefusedByItsNumber) {
    verifies("SWR-MOD-003", Technique::kBoundaryValues, Polarity::kViolation);
    Robot robot;
    for (PortRow& port : robot.table.ports) {
        port.is_mandatory = port.input == &robot.drive.in;
    }
    for (ConnectionRow& connection : robot.table.connections) {
        connection.idle_modes = 0U;
    }
    std::vector<SystemModeRow> rows(kSystemModeMax + 1U, SystemModeRow{"many"});
    SystemView view = make_view(robot.table);
    view.modes.modes = {rows.data(), rows.size()};
    EXPECT_TRUE(has_finding(view, Rule::kModeRowInvalid, kSystemModeMax));
    view.modes.modes = {rows.data(), rows.size() - 1U};
    EXPECT_FALSE(has_finding(view, Rule::kModeRowInvalid, kSystemModeMax - 1U));

    robot.table.ports[0].component = 6U;
    robot.table.ports[0].input = &robot.drive.in;
    robot.table.ports[0].is_mandatory = true;
    EXPECT_NE(check(make_view(robot.table)).rule, Rule::kNone) << "read without going past the components";
}

TEST(ModeCornerTest, AnEnumeratorOfAnotherEnumerationIsNoEventWhateverItsNumber) {
    verifies("SWR-MOD-004", Technique::kErrorGuessing, Polarity::kViolation);
    enum class Lamp { kOn = static_cast<int>(Command::kStart) };
    Robot robot;
    ASSERT_TRUE(robot.begin());
    EXPECT_EQ(robot.modes.request(Lamp::kOn), Status::kBadParameter);
    EXPECT_EQ(robot.modes.request(Command::kStart), Status::kOk);

    Robot by_hand;
    by_hand.table.modes.event_enumeration = nullptr;
    SystemModes modes{make_view(by_hand.table)};
    EXPECT_EQ(modes.request(Lamp::kOn), Status::kOk) << "numbers are all that such a table has";
    EXPECT_EQ(modes.request(Lamp{99}), Status::kBadParameter);
}

TEST(ModeCornerTest, ATableWithSetsAloneWantsItsModesToo) {
    verifies("SWR-MOD-008", Technique::kInterface, Polarity::kViolation);
    SmallParts p;
    const auto table = system(frame(1000_ns), window("all", 0_ns, 400_ns, budget(300_ns), run(p.first)),
                              configuration_set("slow", assign(p.first.speed, 0.5)));
    using Table = testing_support::Untold<std::remove_const_t<decltype(table)>>;
    const Table untold{table};
    ExecutiveFor<Table> without{untold};

    EXPECT_EQ(without.initialize(), Status::kPreconditionNotMet);
}

TEST(ModeCornerTest, AWindowThatOpensTwiceInAFrameCrossesTheBoundaryOnce) {
    verifies("SWR-MOD-008", Technique::kBoundaryValues);
    SmallParts p;
    const auto table =
        system(frame(1000_ns), window("fast", 0_ns, 200_ns, every(500_ns), budget(200_ns), run(p.first)),
               configuration_set("slow", assign(p.first.speed, 0.5)));
    SystemModes modes{make_view(table)};
    ExecutiveFor<std::remove_const_t<decltype(table)>> sut{table, modes};
    ASSERT_EQ(sut.initialize(), Status::kOk);
    ASSERT_EQ(sut.start(), Status::kOk);
    for (std::int64_t release = 0; release < 3000; release += 500) {
        if (release == 500) {
            ASSERT_EQ(modes.get_configuration().set_value(p.first.speed, 2.5), Status::kOk);
        }
        p.host.now = Instant{release};
        ASSERT_EQ(sut.run_window(0U, Instant{release}, p.host), WindowOutcome::kCompleted);
    }

    EXPECT_EQ(p.first.speeds, (std::vector<double>{1.0, 1.0, 2.5, 2.5, 2.5, 2.5}));
}

TEST(ModeCornerTest, AnInputThatGetsAnotherSourceInTheSafeModeTakesNoOldValueOfIt) {
    verifies("SWR-MOD-009", Technique::kBoundaryValues, Polarity::kViolation);
    SmallParts p;
    Part& reader = p.stranger;
    // Either order of the two connections: what ends must not undo what begins.
    const auto make_table = [&](auto earlier, auto later) {
        return system(
            frame(1000_ns), window("all", 0_ns, 400_ns, budget(300_ns), run(reader, p.first, p.second)),
            earlier, later, system_mode("idle", runs(reader, p.first)),
            system_mode("work", runs(reader, p.first, p.second)), safe_mode("halt", runs(reader, p.first)),
            mode_transition("idle", Command::kStart, "work"));
    };
    const auto run_both = [&](const auto& table) {
        SystemModes modes{make_view(table)};
        ExecutiveFor<std::decay_t<decltype(table)>> sut{table, modes};
        ASSERT_EQ(sut.initialize(), Status::kOk);
        ASSERT_EQ(sut.start(), Status::kOk);
        reader.reads.clear();
        const auto run_frame = [&](std::int64_t number) {
            p.host.now = Instant{number * 1000};
            ASSERT_EQ(sut.run_window(0U, p.host.now, p.host), WindowOutcome::kCompleted);
        };
        for (std::int64_t frame_number = 0; frame_number < 12; ++frame_number) {
            if (frame_number == 0) {
                ASSERT_EQ(modes.request(Command::kStart), Status::kOk);
            }
            run_frame(frame_number);
        }
        ASSERT_GT(reader.reads.back(), 2000) << "the second part feeds it in \"work\"";
        ASSERT_EQ(modes.request_safe_mode(), Status::kOk);
        run_frame(12);
        ASSERT_GT(reader.reads.back(), 2000);
        run_frame(13);  // to the safe mode
        EXPECT_EQ(reader.reads.back(), -1) << "the value that waits is of another mode";
        run_frame(14);
        EXPECT_EQ(reader.reads.back(), 1000 + p.first.cycle_count - 1);
        ASSERT_EQ(sut.stop(), Status::kOk);
        ASSERT_EQ(sut.finalize(), Status::kOk);
    };
    run_both(make_table(connect(p.first.out, reader.in, only_in("halt"), any_age(), delayed_by_a_frame()),
                        connect(p.second.out, reader.in, only_in("work"), any_age(), delayed_by_a_frame())));
    run_both(make_table(connect(p.second.out, reader.in, only_in("work"), any_age(), delayed_by_a_frame()),
                        connect(p.first.out, reader.in, only_in("halt"), any_age(), delayed_by_a_frame())));
}

class QueueReader final : public Component {
  public:
    explicit QueueReader() noexcept : Component("reader") {}

    QueueInPort<std::int64_t, 2U, FullPolicy::kOverwrite, EmptyPolicy::kDoNothing, Need::kOptional> in{*this,
                                                                                                       "in"};
    using Ports = mamori::Ports<&QueueReader::in>;
    std::vector<std::int64_t> reads;

    Status on_execute(ContextHandle) noexcept override {
        std::int64_t value = 0;
        while (in.read(value) == Status::kOk) {
            reads.push_back(value);
        }
        return Status::kOk;
    }
};

TEST(ModeCornerTest, AQueueForgetsWhatWaitedInAnotherMode) {
    verifies("SWR-MOD-009", Technique::kBoundaryValues, Polarity::kViolation);
    SmallParts p;
    QueueReader reader;
    const auto table =
        system(frame(1000_ns), window("write", 0_ns, 400_ns, budget(300_ns), run(p.first)),
               window("read", 400_ns, 400_ns, budget(300_ns), run(reader)),
               connect(p.first.out, reader.in, only_in("work"), any_age()),
               system_mode("idle", runs(p.first, reader)), system_mode("work", runs(p.first, reader)),
               safe_mode("halt", runs(p.first, reader)), mode_transition("idle", Command::kStart, "work"),
               mode_transition("work", Command::kStop, "idle"));
    ASSERT_EQ(check(make_view(table)).rule, Rule::kNone);
    SystemModes modes{make_view(table)};
    ExecutiveFor<std::remove_const_t<decltype(table)>> sut{table, modes};
    ASSERT_EQ(sut.initialize(), Status::kOk);
    ASSERT_EQ(sut.start(), Status::kOk);
    std::int64_t frame_number = 0;
    const auto run_frames = [&](std::int64_t count) {
        for (std::int64_t i = 0; i < count; ++i, ++frame_number) {
            for (std::size_t w = 0U; w < 2U; ++w) {
                const Instant release{frame_number * 1000 + static_cast<std::int64_t>(w) * 400};
                p.host.now = release;
                static_cast<void>(sut.run_window(w, release, p.host));
            }
        }
    };
    run_frames(2);
    EXPECT_TRUE(reader.reads.empty()) << "the connection holds in \"work\" only";
    ASSERT_EQ(modes.request(Command::kStart), Status::kOk);  // in frame 1; enters in frame 6
    run_frames(8);
    EXPECT_EQ(reader.reads, (std::vector<std::int64_t>{1007, 1008, 1009, 1010}));
    ASSERT_EQ(modes.request(Command::kStop), Status::kOk);  // in frame 9; leaves in frame 11
    run_frames(8);
    EXPECT_EQ(reader.reads.back(), 1011) << "the last one before the connection ended";
}

TEST(ModeCornerTest, AQueueDropsWhatIsOlderThanItsRestartAndNothingElse) {
    verifies("SWR-MOD-009", Technique::kBoundaryValues, Polarity::kViolation);
    QueueInPort<std::int64_t, 2U, FullPolicy::kDoNothing, EmptyPolicy::kDoNothing> sut{kNoOwner, "in"};
    std::int64_t value = 0;
    ASSERT_EQ(sut.push({11, 1U, Instant{9}}), Status::kOk);
    ASSERT_EQ(sut.push({12, 2U, Instant{9}}), Status::kOk);
    sut.restart(Instant{10}, 0U);
    sut.open(Instant{20});
    EXPECT_EQ(sut.read(value), Status::kPreconditionNotMet) << "full of old ones";

    sut.open(Instant{21});  // empty
    ASSERT_EQ(sut.push({13, 3U, Instant{9}}), Status::kOk);
    ASSERT_EQ(sut.push({14, 4U, Instant{10}}), Status::kOk);
    sut.open(Instant{22});
    EXPECT_TRUE(sut.is_new());
    ASSERT_EQ(sut.read(value), Status::kOk);
    EXPECT_EQ(value, 14) << "published at the very instant of the restart";
    EXPECT_EQ(sut.read(value), Status::kPreconditionNotMet);
}

}  // namespace
}  // namespace mamori
