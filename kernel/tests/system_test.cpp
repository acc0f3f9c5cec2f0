// SPDX-License-Identifier: Apache-2.0
// Goal: a system table is what its description says, and each rule finds its guilty row.
// Method: a constant table read back row by row; tables that break one rule each, on both sides of its limit.
// That the compiler refuses a broken table: compile_fail_test.cpp.
#include "mamori/kernel/system/system.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "mamori/trace/verifies.hpp"
#include "mamori/verification/failed_check.hpp"
#include "support/flow_components.hpp"

namespace mamori {
namespace {

using testing_support::Counter;
using testing_support::Relay;
using namespace verification;

class Listener final : public Component {
  public:
    constexpr Listener() noexcept : Component("listener") {}
    InPort<std::int64_t, Need::kOptional> in{*this, "in"};
    using Ports = mamori::Ports<&Listener::in>;
};
class Portless final : public Component {
  public:
    constexpr Portless() noexcept : Component("portless") {}
};

Counter g_counter;
Relay g_relay;
Relay g_second_relay{"second relay"};
Listener g_listener;
Portless g_portless;

constexpr auto kSystem =
    system(frame(1_ms), window("sense", 0_us, 100_us, budget(50_us), run(g_portless, g_counter, g_relay)),
           window("act", 100_us, 900_us, budget(900_us), run(g_second_relay, g_listener)),
           connect(g_counter.out, g_relay.in, any_age()), connect(g_relay.out, g_second_relay.in, any_age()),
           connect(g_second_relay.out, g_listener.in, any_age()));
MAMORI_CHECK(kSystem);

template <std::size_t kSize>
using Bytes = std::array<std::uint8_t, kSize>;
class LargeOutputs final : public Component {
  public:
    constexpr LargeOutputs() noexcept : Component("large outputs") {}
    OutPort<Bytes<0xFFFFU>> below{*this, "below"};
    OutPort<Bytes<0x10000U>> above{*this, "above"};
    using Ports = mamori::Ports<&LargeOutputs::below, &LargeOutputs::above>;
};
LargeOutputs g_large_outputs;

TEST(SystemTest, APortRowHasTheSizeOfAValueBelow64KiB) {
    verifies("SWR-CIF-012", Technique::kBoundaryValues);
    const auto table = system(frame(1_ms), window("large", 0_us, 1_ms, budget(1_ms), run(g_large_outputs)));

    EXPECT_EQ(table.ports[0].payload_bytes, 0xFFFFU);
    EXPECT_EQ(table.ports[1].payload_bytes, 0U);
    EXPECT_EQ(kSystem.ports[0].payload_bytes, sizeof(std::int64_t));
}

TEST(SystemTest, WindowsHoldTheirPlaceBudgetAndComponents) {
    verifies("SWR-KRN-017");

    ASSERT_EQ(kSystem.windows.size(), 2U);
    EXPECT_EQ(kSystem.frame, 1_ms);
    EXPECT_STREQ(kSystem.windows[1].name, "act");
    EXPECT_EQ(kSystem.windows[1].offset, 100_us);
    EXPECT_EQ(kSystem.windows[1].length, 900_us);
    EXPECT_EQ(kSystem.windows[0].budget, 50_us);
    EXPECT_EQ(kSystem.windows[1].first_component, 3U);
    EXPECT_EQ(kSystem.windows[1].component_count, 2U);
    EXPECT_EQ(kSystem.components,
              (std::array<Component*, 5>{&g_portless, &g_counter, &g_relay, &g_second_relay, &g_listener}));
}

TEST(SystemTest, AComponentAndAWindowGiveTheirIndexInConstantExpressions) {
    verifies("SWR-KRN-063");
    static_assert(index_of(kSystem, g_portless) == 0U);
    static_assert(index_of(kSystem, g_listener) == 4U);
    static_assert(index_of(kSystem, "sense") == 0U);
    const std::array<int, index_of(kSystem, "act") + 1U> per_window{};

    EXPECT_EQ(per_window.size(), kSystem.windows.size());
}

TEST(SystemTest, ModelledTimesAreRowsOfTheirOwn) {
    verifies("SWR-KRN-064");
    Portless fast;
    Portless slow;
    const auto table = system(frame(1_ms), window("all", 0_us, 100_us, budget(50_us), run(fast, slow)),
                              modelled_time(slow, 30_us), modelled_time(fast, 0_us));

    EXPECT_EQ(table.modelled_times[0].component, &slow);
    EXPECT_EQ(table.modelled_times[0].duration, 30_us);
    EXPECT_EQ(check_modelled_times(table.modelled_times, table.components).rule, Rule::kNone);
    EXPECT_EQ(sizeof(kSystem), sizeof(SystemTable<2U, 5U, 6U, 3U>)) << "no byte without modelled times";
}

TEST(SystemTest, TheFirstInvalidModelledTimeIsFound) {
    verifies("SWR-KRN-064", Technique::kBoundaryValues, Polarity::kViolation);
    const Portless stranger;
    const auto find = [](const ModelledTimeRow& row, Duration first) {
        const std::array<ModelledTimeRow, 2U> rows{{{&g_relay, first}, row}};
        return check_modelled_times(rows, kSystem.components);
    };

    EXPECT_EQ(find({&g_counter, 0_us}, 0_us).rule, Rule::kNone);
    EXPECT_EQ(find({&g_counter, Duration{-1}}, 0_us).rule, Rule::kModelledTimeNegative);
    EXPECT_EQ(find({&g_counter, Duration{-1}}, 0_us).element, 1U);
    EXPECT_EQ(find({&g_counter, Duration{-1}}, Duration{-1}).element, 0U);
    EXPECT_EQ(find({&stranger, 0_us}, 0_us).rule, Rule::kModelledTimeOfUnknownComponent);
    EXPECT_EQ(find({nullptr, 0_us}, 0_us).rule, Rule::kModelledTimeOfUnknownComponent);
    EXPECT_EQ(find({&g_relay, 1_us}, 0_us).rule, Rule::kModelledTimeStatedTwice);
}

TEST(SystemTest, ActionBudgetIsThatOfTheTableOrOneSecond) {
    verifies("SWR-KRN-092");
    Portless only;
    const auto table =
        system(frame(1_ms), window("all", 0_us, 100_us, budget(50_us), run(only)), action_budget(20_ms));

    EXPECT_EQ(choose_action_budget(table.action_budgets), 20_ms);
    EXPECT_EQ(choose_action_budget(kSystem.action_budgets), Duration{1'000'000'000});
    EXPECT_EQ(check_action_budget(kSystem.action_budgets).rule, Rule::kNone);
}

TEST(SystemTest, ActionBudgetOutsideItsRangeIsFound) {
    verifies("SWR-KRN-092", Technique::kBoundaryValues, Polarity::kViolation);
    const auto find = [](std::int64_t budget_ns) {
        const std::array<Duration, 1U> stated{Duration{budget_ns}};
        return check_action_budget(stated).rule;
    };

    EXPECT_EQ(find(0), Rule::kActionBudgetOutOfRange);
    EXPECT_EQ(find(-1), Rule::kActionBudgetOutOfRange);
    EXPECT_EQ(find(1), Rule::kNone);
    EXPECT_EQ(find(3'600'000'000'000), Rule::kNone);
    EXPECT_EQ(find(3'600'000'000'001), Rule::kActionBudgetOutOfRange);
}

TEST(SystemTest, IndicesAreThoseOfTheViewAtRunTime) {
    verifies("SWR-KRN-063");
    const SystemView view = make_view(kSystem);

    for (std::size_t i = 0U; i < view.components.size(); ++i) {
        EXPECT_EQ(index_of(view, *view.components[i]), i);
    }
    for (std::size_t i = 0U; i < view.windows.size(); ++i) {
        EXPECT_EQ(index_of(view, view.windows[i].name), i);
    }
}

TEST(SystemTest, AnIndexOfWhatIsNotInTheTableEndsInTheAssertion) {
    verifies("SWR-KRN-063", Technique::kInterface, Polarity::kViolation);
    const SystemView view = make_view(kSystem);
    const Portless stranger;

    EXPECT_CHECK_FAILS(static_cast<void>(index_of(view, stranger)), "table/index_of.hpp", 1);
    EXPECT_CHECK_FAILS(static_cast<void>(index_of(view, "tell")), "table/index_of.hpp", 2);
    EXPECT_CHECK_FAILS(static_cast<void>(index_of(view, nullptr)), "table/index_of.hpp", 2);
}

TEST(SystemTest, PortsAreListedWithOwnerWindowAndNeed) {
    verifies("SWR-KRN-017");

    ASSERT_EQ(kSystem.ports.size(), 6U);
    EXPECT_EQ(kSystem.ports[0].output, &g_counter.out);
    EXPECT_EQ(kSystem.ports[0].component, 1U);
    EXPECT_EQ(kSystem.ports[1].input, &g_relay.in);
    EXPECT_TRUE(kSystem.ports[1].is_mandatory);
    EXPECT_EQ(kSystem.ports[3].owner, &g_second_relay);
    EXPECT_EQ(kSystem.ports[3].window, 1U);
    EXPECT_EQ(kSystem.ports[3].component, 3U);
    EXPECT_FALSE(kSystem.ports[5].is_mandatory);
}

TEST(SystemTest, ConnectionsKnowWhatTheyJoinAndWhetherTheyAreForwardInAWindow) {
    verifies("SWR-KRN-017");

    ASSERT_EQ(kSystem.connections.size(), 3U);
    EXPECT_EQ(kSystem.connections[0].sink, &g_relay.in);
    EXPECT_EQ(kSystem.connections[0].source_component, 1U);
    EXPECT_TRUE(kSystem.connections[0].is_forward_in_window);
    EXPECT_EQ(kSystem.connections[1].source_window, 0U);
    EXPECT_EQ(kSystem.connections[1].sink_window, 1U);
    EXPECT_FALSE(kSystem.connections[1].is_forward_in_window) << "another window";
    EXPECT_TRUE(kSystem.connections[2].is_forward_in_window);
}

TEST(SystemTest, AConnectionAgainstTheOrderOrOntoItselfIsNotForward) {
    verifies("SWR-KRN-017", Technique::kBoundaryValues);
    static constexpr auto kBackward =
        system(frame(1_ms), window("w", 0_us, 1_ms, budget(1_ms), run(g_relay, g_second_relay)),
               connect(g_second_relay.out, g_relay.in, any_age(), delayed_by_a_frame()),
               connect(g_relay.out, g_second_relay.in, any_age()));
    static constexpr auto kOntoItself =
        system(frame(1_ms), window("w", 0_us, 1_ms, budget(1_ms), run(g_relay)),
               connect(g_relay.out, g_relay.in, any_age(), delayed_by_a_frame()));
    MAMORI_CHECK(kBackward);
    MAMORI_CHECK(kOntoItself);

    EXPECT_FALSE(kBackward.connections[0].is_forward_in_window);
    EXPECT_TRUE(kBackward.connections[1].is_forward_in_window);
    EXPECT_FALSE(kOntoItself.connections[0].is_forward_in_window);
}

TEST(SystemTest, ATableWithoutAnyRowIsATable) {
    verifies("SWR-KRN-017", Technique::kBoundaryValues);
    static constexpr auto kEmpty = system(frame(1_ms));
    static constexpr auto kWithoutPorts =
        system(frame(1_ms), window("w", 0_us, 1_ms, budget(1_ms), run(g_portless)));
    MAMORI_CHECK(kEmpty);
    MAMORI_CHECK(kWithoutPorts);

    EXPECT_TRUE(make_view(kEmpty).windows.empty());
    EXPECT_TRUE(make_view(kEmpty).components.empty());
    EXPECT_TRUE(make_view(kWithoutPorts).ports.empty());
    EXPECT_EQ(make_view(kWithoutPorts).components.size(), 1U);
}

// The rules, each at its limit and one nanosecond or one row beyond.

constexpr Finding check_window(Duration offset, Duration length, Duration limit) {
    return check(
        make_view(system(frame(1000_ns), window("first", 0_ns, 100_ns, budget(100_ns), run(g_portless)),
                         window("second", offset, length, budget(limit), run(g_listener)))));
}
template <typename Table>
Finding check_table(const Table& table) {
    return check(make_view(table));
}

TEST(SystemCheckTest, AnAgeLimitFromTheMinimumAgeOnIsAccepted) {
    verifies("SWR-KRN-061", Technique::kBoundaryValues);
    const auto check_limit = [](Duration reader_start, Duration age_max, Duration lead_max) {
        return check_table(system(frame(10_ms),
                                  window("sense", 0_ms, 1_ms, every(5_ms), budget(1_ms), run(g_counter)),
                                  window("plan", reader_start, 1_ms, budget(1_ms), run(g_relay)),
                                  connect(g_counter.out, g_relay.in, fresh_within(age_max, lead_max))));
    };

    EXPECT_EQ(check_limit(8_ms, 2_ms, {}).rule, Rule::kNone);
    EXPECT_EQ(check_limit(8_ms, 2_ms - 2_ns, 2_ns).rule, Rule::kNone);
    EXPECT_EQ(check_limit(1_ms, 1_ns, {}).rule, Rule::kNone) << "starts when the writer's window ends";
    EXPECT_EQ(check_limit(8_ms, 2_ms - 1_ns, {}).rule, Rule::kAgeLimitCannotBeMet);
    EXPECT_EQ(check_limit(8_ms, 2_ms - 2_ns, 1_ns).rule, Rule::kAgeLimitCannotBeMet);
}

TEST(SystemCheckTest, AForwardedValueIsFreshAndADelayedOneHasTheAgeOfItsWindow) {
    verifies("SWR-KRN-061", Technique::kBoundaryValues, Polarity::kViolation);
    const auto check_limit = [](auto& first, auto& second, Duration age_max, auto... delay) {
        return check_table(system(frame(10_ms), window("w", 0_ms, 1_ms, budget(1_ms), run(first, second)),
                                  connect(g_counter.out, g_relay.in, fresh_within(age_max), delay...)));
    };

    EXPECT_EQ(check_limit(g_counter, g_relay, 1_ns).rule, Rule::kNone);
    EXPECT_EQ(check_limit(g_relay, g_counter, 9_ms, delayed_by_a_frame()).rule, Rule::kNone);
    EXPECT_EQ(check_limit(g_relay, g_counter, 9_ms - 1_ns, delayed_by_a_frame()).rule,
              Rule::kAgeLimitCannotBeMet);
}

TEST(SystemCheckTest, TablesAtTheLimitsKeepTheRules) {
    verifies("SWR-KRN-018", Technique::kBoundaryValues);

    static_assert(check_window(100_ns, 900_ns, 900_ns).rule == Rule::kNone);
    EXPECT_EQ(check_window(999_ns, 1_ns, 1_ns).rule, Rule::kNone);
    EXPECT_EQ(check_table(system(frame(1_ns))).rule, Rule::kNone);
    EXPECT_EQ(check_table(kSystem).rule, Rule::kNone);
}

TEST(SystemCheckTest, ADelayIsStatedExactlyWhereItIs) {
    verifies("SWR-KRN-048", Technique::kBoundaryValues, Polarity::kViolation);
    for (std::size_t i = 0U; i < kSystem.connections.size(); ++i) {
        auto table = kSystem;
        table.connections[i].is_delayed_by_a_frame = true;
        EXPECT_EQ(check_table(table).rule, Rule::kDelayNotStated);
        EXPECT_EQ(check_table(table).element, i);
    }
}

TEST(SystemCheckTest, AFrameIsPositive) {
    verifies("SWR-KRN-018", Technique::kBoundaryValues, Polarity::kViolation);

    EXPECT_EQ(check_table(system(frame(0_ns))).rule, Rule::kFrameNotPositive);
    EXPECT_EQ(check_table(system(frame(Duration{-1}))).rule, Rule::kFrameNotPositive);
}

TEST(SystemCheckTest, AWindowOutsideTheFrameIsNamed) {
    verifies("SWR-KRN-018", Technique::kBoundaryValues, Polarity::kViolation);
    constexpr Duration kLongest{std::numeric_limits<std::int64_t>::max()};

    for (const Finding& finding :
         {check_window(100_ns, 901_ns, 1_ns), check_window(100_ns, 0_ns, 1_ns),
          check_window(100_ns, Duration{-1}, 1_ns), check_window(Duration{-1}, 10_ns, 1_ns),
          check_window(1000_ns, 1_ns, 1_ns), check_window(100_ns, kLongest, 1_ns),
          check_window(kLongest, kLongest, 1_ns)}) {
        EXPECT_EQ(finding.rule, Rule::kWindowOutsideFrame);
        EXPECT_EQ(finding.element, 1U);
    }
}

TEST(SystemCheckTest, WindowsThatOverlapOrAreOutOfOrderAreNamed) {
    verifies("SWR-KRN-018", Technique::kBoundaryValues, Polarity::kViolation);

    for (const Finding& finding : {check_window(99_ns, 1_ns, 1_ns), check_window(0_ns, 1_ns, 1_ns)}) {
        EXPECT_EQ(finding.rule, Rule::kWindowsOverlap);
        EXPECT_EQ(finding.element, 1U);
    }
}

TEST(SystemCheckTest, ABudgetIsPositiveAndNotOverItsWindow) {
    verifies("SWR-KRN-018", Technique::kBoundaryValues, Polarity::kViolation);

    for (const Finding& finding : {check_window(100_ns, 10_ns, 11_ns), check_window(100_ns, 10_ns, 0_ns),
                                   check_window(100_ns, 10_ns, Duration{-1})}) {
        EXPECT_EQ(finding.rule, Rule::kBudgetExceedsWindow);
        EXPECT_EQ(finding.element, 1U);
    }
}

TEST(SystemCheckTest, AComponentInTwoPlacesIsNamedAtTheSecond) {
    verifies("SWR-KRN-018", Technique::kEquivalenceClasses, Polarity::kViolation);
    const Finding across =
        check_table(system(frame(1_ms), window("a", 0_us, 1_us, budget(1_us), run(g_portless, g_listener)),
                           window("b", 1_us, 1_us, budget(1_us), run(g_listener))));
    const Finding within =
        check_table(system(frame(1_ms), window("a", 0_us, 1_us, budget(1_us), run(g_portless, g_portless))));

    EXPECT_EQ(across.rule, Rule::kComponentInTwoPlaces);
    EXPECT_EQ(across.element, 2U);
    EXPECT_EQ(within.rule, Rule::kComponentInTwoPlaces);
    EXPECT_EQ(within.element, 1U);
}

TEST(SystemCheckTest, AConnectionOfAComponentThatIsNotInTheTableIsNamed) {
    verifies("SWR-KRN-018", Technique::kErrorGuessing, Polarity::kViolation);
    const Finding source =
        check_table(system(frame(1_ms), window("w", 0_us, 1_us, budget(1_us), run(g_listener)),
                           connect(g_counter.out, g_listener.in, any_age())));
    const Finding sink =
        check_table(system(frame(1_ms), window("w", 0_us, 1_us, budget(1_us), run(g_counter)),
                           connect(g_counter.out, g_listener.in, any_age())));

    EXPECT_EQ(source.rule, Rule::kPortOfUnknownComponent);
    EXPECT_EQ(sink.rule, Rule::kPortOfUnknownComponent);
}

TEST(SystemCheckTest, AMandatoryInputWithoutASourceIsNamedAndAnOptionalOneIsNot) {
    verifies("SWR-KRN-018", Technique::kEquivalenceClasses, Polarity::kViolation);
    const Finding mandatory =
        check_table(system(frame(1_ms), window("w", 0_us, 1_us, budget(1_us), run(g_listener, g_relay))));
    const Finding optional =
        check_table(system(frame(1_ms), window("w", 0_us, 1_us, budget(1_us), run(g_listener))));

    EXPECT_EQ(mandatory.rule, Rule::kInputNotConnected);
    EXPECT_EQ(mandatory.element, 1U);
    EXPECT_EQ(optional.rule, Rule::kNone);
}

TEST(SystemCheckTest, ASecondWriterOfAnInputIsNamed) {
    verifies("SWR-KRN-018", Technique::kEquivalenceClasses, Polarity::kViolation);
    const Finding finding = check_table(system(
        frame(1_ms), window("w", 0_us, 1_us, budget(1_us), run(g_counter, g_relay, g_listener)),
        connect(g_counter.out, g_relay.in, any_age()), connect(g_counter.out, g_listener.in, any_age()),
        connect(g_relay.out, g_listener.in, any_age())));

    EXPECT_EQ(finding.rule, Rule::kInputHasTwoWriters);
    EXPECT_EQ(finding.element, 3U) << "port row of the listener's input";
}

}  // namespace
}  // namespace mamori
