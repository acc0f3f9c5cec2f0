// SPDX-License-Identifier: Apache-2.0
// Goal: a message that no component has written permits nothing and demands nothing. Method: each default
// value.
#include "messages.hpp"

#include <gtest/gtest.h>

#include "mamori/trace/verifies.hpp"

namespace safe_arm {
namespace {

using mamori::safety::SafeState;
using namespace mamori::verification;

TEST(MessagesTest, ReadingThatWasNeverTakenShowsAMachineAtRest) {
    verifies("SWR-SAF-004");
    const JointReading reading{};

    EXPECT_TRUE(reading.brakes_closed);
    EXPECT_FALSE(reading.brakes_open || reading.torque_enabled || reading.relay_closed);
    EXPECT_FALSE(reading.power_good || reading.start_button || reading.reset_button);
    EXPECT_EQ(reading.drive_clock_ns, 0);
    EXPECT_EQ(reading.panel_faults, 0U);
}

TEST(MessagesTest, StateThatWasNeverJudgedPermitsNoStart) {
    verifies("SWR-SAF-007");
    const JointState state{};

    EXPECT_EQ(state.faults, 0U);
    EXPECT_FALSE(state.is_standing || state.is_clock_checked || state.is_setpoint_near);
}

TEST(MessagesTest, DecisionThatWasNeverMadeGivesNoTorque) {
    verifies("SWR-SAF-009");
    const StopCommand decision{};
    EXPECT_EQ(decision.state, SafeState::kSelfTest);
    EXPECT_FALSE(decision.torque_enable || decision.brake_release || decision.relay_close);
    EXPECT_FALSE(decision.stop_requested);
    EXPECT_EQ(decision.brake_test_share, 0.0);

    const DriveCommand given{};
    EXPECT_FALSE(given.torque_enable || given.brake_release || given.relay_close);
}

TEST(MessagesTest, CommandThatWasNeverSentHasNoAge) {
    verifies("SWR-SAF-001");
    const TorqueCommand command{};

    EXPECT_EQ(command.sequence, 0U);
    EXPECT_EQ(command.sent_at_ns, 0);
}

}  // namespace
}  // namespace safe_arm
