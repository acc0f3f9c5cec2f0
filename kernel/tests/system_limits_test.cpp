// SPDX-License-Identifier: Apache-2.0
// Goal: what the compiler does with a description holds while the program runs too: the words, the order of
// the rows, and each condition of each rule by itself.
// Method: tables built from values that are known only at run time; each rule's conditions broken one by one.
#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

#include "mamori/kernel/component/external_trigger.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/trace/verifies.hpp"
#include "support/flow_components.hpp"

namespace mamori {
namespace {

using testing_support::Counter;
using testing_support::Relay;
using namespace verification;
using Rules = std::vector<Rule>;

enum class Fault : std::uint32_t { kHot = 3, kFast = 7, kCold = 9 };
enum class Reaction : std::uint32_t { kSlow = 1, kStop = 2 };

Counter g_counter;
Relay g_constant_relay;
constexpr auto kConstantTable =
    system(frame(1_ms), window("only", 0_us, 1_ms, budget(1_ms), run(g_counter, g_constant_relay)),
           connect(g_counter.out, g_constant_relay.in, any_age()));
MAMORI_CHECK(kConstantTable);

Rules list_rules(const SystemView& view) {
    std::array<Finding, 8U> findings{};
    const std::size_t count = check_all(view, findings);
    Rules rules;
    for (std::size_t i = 0U; i < count && i < findings.size(); ++i) {
        rules.push_back(findings[i].rule);
    }
    return rules;
}
template <typename Table>
Rules list_rules_of(const Table& table) {
    return list_rules(make_view(table));
}

// The words.

TEST(SystemLimitsTest, EveryOptionOfAWindowIsInItsRow) {
    verifies("SWR-KRN-017", Technique::kEquivalenceClasses);
    Counter ticked{"ticked"};
    Counter driven{"driven"};
    ExternalTrigger trigger;
    const auto build = [&](std::size_t events, const char* name, AbortPolicy policy) {
        return system(
            frame(4_ms), abort_policy(policy),
            window("t", 0_us, 1_ms, triggered_by(trigger), partition(name), budget(1_ms), run(ticked)),
            window("e", 1_ms, 1_ms, event_driven(events), rate(250.0_hz, 125.0_hz), budget(1_ms),
                   run(driven)));
    };
    auto table = build(3U, "motion", AbortPolicy::kOpenRtmCompat);

    EXPECT_EQ(table.windows[0].kind, ExecutionKind::kOther);
    EXPECT_EQ(table.windows[0].trigger, &trigger);
    EXPECT_STREQ(table.windows[0].partition, "motion");
    EXPECT_EQ(table.windows[1].kind, ExecutionKind::kEventDriven);
    EXPECT_EQ(table.windows[1].events_per_cycle, 3U);
    EXPECT_STREQ(table.windows[1].partition, "");
    EXPECT_EQ(table.windows[1].alternative_periods[0], 8_ms);
    EXPECT_EQ(table.abort_policy, AbortPolicy::kOpenRtmCompat);
    EXPECT_EQ(build(1U, "", AbortPolicy::kSpecOnly).abort_policy, AbortPolicy::kSpecOnly);
}

TEST(SystemLimitsTest, ASlowerRateOutsideOfWhatNanosecondsCanTellHasNoPeriod) {
    verifies("SWR-KRN-017", Technique::kBoundaryValues);
    const auto calc_period = [](double hz) {
        const auto table = system(
            frame(1_ms), window("w", 0_us, 1_us, rate(1000_hz, Rate{hz}), budget(1_us), run(g_counter)));
        return table.windows[0].alternative_periods[0];
    };

    EXPECT_EQ(calc_period(500.0), 2_ms);
    EXPECT_EQ(calc_period(1.0e9), 1_ns);
    EXPECT_EQ(calc_period(1.0e9 + 1.0), 0_ns);
    EXPECT_EQ(calc_period(0.0), 0_ns);
    EXPECT_EQ(calc_period(-1.0), 0_ns);
}

TEST(SystemLimitsTest, OnlyAConnectionToALaterComponentOfItsWindowIsForward) {
    verifies("SWR-KRN-017", Technique::kBoundaryValues);
    Relay first{"first"};
    Relay second{"second"};
    Relay third{"third"};
    Relay stranger{"stranger"};
    const auto is_forward = [&](Relay& source, Relay& sink) {
        const auto table = system(frame(2_ms), window("a", 0_ms, 1_ms, budget(1_ms), run(first, second)),
                                  window("b", 1_ms, 1_ms, budget(1_ms), run(third)),
                                  connect(source.out, sink.in, any_age()));
        EXPECT_FALSE(table.windows[0].has_deliveries) << "no queue and no crossing";
        EXPECT_EQ(table.windows[0].has_hand_on, table.connections[0].is_forward_in_window);
        return table.connections[0].is_forward_in_window;
    };

    EXPECT_TRUE(is_forward(first, second));
    EXPECT_FALSE(is_forward(second, first));
    EXPECT_FALSE(is_forward(second, second));
    EXPECT_FALSE(is_forward(first, third));
    EXPECT_FALSE(is_forward(stranger, second));
    EXPECT_FALSE(is_forward(stranger, stranger));
}

TEST(SystemLimitsTest, ConnectionsAreSortedWhateverTheOrderTheyAreListedIn) {
    verifies("SWR-KRN-017", Technique::kEquivalenceClasses);
    Counter counter;
    std::array<Relay, 3U> relays{Relay{"0"}, Relay{"1"}, Relay{"2"}};
    const auto sort = [&](std::size_t a, std::size_t b, std::size_t c) {
        const auto table = system(frame(4_ms), window("s", 0_ms, 1_ms, budget(1_ms), run(counter)),
                                  window("0", 1_ms, 1_ms, budget(1_ms), run(relays[0])),
                                  window("1", 2_ms, 1_ms, budget(1_ms), run(relays[1])),
                                  window("2", 3_ms, 1_ms, budget(1_ms), run(relays[2])),
                                  connect(counter.out, relays[a].in, any_age()),
                                  connect(counter.out, relays[b].in, any_age()),
                                  connect(counter.out, relays[c].in, any_age()));
        EXPECT_EQ(table.outgoing_order, (std::array<std::size_t, 3U>{0U, 1U, 2U})) << "equal keys stay";
        return table.latch_order;
    };

    EXPECT_EQ(sort(0U, 1U, 2U), (std::array<std::size_t, 3U>{0U, 1U, 2U}));
    EXPECT_EQ(sort(2U, 1U, 0U), (std::array<std::size_t, 3U>{2U, 1U, 0U}));
    EXPECT_EQ(sort(1U, 2U, 0U), (std::array<std::size_t, 3U>{2U, 0U, 1U}));
}

// The rules.

TEST(SystemLimitsTest, EachConditionOnThePlaceOfAWindowCountsByItself) {
    verifies("SWR-KRN-025", Technique::kBoundaryValues, Polarity::kViolation);
    struct Case {
        std::int64_t offset, length, limit;
        Rules expected;
    };
    const std::vector<Case> cases{{100, 900, 900, {}},
                                  {100, 900, 901, {Rule::kBudgetExceedsWindow}},
                                  {100, 900, 0, {Rule::kBudgetExceedsWindow}},
                                  {-1, 900, 900, {Rule::kWindowOutsideFrame}},
                                  {100, 0, 0, {Rule::kWindowOutsideFrame}},
                                  {1001, 1, 1, {Rule::kWindowOutsideFrame}},
                                  {100, 901, 1, {Rule::kWindowOutsideFrame}},
                                  {49, 1, 1, {}},
                                  {49, 2, 1, {Rule::kWindowsOverlap}},
                                  {99, 1, 1, {Rule::kWindowsOverlap}}};

    for (const Case& one : cases) {
        Counter counter;
        Relay relay;
        const auto table = system(
            frame(1000_ns), window("a", 50_ns, 50_ns, budget(50_ns), run(counter)),
            window("b", Duration{one.offset}, Duration{one.length}, budget(Duration{one.limit}), run(relay)),
            connect(counter.out, relay.in, any_age()));
        EXPECT_EQ(list_rules_of(table), one.expected) << one.offset << " " << one.length << " " << one.limit;
    }
}

auto declare_stack(Counter& counter, std::size_t size) {
    return system(frame(1_ms), window("a", 0_ms, 1_ms, budget(1_ms), stack(size), run(counter)));
}

TEST(SystemLimitsTest, TheDeclaredStackIsInTheRow) {
    verifies("SWR-KRN-094", Technique::kBoundaryValues);
    Counter counter;
    for (const std::size_t kib : {1U, 64U, 65534U}) {
        const auto table = declare_stack(counter, kib * 1_KiB);
        EXPECT_EQ(table.windows[0U].stack_kib, kib);
        EXPECT_EQ(list_rules_of(table), Rules{}) << kib;
    }
    const auto silent = system(frame(1_ms), window("a", 0_ms, 1_ms, budget(1_ms), run(counter)));
    EXPECT_EQ(silent.windows[0U].stack_kib, 0U);
    EXPECT_EQ(list_rules_of(silent), Rules{});
}

TEST(SystemLimitsTest, AStackThatIsNoMultipleOfOneKibInRangeIsRejected) {
    verifies("SWR-KRN-094", Technique::kBoundaryValues, Polarity::kViolation);
    Counter counter;
    for (const std::size_t size :
         {std::size_t{0U}, 1_KiB - 1U, 1_KiB + 1U, 65535_KiB, 65536_KiB, ~std::size_t{0U}}) {
        EXPECT_EQ(list_rules_of(declare_stack(counter, size)), Rules{Rule::kStackOutOfRange}) << size;
    }
}

TEST(SystemLimitsTest, AWindowWithPortsBeyondTheTableAndAComponentWithoutARowAreInvalid) {
    verifies("SWR-KRN-025", Technique::kErrorGuessing, Polarity::kViolation);
    auto table = system(frame(1_ms), window("w", 0_us, 1_ms, budget(1_ms), run(g_counter)));
    ASSERT_EQ(list_rules_of(table), Rules{});

    SystemView without_rows = make_view(table);
    without_rows.component_rows = {};
    EXPECT_EQ(list_rules(without_rows), Rules{Rule::kComponentRowInvalid});
    table.windows[0].port_count = 2U;
    EXPECT_EQ(list_rules_of(table), Rules{Rule::kWindowRowInvalid});
}

TEST(SystemLimitsTest, ACoreOrAPartitionIsLeftThroughABufferOnly) {
    verifies("SWR-KRN-025", Technique::kEquivalenceClasses, Polarity::kViolation);
    Counter counter;
    Relay relay;
    Crossing<std::int64_t> crossing;
    const auto check_wired = [&](const auto& wiring, std::size_t core_index, const char* name) {
        return list_rules_of(system(
            frame(2_ms), window("w", 0_ms, 1_ms, partition("motion"), budget(1_ms), run(counter)),
            window("r", 1_ms, 1_ms, core(core_index), partition(name), budget(1_ms), run(relay)), wiring));
    };
    const auto direct = connect(counter.out, relay.in, any_age());
    const auto buffered = connect(counter.out, relay.in, through(crossing), any_age());
    std::string same_name{"motion"};

    EXPECT_EQ(check_wired(direct, 0U, same_name.c_str()), Rules{}) << "equal letters are one partition";
    for (const char* other : {"motioN", "motion2", "mot", "", "plan"}) {
        EXPECT_EQ(check_wired(direct, 0U, other), Rules{Rule::kCrossingWithoutBuffer}) << other;
        EXPECT_EQ(check_wired(buffered, 0U, other), Rules{}) << other;
    }
    EXPECT_EQ(check_wired(direct, 1U, "motion"), Rules{Rule::kCrossingWithoutBuffer});
    EXPECT_EQ(check_wired(buffered, 1U, "motion"), Rules{});
}

TEST(SystemLimitsTest, ACrossingServesOneConnection) {
    verifies("SWR-KRN-025", Technique::kEquivalenceClasses, Polarity::kViolation);
    Counter counter;
    Relay first{"first"};
    Relay second{"second"};
    std::array<Crossing<std::int64_t>, 2U> crossings{};
    const auto check_pair = [&](const auto& to_first, const auto& to_second) {
        return list_rules_of(system(frame(1_ms),
                                    window("w", 0_ms, 1_ms, budget(1_ms), run(counter, first, second)),
                                    to_first, to_second));
    };
    const auto direct = connect(counter.out, second.in, any_age());
    const auto own = connect(counter.out, second.in, through(crossings[1]), any_age());
    const auto shared = connect(counter.out, second.in, through(crossings[0]), any_age());
    const auto of_first = connect(counter.out, first.in, through(crossings[0]), any_age());

    EXPECT_EQ(check_pair(of_first, direct), Rules{});
    EXPECT_EQ(check_pair(of_first, own), Rules{});
    EXPECT_EQ(check_pair(of_first, shared), Rules{Rule::kCrossingUsedTwice});
}

TEST(SystemLimitsTest, ReactionsFindTheirFaultAmongSeveral) {
    verifies("SWR-KRN-025", Technique::kEquivalenceClasses, Polarity::kViolation);
    const auto check_reactions_to = [](Fault first, Fault second) {
        return list_rules_of(system(frame(1_ms), faults<Fault::kHot, Fault::kFast>(),
                                    react(first, Reaction::kStop, within(1_ms)),
                                    react(second, Reaction::kSlow, within(1_ms))));
    };

    EXPECT_EQ(check_reactions_to(Fault::kHot, Fault::kFast), Rules{});
    EXPECT_EQ(check_reactions_to(Fault::kFast, Fault::kHot), Rules{});
    EXPECT_EQ(check_reactions_to(Fault::kHot, Fault::kHot),
              (Rules{Rule::kFaultWithTwoReactions, Rule::kFaultWithoutReaction}));
    EXPECT_EQ(check_reactions_to(Fault::kHot, Fault::kCold),
              (Rules{Rule::kFaultWithoutReaction, Rule::kReactionToUnknownFault}));
}

TEST(SystemLimitsTest, TheCheckOfAConstantTableAnswersWhileRunningToo) {
    verifies("SWR-KRN-018", Technique::kInterface);

    EXPECT_TRUE(detail::keeps_rules<kConstantTable>());
    EXPECT_EQ(detail::calc_length(kConstantTable.windows[0].name), 4U);
    EXPECT_EQ(detail::calc_length(""), 0U);
    EXPECT_EQ(detail::calc_length(nullptr), 0U);
    EXPECT_EQ(detail::require_ports<Counter>(Counter::Ports{}).kCount, 1U);
}

TEST(SystemLimitsTest, EveryRuleHasASentenceOfItsOwn) {
    verifies("SWR-TAB-015", Technique::kInterface);
    const int rule_count = static_cast<int>(Rule::kSafeModeActivates) + 1;
    std::set<std::string> sentences;

    for (int rule = 0; rule <= rule_count; ++rule) {
        sentences.insert(get_sentence(static_cast<Rule>(rule)));
    }
    EXPECT_EQ(sentences.size(), static_cast<std::size_t>(rule_count) + 1U);
    EXPECT_EQ(sentences.count("invalid rule"), 1U) << "a number without a rule";
}

}  // namespace
}  // namespace mamori
