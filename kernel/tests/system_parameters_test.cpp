// SPDX-License-Identifier: Apache-2.0
// Goal: parameters are part of a system table; all cores take a set at the same frame, in every order in
// which they can come to it. Method: two cores without modes, run by hand in every order of their frames.
#include <gtest/gtest.h>

#include <set>

#include "mamori/kernel/table/system_check.hpp"
#include "mamori/trace/verifies.hpp"
#include "support/mode_system.hpp"

namespace mamori {
namespace {

using namespace testing_support;
using namespace verification;
using Speeds = std::vector<double>;

struct PlantParts {
    TroublePlan plan{};
    std::array<ModeHost, 2U> hosts;
    Part first{"first", 1, hosts[0], plan};
    Part second{"second", 2, hosts[1], plan};
};
auto make_plant_table(PlantParts& p) {
    return system(frame(1000_ns), window("a", 0_ns, 400_ns, budget(300_ns), run(p.first)),
                  window("b", 400_ns, 500_ns, core(1), budget(400_ns), run(p.second)),
                  configuration_set("slow", assign(p.first.speed, 0.5), assign(p.second.speed, 0.5)),
                  configuration_set("fast", assign(p.first.speed, 2.0), assign(p.second.speed, 2.0)));
}
struct Plant : PlantParts {
    using Table = decltype(make_plant_table(std::declval<PlantParts&>()));

    Table table{make_plant_table(*this)};
    SystemModes modes;
    ExecutiveFor<Table> core_0{table, modes};
    ExecutiveFor<Table> core_1{table, modes, 1U};
    std::array<Executive*, 2U> cores{{&core_0, &core_1}};
    std::array<ModeObserver, 2U> observers;
    std::array<std::int64_t, 2U> frames{};

