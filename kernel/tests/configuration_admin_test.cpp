// SPDX-License-Identifier: Apache-2.0
// Goal: a configuration set becomes active as a whole, at the frame boundary, or not at all; single values
// follow it; the outside may ask at any time. Method: requests and boundaries in every order; a table with a
// value that the compiler could not judge, to show that nothing of a bad set is switched; two threads that
// send requests while cycles run (also under the thread sanitizer).
#include "mamori/kernel/parameter/configuration_admin.hpp"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <thread>

#include "mamori/kernel/base/constant_init.hpp"
#include "mamori/kernel/parameter/configuration_set.hpp"
#include "mamori/trace/verifies.hpp"
#include "mamori/verification/failed_check.hpp"
#include "support/configured_components.hpp"

namespace mamori {
namespace {

using testing_support::Axis;
using testing_support::NamedAxis;
using namespace verification;

Axis g_axis;
NamedAxis g_named{"named"};
Axis g_stranger;
constexpr auto kConfiguration =
    configuration(parameters_of(g_axis, g_named),
                  configuration_set("default", assign(g_axis.speed, 1.0), assign(g_axis.gains, {1, 1, 1}),
                                    assign(g_named.level, 0)),
                  configuration_set("slow", assign(g_axis.speed, 0.5), assign(g_axis.gains, {2, 2, 2})),
                  configuration_set("fast", assign(g_axis.speed, 3.0), assign(g_axis.gains, {3, 3, 3})),
                  configuration_set("bad", assign(g_axis.speed, 2.0), assign(g_axis.gains, {9, 9, 9}),
                                    assign(g_named.level, 11)));
MAMORI_CHECK_CONFIGURATION(kConfiguration);
MAMORI_CONSTINIT ConfigurationAdmin g_admin{make_view(kConfiguration)};

class ConfigurationAdminTest : public ::testing::Test {
  protected:
    ConfigurationAdminTest() {
        EXPECT_EQ(sut_.activate_configuration_set(0U), Status::kOk);
        EXPECT_EQ(sut_.switch_at_frame_boundary(), Status::kOk);
    }
    ConfigurationAdmin sut_{make_view(kConfiguration)};
};

TEST_F(ConfigurationAdminTest, ASetBecomesActiveAtTheBoundaryAsAWhole) {
    verifies("SWR-PAR-007");

    ASSERT_EQ(sut_.activate_configuration_set(1U), Status::kOk);
    EXPECT_EQ(g_axis.speed.get(), 1.0);
    EXPECT_EQ(sut_.get_active_configuration_set(), 0U);
    EXPECT_EQ(sut_.switch_at_frame_boundary(), Status::kOk);
    EXPECT_EQ(g_axis.speed.get(), 0.5);
    EXPECT_EQ(g_axis.gains.get()[2], 2);
    EXPECT_EQ(sut_.get_active_configuration_set(), 1U);
}

TEST_F(ConfigurationAdminTest, ABoundaryWithoutARequestChangesNothing) {
    verifies("SWR-PAR-007", Technique::kStateTransition);

    ASSERT_EQ(sut_.activate_configuration_set(1U), Status::kOk);
    ASSERT_EQ(sut_.switch_at_frame_boundary(), Status::kOk);
    ASSERT_EQ(g_axis.speed.activate(std::array{to_scalar(2.5)}), Status::kOk);
    EXPECT_EQ(sut_.switch_at_frame_boundary(), Status::kOk);
    EXPECT_EQ(g_axis.speed.get(), 2.5);
}

TEST_F(ConfigurationAdminTest, AParameterThatTheSetDoesNotNameKeepsItsValue) {
    verifies("SWR-PAR-007", Technique::kEquivalenceClasses);

    ASSERT_EQ(sut_.set_value(g_named.level, std::int16_t{7}), Status::kOk);
    ASSERT_EQ(sut_.activate_configuration_set(2U), Status::kOk);
    ASSERT_EQ(sut_.switch_at_frame_boundary(), Status::kOk);
    ASSERT_EQ(sut_.activate_configuration_set(1U), Status::kOk);
    ASSERT_EQ(sut_.switch_at_frame_boundary(), Status::kOk);
    EXPECT_EQ(g_named.level.get(), 7);
}

TEST_F(ConfigurationAdminTest, ASetWithOneRefusedValueIsNotSwitchedAtAll) {
    verifies("SWR-PAR-007", Technique::kFaultInjection, Polarity::kViolation);

    ASSERT_EQ(sut_.activate_configuration_set(3U), Status::kOk);
    EXPECT_EQ(sut_.switch_at_frame_boundary(), Status::kBadParameter);
    EXPECT_EQ(g_axis.speed.get(), 1.0);
    EXPECT_EQ(g_axis.gains.get()[0], 1);
    EXPECT_EQ(g_named.level.get(), 0);
    EXPECT_EQ(sut_.get_active_configuration_set(), 0U);
    EXPECT_EQ(sut_.get_last_finding().rule, ConfigurationRule::kValueOutsideConstraint);
    EXPECT_EQ(sut_.get_last_finding().set, 3U);
    EXPECT_EQ(sut_.get_last_finding().assignment, 2U);
    EXPECT_EQ(sut_.switch_at_frame_boundary(), Status::kOk) << "the request is gone";
}

TEST_F(ConfigurationAdminTest, AnInitialSetIsActiveFromTheFirstBoundaryOn) {
    verifies("SWR-PAR-007", Technique::kStateTransition);
    ConfigurationAdmin with_initial_set{make_view(kConfiguration), 2U};

    EXPECT_EQ(with_initial_set.get_active_configuration_set(), kNoConfigurationSet);
    EXPECT_EQ(with_initial_set.switch_at_frame_boundary(), Status::kOk);
    EXPECT_EQ(with_initial_set.get_active_configuration_set(), 2U);
    EXPECT_EQ(g_axis.speed.get(), 3.0);
    EXPECT_EQ(g_admin.get_active_configuration_set(), kNoConfigurationSet);
}

TEST_F(ConfigurationAdminTest, OfSeveralRequestsForASetTheLastOneCounts) {
    verifies("SWR-PAR-008", Technique::kStateTransition);

    ASSERT_EQ(sut_.activate_configuration_set(make_text("slow")), Status::kOk);
    ASSERT_EQ(sut_.activate_configuration_set(make_text("fast")), Status::kOk);
    ASSERT_EQ(sut_.switch_at_frame_boundary(), Status::kOk);
    EXPECT_EQ(g_axis.speed.get(), 3.0);
    EXPECT_EQ(sut_.get_active_configuration_set(), 2U);
}

TEST_F(ConfigurationAdminTest, ARequestForASetThatDoesNotExistIsRefusedAndLeavesAnEarlierOneAlone) {
    verifies("SWR-PAR-008", Technique::kBoundaryValues, Polarity::kViolation);

    ASSERT_EQ(sut_.activate_configuration_set(1U), Status::kOk);
    EXPECT_EQ(sut_.activate_configuration_set(4U), Status::kBadParameter);
    EXPECT_EQ(sut_.activate_configuration_set(kNoConfigurationSet), Status::kBadParameter);
    EXPECT_EQ(sut_.activate_configuration_set(std::size_t{1} << 32U), Status::kBadParameter);
    for (const char* name : {"", "slo", "slower", "SLOW"}) {
        EXPECT_EQ(sut_.activate_configuration_set(make_text(name)), Status::kBadParameter) << name;
    }
    ASSERT_EQ(sut_.switch_at_frame_boundary(), Status::kOk);
    EXPECT_EQ(sut_.get_active_configuration_set(), 1U);
}

TEST_F(ConfigurationAdminTest, RequestsFromOtherThreadsNeverShowHalfASet) {
    verifies("SWR-PAR-008", Technique::kFaultInjection, Polarity::kViolation);
    std::atomic<bool> is_done{false};
    std::thread requester{[this, &is_done] {
        for (std::size_t i = 0U; !is_done.load(); ++i) {
            EXPECT_EQ(sut_.activate_configuration_set(1U + i % 2U), Status::kOk);
        }
    }};
    std::thread second{[this, &is_done] {
        for (int i = 0; !is_done.load(); ++i) {
            const Status status = sut_.set_value(g_named.level, static_cast<std::int16_t>(i % 21 - 10));
            EXPECT_TRUE(status == Status::kOk || status == Status::kPreconditionNotMet);
            EXPECT_EQ(sut_.set_value(g_named.level, std::int16_t{11}), Status::kBadParameter);
            static_cast<void>(sut_.get_active_configuration_set());
        }
    }};

    int switch_count = 0;
    while (switch_count < 1000) {
        const std::size_t before = sut_.get_active_configuration_set();
        ASSERT_EQ(sut_.switch_at_frame_boundary(), Status::kOk);
        switch_count += sut_.get_active_configuration_set() != before ? 1 : 0;
        const double speed = g_axis.speed.get();
        const std::int16_t level = g_named.level.get();
        ASSERT_TRUE((speed == 1.0 && g_axis.gains.get()[1] == 1) ||
                    (speed == 0.5 && g_axis.gains.get()[1] == 2) ||
                    (speed == 3.0 && g_axis.gains.get()[1] == 3));
        ASSERT_EQ(g_named.level.get(), level) << "nothing changes between two boundaries";
        ASSERT_EQ(g_axis.speed.get(), speed);
    }
    is_done = true;
    requester.join();
    second.join();
}

TEST_F(ConfigurationAdminTest, SingleValuesBecomeActiveAtTheBoundaryAfterTheSet) {
    verifies("SWR-PAR-009");

    ASSERT_EQ(sut_.set_value(g_axis.speed, 2.0), Status::kOk);
    ASSERT_EQ(sut_.set_value(g_named.level, std::array{to_scalar(-10)}), Status::kOk);
    ASSERT_EQ(sut_.activate_configuration_set(1U), Status::kOk);
    EXPECT_EQ(g_axis.speed.get(), 1.0);
    ASSERT_EQ(sut_.switch_at_frame_boundary(), Status::kOk);
    EXPECT_EQ(g_axis.speed.get(), 2.0);
    EXPECT_EQ(g_axis.gains.get()[0], 2);
    EXPECT_EQ(g_named.level.get(), -10);
}

TEST_F(ConfigurationAdminTest, ASingleValueIsSwitchedBesideARefusedSet) {
    verifies("SWR-PAR-009", Technique::kErrorGuessing);

    ASSERT_EQ(sut_.set_value(g_named.level, std::int16_t{10}), Status::kOk);
    ASSERT_EQ(sut_.activate_configuration_set(3U), Status::kOk);
    EXPECT_EQ(sut_.switch_at_frame_boundary(), Status::kBadParameter);
    EXPECT_EQ(g_named.level.get(), 10);
}

TEST_F(ConfigurationAdminTest, ASingleValueOutsideItsConstraintIsRefusedAtOnce) {
    verifies("SWR-PAR-009", Technique::kBoundaryValues, Polarity::kViolation);

    EXPECT_EQ(sut_.set_value(g_axis.speed, 3.1), Status::kBadParameter);
    EXPECT_EQ(sut_.set_value(g_axis.speed, std::array{to_scalar(0.4)}), Status::kBadParameter);
    EXPECT_EQ(sut_.set_value(g_axis.speed, std::array{to_scalar(1)}), Status::kBadParameter);
    EXPECT_EQ(sut_.set_value(g_stranger.speed, 1.0), Status::kBadParameter);
    EXPECT_EQ(sut_.set_value(g_stranger.speed, std::array{to_scalar(1.0)}), Status::kBadParameter);
    ASSERT_EQ(sut_.switch_at_frame_boundary(), Status::kOk);
    EXPECT_EQ(g_axis.speed.get(), 1.0);
}

TEST_F(ConfigurationAdminTest, ParametersAreFoundByTheNamesOfComponentAndParameter) {
    verifies("SWR-PAR-009", Technique::kEquivalenceClasses, Polarity::kViolation);

    EXPECT_EQ(sut_.find(make_text("axis"), make_text("gains")).get_value(), &g_axis.gains);
    EXPECT_EQ(sut_.find(make_text("named"), make_text("level")).get_value(), &g_named.level);
    EXPECT_EQ(sut_.find(make_text("axis"), make_text("level")).get_status(), Status::kBadParameter);
    EXPECT_EQ(sut_.find(make_text("other"), make_text("speed")).get_status(), Status::kBadParameter);
}

TEST(ConfigurationAdminDeathTest, AnInitialSetThatDoesNotExistIsAnOwnBug) {
    verifies("SWR-PAR-007", Technique::kBoundaryValues, Polarity::kViolation);

    EXPECT_CHECK_FAILS(static_cast<void>(ConfigurationAdmin(make_view(kConfiguration), 4U)),
                       "configuration_admin.hpp", 1);
}

}  // namespace
}  // namespace mamori
