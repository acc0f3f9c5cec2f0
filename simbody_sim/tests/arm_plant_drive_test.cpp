// SPDX-License-Identifier: Apache-2.0
// Goal: drives give no more torque than they can, and none at all once it is taken away from them.
#include <algorithm>
#include <limits>

#include "arm_test_support.hpp"
#include "mamori/simbody_sim/computed_torque_controller.hpp"

namespace mamori::sim {
namespace {

using namespace test;

class ArmPlantDriveTest : public ::testing::Test {
  protected:
    ArmPlantDriveTest() { sut_.reset(kBentPose); }

    /// Holds the pose until the brakes are open.
    void hold_for(Duration duration) {
        for (Duration done{}; done < duration; done = done + 1_ms) {
            ASSERT_EQ(sut_.step(hold(), 1_ms), Status::kOk);
        }
    }
    safety::ArmOutputs hold() {
        return command(controller_.calc_torque(kBentPose, {}, {}, sut_.positions(), sut_.velocities()));
    }

    const ArmModel model_ = load_shipped_model();
    ArmPlant sut_{model_};
    ComputedTorqueController controller_{model_};
};

TEST_F(ArmPlantDriveTest, CommandedTorqueIsDeliveredAndMeasured) {
    verifies("SWR-SIM-005");
    const JointVector wanted{1.0, -2.0, 3.0, -4.0, 0.5, -0.25, 0.125};

    ASSERT_EQ(sut_.step(command(wanted), kPlantSubstep), Status::kOk);
    EXPECT_EQ(sut_.torques(), wanted);
    EXPECT_EQ(sut_.sample().measured_torque_nm, wanted);
}

TEST_F(ArmPlantDriveTest, TorqueSaturatesAtItsLimitOnBothSides) {
    verifies("SWR-SIM-005", Technique::kBoundaryValues);
    JointVector wanted{};
    for (std::size_t i = 0U; i < kArmJointCount; ++i) {
        wanted[i] = (i % 2U == 0U ? 1.001 : -1.001) * model_.joints[i].torque_limit_nm;
    }

    ASSERT_EQ(sut_.step(command(wanted), kPlantSubstep), Status::kOk);
    for (std::size_t i = 0U; i < kArmJointCount; ++i) {
        EXPECT_EQ(std::abs(sut_.torques()[i]), model_.joints[i].torque_limit_nm);
        EXPECT_EQ(std::signbit(sut_.torques()[i]), i % 2U != 0U);
    }
}

TEST_F(ArmPlantDriveTest, ATorqueThatIsNoNumberGivesNoTorque) {
    verifies("SWR-SIM-005", Technique::kErrorGuessing);
    JointVector wanted{};
    wanted[0] = std::numeric_limits<double>::quiet_NaN();
    wanted[1] = std::numeric_limits<double>::infinity();
    wanted[2] = 7.0;

    ASSERT_EQ(sut_.step(command(wanted), kPlantSubstep), Status::kOk);
    EXPECT_EQ(sut_.torques(), (JointVector{0.0, 0.0, 7.0}));
}

TEST_F(ArmPlantDriveTest, BackEmfBoundsTheSpeedOfARunawayJoint) {
    verifies("SWR-SIM-005", Technique::kFaultInjection);
    hold_for(100_ms);

    sut_.faults().torque_runaway[0] = 1.0;  // vertical axis: the motor alone drives it
    sut_.faults().torque_runaway[6] = -1.0;
    double fastest_1 = 0.0;
    double fastest_7 = 0.0;
    for (int frame = 0; frame < 600; ++frame) {
        ASSERT_EQ(sut_.step(hold(), 1_ms), Status::kOk);
        fastest_1 = std::max(fastest_1, sut_.velocities()[0]);
        fastest_7 = std::max(fastest_7, -sut_.velocities()[6]);
    }
    EXPECT_GT(fastest_1, 0.9 * model_.joints[0].speed_limit_rad_s);
    EXPECT_LE(fastest_1, model_.joints[0].speed_limit_rad_s);
    EXPECT_GT(fastest_7, 0.9 * model_.joints[6].speed_limit_rad_s);
    EXPECT_LE(fastest_7, model_.joints[6].speed_limit_rad_s);
}

TEST_F(ArmPlantDriveTest, BackEmfDoesNotWeakenABrakingTorque) {
    verifies("SWR-SIM-005", Technique::kBoundaryValues);
    hold_for(100_ms);
    sut_.faults().torque_runaway[0] = 1.0;
    hold_for(400_ms);
    ASSERT_GT(sut_.velocities()[0], 0.5);

    sut_.faults().torque_runaway[0] = -1.0;
    ASSERT_EQ(sut_.step(hold(), kPlantSubstep), Status::kOk);
    EXPECT_EQ(sut_.torques()[0], -model_.joints[0].torque_limit_nm);
}

TEST_F(ArmPlantDriveTest, SafeTorqueOffTakesTorqueAfterItsDelayAndReportsIt) {
    verifies("SWR-SIM-006");
    hold_for(100_ms);
    ASSERT_TRUE(sut_.sample().torque_enabled);
    safety::ArmOutputs off = hold();
    off.torque_enable = false;

    ASSERT_EQ(sut_.step(off, model_.sto_delay), Status::kOk);
    EXPECT_NE(sut_.torques()[1], 0.0) << "the delay is not over";
    ASSERT_EQ(sut_.step(off, kPlantSubstep), Status::kOk);
    EXPECT_EQ(sut_.torques(), JointVector{});
    EXPECT_FALSE(sut_.sample().torque_enabled);
    EXPECT_TRUE(sut_.sample().power_good);
    EXPECT_FALSE(sut_.sample().brake_closed[1]) << "torque off alone leaves the brakes to their command";
}

TEST_F(ArmPlantDriveTest, RunawayCannotPassSafeTorqueOff) {
    verifies("SWR-SIM-006", Technique::kFaultInjection);
    hold_for(100_ms);
    sut_.faults().torque_runaway[0] = 1.0;

    ASSERT_EQ(sut_.step(safety::ArmOutputs{}, model_.sto_delay), Status::kOk);
    EXPECT_GT(sut_.torques()[0], 0.5 * model_.joints[0].torque_limit_nm) << "the delay is not over";
    ASSERT_EQ(sut_.step(safety::ArmOutputs{}, kPlantSubstep), Status::kOk);
    EXPECT_EQ(sut_.torques(), JointVector{});
}

TEST_F(ArmPlantDriveTest, ExpiredWatchdogTakesTorqueAndBrakeCurrentWhateverIsCommanded) {
    verifies("SWR-SIM-006", Technique::kFaultInjection);
    hold_for(100_ms);

    sut_.set_watchdog_expired(true);
    ASSERT_EQ(sut_.step(hold(), model_.sto_delay + kPlantSubstep), Status::kOk);
    EXPECT_EQ(sut_.torques(), JointVector{});
    EXPECT_FALSE(sut_.sample().torque_enabled);
    hold_for(40_ms);
    for (const bool closed : sut_.sample().brake_closed) {
        EXPECT_TRUE(closed);
    }

    sut_.set_watchdog_expired(false);
    ASSERT_EQ(sut_.step(hold(), kPlantSubstep), Status::kOk);
    EXPECT_TRUE(sut_.sample().torque_enabled) << "the relay only interrupts; the latch is the software's";
}

TEST_F(ArmPlantDriveTest, PowerLossTakesTorqueAtOnceAndClosesTheBrakesAfterTheirDelay) {
    verifies("SWR-SIM-006", Technique::kFaultInjection);
    hold_for(100_ms);

    sut_.faults().power_lost = true;
    ASSERT_EQ(sut_.step(hold(), kPlantSubstep), Status::kOk);
    EXPECT_EQ(sut_.torques(), JointVector{});
    EXPECT_FALSE(sut_.sample().power_good);
    EXPECT_FALSE(sut_.sample().torque_enabled);
    ASSERT_EQ(sut_.step(hold(), model_.joints[1].brake.closing_delay - kPlantSubstep), Status::kOk);
    EXPECT_FALSE(sut_.sample().brake_closed[1]);
    ASSERT_EQ(sut_.step(hold(), kPlantSubstep), Status::kOk);
    EXPECT_TRUE(sut_.sample().brake_closed[1]);
}

TEST_F(ArmPlantDriveTest, ButtonsAreShownAsPressed) {
    verifies("SWR-SIM-006", Technique::kInterface);

    sut_.set_buttons(true, false);
    EXPECT_TRUE(sut_.sample().start_button);
    EXPECT_FALSE(sut_.sample().reset_button);
    sut_.set_buttons(false, true);
    EXPECT_FALSE(sut_.sample().start_button);
    EXPECT_TRUE(sut_.sample().reset_button);
    sut_.reset({});
    EXPECT_FALSE(sut_.sample().reset_button);
}

TEST_F(ArmPlantDriveTest, AStuckButtonStaysPushedOnceItIsPushed) {
    verifies("SWR-SIM-012", Technique::kFaultInjection);
    sut_.faults().start_stuck = true;
    sut_.faults().reset_stuck = true;

    sut_.set_buttons(false, false);
    EXPECT_FALSE(sut_.sample().start_button || sut_.sample().reset_button);
    sut_.set_buttons(true, false);
    sut_.set_buttons(false, true);
    sut_.set_buttons(false, false);
    EXPECT_TRUE(sut_.sample().start_button && sut_.sample().reset_button);
}

TEST_F(ArmPlantDriveTest, EachChannelOfAStopIsShown) {
    verifies("SWR-SIM-006", Technique::kInterface);

    EXPECT_TRUE(sut_.sample().emergency_stop_closed[0] && sut_.sample().emergency_stop_closed[1]);
    sut_.faults().emergency_stop_open = {true, false};
    EXPECT_FALSE(sut_.sample().emergency_stop_closed[0]);
    EXPECT_TRUE(sut_.sample().emergency_stop_closed[1]);
    EXPECT_TRUE(sut_.sample().protective_stop_closed[0] && sut_.sample().protective_stop_closed[1]);
    sut_.faults().protective_stop_open = {false, true};
    EXPECT_TRUE(sut_.sample().protective_stop_closed[0]);
    EXPECT_FALSE(sut_.sample().protective_stop_closed[1]);
}

TEST_F(ArmPlantDriveTest, EnablingDeviceHoldToRunButtonAndModeAreShown) {
    verifies("SWR-SIM-006", Technique::kInterface);
    using Contacts = std::array<bool, 3U>;
    const std::array<bool, 2U> closed{true, true};
    const std::array<bool, 2U> open{false, false};

    EXPECT_EQ(sut_.sample().enabling_closed, closed);
    EXPECT_FALSE(sut_.sample().enabling_squeezed);
    EXPECT_TRUE(sut_.sample().run_button);
    EXPECT_EQ(sut_.sample().mode_selected, (Contacts{true, false, false}));
    sut_.faults().enabling_squeezed = true;
    sut_.faults().run_released = true;
    sut_.faults().mode = 2U;
    EXPECT_EQ(sut_.sample().enabling_closed, open);
    EXPECT_TRUE(sut_.sample().enabling_squeezed);
    EXPECT_FALSE(sut_.sample().run_button);
    EXPECT_EQ(sut_.sample().mode_selected, (Contacts{false, false, true}));
    sut_.faults().enabling_squeezed = false;
    sut_.faults().enabling_open = {true, true};
    EXPECT_EQ(sut_.sample().enabling_closed, open);
    EXPECT_FALSE(sut_.sample().enabling_squeezed);
}

TEST_F(ArmPlantDriveTest, AnOpenRelayTakesTorqueAndBrakeCurrentAndItsContactSaysSo) {
    verifies("SWR-SIM-006");
    hold_for(100_ms);
    ASSERT_TRUE(sut_.sample().relay_closed);
    safety::ArmOutputs open = hold();
    open.relay_close = false;

    ASSERT_EQ(sut_.step(open, 40_ms), Status::kOk);
    EXPECT_FALSE(sut_.sample().relay_closed);
    EXPECT_FALSE(sut_.sample().torque_enabled);
    EXPECT_TRUE(sut_.sample().brake_closed[1]);
}

TEST_F(ArmPlantDriveTest, ARelayThatIsStuckStaysClosedOnceItIsClosed) {
    verifies("SWR-SIM-012", Technique::kFaultInjection);
    sut_.faults().relay_stuck = true;
    ASSERT_EQ(sut_.step({}, 1_ms), Status::kOk);
    EXPECT_FALSE(sut_.sample().relay_closed);
    hold_for(100_ms);

    safety::ArmOutputs open = hold();
    open.relay_close = false;
    ASSERT_EQ(sut_.step(open, 40_ms), Status::kOk);
    EXPECT_TRUE(sut_.sample().relay_closed);
    EXPECT_TRUE(sut_.sample().torque_enabled);
    sut_.set_watchdog_expired(true);
    ASSERT_EQ(sut_.step(open, 40_ms), Status::kOk);
    EXPECT_TRUE(sut_.sample().relay_closed);
    EXPECT_FALSE(sut_.sample().torque_enabled) << "the watchdog acts on safe torque off as well";
    EXPECT_TRUE(sut_.sample().brake_closed[1]);
}

TEST_F(ArmPlantDriveTest, DrivesThatIgnoreSafeTorqueOffLoseTheirTorqueByTheRelay) {
    verifies("SWR-SIM-012", Technique::kFaultInjection);
    sut_.faults().sto_ignored = true;
    ASSERT_EQ(sut_.step({}, 1_ms), Status::kOk);
    EXPECT_FALSE(sut_.sample().torque_enabled) << "torque that was never on stays off";
    hold_for(100_ms);
    safety::ArmOutputs off = hold();
    off.torque_enable = false;
    ASSERT_EQ(sut_.step(off, 40_ms), Status::kOk);
    EXPECT_TRUE(sut_.sample().torque_enabled);

    off.relay_close = false;
    ASSERT_EQ(sut_.step(off, 10_ms), Status::kOk);
    EXPECT_FALSE(sut_.sample().torque_enabled);
}

}  // namespace
}  // namespace mamori::sim