    explicit Plant(std::size_t initial_set = kNoConfigurationSet) : modes(make_view(table), initial_set) {}
    bool begin() {
        bool is_ready = true;
        for (std::size_t core = 0U; core < 2U; ++core) {
            cores[core]->set_observer(&observers[core]);
            is_ready = is_ready && cores[core]->initialize() == Status::kOk;
        }
        return is_ready && start();
    }
    bool start() { return core_0.start() == Status::kOk && core_1.start() == Status::kOk; }
    void stop() {
        ASSERT_EQ(core_0.stop(), Status::kOk);
        ASSERT_EQ(core_1.stop(), Status::kOk);
    }
    void run_core(std::size_t core) {
        const Instant release{frames[core]++ * 1000 + (core == 0U ? 0 : 400)};
        hosts[core].now = release;
        ASSERT_EQ(cores[core]->run_window(core, release, hosts[core]), WindowOutcome::kCompleted);
    }
    void run_frames(int count) {
        for (int i = 0; i < count; ++i) {
            run_core(0U);
            run_core(1U);
        }
    }
};

TEST(SystemParametersTest, TheTableKnowsEachParameterAndEachWindowItsOwn) {
    verifies("SWR-MOD-002");
    Plant plant;
    const SystemView view = make_view(plant.table);

    ASSERT_EQ(view.configuration.parameters.size(), 2U);
    EXPECT_EQ(view.configuration.parameters[1].parameter, &plant.second.speed);
    EXPECT_EQ(view.windows[1].first_parameter, 1U);
    EXPECT_EQ(view.windows[1].parameter_count, 1U);
    EXPECT_EQ(view.configuration.sets.size(), 2U);
    EXPECT_EQ(check(view).rule, Rule::kNone);
}

TEST(SystemParametersTest, ATableMadeAtRunTimeIsRefusedWithTheGuiltySetAndAssignment) {
    verifies("SWR-MOD-002", Technique::kInterface, Polarity::kViolation);
    Plant plant;
    plant.table.configuration.assignments[3].is_refused = true;
    const Finding finding = check(make_view(plant.table));

    EXPECT_EQ(finding.rule, Rule::kConfigurationRefused);
    EXPECT_EQ(finding.element, 1U);
    EXPECT_EQ(finding.other, 1U);
    EXPECT_STREQ(get_name(finding.rule), "ConfigurationRefused");
    EXPECT_EQ(plant.core_0.initialize(), Status::kBadParameter);
    EXPECT_EQ(plant.core_0.get_failed_component(), kNoIndex) << "no component is faulty";
    plant.table.configuration.assignments[3].is_refused = false;
    plant.table.windows[1].parameter_count = 2U;
    EXPECT_EQ(check(make_view(plant.table)).rule, Rule::kWindowRowInvalid);
}

TEST(SystemParametersTest, AnInitialSetIsThereBeforeTheFirstAction) {
    verifies("SWR-MOD-008");
    Plant plant{1U};
    ASSERT_TRUE(plant.begin());

    EXPECT_EQ(plant.first.speed_at_birth, 2.0);
    EXPECT_EQ(plant.second.speed_at_birth, 2.0);
    EXPECT_EQ(plant.second.speed_at_start, 2.0);
    EXPECT_EQ(plant.modes.get_configuration().get_active_configuration_set(), 1U);
}

TEST(SystemParametersTest, WhatIsAskedForWhileNothingRunsIsThereBeforeOnActivated) {
    verifies("SWR-MOD-008");
    Plant plant;
    ASSERT_EQ(plant.core_0.initialize(), Status::kOk);
    ASSERT_EQ(plant.core_1.initialize(), Status::kOk);
    ConfigurationAdmin& admin = plant.modes.get_configuration();
    ASSERT_EQ(admin.activate_configuration_set(0U), Status::kOk);
    ASSERT_EQ(admin.set_value(plant.second.speed, 0.7), Status::kOk);
    ASSERT_EQ(plant.core_0.start(), Status::kOk);
    ASSERT_EQ(plant.core_1.start(), Status::kOk);

    EXPECT_EQ(plant.first.speed_at_start, 0.5);
    EXPECT_EQ(plant.second.speed_at_start, 0.7) << "a single value comes after the set";
}

TEST(SystemParametersTest, ASingleValueIsTakenAtTheNextFrameOfItsCore) {
    verifies("SWR-MOD-008");
    Plant plant;
    ASSERT_TRUE(plant.begin());
    plant.run_core(0U);
    ASSERT_EQ(plant.modes.get_configuration().set_value(plant.first.speed, 0.3), Status::kOk);
    plant.run_core(1U);
    plant.run_frames(1);

    EXPECT_EQ(plant.first.speeds, (Speeds{1.0, 0.3}));
    EXPECT_EQ(plant.second.speeds, (Speeds{1.0, 1.0}));
}

TEST(SystemParametersTest, BothCoresTakeASetAtTheSameFrameInEveryOrder) {
    verifies("SWR-MOD-006", Technique::kStateTransition);
    constexpr unsigned kFrames = 10U;
    std::set<Speeds> seen;
    // While no core is more than a frame ahead, who is first is free in each frame.
    for (unsigned order = 0U; order < 1U << kFrames; ++order) {
        Plant plant;
        ASSERT_TRUE(plant.begin());
        for (unsigned frame = 0U; frame < kFrames; ++frame) {
            const std::size_t first = order >> frame & 1U;
            plant.run_core(first);
            plant.run_core(1U - first);
            if (frame == 2U) {
                ASSERT_EQ(plant.modes.get_configuration().activate_configuration_set(make_text("fast")),
                          Status::kOk);
            }
        }
        ASSERT_EQ(plant.first.speeds, plant.second.speeds) << order;
        ASSERT_EQ(plant.observers[1].steps.size(), 1U);
        ASSERT_EQ(plant.observers[1].steps[0].frame, 4) << "two frames after it was asked for";
        seen.insert(plant.first.speeds);
    }
    EXPECT_EQ(seen.size(), 1U);
}

TEST(SystemParametersTest, ACoreThatIsAWholeFrameLateSaysSo) {
    verifies("SWR-MOD-006", Technique::kFaultInjection, Polarity::kViolation);
    Plant plant;
    ASSERT_TRUE(plant.begin());
    ASSERT_EQ(plant.modes.get_configuration().activate_configuration_set(1U), Status::kOk);
    plant.run_core(1U);
    plant.run_core(1U);  // frame 1, at which the set would have been due, before core 0 begins frame 0
    plant.run_core(0U);
    plant.run_core(0U);
    plant.run_frames(4);

    EXPECT_EQ(plant.second.speed.get(), 2.0) << "it comes all the same";
    EXPECT_EQ(plant.modes.get_failure().cause, ModeFailureCause::kLate);
    EXPECT_EQ(plant.modes.get_failure().step, ModeStep::kSet);
    EXPECT_EQ(plant.modes.request_safe_mode(), Status::kUnsupported) << "a table without modes has none";
}

TEST(SystemParametersTest, ARefusedSetIsToldAndChangesNothing) {
    verifies("SWR-MOD-008", Technique::kFaultInjection, Polarity::kViolation);
    Plant plant;
    ASSERT_TRUE(plant.begin());
    plant.table.configuration.values[3] = to_scalar(99.0);  // memory is corrupted
    ASSERT_EQ(plant.modes.get_configuration().activate_configuration_set(1U), Status::kOk);
    plant.run_frames(5);

    EXPECT_EQ(plant.first.speeds, Speeds(5U, 1.0)) << "also the value of the other core, which was sound";
    ASSERT_EQ(plant.observers[0].refused_sets.size(), 1U);
    EXPECT_EQ(plant.observers[0].refused_sets[0].set, 1U);
    EXPECT_EQ(plant.observers[0].refused_sets[0].assignment, 1U);
    EXPECT_EQ(plant.modes.get_failure().cause, ModeFailureCause::kNone);
    ASSERT_EQ(plant.modes.get_configuration().activate_configuration_set(0U), Status::kOk);
    plant.run_frames(5);
    EXPECT_EQ(plant.second.speed.get(), 0.5) << "the next request is served";
}

TEST(SystemParametersTest, ASetThatTheCompilerCouldNotJudgeIsRefusedBeforeAnythingIsSwitched) {
    verifies("SWR-MOD-002", Technique::kErrorGuessing, Polarity::kViolation);
    Plant plant{1U};
    plant.table.configuration.values[1] = to_scalar(99.0);  // as assign(p.second.speed, 99.0) leaves it
    ASSERT_EQ(check(make_view(plant.table)).rule, Rule::kNone) << "a Part has no default constructor";
    EXPECT_EQ(plant.core_1.initialize(), Status::kBadParameter) << "also with nobody who listens";
    plant.core_0.set_observer(&plant.observers[0]);

    EXPECT_EQ(plant.core_0.initialize(), Status::kBadParameter);
    EXPECT_EQ(plant.first.speed.get(), 1.0) << "the initial set was another one";
    EXPECT_FALSE(plant.first.is_alive());
    ASSERT_EQ(plant.observers[0].refused_sets.size(), 1U);
    EXPECT_EQ(plant.observers[0].refused_sets[0].set, 0U);
    EXPECT_EQ(plant.observers[0].refused_sets[0].assignment, 1U);
    plant.table.configuration.values[1] = to_scalar(0.5);
    ASSERT_TRUE(plant.begin());
    EXPECT_EQ(plant.first.speed_at_birth, 2.0) << "the request for the initial set was not lost";
}

TEST(SystemParametersTest, ACoreDoesNotStartBeforeTheOtherOneIsInitialised) {
    verifies("SWR-KRN-024", Technique::kStateTransition, Polarity::kViolation);
    Plant plant;
    ASSERT_EQ(plant.core_1.initialize(), Status::kOk);

    EXPECT_EQ(plant.core_1.start(), Status::kPreconditionNotMet);
    EXPECT_EQ(plant.core_1.get_failed_component(), 0U) << "it has no context";
}

TEST(SystemParametersTest, TheLastSetIsCheckedAtInitialisation) {
    verifies("SWR-MOD-002", Technique::kBoundaryValues, Polarity::kViolation);
    Plant plant;
    plant.table.configuration.values[3] = to_scalar(99.0);  // of the last set
    plant.core_0.set_observer(&plant.observers[0]);

    EXPECT_EQ(plant.core_0.initialize(), Status::kBadParameter);
    ASSERT_EQ(plant.observers[0].refused_sets.size(), 1U);
    EXPECT_EQ(plant.observers[0].refused_sets[0].set, 1U);
    EXPECT_EQ(plant.observers[0].refused_sets[0].assignment, 1U);
}

TEST(SystemParametersTest, ASetThatWasRefusedWhileTheSystemRanIsNoReasonToRefuseTheNextStart) {
    verifies("SWR-MOD-008", Technique::kFaultInjection, Polarity::kViolation);
    for (const int frames : {1, 5}) {  // agreed on, and judged
        Plant plant{0U};
        ASSERT_TRUE(plant.begin());
        plant.table.configuration.values[3] = to_scalar(99.0);  // memory is corrupted
        ASSERT_EQ(plant.modes.get_configuration().activate_configuration_set(1U), Status::kOk);
        plant.run_frames(frames);
        plant.stop();

        ASSERT_TRUE(plant.start()) << frames;
        EXPECT_EQ(plant.first.speed_at_start, 0.5) << "the set before still holds";
        EXPECT_EQ(plant.second.speed_at_start, 0.5);
    }
}

TEST(SystemParametersTest, ASetThatIsRefusedAtAStartIsRefusedOnce) {
    verifies("SWR-MOD-008", Technique::kFaultInjection, Polarity::kViolation);
    Plant plant{0U};
    ASSERT_TRUE(plant.begin());
    plant.stop();
    plant.table.configuration.values[3] = to_scalar(99.0);  // memory is corrupted
    ASSERT_EQ(plant.modes.get_configuration().activate_configuration_set(1U), Status::kOk);

    EXPECT_EQ(plant.core_0.start(), Status::kBadParameter);
    EXPECT_EQ(plant.first.speed.get(), 0.5) << "no value of the set was switched";
    ASSERT_TRUE(plant.start()) << "the request is gone";
    EXPECT_EQ(plant.first.speed_at_start, 0.5);
}

TEST(SystemParametersTest, AResetOfATableWithoutModesKeepsTheSetThatHolds) {
    verifies("SWR-MOD-008", Technique::kStateTransition);
    Plant plant{1U};
    ASSERT_TRUE(plant.begin());
    ASSERT_EQ(plant.modes.get_configuration().set_value(plant.second.speed, 0.7), Status::kOk);
    plant.run_frames(1);
    plant.stop();
    ASSERT_EQ(plant.modes.reset(), Status::kOk);

    ASSERT_TRUE(plant.start());
    EXPECT_EQ(plant.second.speed_at_start, 2.0);
}

TEST(SystemParametersTest, ASetThatHoldsAndIsCorruptedLaterKeepsTheSystemFromStarting) {
    verifies("SWR-MOD-008", Technique::kFaultInjection, Polarity::kViolation);
    Plant plant{1U};
    ASSERT_TRUE(plant.begin());
    plant.stop();
    plant.table.configuration.values[3] = to_scalar(99.0);  // memory is corrupted

    EXPECT_EQ(plant.core_0.start(), Status::kBadParameter);
    EXPECT_EQ(plant.core_0.start(), Status::kBadParameter) << "what the system must have is not there";
}

TEST(SystemParametersTest, ASetThatWasUnderWayAtTheStopIsThereAtTheNextStart) {
    verifies("SWR-MOD-008", Technique::kErrorGuessing, Polarity::kViolation);
    Plant plant;
    ASSERT_TRUE(plant.begin());
    ASSERT_EQ(plant.modes.get_configuration().activate_configuration_set(1U), Status::kOk);
    plant.run_frames(1);
    ASSERT_EQ(plant.modes.get_step(), ModeStep::kSet);
    plant.stop();
    ASSERT_EQ(plant.core_0.start(), Status::kOk);

    EXPECT_EQ(plant.first.speed_at_start, 2.0);
}

/// Two windows on one core, and modes that no set belongs to.
struct LineParts {
    TroublePlan plan{};
    ModeHost host;
    Part first{"first", 1, host, plan};
    Part second{"second", 2, host, plan};
};
auto make_line_table(LineParts& p) {
    return system(frame(1000_ns), window("a", 0_ns, 400_ns, budget(300_ns), run(p.first)),
                  window("b", 400_ns, 500_ns, budget(400_ns), run(p.second)),
                  configuration_set("slow", assign(p.first.speed, 0.5), assign(p.second.speed, 0.5)),
                  configuration_set("fast", assign(p.first.speed, 2.0), assign(p.second.speed, 2.0)),
                  system_mode("idle", runs(p.first, p.second)), safe_mode("halt", runs(p.first, p.second)));
}
class StoppedWindowTest : public ::testing::Test {
  protected:
    using Table = decltype(make_line_table(std::declval<LineParts&>()));

