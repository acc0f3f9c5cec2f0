// SPDX-License-Identifier: Apache-2.0
// Goal: a configuration is what its description says, and each rule finds its guilty row.
// Method: a constant table read back row by row; tables that break one rule each. That the compiler refuses a
// broken table: parameter_compile_fail_test.cpp.
#include "mamori/kernel/parameter/configuration_set.hpp"

#include <gtest/gtest.h>

#include <array>

#include "mamori/trace/verifies.hpp"
#include "support/configured_components.hpp"

namespace mamori {
namespace {

using testing_support::Axis;
using testing_support::NamedAxis;
using namespace verification;

class Plain final : public Component {
  public:
    constexpr Plain() noexcept : Component("plain") {}
};

Axis g_axis;
Axis g_stranger;
NamedAxis g_named{"named"};
Plain g_plain;

constexpr auto kConfiguration =
    configuration(parameters_of(g_axis, g_plain, g_named),
                  configuration_set("normal", assign(g_axis.speed, 2.0), assign(g_axis.gains, {1, 2, 3})),
                  configuration_set("nothing"), configuration_set("slow", assign(g_named.level, -5)));
MAMORI_CHECK_CONFIGURATION(kConfiguration);

template <typename Table>
ConfigurationFinding check_table(const Table& table) {
    return check(make_view(table));
}

TEST(ConfigurationSetTest, ParametersAreListedWithTheirOwnersInOrder) {
    verifies("SWR-PAR-006");

    ASSERT_EQ(kConfiguration.parameters.size(), 3U);
    EXPECT_EQ(kConfiguration.parameters[0].parameter, &g_axis.speed);
    EXPECT_EQ(kConfiguration.parameters[1].parameter, &g_axis.gains);
    EXPECT_EQ(kConfiguration.parameters[1].owner, &g_axis);
    EXPECT_EQ(kConfiguration.parameters[2].parameter, &g_named.level);
    EXPECT_EQ(parameter_count<Plain>(), 0U);
}

TEST(ConfigurationSetTest, SetsHoldTheirAssignmentsAndValues) {
    verifies("SWR-PAR-006");
    const ConfigurationView view = make_view(kConfiguration);

    ASSERT_EQ(view.sets.size(), 3U);
    EXPECT_STREQ(view.sets[2].name, "slow");
    ASSERT_EQ(view.get_assignments(view.sets[0]).size(), 2U);
    EXPECT_TRUE(view.get_assignments(view.sets[1]).empty());
    const AssignmentRow& gains = view.get_assignments(view.sets[0])[1];
    EXPECT_EQ(gains.parameter, &g_axis.gains);
    ASSERT_EQ(view.get_values(gains).size(), 3U);
    EXPECT_EQ(view.get_values(gains)[2].whole.magnitude, 3U);
    const AssignmentRow& level = view.get_assignments(view.sets[2])[0];
    EXPECT_TRUE(view.get_values(level)[0].whole.is_negative);
}

TEST(ConfigurationSetTest, PartsMayComeInAnyOrder) {
    verifies("SWR-PAR-006", Technique::kInterface);
    ConfigurationBuilder<3U, 1U, 1U, 1U> builder;
    builder.add(configuration_set("late", assign(g_named.level, 1)));
    builder.add(parameters_of(g_axis));
    builder.add(parameters_of(g_named));

    EXPECT_EQ(check_table(builder.finish()).rule, ConfigurationRule::kNone);
}

TEST(ConfigurationSetTest, TheParameterOfAnAssignmentIsFoundForTheMessage) {
    verifies("SWR-PAR-022", Technique::kEquivalenceClasses, Polarity::kViolation);
    const ConfigurationView view = make_view(kConfiguration);
    ConfigurationView without_parameters = view;
    without_parameters.parameters = {};

    EXPECT_EQ(detail::find_assigned(view, 0U, 0U), 0U);
    EXPECT_EQ(detail::find_assigned(view, 0U, 1U), 1U);
    EXPECT_EQ(detail::find_assigned(view, 2U, 0U), 2U);
    EXPECT_EQ(detail::find_assigned(without_parameters, 2U, 0U), 0U) << "no parameter of the table";
    EXPECT_EQ(detail::find_assigned(view, 2U, 9U), 3U) << "no such assignment";
}

TEST(ConfigurationSetTest, TablesWithoutSetsOrParametersKeepTheRules) {
    verifies("SWR-PAR-006", Technique::kBoundaryValues);
    static constexpr auto kWithoutSets = configuration(parameters_of(g_axis));
    static constexpr auto kEmpty = configuration(parameters_of(g_plain));
    MAMORI_CHECK_CONFIGURATION(kWithoutSets);
    MAMORI_CHECK_CONFIGURATION(kEmpty);

    EXPECT_TRUE(make_view(kEmpty).parameters.empty());
    EXPECT_TRUE(detail::keeps_configuration_rules<kEmpty>());
    EXPECT_EQ(detail::require_parameters<Axis>(Axis::Parameters{}).kCount, 2U);
    EXPECT_TRUE(make_view(kWithoutSets).sets.empty());
}

TEST(ConfigurationCheckTest, ValuesAtTheLimitsAreAcceptedAndBeyondThemNamed) {
    verifies("SWR-PAR-006", Technique::kBoundaryValues, Polarity::kViolation);
    const auto check_speed = [](double speed) {
        return check_table(configuration(
            parameters_of(g_axis), configuration_set("first"),
            configuration_set("second", assign(g_axis.gains, {1, 1, 1}), assign(g_axis.speed, speed))));
    };

    EXPECT_EQ(check_speed(0.5).rule, ConfigurationRule::kNone);
    EXPECT_EQ(check_speed(3.0).rule, ConfigurationRule::kNone);
    for (const double speed : {0.49, 3.01}) {
        const ConfigurationFinding finding = check_speed(speed);
        EXPECT_EQ(finding.rule, ConfigurationRule::kValueOutsideConstraint);
        EXPECT_EQ(finding.set, 1U);
        EXPECT_EQ(finding.assignment, 1U);
    }
}

TEST(ConfigurationCheckTest, AParameterThatNoComponentOfTheTableHasIsNamed) {
    verifies("SWR-PAR-006", Technique::kErrorGuessing, Polarity::kViolation);
    const ConfigurationFinding finding = check_table(
        configuration(parameters_of(g_axis), configuration_set("set", assign(g_stranger.speed, 1.0))));

    EXPECT_EQ(finding.rule, ConfigurationRule::kUnknownParameter);
    EXPECT_EQ(finding.assignment, 0U);
}

TEST(ConfigurationCheckTest, AParameterThatASetAssignsTwiceIsNamedAtTheSecond) {
    verifies("SWR-PAR-006", Technique::kEquivalenceClasses, Polarity::kViolation);
    const ConfigurationFinding finding =
        check_table(configuration(parameters_of(g_axis), configuration_set("set", assign(g_axis.speed, 1.0),
                                                                           assign(g_axis.gains, {1, 1, 1}),
                                                                           assign(g_axis.speed, 1.0))));

    EXPECT_EQ(finding.rule, ConfigurationRule::kParameterAssignedTwice);
    EXPECT_EQ(finding.assignment, 2U);
}

TEST(ConfigurationCheckTest, ASecondSetOfOneNameIsNamed) {
    verifies("SWR-PAR-006", Technique::kEquivalenceClasses, Polarity::kViolation);
    const ConfigurationFinding finding = check_table(configuration(
        parameters_of(g_axis), configuration_set("a"), configuration_set("b"), configuration_set("a")));

    EXPECT_EQ(finding.rule, ConfigurationRule::kSetNamedTwice);
    EXPECT_EQ(finding.set, 2U);
}

TEST(ConfigurationCheckTest, AValueThatOnlyTheComponentCanJudgeIsFoundInEachPlace) {
    verifies("SWR-PAR-006", Technique::kBoundaryValues, Polarity::kViolation);
    constexpr std::int16_t kTooHigh = 11;
    const auto table =
        configuration(parameters_of(g_axis, g_named),
                      configuration_set("first", assign(g_named.level, kTooHigh), assign(g_axis.speed, 1.0)),
                      configuration_set("fine", assign(g_axis.speed, 1.0), assign(g_named.level, 10)),
                      configuration_set("last", assign(g_axis.speed, 1.0), assign(g_named.level, kTooHigh)));
    std::array<ConfigurationFinding, 3U> findings{};

    ASSERT_EQ(collect_findings(make_view(table), findings), 2U);
    EXPECT_EQ(findings[0].rule, ConfigurationRule::kValueOutsideConstraint);
    EXPECT_EQ(findings[0].set, 0U);
    EXPECT_EQ(findings[0].assignment, 0U);
    EXPECT_EQ(findings[1].rule, ConfigurationRule::kValueOutsideConstraint);
    EXPECT_EQ(findings[1].set, 2U);
    EXPECT_EQ(findings[1].assignment, 1U);
}

TEST(ConfigurationCheckTest, ARowThatMustNotBeFollowedHidesTheRest) {
    verifies("SWR-PAR-006", Technique::kFaultInjection, Polarity::kViolation);
    auto table = kConfiguration;
    table.sets[0].name = nullptr;
    std::array<ConfigurationFinding, 4> findings{};

    const ConfigurationFinding first = check(make_view(table));
    EXPECT_EQ(first.rule, ConfigurationRule::kSetRowInvalid);
    EXPECT_EQ(first.set, 0U);
    EXPECT_EQ(collect_findings(make_view(table), findings), 1U);
    EXPECT_EQ(findings[0].rule, ConfigurationRule::kSetRowInvalid);
}

TEST(ConfigurationCheckTest, WhileRunningAllFindingsComeAtOnce) {
    verifies("SWR-PAR-006", Technique::kInterface, Polarity::kViolation);
    const auto table =
        configuration(parameters_of(g_axis, g_named),
                      configuration_set("a", assign(g_axis.speed, 9.0), assign(g_stranger.speed, 1.0)),
                      configuration_set("a", assign(g_named.level, 11), assign(g_axis.gains, {0, 0, 0})));
    std::array<ConfigurationFinding, 8U> findings{};
    std::array<ConfigurationFinding, 1U> only_one{};

    EXPECT_EQ(collect_findings(make_view(table), findings), 5U);
    EXPECT_EQ(findings[0].rule, ConfigurationRule::kValueOutsideConstraint);
    EXPECT_EQ(findings[1].rule, ConfigurationRule::kUnknownParameter);
    EXPECT_EQ(findings[2].rule, ConfigurationRule::kSetNamedTwice);
    EXPECT_EQ(findings[3].rule, ConfigurationRule::kValueOutsideConstraint);
    EXPECT_EQ(findings[3].assignment, 1U);
    EXPECT_EQ(findings[4].rule, ConfigurationRule::kValueOutsideConstraint)
        << "a component that cannot be made for the question is asked itself";
    EXPECT_EQ(findings[4].assignment, 0U);
    EXPECT_EQ(findings[5].rule, ConfigurationRule::kNone);
    EXPECT_EQ(collect_findings(make_view(table), only_one), 5U) << "also those without room are counted";
    EXPECT_EQ(collect_findings(make_view(kConfiguration), findings), 0U);
}

}  // namespace
}  // namespace mamori
