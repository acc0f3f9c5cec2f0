// SPDX-License-Identifier: Apache-2.0
// Goal: each rule of a safety table is checked by itself. Method: a table that is built while the test runs,
// changed in one value at a time, on both sides of each limit.
#include "mamori/safety/cycle/safety_rules.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "mamori/trace/verifies.hpp"

namespace mamori::safety {
namespace {

using namespace literals;
using namespace verification;

enum class Fault { kFast, kSilent };
constexpr auto kBeyond = static_cast<Fault>(2);

class Watched final : public Component {
  public:
    constexpr explicit Watched(const char* name) noexcept : Component(name) {}
};
class Sensor final : public Component {
  public:
    constexpr explicit Sensor(const char* name) noexcept : Component(name) {}
    OutPort<std::uint32_t> seen{*this, "seen"};
    OutPort<std::uint32_t> spare{*this, "spare"};
    using Ports = mamori::Ports<&Sensor::seen, &Sensor::spare>;
};
class Decider final : public Component, public CycleComponent {
  public:
    constexpr Decider() noexcept : Component("guard") {}
    InPort<std::uint32_t> seen{*this, "seen"};
    using Ports = mamori::Ports<&Decider::seen>;
};
Decider g_guard;
Watched g_controller{"controller"};
Watched g_stranger{"stranger"};
Sensor g_sensor{"sensor"};
Sensor g_strange_sensor{"strange_sensor"};
constexpr auto kStandstill = StopConfirmation::kStandstill;
constexpr auto kClosedBrakes = StopConfirmation::kClosedBrakes;
constexpr auto kTorqueOff = StopConfirmation::kTorqueOff;

template <typename... Parts>
constexpr auto build(const Parts&... parts) {
    return safety::system(
        frame(1_ms), window("all", 0_us, 1_ms, budget(1_ms), run(g_sensor, g_guard, g_controller)),
        connect(g_sensor.seen, g_guard.seen, any_age()), supervise(g_sensor, alive(), deadline(1_ms)),
        confirmed_by(g_sensor.seen, kStandstill, kClosedBrakes, kTorqueOff),
        faults<Fault::kFast, Fault::kSilent>(), react(Fault::kFast, Reaction::kSs1, within(2_ms)),
        react(Fault::kSilent, Reaction::kSto, within(2_ms)), parts...);
}

auto make_cycle(Fault late = Fault::kFast, Fault self_test = Fault::kFast, Fault brakes = Fault::kFast) {
    return cycle(StopBounds{20_ms, 20_ms}, BrakeLimits{10_ms, true}, WatchdogWindow{500_us, 4_ms},
                 torque_feedback(5_ms), tolerated_lateness(50_us), on_late_reaction(raises(late)),
                 on_failed_self_test(raises(self_test)), on_unconfirmed_brakes(raises(brakes)),
                 brakes_first<Fault::kSilent>());
}

auto build_sound() {
    return build(supervise(g_guard, alive(2U, 3U), deadline(100_us)),
                 supervise(g_controller, alive(2U, 3U), deadline(100_us), raises(Fault::kSilent)),
                 confirm(Fault::kFast, {2U}), confirm(Fault::kSilent, {3U}), make_cycle());
}

/// The rule that a sound table violates after one change.
template <typename Change>
SafetyFinding check(Change change) {
    auto table = build_sound();
    change(table);
    return detail::check_safety(table);
}

TEST(SafetyRulesTest, ASoundTableViolatesNothing) {
    verifies("SWR-CYC-002");
    EXPECT_EQ(build_sound().cycle.brakes_first, 2U);
    EXPECT_EQ(check([](auto&) {}).rule, SafetyRule::kNone);
    EXPECT_EQ(detail::to_fault(static_cast<Fault>(0xFFFF)), kNoFault - 1U) << "out of range";
    EXPECT_EQ(detail::to_fault(static_cast<Fault>(0xFFFE)), kNoFault - 1U);
}

TEST(SafetyRulesTest, FaultsAndReactionsAreThoseOfTheSafetyLayer) {
    verifies("SWR-CYC-002", Technique::kBoundaryValues, Polarity::kViolation);
    EXPECT_EQ(check([](auto& table) { table.faults[1U].fault = 2U; }).rule, SafetyRule::kFaultsNumbered);
    EXPECT_EQ(check([](auto& table) { table.reactions[1U].reaction = 5U; }).rule, SafetyRule::kReactionKnown);
    EXPECT_EQ(check([](auto& table) { table.reactions[1U].reaction = 5U; }).row, 1U);
}

TEST(SafetyRulesTest, SupervisionIsOfComponentsOfTheTableInRange) {
    verifies("SWR-CYC-002", Technique::kBoundaryValues, Polarity::kViolation);
    EXPECT_EQ(check([](auto& table) { table.supervised[2U].watch.component = &g_stranger; }).rule,
              SafetyRule::kSupervisedInTable);
    EXPECT_EQ(check([](auto& table) { table.supervised[2U].watch.component = &g_guard; }).rule,
              SafetyRule::kSupervisedOnce);
    EXPECT_EQ(check([](auto& table) { table.supervised[2U].watch.limits.alive = {3U, 2U}; }).rule,
              SafetyRule::kAliveInRange);
    EXPECT_EQ(check([](auto& table) { table.supervised[2U].watch.limits.deadline = {}; }).rule,
              SafetyRule::kDeadlineInRange);
    EXPECT_EQ(check([](auto& table) { table.supervised[2U].fault = 2U; }).rule,
              SafetyRule::kRaisedFaultDeclared);
    EXPECT_EQ(check([](auto& table) {
                  table.supervised[0U].fault = 1U;
                  table.supervised[1U].fault = 1U;
              }).rule,
              SafetyRule::kSomethingProven);
}

TEST(SafetyRulesTest, ConfirmationsAreOfDeclaredFaultsOnce) {
    verifies("SWR-CYC-002", Technique::kBoundaryValues, Polarity::kViolation);
    EXPECT_EQ(check([](auto& table) { table.confirmations[1U].fault = 2U; }).rule,
              SafetyRule::kConfirmedFaultDeclared);
    EXPECT_EQ(check([](auto& table) { table.confirmations[1U].fault = 0U; }).rule,
              SafetyRule::kConfirmedOnce);
    EXPECT_EQ(check([](auto& table) { table.confirmations[1U].confirmation = {0U}; }).rule,
              SafetyRule::kConfirmationInRange);
    EXPECT_EQ(check([](auto& table) { table.confirmations[1U].healing = {0U}; }).rule,
              SafetyRule::kConfirmationInRange);
}

class Check final : public SelfTest {
  public:
    void begin() noexcept override {}
    SelfTestStatus step() noexcept override { return SelfTestStatus::kPassed; }
    std::size_t get_step_count() const noexcept override { return 1U; }
};
Check g_check;
Check g_other_check;

/// The finding of a table whose second self test is changed.
template <typename Change>
SafetyFinding check_self_test(Change change) {
    auto table = build(supervise(g_guard, alive(), deadline(1_ms)), make_cycle(),
                       self_test(g_check, found_within(2_ms), raises(Fault::kFast)),
                       self_test(g_other_check, found_within(2_ms), raises(Fault::kSilent)));
    change(table.self_tests[1U]);
    const SafetyFinding finding = detail::check_safety(table);
    return finding.rule == SafetyRule::kNone ? detail::check_cycle_window(table, 0U) : finding;
}

TEST(SafetyRulesTest, SelfTestsWithATimeForTheirStepsAreAccepted) {
    verifies("SWR-CYC-023", Technique::kBoundaryValues);
    EXPECT_EQ(check_self_test([](SelfTestRow&) {}).rule, SafetyRule::kNone);
    EXPECT_EQ(check_self_test([](SelfTestRow& row) { row.fault = 0U; }).rule, SafetyRule::kNone);
}

TEST(SafetyRulesTest, SelfTestsAreOfDeclaredFaultsOnceWithSteps) {
    verifies("SWR-CYC-023", Technique::kBoundaryValues, Polarity::kViolation);
    const auto expect = [](SafetyRule rule, auto change) {
        const SafetyFinding finding = check_self_test(change);
        EXPECT_EQ(finding.rule, rule);
        EXPECT_EQ(finding.row, 1U);
    };
    expect(SafetyRule::kTestedFaultDeclared, [](SelfTestRow& row) { row.fault = 2U; });
    expect(SafetyRule::kTestedOnce, [](SelfTestRow& row) { row.check = &g_check; });
    expect(SafetyRule::kTestHasSteps, [](SelfTestRow& row) { row.found_within = 2_ms - 1_ns; });
    expect(SafetyRule::kTestHasSteps, [](SelfTestRow& row) { row.found_within = 0_ms; });
    expect(SafetyRule::kTestHasSteps, [](SelfTestRow& row) { row.found_within = Duration{-1}; });
}

TEST(SafetyRulesTest, SettingsOfTheCycleAreInRange) {
    verifies("SWR-CYC-002", Technique::kBoundaryValues, Polarity::kViolation);
    const auto check_cycle = [](auto change) {
        return check([&change](auto& table) { change(table.cycle); }).rule;
    };
    EXPECT_EQ(check_cycle([](CycleRow& row) { row.stops.ss1_within = 0_ms; }),
              SafetyRule::kStopBoundsInRange);
    EXPECT_EQ(check_cycle([](CycleRow& row) { row.stops.ss2_within = 0_ms; }),
              SafetyRule::kStopBoundsInRange);
    EXPECT_EQ(check_cycle([](CycleRow& row) { row.brakes.closes_within = 0_ms; }),
              SafetyRule::kBrakesHaveTime);
    EXPECT_EQ(check_cycle([](CycleRow& row) { row.brakes.closes_within = 20_ms; }),
              SafetyRule::kBrakesHaveTime);
    EXPECT_EQ(check_cycle([](CycleRow& row) { row.brakes.closes_within = 20_ms - 1_ns; }), SafetyRule::kNone);
    EXPECT_EQ(check_cycle([](CycleRow& row) { row.watchdog = {Duration{-1}, 4_ms}; }),
              SafetyRule::kWatchdogInRange);
    EXPECT_EQ(check_cycle([](CycleRow& row) { row.watchdog = {4_ms, 4_ms}; }), SafetyRule::kWatchdogInRange);
    EXPECT_EQ(check_cycle([](CycleRow& row) { row.torque_feedback = 0_ms; }),
              SafetyRule::kTorqueFeedbackInRange);
    EXPECT_EQ(check_cycle([](CycleRow& row) { row.lateness_max = Duration{-1}; }),
              SafetyRule::kLatenessInRange);
    EXPECT_EQ(check_cycle([](CycleRow& row) { row.lateness_max = 0_ms; }), SafetyRule::kNone);
    EXPECT_EQ(check_cycle([](CycleRow& row) { row.late_fault = 2U; }), SafetyRule::kCycleFaultDeclared);
    EXPECT_EQ(check_cycle([](CycleRow& row) { row.self_test_fault = 2U; }), SafetyRule::kCycleFaultDeclared);
    EXPECT_EQ(check_cycle([](CycleRow& row) { row.brake_fault = 2U; }), SafetyRule::kCycleFaultDeclared);
}

TEST(SafetyRulesTest, FaultsOfBrakesFirstAreDeclaredLeadToStoAndTheirBrakesHaveContacts) {
    verifies("SWR-CYC-002", Technique::kBoundaryValues, Polarity::kViolation);
    constexpr std::uint64_t kAll = ~std::uint64_t{0U};
    const auto check_first = [](std::uint64_t faults, std::size_t count, std::uint64_t sto,
                                bool has_contacts) {
        CycleRow row{};
        row.brakes_first = faults;
        row.brakes.has_contacts = has_contacts;
        return detail::check_brakes_first(row, count, sto);
    };
    EXPECT_EQ(check_first(3U, 2U, 3U, true), SafetyRule::kNone);
    EXPECT_EQ(check_first(4U, 2U, kAll, true), SafetyRule::kBrakesFirstDeclared);
    EXPECT_EQ(check_first(kAll, 64U, kAll, true), SafetyRule::kNone);
    EXPECT_EQ(check_first(kAll, 63U, kAll, true), SafetyRule::kBrakesFirstDeclared);
    EXPECT_EQ(check_first(1U, 65U, kAll, true), SafetyRule::kBrakesFirstDeclared);
    EXPECT_EQ(check_first(3U, 2U, 2U, true), SafetyRule::kBrakesFirstBySto);
    EXPECT_EQ(check_first(1U, 2U, 3U, false), SafetyRule::kBrakesFirstHasContacts);
    EXPECT_EQ(check_first(0U, 65U, 0U, false), SafetyRule::kNone);
    EXPECT_EQ(check([](auto& table) { table.cycle.brakes_first = 1U; }).rule, SafetyRule::kBrakesFirstBySto)
        << "its reaction is SS1";
}

TEST(SafetyRulesTest, ATableHasOneCycle) {
    verifies("SWR-CYC-002", Technique::kEquivalenceClasses, Polarity::kViolation);
    const auto guard = supervise(g_guard, alive(), deadline(1_ms));
    EXPECT_EQ(detail::check_safety(build(guard)).rule, SafetyRule::kCycleOnce);
    EXPECT_EQ(detail::check_safety(build(guard, make_cycle(), make_cycle())).rule, SafetyRule::kCycleOnce);
    EXPECT_EQ(detail::check_safety(build(guard, make_cycle(Fault::kFast, Fault::kFast, kBeyond))).rule,
              SafetyRule::kCycleFaultDeclared);
}

constexpr auto kSound =
    build(supervise(g_guard, alive(), deadline(1_ms)),
          cycle(StopBounds{20_ms, 20_ms}, BrakeLimits{10_ms, true}, WatchdogWindow{500_us, 4_ms},
                torque_feedback(5_ms), tolerated_lateness(50_us), on_late_reaction(raises(Fault::kFast)),
                on_failed_self_test(raises(Fault::kFast)), on_unconfirmed_brakes(raises(Fault::kFast))));

TEST(SafetyRulesTest, TheCheckOfAConstantTableAnswersWhileRunningToo) {
    verifies("SWR-CYC-002", Technique::kInterface);
    EXPECT_TRUE(keeps_safety_rules<kSound>());
    EXPECT_TRUE((std::is_same_v<decltype(detail::show_faulty<kSound, SafetyRule::kAliveInRange, 1U>()),
                                detail::Shown<Decider>>));
    EXPECT_TRUE((std::is_same_v<decltype(detail::show_faulty<kSound, SafetyRule::kSourceConnected, 0U>()),
                                detail::Shown<Sensor>>));
    EXPECT_TRUE((std::is_same_v<decltype(detail::show_faulty<kSound, SafetyRule::kStopConfirmed, 1U>()),
                                detail::Shown<Unconfirmed<kClosedBrakes>>>));
    static_cast<void>(detail::show_faulty<kSound, SafetyRule::kNone, 0U>());
    static_cast<void>(detail::show_faulty<kSound, SafetyRule::kAliveInRange, 0U>());
    static_cast<void>(detail::show_faulty<kSound, SafetyRule::kSourceConnected, 0U>());
    static_cast<void>(detail::show_faulty<kSound, SafetyRule::kStopConfirmed, 0U>());
}

// ---- Checkpoints ----

enum class Entity { kFirst, kSecond, kUnknown };
enum class Point { kFirst, kSecond };
constexpr std::array kEntities{supervise(Entity::kFirst), supervise(Entity::kSecond)};
constexpr std::array kPoints{checkpoint(Point::kFirst, Entity::kFirst, CheckpointRole::kInitialAndFinal),
                             checkpoint(Point::kSecond, Entity::kSecond, CheckpointRole::kInitialAndFinal)};
constexpr SupervisionTable kTable{kEntities, kPoints, {}, {}, {}};
constexpr SupervisionTable kOtherTable{kEntities, kPoints, {}, {}, {}};
SupervisionStorage<kTable> g_storage;
ExpiryStorage g_expiry;
ExpiryMemory g_memory{g_expiry};
CheckpointSupervisor g_supervisor{g_storage, g_memory};
CheckpointSupervisor g_other_supervisor{g_storage, g_memory};

TEST(CheckpointRulesTest, EachEntityOfOneTableIsThatOfOneComponent) {
    verifies("SWR-CYC-015", Technique::kEquivalenceClasses);
    EXPECT_EQ(check([](auto& table) {
                  table.supervised[0U].checkpoints = checkpoints<kTable>(g_supervisor, Entity::kSecond);
                  table.supervised[2U].checkpoints = checkpoints<kTable>(g_supervisor, Entity::kFirst);
              }).rule,
              SafetyRule::kNone);
}

TEST(CheckpointRulesTest, AnEntityThatIsUnknownMissingOrOfTwoComponentsIsRejected) {
    verifies("SWR-CYC-015", Technique::kBoundaryValues, Polarity::kViolation);
    const auto check_pair = [](Checkpoints first, Checkpoints second) {
        return check([&](auto& table) {
            table.supervised[0U].checkpoints = first;
            table.supervised[2U].checkpoints = second;
        });
    };
    const Checkpoints first = checkpoints<kTable>(g_supervisor, Entity::kFirst);
    const Checkpoints second = checkpoints<kTable>(g_supervisor, Entity::kSecond);
    EXPECT_EQ(check_pair(first, second).rule, SafetyRule::kNone);
    EXPECT_EQ(check_pair(first, checkpoints<kTable>(g_supervisor, Entity::kUnknown)).rule,
              SafetyRule::kEntityKnown);
    EXPECT_EQ(check_pair(second, second).rule, SafetyRule::kEntityOfOneComponent);
    EXPECT_EQ(check_pair(second, second).row, 2U);
    EXPECT_EQ(check_pair({}, second).rule, SafetyRule::kEntityOfAComponent);
    EXPECT_EQ(check_pair({}, second).row, 0U);
    EXPECT_EQ(check_pair(first, {}).row, 1U);
    EXPECT_EQ(check_pair(first, checkpoints<kOtherTable>(g_supervisor, Entity::kSecond)).rule,
              SafetyRule::kCheckpointsOfOneTable);
    EXPECT_EQ(check_pair(first, checkpoints<kTable>(g_other_supervisor, Entity::kSecond)).rule,
              SafetyRule::kCheckpointsOfOneTable);
}

// ---- Sources of confirmations ----

TEST(StopSourceRulesTest, EachKindOfStopNeedsItsConfirmations) {
    verifies("SWR-CYC-012", Technique::kEquivalenceClasses);
    const auto find_missing = [](Reaction reaction, bool has_contacts) {
        std::vector<StopConfirmation> missing;
        for (const StopConfirmation confirmation : {kStandstill, kClosedBrakes, kTorqueOff}) {
            const SafetyFinding finding = check([&](auto& table) {
                table.cycle.brakes_first = 0U;
                table.reactions[0U].reaction = static_cast<std::uint32_t>(Reaction::kDegrade);
                table.reactions[1U].reaction = static_cast<std::uint32_t>(reaction);
                table.cycle.brakes.has_contacts = has_contacts;
                table.stop_sources[0U].confirms[static_cast<std::size_t>(confirmation)] = false;
            });
            if (finding.rule == SafetyRule::kStopConfirmed) {
                EXPECT_EQ(finding.row, static_cast<std::size_t>(confirmation));
                missing.push_back(confirmation);
            }
        }
        return missing;
    };
    using All = std::vector<StopConfirmation>;
    EXPECT_EQ(find_missing(Reaction::kDegrade, true), All{});
    EXPECT_EQ(find_missing(Reaction::kSs2, true), (All{kStandstill, kClosedBrakes, kTorqueOff}));
    EXPECT_EQ(find_missing(Reaction::kSs1, true), (All{kStandstill, kClosedBrakes, kTorqueOff}));
    EXPECT_EQ(find_missing(Reaction::kSs1, false), (All{kStandstill, kTorqueOff}));
    EXPECT_EQ(find_missing(Reaction::kSto, true), (All{kClosedBrakes, kTorqueOff}));
    EXPECT_EQ(find_missing(Reaction::kSto, false), (All{kTorqueOff}));
}

TEST(StopSourceRulesTest, AConfirmationHasOneSupervisedSourceOfTheTable) {
    verifies("SWR-CYC-012", Technique::kEquivalenceClasses, Polarity::kViolation);
    EXPECT_EQ(check([](auto& table) { table.stop_sources[0U].port = &g_strange_sensor.seen; }).rule,
              SafetyRule::kSourceInTable);
    const auto guard = supervise(g_guard, alive(), deadline(1_ms));
    const auto again = build(guard, confirmed_by(g_sensor.spare, kTorqueOff), make_cycle());
    EXPECT_EQ(detail::check_safety(again).rule, SafetyRule::kConfirmedByOnce);
    EXPECT_EQ(detail::check_safety(again).row, 1U);
    auto unsupervised = build(guard, make_cycle());
    unsupervised.supervised[0U].watch.component = &g_controller;
    EXPECT_EQ(detail::check_safety(unsupervised).rule, SafetyRule::kSourceSupervised);
}

TEST(StopSourceRulesTest, ASourceIsConnectedToTheCycleInEachOfItsModes) {
    verifies("SWR-CYC-012", Technique::kEquivalenceClasses, Polarity::kViolation);
    const auto check_source = [](auto change) {
        auto table = build_sound();
        change(table);
        return detail::check_sources_of_cycle(table, 1U).rule;
    };
    EXPECT_EQ(check_source([](auto&) {}), SafetyRule::kNone);
    EXPECT_EQ(check_source([](auto& table) { table.stop_sources[0U].port = &g_sensor.spare; }),
              SafetyRule::kSourceConnected);
    EXPECT_EQ(check_source([](auto& table) { table.connections[0U].sink_component = 2U; }),
              SafetyRule::kSourceConnected);
    EXPECT_EQ(check_source([](auto& table) { table.connections[0U].idle_modes = 2U; }),
              SafetyRule::kSourceConnected);
    EXPECT_EQ(check_source([](auto& table) {
                  table.connections[0U].idle_modes = 2U;
                  table.component_rows[1U].modes = 1U;
              }),
              SafetyRule::kNone);
}

TEST(StopSourceRulesTest, ASourceRunsBeforeTheCycleAndAtLeastAsOften) {
    verifies("SWR-CYC-012", Technique::kBoundaryValues, Polarity::kViolation);
    const auto check_order = [](Duration offset, Duration period) {
        const auto table =
            safety::system(frame(6_ms), window("cycle", 1_ms, 1_ms, every(3_ms), budget(1_ms), run(g_guard)),
                           window("source", offset, 1_ms, every(period), budget(1_ms), run(g_sensor)),
                           connect(g_sensor.seen, g_guard.seen, any_age()), faults<Fault::kFast>(),
                           confirmed_by(g_sensor.seen, kStandstill, kClosedBrakes, kTorqueOff));
        return detail::check_sources_of_cycle(table, 0U).rule;
    };
    EXPECT_EQ(check_order(0_ms, 3_ms), SafetyRule::kNone);
    EXPECT_EQ(check_order(1_ms - 1_ns, 1_ms), SafetyRule::kNone);
    EXPECT_EQ(check_order(1_ms, 3_ms), SafetyRule::kSourceBeforeCycle);
    EXPECT_EQ(check_order(2_ms, 3_ms), SafetyRule::kSourceBeforeCycle);
    EXPECT_EQ(check_order(0_ms, 2_ms), SafetyRule::kSourceBeforeCycle) << "it misses a cycle";
    EXPECT_EQ(check_order(0_ms, 6_ms), SafetyRule::kSourceBeforeCycle);
    auto delayed = build_sound();
    EXPECT_EQ(detail::check_sources_of_cycle(delayed, 1U).rule, SafetyRule::kNone);
    delayed.connections[0U].is_forward_in_window = false;
    EXPECT_EQ(detail::check_sources_of_cycle(delayed, 1U).rule, SafetyRule::kSourceBeforeCycle);
    EXPECT_EQ(detail::check_sources_of_cycle(build_sound(), 0U).rule, SafetyRule::kSourceConnected);
}

TEST(SafetyRulesTest, ThePeriodOfTheCycleIsInsideTheWindowOfTheWatchdog) {
    verifies("SWR-CYC-011", Technique::kBoundaryValues);
    const auto check_window = [](Duration shortest, Duration longest) {
        auto table = build_sound();
        table.cycle.watchdog = {shortest, longest};
        return detail::check_cycle_window(table, 0U).rule;
    };
    EXPECT_EQ(check_window(1_ms, 2_ms), SafetyRule::kNone);
    EXPECT_EQ(check_window(0_ms, 1_ms), SafetyRule::kNone);
    EXPECT_EQ(check_window(1_ms + 1_ns, 2_ms), SafetyRule::kWatchdogFitsPeriod);
    EXPECT_EQ(check_window(0_ms, 1_ms - 1_ns), SafetyRule::kWatchdogFitsPeriod);
}

TEST(SafetyRulesTest, ASupervisedComponentRunsOnTheCoreOfTheCycle) {
    verifies("SWR-CYC-011", Technique::kEquivalenceClasses, Polarity::kViolation);
    const auto table = safety::system(
        frame(1_ms), window("a", 0_us, 1_ms, budget(1_ms), run(g_guard)),
        window("b", 0_us, 1_ms, core(1U), budget(1_ms), run(g_controller)), faults<Fault::kFast>(),
        react(Fault::kFast, Reaction::kSs1, within(2_ms)), supervise(g_guard, alive(), deadline(1_ms)),
        supervise(g_controller, alive(), deadline(1_ms)), make_cycle());
    EXPECT_EQ(detail::check_cycle_window(table, 0U).rule, SafetyRule::kSupervisedOnCore);
    EXPECT_EQ(detail::check_cycle_window(table, 0U).row, 1U);
    EXPECT_EQ(detail::check_cycle_window(table, 1U).row, 0U);
}

}  // namespace
}  // namespace mamori::safety