    void SetUp() override {
        ASSERT_EQ(executive_.initialize(), Status::kOk);
        ASSERT_EQ(executive_.start(), Status::kOk);
        run_frames(1);
    }
    void run_window(std::size_t window) {
        parts_.host.now = Instant{frame_ * 1000 + static_cast<std::int64_t>(window) * 400};
        static_cast<void>(executive_.run_window(window, parts_.host.now, parts_.host));
    }
    void run_frames(int count) {
        for (int i = 0; i < count; ++i, ++frame_) {
            run_window(0U);
            run_window(1U);
        }
    }
    ExecutionContext& get_context() { return executive_.get_context(1U); }
    ConfigurationAdmin& get_configuration() { return modes_.get_configuration(); }

    LineParts parts_;
    Table table_{make_line_table(parts_)};
    SystemModes modes_{make_view(table_)};
    ExecutiveFor<Table> executive_{table_, modes_};
    std::int64_t frame_{0};
};

TEST_F(StoppedWindowTest, ItTakesASetInTheFrameInWhichTheOthersTakeIt) {
    verifies("SWR-MOD-008", Technique::kErrorGuessing, Polarity::kViolation);
    ASSERT_EQ(get_context().stop(parts_.host.now), Status::kOk);
    ASSERT_EQ(get_configuration().activate_configuration_set(1U), Status::kOk);
    for (int frame = 0; frame < 5; ++frame) {
        run_frames(1);
        EXPECT_EQ(parts_.first.speed.get(), parts_.second.speed.get()) << frame;
    }

    EXPECT_EQ(parts_.second.speed.get(), 2.0);
    EXPECT_EQ(modes_.get_failure().cause, ModeFailureCause::kNone);
    EXPECT_EQ(modes_.get_mode(), 0U);
}

TEST_F(StoppedWindowTest, ItTakesASetWhoseFrameItWasStoppedIn) {
    verifies("SWR-MOD-008", Technique::kBoundaryValues, Polarity::kViolation);
    ASSERT_EQ(get_configuration().activate_configuration_set(1U), Status::kOk);
    run_frames(1);
    run_window(0U);
    ASSERT_EQ(parts_.first.speed.get(), 2.0);
    ASSERT_EQ(parts_.second.speed.get(), 1.0) << "its turn would come now";
    ASSERT_EQ(get_context().stop(parts_.host.now), Status::kOk);
    run_window(1U);
    ++frame_;
    run_frames(5);

    EXPECT_EQ(parts_.second.speed.get(), 2.0);
    EXPECT_EQ(modes_.get_failure().cause, ModeFailureCause::kNone);
}

TEST_F(StoppedWindowTest, AWindowThatIsStartedAgainInTheFrameOfASetHasIt) {
    verifies("SWR-MOD-008", Technique::kBoundaryValues);
    ASSERT_EQ(get_context().stop(parts_.host.now), Status::kOk);
    ASSERT_EQ(get_configuration().activate_configuration_set(1U), Status::kOk);
    run_frames(1);
    run_window(0U);
    ASSERT_EQ(get_context().start(parts_.host.now), Status::kOk);
    run_window(1U);
    ++frame_;
    run_frames(5);

    EXPECT_EQ(parts_.second.speeds, (Speeds{1.0, 2.0, 2.0, 2.0, 2.0, 2.0, 2.0}));
    EXPECT_EQ(modes_.get_failure().cause, ModeFailureCause::kNone);
}

TEST_F(StoppedWindowTest, ASetCountsThatWasAskedForAfterASingleValue) {
    verifies("SWR-MOD-008", Technique::kErrorGuessing);
    ASSERT_EQ(get_context().stop(parts_.host.now), Status::kOk);
    ASSERT_EQ(get_configuration().set_value(parts_.second.speed, 0.7), Status::kOk);
    run_frames(1);
    EXPECT_EQ(parts_.second.speed.get(), 0.7);
    ASSERT_EQ(get_configuration().activate_configuration_set(1U), Status::kOk);
    run_frames(3);

    EXPECT_EQ(parts_.second.speed.get(), 2.0);
}

TEST_F(StoppedWindowTest, AWindowWhoseWorkHangsTakesTheSetWhenItComesBack) {
    verifies("SWR-MOD-008", Technique::kFaultInjection, Polarity::kViolation);
    parts_.host.aside = ModeHost::Aside::kEverything;
    parts_.second.hangs_in_cycle = true;
    run_frames(1);
    ASSERT_EQ(get_configuration().activate_configuration_set(1U), Status::kOk);
    run_frames(10);
    EXPECT_EQ(parts_.second.speed.get(), 1.0) << "somebody may still read it";
    EXPECT_EQ(modes_.get_failure().cause, ModeFailureCause::kNoTurn);
    parts_.second.hangs_in_cycle = false;
    parts_.host.release_hanging();
    run_frames(3);

    EXPECT_EQ(parts_.second.speed.get(), 2.0);
}

}  // namespace
}  // namespace mamori
