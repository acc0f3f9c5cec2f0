// SPDX-License-Identifier: Apache-2.0
// Goal: windows with periods, rates, worst cases, cores and reactions are in the table, and their rules find
// the guilty element on both sides of each limit.
// Method: tables that break one rule each; overlap of periodic windows against counting every nanosecond.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "mamori/kernel/component/external_trigger.hpp"
#include "mamori/kernel/dataflow/queue_in_port.hpp"
#include "mamori/kernel/run/executive.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/trace/verifies.hpp"
#include "support/flow_components.hpp"

namespace mamori {
namespace {

using testing_support::Counter;
using testing_support::Relay;
using namespace verification;

enum class Fault : std::uint32_t { kHot = 3, kFast = 7 };
enum class Reaction : std::uint32_t { kSlow = 1, kStop = 2 };

/// A reader with a queue.
class QueueReader final : public Component {
  public:
    QueueReader() : Component("queue reader") {}
    QueueInPort<std::int64_t, 4U> in{*this, "in"};
    using Ports = mamori::Ports<&QueueReader::in>;
};

Counter g_counter;
Counter g_other{"other"};
Relay g_relay;
Crossing<std::int64_t> g_crossing;

constexpr auto kSystem = system(
    frame(12_ms),
    window("fast", 0_ms, 1_ms, every(3_ms), rate(333.333333333_hz, 166.666666667_hz), budget(500_us),
           run(worst_case(g_counter, 400_us))),
    window("slow", 1_ms, 1_ms, every(12_ms), core(1), partition("plan"), budget(1_ms), run(g_relay)),
    connect(g_counter.out, g_relay.in, through(g_crossing), fresh_within(5_ms)),
    abort_policy(AbortPolicy::kOpenRtmCompat), faults<Fault::kHot, Fault::kFast>(),
    react(Fault::kFast, Reaction::kStop, within(20_ms)), react(Fault::kHot, Reaction::kSlow, within(1_s)));
MAMORI_CHECK(kSystem);

template <typename Table>
std::vector<Rule> list_rules(const Table& table) {
    std::array<Finding, 16U> findings{};
    const std::size_t count = check_all(make_view(table), findings);
    std::vector<Rule> rules;
    for (std::size_t i = 0U; i < count && i < findings.size(); ++i) {
        rules.push_back(findings[i].rule);
    }
    return rules;
}
using Rules = std::vector<Rule>;

TEST(SystemRatesTest, ThePartsAreInTheTable) {
    verifies("SWR-KRN-017");

    EXPECT_EQ(kSystem.windows[0].period, 3_ms);
    EXPECT_EQ(kSystem.windows[0].alternative_count, 1U);
    EXPECT_EQ(kSystem.windows[0].alternative_periods[0], 6_ms);
    EXPECT_EQ(kSystem.windows[1].core, 1U);
    EXPECT_STREQ(kSystem.windows[1].partition, "plan");
    EXPECT_EQ(kSystem.component_rows[0].worst_case, 400_us);
    EXPECT_EQ(kSystem.connections[0].crossing, &g_crossing);
    EXPECT_EQ(kSystem.connections[0].age_max, 5_ms);
    EXPECT_EQ(kSystem.abort_policy, AbortPolicy::kOpenRtmCompat);
    EXPECT_EQ(kSystem.faults[1].fault, 7U);
    EXPECT_EQ(kSystem.reactions[0].reaction, 2U);
    EXPECT_EQ(kSystem.reactions[0].within, 20_ms);
}

TEST(SystemRatesTest, TheSecondPassIsKnownToBeNeededOnlyWhereItIsOverridden) {
    verifies("SWR-KRN-017", Technique::kEquivalenceClasses);

    EXPECT_TRUE(kSystem.windows[0].has_second_pass);
    EXPECT_FALSE(kSystem.windows[1].has_second_pass);
}

TEST(SystemRatesTest, AWindowKnowsWhetherItHasOutputsAndFeedsAQueueOrACrossing) {
    verifies("SWR-KRN-017", Technique::kEquivalenceClasses);
    QueueReader reader;
    const auto table = system(frame(1_ms), window("w", 0_us, 200_us, budget(1_us), run(g_counter)),
                              window("r", 200_us, 200_us, budget(1_us), run(reader)),
                              connect(g_counter.out, reader.in, any_age()));

    EXPECT_TRUE(table.windows[0].has_outputs);
    EXPECT_TRUE(table.windows[0].has_deliveries);
    EXPECT_FALSE(table.windows[1].has_outputs);
    EXPECT_FALSE(table.windows[1].has_deliveries);

    Counter stranger{"stranger"};
    Relay relay;
    const auto other = system(frame(1_ms), window("w", 0_us, 200_us, budget(1_us), run(g_counter)),
                              window("r", 200_us, 200_us, budget(1_us), run(reader)),
                              window("s", 400_us, 200_us, budget(1_us), run(relay)),
                              connect(stranger.out, reader.in, any_age()),
                              connect(g_counter.out, relay.in, through(g_crossing), any_age()));
    EXPECT_TRUE(other.windows[0].has_deliveries);
    EXPECT_FALSE(other.windows[1].has_deliveries);
    EXPECT_FALSE(other.windows[2].has_deliveries) << "the writer of the queue is in no window";
}

TEST(SystemRatesTest, PeriodicWindowsOverlapExactlyWhenTheyMeetInSomeFrame) {
    verifies("SWR-KRN-018", Technique::kBackToBack, Polarity::kViolation);
    const std::int64_t frame_length = 60;
    std::size_t overlap_count = 0U;
    for (const std::int64_t period : {12, 15, 20}) {
        for (const std::int64_t other_period : {10, 15, 30}) {
            for (std::int64_t offset = 0; offset < 9; ++offset) {
                const auto table =
                    system(frame(Duration{frame_length}),
                           window("a", 2_ns, 3_ns, every(Duration{period}), budget(1_ns), run(g_counter)),
                           window("b", Duration{offset}, 1_ns, every(Duration{other_period}), budget(1_ns),
                                  run(g_other)));
                std::vector<int> users(60U, 0);
                for (std::int64_t t = 2; t < frame_length; t += period) {
                    std::fill_n(users.begin() + t, 3, 1);
                }
                bool overlaps = false;
                for (std::int64_t t = offset; t < frame_length; t += other_period) {
                    overlaps = overlaps || *(users.begin() + t) == 1;
                }
                overlap_count += overlaps ? 1U : 0U;
                EXPECT_EQ(list_rules(table), overlaps ? Rules{Rule::kWindowsOverlap} : Rules{})
                    << period << " " << other_period << " " << offset;
            }
        }
    }
    EXPECT_GT(overlap_count, 10U) << "both outcomes occur";
    EXPECT_LT(overlap_count, 71U);
}

TEST(SystemRatesTest, WindowsOfTwoCoresMayOverlap) {
    verifies("SWR-KRN-018", Technique::kEquivalenceClasses);

    EXPECT_EQ(list_rules(system(frame(1_ms), window("a", 0_us, 1_ms, budget(1_us), run(g_counter)),
                                window("b", 0_us, 1_ms, core(1), budget(1_us), run(g_other)))),
              Rules{});
}

TEST(SystemRatesTest, ADeclaredRateIsThatOfTheOpenings) {
    verifies("SWR-KRN-018", Technique::kBoundaryValues, Polarity::kViolation);
    const auto check_rate = [](Rate declared, Duration period) {
        return list_rules(system(frame(100_ms), window("a", 0_us, 1_us, every(period), rate(declared),
                                                       budget(1_us), run(g_counter))));
    };

    EXPECT_EQ(check_rate(1000_hz, 1_ms), Rules{});
    EXPECT_EQ(check_rate(1001_hz, 1_ms), Rules{Rule::kRateNotOccurrences});
    EXPECT_EQ(check_rate(999_hz, 1_ms), Rules{Rule::kRateNotOccurrences});
    EXPECT_EQ(check_rate(Rate{-1000.0}, 1_ms), Rules{Rule::kRateNotOccurrences});
    EXPECT_EQ(check_rate(Rate{0.0}, 1_ms), Rules{Rule::kRateNotOccurrences});
    EXPECT_EQ(check_rate(Rate{1000.0 * (1.0 + 2.0e-9)}, 1_ms), Rules{Rule::kRateNotOccurrences});
}

TEST(SystemRatesTest, WindowsAreToldApartByTheirNames) {
    verifies("SWR-KRN-018", Technique::kEquivalenceClasses, Polarity::kViolation);
    Counter third{"third"};
    const auto check_names = [&third](const char* a, const char* b, const char* c) {
        std::array<Finding, 4U> findings{};
        const auto table = system(frame(1_ms), window(a, 0_us, 1_us, budget(1_us), run(g_counter)),
                                  window(b, 1_us, 1_us, budget(1_us), run(g_other)),
                                  window(c, 0_us, 1_us, core(1U), budget(1_us), run(third)));
        const std::size_t count = check_all(make_view(table), findings);
        std::vector<std::array<std::size_t, 2U>> rows;
        for (std::size_t i = 0U; i < count; ++i) {
            EXPECT_EQ(findings[i].rule, Rule::kWindowNamedTwice);
            rows.push_back({findings[i].element, findings[i].other});
        }
        return rows;
    };
    using Rows = std::vector<std::array<std::size_t, 2U>>;
    const std::string other_place{"a"};

    EXPECT_EQ(check_names("a", "b", "ab"), Rows{});
    EXPECT_EQ(check_names("a", "b", other_place.c_str()), (Rows{{2U, 0U}})) << "on another core, too";
    EXPECT_EQ(check_names("a", "b", "b"), (Rows{{2U, 1U}}));
    EXPECT_EQ(check_names("a", "a", "a"), (Rows{{1U, 0U}, {2U, 0U}})) << "each one once";
}

TEST(SystemRatesTest, ATriggerReleasesOneWindow) {
    verifies("SWR-KRN-018", Technique::kEquivalenceClasses, Polarity::kViolation);
    Counter third{"third"};
    ExternalTrigger one;
    ExternalTrigger two;
    const auto check_triggers = [&third](ExternalTrigger& b, ExternalTrigger& c) {
        std::array<Finding, 4U> findings{};
        const auto table = system(frame(1_ms), window("a", 0_us, 1_us, budget(1_us), run(g_counter)),
                                  window("b", 1_us, 1_us, triggered_by(b), budget(1_us), run(g_other)),
                                  window("c", 2_us, 1_us, triggered_by(c), budget(1_us), run(third)));
        const std::size_t count = check_all(make_view(table), findings);
        EXPECT_EQ(count == 0U ? Rule::kNone : Rule::kTriggerUsedTwice, findings[0].rule);
        EXPECT_LE(count, 1U);
        return std::array<std::size_t, 2U>{findings[0].element, findings[0].other};
    };

    EXPECT_EQ(check_triggers(one, two), (std::array<std::size_t, 2U>{0U, 0U}));
    EXPECT_EQ(check_triggers(one, one), (std::array<std::size_t, 2U>{2U, 1U}));
}

TEST(SystemRatesTest, APeriodThatIsSaidIsPositive) {
    verifies("SWR-KRN-018", Technique::kBoundaryValues, Polarity::kViolation);
    const auto check_period = [](Duration period) {
        return list_rules(
            system(frame(1_ms), window("a", 0_us, 1_ns, every(period), budget(1_ns), run(g_counter))));
    };

    EXPECT_EQ(check_period(1_ns), Rules{});
    EXPECT_EQ(check_period(0_ns), Rules{Rule::kWindowRowInvalid});
    EXPECT_EQ(check_period(Duration{-1}), Rules{Rule::kWindowRowInvalid});
}

TEST(SystemRatesTest, AFaultIsDeclaredOnce) {
    verifies("SWR-KRN-018", Technique::kEquivalenceClasses, Polarity::kViolation);
    const auto table = system(frame(1_ms), faults<Fault::kHot, Fault::kFast, Fault::kHot, Fault::kHot>(),
                              react(Fault::kHot, Reaction::kStop, within(1_ms)),
                              react(Fault::kFast, Reaction::kStop, within(1_ms)));
    std::array<Finding, 4U> findings{};

    ASSERT_EQ(check_all(make_view(table), findings), 2U);
    EXPECT_EQ(findings[0].rule, Rule::kFaultDeclaredTwice);
    EXPECT_EQ(findings[0].element, 2U);
    EXPECT_EQ(findings[0].other, 0U);
    EXPECT_EQ(findings[1].rule, Rule::kFaultDeclaredTwice);
    EXPECT_EQ(findings[1].element, 3U);
    EXPECT_EQ(findings[1].other, 0U);
}

TEST(SystemRatesTest, AValueCanBeFreshForAWhile) {
    verifies("SWR-KRN-018", Technique::kBoundaryValues, Polarity::kViolation);
    const auto check_age = [](Duration age_max, Duration lead_max = Duration{}) {
        return list_rules(system(frame(1_ms), window("a", 0_us, 1_us, budget(1_us), run(g_counter, g_relay)),
                                 connect(g_counter.out, g_relay.in, fresh_within(age_max, lead_max))));
    };

    EXPECT_EQ(check_age(1_ns), Rules{});
    EXPECT_EQ(check_age(0_ns), Rules{Rule::kAgeLimitNotPositive});
    EXPECT_EQ(check_age(Duration{-1}), Rules{Rule::kAgeLimitNotPositive});
    EXPECT_EQ(check_age(1_ns, 1_ns), Rules{});
    EXPECT_EQ(check_age(1_ns, Duration{-1}), Rules{Rule::kAgeLimitNotPositive});
}

TEST(SystemRatesTest, ASlowerRateIsAWholePartOfTheFirst) {
    verifies("SWR-KRN-018", Technique::kBoundaryValues, Polarity::kViolation);
    const auto check_slower = [](Rate slower) {
        return list_rules(system(
            frame(1_ms), window("a", 0_us, 1_us, rate(1000_hz, slower), budget(1_us), run(g_counter))));
    };

    EXPECT_EQ(check_slower(500_hz), Rules{});
    EXPECT_EQ(check_slower(250_hz), Rules{});
    for (const double hz : {1000.0, 2000.0, 600.0, 0.0, -500.0}) {
        EXPECT_EQ(check_slower(Rate{hz}), Rules{Rule::kRateNotReachable}) << hz;
    }
}

TEST(SystemRatesTest, WorstCasesMayFillTheBudgetAndNoMore) {
    verifies("SWR-KRN-018", Technique::kBoundaryValues, Polarity::kViolation);
    const auto check_sum = [](Duration second) {
        return list_rules(
            system(frame(1_ms), window("a", 0_us, 100_us, budget(50_us),
                                       run(worst_case(g_counter, 30_us), worst_case(g_other, second)))));
    };

    EXPECT_EQ(check_sum(20_us), Rules{});
    EXPECT_EQ(check_sum(20_us + 1_ns), Rules{Rule::kWorstCasesExceedBudget});
    EXPECT_EQ(check_sum(Duration{std::numeric_limits<std::int64_t>::max()}),
              Rules{Rule::kWorstCasesExceedBudget});
}

TEST(SystemRatesTest, AReaderOnAnotherCoreMayStartWhileItsWriterIsOpen) {
    verifies("SWR-KRN-082", Technique::kBoundaryValues);
    const auto check_offset = [](Duration offset) {
        return list_rules(system(frame(1_ms), window("w", 100_us, 200_us, budget(1_us), run(g_counter)),
                                 window("r", offset, 1_us, core(1), budget(1_us), run(g_relay)),
                                 connect(g_counter.out, g_relay.in, through(g_crossing), any_age())));
    };

    EXPECT_EQ(check_offset(100_us - 1_ns), Rules{});
    EXPECT_EQ(check_offset(100_us), Rules{});
    EXPECT_EQ(check_offset(300_us - 1_ns), Rules{});
    EXPECT_EQ(check_offset(300_us), Rules{});
}

TEST(SystemRatesTest, AReaderOnAnotherCoreStartsAfterThePublicationMargin) {
    verifies("SWR-KRN-051", Technique::kBoundaryValues, Polarity::kViolation);
    const auto check_offset = [](Duration margin, Duration offset, std::size_t reader_core) {
        return list_rules(system(frame(1_ms), publication_margin(margin),
                                 window("w", 100_us, 200_us, budget(1_us), run(g_counter)),
                                 window("r", offset, 1_us, core(reader_core), budget(1_us), run(g_relay)),
                                 connect(g_counter.out, g_relay.in, through(g_crossing), any_age())));
    };

    EXPECT_EQ(check_offset(50_us, 350_us, 1U), Rules{});
    EXPECT_EQ(check_offset(50_us, 350_us - 1_ns, 1U), Rules{Rule::kMarginNotKept});
    EXPECT_EQ(check_offset(50_us, 300_us, 1U), Rules{Rule::kMarginNotKept});
    EXPECT_EQ(check_offset(50_us, 300_us, 0U), Rules{}) << "one core publishes before it continues";
    EXPECT_EQ(check_offset(Duration{-1}, 350_us, 1U), Rules{Rule::kMarginNotKept});
    EXPECT_EQ(check_offset(800_us, 100_us - 1_ns, 1U), Rules{Rule::kMarginNotKept});
    EXPECT_EQ(check_offset(800_us - 1_ns, 100_us - 1_ns, 1U), Rules{}) << "a reader of the next frame";
}

TEST(SystemRatesTest, AQueueBetweenCoresKeepsThePublicationMarginInEachPeriod) {
    verifies("SWR-KRN-051", Technique::kBoundaryValues, Polarity::kViolation);
    QueueReader reader;
    const auto check_margin = [&reader](Duration margin) {
        return list_rules(system(frame(6_ms), publication_margin(margin),
                                 window("w", 0_us, 200_us, every(2_ms), budget(1_us), run(g_counter)),
                                 window("r", 1_ms, 1_us, every(3_ms), core(1), budget(1_us), run(reader)),
                                 connect(g_counter.out, reader.in, any_age())));
    };

    // Ends at 200, 2200 and 4200 us; starts at 1000 and 4000 us; periods of 2 and 3 ms meet every 1 ms.
    EXPECT_EQ(check_margin(800_us), Rules{});
    EXPECT_EQ(check_margin(800_us + 1_ns), Rules{Rule::kMarginNotKept});
}

TEST(SystemRatesTest, OneReactionForEachFaultIsAccepted) {
    verifies("SWR-FLT-004", Technique::kEquivalenceClasses);
    EXPECT_EQ(list_rules(system(frame(1_ms), faults<Fault::kHot, Fault::kFast>(),
                                react(Fault::kFast, Reaction::kStop, within(1_ms)),
                                react(Fault::kHot, Reaction::kStop, within(1_ns)))),
              Rules{});
}

TEST(SystemRatesTest, EveryFaultHasOneReactionAndEveryReactionAFaultAndTime) {
    verifies("SWR-KRN-018", Technique::kEquivalenceClasses, Polarity::kViolation);
    const auto stop = react(Fault::kHot, Reaction::kStop, within(1_ns));

    EXPECT_EQ(list_rules(system(frame(1_ms), faults<Fault::kHot>())), Rules{Rule::kFaultWithoutReaction});
    EXPECT_EQ(list_rules(system(frame(1_ms), faults<Fault::kHot>(), stop, stop)),
              Rules{Rule::kFaultWithTwoReactions});
    EXPECT_EQ(list_rules(system(frame(1_ms), stop)), Rules{Rule::kReactionToUnknownFault});
    EXPECT_EQ(list_rules(system(frame(1_ms), faults<Fault::kHot>(),
                                react(Fault::kHot, Reaction::kStop, within(0_ns)))),
              Rules{Rule::kReactionWithoutTime});
}

enum class Mode { kWork, kTeach, kHalt };
enum class Command { kTeach };

/// A system of three modes with one fault.
template <typename... Reactions>
auto make_system_with_modes(const Reactions&... reactions) {
    return system(frame(1_ms), window("a", 0_us, 100_us, budget(100_us), run(g_counter)),
                  system_mode("work", runs(g_counter)), system_mode("teach", runs(g_counter)),
                  safe_mode("halt", runs(g_counter)), mode_transition("work", Command::kTeach, "teach"),
                  faults<Fault::kHot>(), reactions...);
}
constexpr auto kInWork = react(Fault::kHot, Reaction::kStop, within(1_ms), in_modes<Mode::kWork>());
constexpr auto kElsewhere =
    react(Fault::kHot, Reaction::kSlow, within(1_ms), in_modes<Mode::kTeach, Mode::kHalt>());

TEST(SystemRatesTest, AGroupIsItsPartsInOrder) {
    verifies("SWR-KRN-095");
    const auto hot = react(Fault::kHot, Reaction::kStop, within(1_ms));
    const auto fast = react(Fault::kFast, Reaction::kSlow, within(2_ms));
    const auto joined =
        system(frame(1_ms),
               parts(window("a", 0_us, 100_us, budget(100_us), run(g_counter)), parts(),
                     parts(faults<Fault::kHot>(), hot)),
               window("b", 100_us, 100_us, budget(100_us), run(g_relay)), parts(faults<Fault::kFast>()), fast,
               connect(g_counter.out, g_relay.in, any_age()));

    EXPECT_EQ(list_rules(joined), Rules{});
    EXPECT_EQ(joined.components[0], &g_counter);
    EXPECT_EQ(joined.components[1], &g_relay);
    EXPECT_EQ(joined.faults[0].fault, 3U);
    EXPECT_EQ(joined.faults[1].fault, 7U);
    EXPECT_EQ(joined.reactions[1].within, 2_ms);
}

TEST(SystemRatesTest, OneReactionForEachFaultAndModeIsAccepted) {
    verifies("SWR-FLT-011", Technique::kEquivalenceClasses);
    const auto table = make_system_with_modes(parts(kInWork, kElsewhere));

    EXPECT_EQ(list_rules(table), Rules{});
    EXPECT_EQ(table.reactions[0].modes, 1U);
    EXPECT_EQ(table.reactions[1].modes, 6U);
    EXPECT_EQ(list_rules(make_system_with_modes(react(Fault::kHot, Reaction::kStop, within(1_ms)))), Rules{});
}

TEST(SystemRatesTest, EveryFaultHasOneReactionInEachMode) {
    verifies("SWR-FLT-011", Technique::kEquivalenceClasses, Polarity::kViolation);
    const auto list_findings = [](const auto& table) {
        std::array<Finding, 4U> findings{};
        return check_all(make_view(table), findings) == 1U ? findings[0] : Finding{};
    };

    const Finding missing = list_findings(make_system_with_modes(kInWork));
    EXPECT_EQ(missing.rule, Rule::kFaultWithoutReaction);
    EXPECT_EQ(missing.other, 1U);
    const Finding twice = list_findings(make_system_with_modes(
        kInWork, kElsewhere, react(Fault::kHot, Reaction::kStop, within(1_ms), in_modes<Mode::kHalt>())));
    EXPECT_EQ(twice.rule, Rule::kFaultWithTwoReactions);
    EXPECT_EQ(twice.other, 2U);
}

TEST(SystemRatesTest, AReactionNamesModesOfTheTable) {
    verifies("SWR-FLT-011", Technique::kBoundaryValues, Polarity::kViolation);
    const auto check_mask = [](ModeMask mask, auto... modes) {
        auto table = system(frame(1_ms), window("a", 0_us, 100_us, budget(100_us), run(g_counter)), modes...,
                            faults<Fault::kHot>(), react(Fault::kHot, Reaction::kStop, within(1_ms)));
        table.reactions[0].modes = mask;
        return list_rules(table);
    };
    const auto work = system_mode("work", runs(g_counter));
    const auto halt = safe_mode("halt", runs(g_counter));

    EXPECT_EQ(check_mask(kEveryMode), Rules{});
    EXPECT_EQ(check_mask(1U), Rules{Rule::kReactionInUnknownMode}) << "a table without modes";
    EXPECT_EQ(check_mask(0U), (Rules{Rule::kFaultWithoutReaction, Rule::kReactionInUnknownMode}));
    EXPECT_EQ(check_mask(3U, work, halt), Rules{});
    EXPECT_EQ(check_mask(7U, work, halt), Rules{Rule::kReactionInUnknownMode});
    const std::array<SystemModeRow, kSystemModeMax> most{};
    SystemView view{};
    view.modes.modes = most;
    ReactionRow row{};
    row.modes = ModeMask{1U} << 31U;
    EXPECT_TRUE(detail::has_known_modes(view, row)) << "the last of 32 modes";
    view.modes.modes = {most.data(), most.size() - 1U};
    EXPECT_FALSE(detail::has_known_modes(view, row));
}

// Tables made at run time.

TEST(RunTimeTableTest, AllFindingsAreToldAtOnce) {
    verifies("SWR-KRN-025", Technique::kErrorGuessing, Polarity::kViolation);

    EXPECT_EQ(
        list_rules(system(frame(1_ms), window("a", 0_us, 100_us, budget(101_us), run(g_relay)),
                          window("b", 50_us, 100_us, every(300_us), budget(1_us), run(g_relay)),
                          connect(g_counter.out, g_relay.in, any_age()), faults<Fault::kHot>())),
        (Rules{Rule::kBudgetExceedsWindow, Rule::kPeriodNotInFrame, Rule::kWindowsOverlap,
               Rule::kComponentInTwoPlaces, Rule::kPortOfUnknownComponent, Rule::kFaultWithoutReaction}));
}

TEST(RunTimeTableTest, FindingsBeyondTheRoomAreCounted) {
    verifies("SWR-KRN-025", Technique::kBoundaryValues, Polarity::kViolation);
    const auto table = system(frame(1_ms), faults<Fault::kHot, Fault::kFast>());
    std::array<Finding, 1U> findings{};

    EXPECT_EQ(check_all(make_view(table), findings), 2U);
    EXPECT_EQ(check_all(make_view(table), {}), 2U);
    EXPECT_EQ(findings[0].rule, Rule::kFaultWithoutReaction);
}

TEST(RunTimeTableTest, RowsThatAreInvalidInThemselvesHideWhatReliesOnThem) {
    verifies("SWR-KRN-025", Technique::kErrorGuessing, Polarity::kViolation);
    const auto good = system(frame(1_ms), window("a", 0_us, 1_us, budget(1_us), run(g_counter, g_relay)),
                             connect(g_counter.out, g_relay.in, any_age()));
    const auto list_broken = [&good](auto&& spoil) {
        auto table = good;
        spoil(table);
        return list_rules(table);
    };

    EXPECT_EQ(list_broken([](auto&) {}), Rules{});
    EXPECT_EQ(list_broken([](auto& t) { t.frame = 0_ns; }), Rules{Rule::kFrameNotPositive});
    EXPECT_EQ(list_broken([](auto& t) { t.windows[0].name = nullptr; }), Rules{Rule::kWindowRowInvalid});
    EXPECT_EQ(list_broken([](auto& t) { t.windows[0].partition = nullptr; }), Rules{Rule::kWindowRowInvalid});
    EXPECT_EQ(list_broken([](auto& t) { t.windows[0].period = 0_ns; }), Rules{Rule::kWindowRowInvalid});
    EXPECT_EQ(list_broken([](auto& t) { t.windows[0].component_count = 3U; }),
              Rules{Rule::kWindowRowInvalid});
    EXPECT_EQ(list_broken([](auto& t) { t.windows[0].first_component = 1U; }),
              Rules{Rule::kWindowRowInvalid});
    EXPECT_EQ(list_broken([](auto& t) { t.windows[0].latch_count = 2U; }), Rules{Rule::kWindowRowInvalid});
    EXPECT_EQ(list_broken([](auto& t) { t.windows[0].alternative_count = 5U; }),
              Rules{Rule::kWindowRowInvalid});
    EXPECT_EQ(list_broken([](auto& t) { t.components[1] = nullptr; }), Rules{Rule::kComponentRowInvalid});
    EXPECT_EQ(list_broken([](auto& t) { t.component_rows[1].window = 1U; }),
              Rules{Rule::kComponentRowInvalid});
    EXPECT_EQ(list_broken([](auto& t) { t.component_rows[1].port_count = 3U; }),
              Rules{Rule::kComponentRowInvalid});
    EXPECT_EQ(list_broken([](auto& t) { t.component_rows[0].outgoing_count = 2U; }),
              Rules{Rule::kComponentRowInvalid});
    EXPECT_EQ(list_broken([](auto& t) { t.ports[0].output = nullptr; }), Rules{Rule::kPortRowInvalid});
    EXPECT_EQ(list_broken([](auto& t) { t.connections[0].source = nullptr; }),
              Rules{Rule::kConnectionRowInvalid});
    EXPECT_EQ(list_broken([](auto& t) { t.connections[0].sink = nullptr; }),
              Rules{Rule::kConnectionRowInvalid});
    EXPECT_EQ(list_broken([](auto& t) { t.connections[0].operations = {}; }),
              Rules{Rule::kConnectionRowInvalid});
    EXPECT_EQ(list_broken([](auto& t) { t.connections[0].source_window = 1U; }),
              Rules{Rule::kConnectionRowInvalid});
    EXPECT_EQ(list_broken([](auto& t) { t.connections[0].sink_window = 1U; }),
              Rules{Rule::kConnectionRowInvalid});
}

TEST(RunTimeTableTest, AnExecutiveRefusesATableWithAFindingAndRunsOneWithout) {
    verifies("SWR-KRN-025", Technique::kErrorGuessing, Polarity::kViolation);
    Counter counter;
    const auto broken = system(frame(1_ms), window("a", 0_us, 1_us, budget(2_us), run(counter)));
    const auto good = system(frame(1_ms), window("a", 0_us, 1_us, budget(1_us), run(counter)));
    ExecutiveFor refusing{broken};
    ExecutiveFor running{good};

    EXPECT_EQ(refusing.initialize(), Status::kBadParameter);
    EXPECT_FALSE(counter.is_alive());
    EXPECT_EQ(running.initialize(), Status::kOk);
    EXPECT_EQ(running.finalize(), Status::kOk);
}

/// The enumerator's name, as the compiler spells it.
template <Rule kRule>
std::string spell() {
    const std::string words = __PRETTY_FUNCTION__;
    const std::string before = "Rule::k";
    const std::size_t begin = words.find(before) + before.size();
    return words.substr(begin, words.find_first_of(";]", begin) - begin);
}

template <std::size_t... kIndices>
std::vector<std::string> spell_all(std::index_sequence<kIndices...>) {
    return {spell<static_cast<Rule>(kIndices)>()...};
}

TEST(RunTimeTableTest, EachRuleHasANameOfItsOwn) {
    verifies("SWR-KRN-025", Technique::kBackToBack);
    constexpr std::size_t kCount = static_cast<std::size_t>(Rule::kSafeModeActivates) + 1U;
    const std::vector<std::string> names = spell_all(std::make_index_sequence<kCount>{});

    ASSERT_EQ(names[0], "None");
    for (std::size_t i = 0U; i < kCount; ++i) {
        EXPECT_EQ(get_name(static_cast<Rule>(i)), names[i]);
    }
    EXPECT_STREQ(get_name(static_cast<Rule>(kCount)), "Invalid");
    EXPECT_STREQ(get_name(static_cast<Rule>(999)), "Invalid");
}

}  // namespace
}  // namespace mamori
