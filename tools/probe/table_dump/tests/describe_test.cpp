// SPDX-License-Identifier: Apache-2.0
// Goal: each finding becomes a sentence with the contradicting names and numbers, and no row contents crash
// the function. Method: tables made at run time, as tools do, each of which violates one rule; rows with
// invalid indices.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "mamori/table_dump/table_dump.hpp"
#include "mamori/trace/verifies.hpp"
#include "parts.hpp"

namespace mamori::table_dump {
namespace {

using namespace testing_support;
using namespace verification;

Source g_encoder{"encoder"};
Source g_second_encoder{"second_encoder"};
Filter g_monitor{"monitor"};
Filter g_planner{"planner"};
Crossing<double> g_crossing;

/// Complies with every rule; each test violates one rule in a copy.
constexpr auto kSound =
    system(frame(10_ms),
           window("sense", 0_us, 200_us, every(1_ms), rate(1000_hz, 500_hz), budget(150_us),
                  run(worst_case(g_encoder, 40_us), worst_case(g_monitor, 60_us))),
           window("plan", 1200_us, 8_ms, core(1U), budget(7_ms), run(g_planner)),
           connect(g_encoder.out, g_monitor.in, any_age()),
           connect(g_monitor.out, g_planner.in, through(g_crossing), any_age()),
           faults<Fault::kOverspeed, Fault::kTrackingLost>(),
           react(Fault::kOverspeed, Reaction::kSs1, within(20_ms)),
           react(Fault::kTrackingLost, Reaction::kSto, within(5_ms)));

using Sentences = std::vector<std::string>;

/// The findings without their rules, which EachFindingEndsWithItsRule compares.
Sentences describe_elements(const SystemView& view) {
    Sentences elements = describe_all(view);
    for (std::string& text : elements) {
        text.resize(std::min(text.size(), text.find("; rule: ")));
    }
    return elements;
}

class DescribeTest : public ::testing::Test {
  protected:
    Sentences describe_table() const { return describe_elements(make_view(table_)); }

