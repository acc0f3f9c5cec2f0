// SPDX-License-Identifier: Apache-2.0
// Goal: the words of the modes become rows, and a table made at run time is refused with all that is wrong.
// Method: the robot of support/mode_system.hpp; each rule broken by hand.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>

#include "mamori/kernel/table/system_check.hpp"
#include "mamori/trace/verifies.hpp"
#include "support/mode_system.hpp"

namespace mamori {
namespace {

using namespace testing_support;
using namespace verification;

constexpr ModeMask kAll = 15U;

TEST(ModeTableTest, ComponentsAndConnectionsKnowTheirModes) {
    verifies("SWR-MOD-001");
    const Robot robot;
    const auto& table = robot.table;
    const ModeMask work = to_mask(kWork);
    const ModeMask teach = to_mask(kTeach);

    const std::array<ModeMask, 6U> of_components{{kAll, work, work | teach, teach, work | teach, kAll}};
    for (std::size_t i = 0U; i < 6U; ++i) {
        EXPECT_EQ(table.component_rows[i].modes, of_components[i]) << i;
    }
    EXPECT_EQ(table.connections[0].get_modes(), work) << "the planner runs there only";
    EXPECT_EQ(table.connections[1].get_modes(), teach);
    EXPECT_EQ(table.connections[2].get_modes(), work) << "only_in";
    EXPECT_EQ(table.modes.modes[kWork].set, 1U);
    EXPECT_EQ(table.modes.modes[kIdle].set, kNoIndex);
    EXPECT_EQ(find_safe_mode(make_view(table.modes)), kHalt);
    EXPECT_EQ(table.modes.transitions[2].source, kWork);
    EXPECT_EQ(table.modes.transitions[2].event, static_cast<std::uint32_t>(Command::kTeach));
    EXPECT_EQ(table.modes.transitions[2].target, kTeach);
}

TEST(ModeTableTest, ATableWithoutModesRunsEverythingAlways) {
    verifies("SWR-MOD-001");
    testing_support::RobotParts parts;
    const auto table = system(frame(1000_ns), window("w", 0_ns, 400_ns, budget(300_ns), run(parts.planner)));

    EXPECT_EQ(table.component_rows[0].modes, kEveryMode);
    EXPECT_EQ(check(make_view(table)).rule, Rule::kNone);
}

TEST(ModeTableTest, EachBrokenRuleIsFoundAtRunTimeToo) {
    verifies("SWR-MOD-001", Technique::kInterface, Polarity::kViolation);
    using Break = std::function<void(Robot::Table&)>;
    const std::vector<std::pair<Rule, Break>> cases{
        {Rule::kModeRowInvalid, [](auto& t) { t.modes.modes[1].name = nullptr; }},
        {Rule::kModeNamedTwice, [](auto& t) { t.modes.modes[1].name = "idle"; }},
        {Rule::kModeOfUnknownSet, [](auto& t) { t.modes.modes[1].set = 2U; }},
        {Rule::kTwoSafeModes, [](auto& t) { t.modes.modes[0].is_safe = true; }},
        {Rule::kNoSafeMode, [](auto& t) { t.modes.modes[3].is_safe = false; }},
        {Rule::kModeOfUnknownComponent, [](auto& t) { t.modes.members[0].index = 6U; }},
        {Rule::kComponentInNoMode, [](auto& t) { t.component_rows[3].modes = 0U; }},
        {Rule::kConnectionOfUnknownMode, [](auto& t) { t.modes.connection_modes[0].mode = 4U; }},
        {Rule::kTransitionOfUnknownMode, [](auto& t) { t.modes.transitions[0].source = kNoIndex; }},
        {Rule::kTransitionOfUnknownMode, [](auto& t) { t.modes.transitions[0].target = 4U; }},
        {Rule::kTransitionAmbiguous, [](auto& t) { t.modes.transitions[1].event = 0U; }},
        {Rule::kSafeModeIsLeft, [](auto& t) { t.modes.transitions[5].source = kHalt; }},
        {Rule::kSafeModeActivates, [](auto& t) { t.component_rows[0].modes = kAll - to_mask(kTeach); }},
        {Rule::kModeUnreachable,
         [](auto& t) {
             for (ModeTransitionRow& row : t.modes.transitions) {
                 row.target = row.target == kTeach ? kIdle : row.target;
             }
         }},
        {Rule::kInputHasTwoWriters, [](auto& t) { t.connections[1].idle_modes &= ~to_mask(kWork); }},
        {Rule::kInputNotFedInMode,
         [](auto& t) {
             for (PortRow& port : t.ports) {
                 port.is_mandatory = port.input == t.connections[0].sink;
             }
             t.connections[1].idle_modes = kEveryMode;
         }},
    };
    for (const auto& [rule, break_it] : cases) {
        Robot robot;
        ASSERT_EQ(check(make_view(robot.table)).rule, Rule::kNone);
        break_it(robot.table);
        std::array<Finding, 16U> findings{};
        const std::size_t count = check_all(make_view(robot.table), findings);

        EXPECT_TRUE(std::any_of(findings.begin(), findings.begin() + static_cast<std::ptrdiff_t>(count),
                                [expected = rule](const Finding& found) { return found.rule == expected; }))
            << get_name(rule);
        EXPECT_STRNE(get_name(rule), "Invalid");
        EXPECT_EQ(robot.core_0.initialize(), Status::kBadParameter) << get_name(rule);
    }
}

TEST(ModeTableTest, AQueueHasOneWriterWhateverTheModes) {
    verifies("SWR-MOD-003", Technique::kInterface, Polarity::kViolation);
    Robot robot;
    ConnectionOperations queue = robot.table.connections[1].operations;
    queue.is_latest = false;
    robot.table.connections[1].operations = queue;

    EXPECT_EQ(check(make_view(robot.table)).rule, Rule::kInputHasTwoWriters);
}

}  // namespace
}  // namespace mamori
