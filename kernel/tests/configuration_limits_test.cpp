// SPDX-License-Identifier: Apache-2.0
// Goal: of several findings in a configuration the first one is told, and an admin shows the table it serves.
// Method: a table that breaks one rule after the other, judged while the program runs.
#include <gtest/gtest.h>

#include "mamori/kernel/parameter/configuration_admin.hpp"
#include "mamori/kernel/parameter/configuration_set.hpp"
#include "mamori/trace/verifies.hpp"
#include "support/configured_components.hpp"

namespace mamori {
namespace {

using testing_support::Axis;
using namespace verification;

Axis g_axis;

TEST(ConfigurationLimitsTest, OfSeveralFindingsTheFirstIsTold) {
    verifies("SWR-PAR-006", Technique::kErrorGuessing, Polarity::kViolation);
    Axis stranger;
    const auto check_with = [&stranger](double speed) {
        const auto table =
            configuration(parameters_of(g_axis),
                          configuration_set("a", assign(g_axis.speed, speed), assign(g_axis.speed, 1.0)),
                          configuration_set("a", assign(stranger.speed, 1.0)));
        return check(make_view(table));
    };

    EXPECT_EQ(check_with(1.0).rule, ConfigurationRule::kParameterAssignedTwice);
    EXPECT_EQ(check_with(1.0).set, 0U);
    EXPECT_EQ(check_with(1.0).assignment, 1U);
}

TEST(ConfigurationLimitsTest, AnAdminShowsTheTableThatItServes) {
    verifies("SWR-PAR-007", Technique::kInterface);
    const auto table =
        configuration(parameters_of(g_axis), configuration_set("only", assign(g_axis.speed, 1.0)));
    const ConfigurationAdmin sut{make_view(table)};

    ASSERT_EQ(sut.get_view().sets.size(), 1U);
    EXPECT_STREQ(sut.get_view().sets[0].name, "only");
    EXPECT_EQ(sut.get_view().parameters.size(), table.parameters.size());
}

}  // namespace
}  // namespace mamori