    std::remove_const_t<decltype(kSound)> table_ = kSound;
};

TEST_F(DescribeTest, ATableThatCompliesWithEveryRuleHasNoFindings) {
    verifies("SWR-TAB-003");
    EXPECT_EQ(describe_table(), Sentences{});
    EXPECT_EQ(describe({}, make_view(table_)), "the table keeps every rule");
}

TEST_F(DescribeTest, TheFrameIsNamedWithItsLength) {
    verifies("SWR-TAB-003");
    table_.frame = {-1};
    EXPECT_EQ(describe_table(), Sentences{"the major frame of -1 ns is not positive"});
}

TEST_F(DescribeTest, AConnectionIsNamedWithTheAgeLimitOrDelayThatItDoesNotState) {
    verifies("SWR-TAB-003");
    table_.connections[0].age_max = {0};
    table_.connections[0].is_delayed_by_a_frame = true;
    EXPECT_EQ(describe_table(),
              (Sentences{"connection 'encoder.out -> monitor.in' states a delay that it does not have",
                         "connection 'encoder.out -> monitor.in': its age limit is not stated"}));
    table_ = kSound;
    table_.connections[0].age_max = {-1};
    EXPECT_EQ(describe_table(),
              Sentences{"connection 'encoder.out -> monitor.in': no value is fresh within -1 ns"});
}

/// Its second port has the name of the first, is listed, and belongs to `owner`; its third port is not
/// listed.
class Faulty final : public Component {
  public:
    Faulty(const char* name, Component* owner) noexcept
        : Component(name), second(owner == nullptr ? *this : *owner, "first") {}
    InPort<double, Need::kOptional> first{*this, "first"};
    InPort<double, Need::kOptional> second;
    OutPort<double> third{*this, "third"};
    using Ports = mamori::Ports<&Faulty::first, &Faulty::second>;
};

TEST_F(DescribeTest, ComponentsAndPortsAreNamedWithTheNamesAndListsThatDisagree) {
    verifies("SWR-TAB-003");
    Faulty one{"axis", nullptr};
    Faulty other{"axis", &one};
    const auto table = system(frame(1_ms), window("w", 0_us, 100_us, budget(50_us), run(one, other)));

    EXPECT_EQ(
        describe_elements(make_view(table)),
        (Sentences{
            "component 'axis' does not list port 'first'", "component 'axis' does not list port 'third'",
            "port 'axis.first': row 1 has the name of row 0", "component 'axis': row 1 has the name of row 0",
            "component 'axis' does not list port 'third'",
            "port 'axis.first' is not constructed with its component",
            "port 'axis.first': row 3 has the name of row 2"}));
}

TEST_F(DescribeTest, WindowsAreNamedWithTheTimesThatDisagree) {
    verifies("SWR-TAB-003");
    table_.windows[0].period = 3_ms;
    table_.windows[0].has_rate = false;
    table_.windows[0].alternative_count = 0U;
    table_.windows[1].offset = 3_ms;
    EXPECT_EQ(describe_table(),
              (Sentences{"window 'sense': its period of 3 ms does not divide the major frame of 10 ms",
                         "window 'plan': it starts at 3 ms for 8 ms and is not inside its period of 10 ms"}));
}

TEST_F(DescribeTest, OverlappingWindowsAreBothNamed) {
    verifies("SWR-TAB-003");
    table_.windows[1].core = 0U;
    EXPECT_EQ(describe_table(), Sentences{"window 'plan': it overlaps window 'sense' on core 0"});
}

TEST_F(DescribeTest, WindowsWithEqualNamesAreDistinguishedByTheirRows) {
    verifies("SWR-TAB-003");
    table_.windows[1].name = "sense";
    EXPECT_EQ(describe_table(), Sentences{"window 'sense': row 1 has the name of row 0"});
}

TEST_F(DescribeTest, AnAgeLimitIsNamedWithItsConnection) {
    verifies("SWR-TAB-003");
    table_.connections[0].age_max = {0};
    EXPECT_EQ(describe_table(),
              Sentences{"connection 'encoder.out -> monitor.in': its age limit is not stated"});
}

TEST_F(DescribeTest, ABudgetIsComparedWithItsWindow) {
    verifies("SWR-TAB-003");
    table_.windows[0].budget = 201_us;
    EXPECT_EQ(describe_table(), Sentences{"window 'sense': its budget of 201 us is not in 1 ns .. its length "
                                          "of 200 us"});
}

TEST_F(DescribeTest, AStackIsComparedWithItsRange) {
    verifies("SWR-TAB-003");
    table_.windows[0].stack_kib = kStackKibMax + 1U;
    EXPECT_EQ(describe_table(), Sentences{"window 'sense': its stack is not a multiple of 1 KiB in 1 KiB .. "
                                          "65534 KiB"});
}

TEST_F(DescribeTest, ABackgroundWindowIsComparedWithTheWindowsThatPreemptIt) {
    verifies("SWR-TAB-003");
    const auto check_budget = [](Duration limit, Duration length) {
        return describe_elements(make_view(
            system(frame(10_ms), window("sense", 0_us, 500_us, every(1_ms), budget(400_us), run(g_encoder)),
                   window("plan", 0_us, length, background(), budget(limit), run(g_second_encoder)))));
    };
    EXPECT_EQ(check_budget(6_ms, 9_ms),
              Sentences{"window 'plan': its budget of 6 ms does not fit into its length of 9 ms with the "
                        "windows of core 0 that preempt it and the publication margin of 0 ns"});
    EXPECT_EQ(check_budget(6_ms, 5_ms),
              Sentences{"window 'plan': its budget of 6 ms is not in 1 ns .. its length of 5 ms"});
}

TEST_F(DescribeTest, AReaderWhoseValueMayBeOverwrittenIsNamedWithItsWriter) {
    verifies("SWR-TAB-003");
    table_.publication_margin = 10_ms;
    EXPECT_EQ(describe_table().front(),
              "connection 'monitor.out -> planner.in': window 'plan' may start when "
              "window 'sense' has published two newer values");
}

TEST_F(DescribeTest, WorstCasesAreListedByComponent) {
    verifies("SWR-TAB-003");
    table_.component_rows[1].worst_case = 120_us;
    EXPECT_EQ(describe_table(), Sentences{"window 'sense': the worst cases of its components are longer than "
                                          "its budget of 150 us: encoder 40 us, monitor 120 us"});
}

TEST_F(DescribeTest, RatesAreComparedWithTheOpenings) {
    verifies("SWR-TAB-003");
    table_.windows[0].rate_hz = 900.0;
    table_.windows[0].alternative_periods[0] = 1500_us;
    EXPECT_EQ(
        describe_table(),
        (Sentences{"window 'sense': its rate of 900 Hz does not match its window starts, every 1 ms",
                   "window 'sense': a slower period is not a multiple of its period of 1 ms: 1500 us"}));
}

TEST_F(DescribeTest, AComponentInTwoWindowsIsNamedWithBoth) {
    verifies("SWR-TAB-003");
    const auto table = system(frame(1_ms), window("sense", 0_us, 1_us, budget(1_us), run(g_encoder)),
                              window("plan", 1_us, 1_us, budget(1_us), run(g_encoder)));
    EXPECT_EQ(describe_elements(make_view(table)),
              Sentences{"component 'encoder' runs in window 'sense' and again in window 'plan'"});
}

TEST_F(DescribeTest, ConnectionsAndInputsAreNamedByComponentAndPort) {
    verifies("SWR-TAB-003");
    const auto table = system(
        frame(1_ms), window("w", 0_us, 1_us, budget(1_us), run(g_encoder, g_monitor, g_planner)),
        connect(g_encoder.out, g_monitor.in, any_age()), connect(g_encoder.out, g_monitor.in, any_age()));
    EXPECT_EQ(describe_elements(make_view(table)),
              (Sentences{"input 'monitor.in' has more than one connection",
                         "input 'planner.in' is mandatory and has no connection"}));
}

TEST_F(DescribeTest, AConnectionOfAnUnknownComponentIsNamedByItsKnownParts) {
    verifies("SWR-TAB-003");
    const auto table = system(frame(1_ms), window("w", 0_us, 1_us, budget(1_us), run(g_monitor)),
                              connect(g_second_encoder.out, g_monitor.in, any_age()));
    EXPECT_EQ(describe_elements(make_view(table)),
              Sentences{"connection '?.out -> monitor.in': one end belongs to no component "
                        "that a window runs"});
}

TEST_F(DescribeTest, InterCoreBuffersAreNamedByTheirConnections) {
    verifies("SWR-TAB-003");
    table_.connections[0].crossing = &g_crossing;
    table_.connections[1].operations = table_.connections[0].operations;
    EXPECT_EQ(describe_table(),
              (Sentences{"connection 'monitor.out -> planner.in' leaves its core or partition without "
                         "a Crossing or a queue",
                         "connection 'monitor.out -> planner.in' uses the Crossing of 'encoder.out -> "
                         "monitor.in'"}));
}

TEST_F(DescribeTest, FaultsAndReactionsAreNamedByTheirNumbers) {
    verifies("SWR-TAB-003");
    table_.reactions[1].fault = 7U;
    table_.reactions[0].within = {0};
    EXPECT_EQ(describe_table(), (Sentences{"fault 1 has no reaction", "the reaction to fault 0 has 0 ns",
                                           "the reaction to fault 7 is for a fault that is not declared"}));
    table_.reactions[1].fault = 0U;
    EXPECT_EQ(describe_table()[0], "fault 0 has more than one reaction");
}

TEST_F(DescribeTest, RowsWithInvalidIndicesAreDescribedToo) {
    verifies("SWR-TAB-003", Technique::kErrorGuessing, Polarity::kViolation);
    table_.windows[0].name = nullptr;
    table_.windows[1].component_count = std::numeric_limits<std::size_t>::max();
    table_.components[0] = nullptr;
    table_.ports[0].output = nullptr;
    table_.connections[0].source = nullptr;
    table_.connections[1].sink_window = 99U;
    const Sentences sentences = describe_table();
    ASSERT_EQ(sentences.size(), 6U);
    EXPECT_EQ(sentences[0].substr(0U, 17U), "window '?': row 0");
    EXPECT_EQ(sentences[1].substr(0U, 20U), "window 'plan': row 1");
    EXPECT_EQ(sentences[2].substr(0U, 20U), "component '?': row 0");
    EXPECT_EQ(sentences[3].substr(0U, 28U), "port 'encoder.?': row 0 is i");
    EXPECT_EQ(sentences[4].substr(0U, 35U), "connection '?.? -> monitor.in': row");
    EXPECT_EQ(sentences[5].substr(0U, 42U), "connection 'monitor.out -> planner.in': ro");
}

TEST_F(DescribeTest, EachFindingEndsWithItsRule) {
    verifies("SWR-TAB-015", Technique::kInterface);
    for (int number = 1; number <= static_cast<int>(Rule::kSafeModeActivates); ++number) {
        const auto rule = static_cast<Rule>(number);
        const std::string text = describe({rule, 0U, 0U}, make_view(table_));
        const std::string end = std::string("; rule: ") + get_sentence(rule);
        ASSERT_GT(text.size(), end.size()) << text;
        EXPECT_EQ(text.substr(text.size() - end.size()), end);
    }
}

TEST_F(DescribeTest, EachRuleAndEachElementGivesASentence) {
    verifies("SWR-TAB-003", Technique::kBoundaryValues, Polarity::kViolation);
    table_.windows[1].component_count = std::numeric_limits<std::size_t>::max();
    for (int rule = 0; rule <= static_cast<int>(Rule::kSafeModeActivates) + 1; ++rule) {
        for (const std::size_t element : {std::size_t{0U}, std::size_t{1U}, kNoIndex}) {
            const std::string text =
                describe({static_cast<Rule>(rule), element, kNoIndex}, make_view(table_));
            EXPECT_GT(text.size(), 20U) << rule << " " << element << " " << text;
        }
    }
    EXPECT_EQ(describe({static_cast<Rule>(99), 0U, 0U}, SystemView{}), "no rule has the number 99");
}

}  // namespace
}  // namespace mamori::table_dump
