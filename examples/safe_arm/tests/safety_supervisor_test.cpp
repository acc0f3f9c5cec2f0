// SPDX-License-Identifier: Apache-2.0
// Goal: one place turns observations into the declared reaction, starts only on purpose, and serves the
// watchdog on proven health only. Method: frame after frame with readings, monitor results and component runs
// made here.
#include "safety_supervisor.hpp"

#include "mamori/trace/verifies.hpp"
#include "safety_supervisor_fixture.hpp"

namespace safe_arm {
namespace {

using mamori::Duration;
using mamori::Instant;
using mamori::Status;
using mamori::safety::SafeState;
using mamori::safety::SelfTestStatus;
using namespace mamori::verification;

using SafetySupervisorTest = SafetySupervisorFixture;

TEST_F(SafetySupervisorTest, PassedSelfTestAndDeliberateStartLeadToOperation) {
    verifies("SWR-SAF-014", Technique::kStateTransition);

    const StopCommand command = operate();
    EXPECT_EQ(command.state, SafeState::kOperational);
    EXPECT_TRUE(command.torque_enable);
    EXPECT_TRUE(command.brake_release);
}

TEST_F(SafetySupervisorTest, SelfTestNeedsItsGoodFramesInARow) {
    verifies("SWR-SAF-014", Technique::kBoundaryValues, Polarity::kViolation);
    const auto count_frames = [this](int disturbed) {
        int frames = 0;
        for (; sut_.get_state() == SafeState::kSelfTest && frames < 400; ++frames) {
            reading_.brakes_closed = frames != disturbed;
            step();
        }
        return frames;
    };
    EXPECT_EQ(count_frames(30), 30 + static_cast<int>(kSelfTestFrames) + 105)
        << "then the tests of the devices";
    EXPECT_EQ(sut_.get_state(), SafeState::kStandby);
}

TEST_F(SafetySupervisorTest, SelfTestThatNeverPassesLocksOut) {
    verifies("SWR-SAF-014", Technique::kFaultInjection, Polarity::kViolation);
    watchdog_.answer = Status::kError;

    step_until(SafeState::kLockedOut, 600);
    EXPECT_EQ(sut_.get_state(), SafeState::kLockedOut);
    EXPECT_EQ(sut_.get_first_fault(), to_index(ArmFault::kSelfTestFailed));
}

TEST_F(SafetySupervisorTest, SelfTestDoesNotPassBeforeTheWatchdogIsServed) {
    verifies("SWR-SAF-014", Technique::kFaultInjection, Polarity::kViolation);
    // A watchdog that was never served has not begun to watch: nothing would open the relay.
    supervision_.on_budget_overrun(0U, kOther, now_);

    step_until(SafeState::kStandby, 600);
    EXPECT_EQ(watchdog_.services, 0);
    EXPECT_EQ(sut_.get_state(), SafeState::kLockedOut);
}

TEST_F(SafetySupervisorTest, StartIsRefusedWhileTheWatchdogIsNotServed) {
    verifies("SWR-SAF-014", Technique::kFaultInjection, Polarity::kViolation);
    step_until(SafeState::kStandby, 400);
    watchdog_.answer = Status::kError;
    step();

    reading_.start_button = true;
    EXPECT_EQ(step().state, SafeState::kStandby);
}

TEST_F(SafetySupervisorTest, StartIsRefusedWithoutItsPreconditions) {
    verifies("SWR-SAF-014", Technique::kErrorGuessing, Polarity::kViolation);
    reading_.start_button = true;
    step_until(SafeState::kStandby, 400);
    EXPECT_EQ(step().state, SafeState::kStandby) << "held since power-up: no edge";
    reading_.start_button = false;
    step();
    state_.is_setpoint_near = false;
    reading_.start_button = true;
    EXPECT_EQ(step().state, SafeState::kStandby) << "setpoint away from the measured position";
    state_.is_setpoint_near = true;
    EXPECT_EQ(step().state, SafeState::kStandby) << "the push of the frame before counts for nothing";
}

TEST_F(SafetySupervisorTest, StartWaitsForTheComparisonOfBothClocks) {
    verifies("SWR-SAF-047", Technique::kStateTransition);
    state_.is_clock_checked = false;
    step_until(SafeState::kStandby, 400);
    reading_.start_button = true;
    EXPECT_EQ(step().state, SafeState::kStandby);
    reading_.start_button = false;
    state_.is_clock_checked = true;
    step();
    reading_.start_button = true;
    EXPECT_EQ(step().state, SafeState::kOperational);
}

TEST_F(SafetySupervisorTest, FaultStopsTorqueInTheSameFrameAndStaysLatched) {
    verifies("SWR-SAF-013", Technique::kFaultInjection, Polarity::kViolation);
    operate();

    state_.faults = to_bit(ArmFault::kPowerLost);
    EXPECT_FALSE(step().torque_enable);
    EXPECT_EQ(sut_.get_state(), SafeState::kSafe);
    state_.faults = 0U;
    EXPECT_EQ(step().state, SafeState::kSafe);
    EXPECT_EQ(sut_.get_first_fault(), to_index(ArmFault::kPowerLost));
    EXPECT_EQ(sut_.get_reaction(), mamori::safety::Reaction::kSto);
}

TEST_F(SafetySupervisorTest, FaultFreeOperationGoesOn) {
    verifies("SWR-SAF-013");
    operate();

    for (int i = 0; i < 100; ++i) {
        EXPECT_EQ(step().state, SafeState::kOperational);
    }
    EXPECT_EQ(sut_.get_reaction(), mamori::safety::Reaction::kNone);
}

TEST_F(SafetySupervisorTest, FaultIsLatchedAfterItsConfirmationAndNotBefore) {
    verifies("SWR-SAF-013", Technique::kBoundaryValues, Polarity::kViolation);
    operate();
    state_.faults = to_bit(ArmFault::kTorqueDeviation);
    step();
    ASSERT_EQ(step().state, SafeState::kOperational);
    state_.faults = 0U;
    step();
    state_.faults = to_bit(ArmFault::kTorqueDeviation);
    step();
    ASSERT_EQ(step().state, SafeState::kOperational);

    EXPECT_EQ(step().state, SafeState::kSafe);
}

TEST_F(SafetySupervisorTest, ControlledStopEndsSafeWhenItIsConfirmed) {
    verifies("SWR-SAF-013", Technique::kStateTransition);
    operate();
    state_.is_standing = false;
    state_.faults = to_bit(ArmFault::kEncoderImplausible);
    const StopCommand command = step();
    EXPECT_EQ(command.state, SafeState::kProtectiveStopSs1);
    EXPECT_TRUE(command.torque_enable);
    EXPECT_TRUE(command.stop_requested);

    state_.is_standing = true;
    EXPECT_EQ(step().state, SafeState::kProtectiveStopSs1) << "the brakes close";
    reading_.brakes_closed = true;
    EXPECT_EQ(step().state, SafeState::kSafe);
}

TEST_F(SafetySupervisorTest, ContactsStuckAtClosedConfirmNoStopBeforeTheClosingTime) {
    verifies("SWR-SAF-018", Technique::kFaultInjection, Polarity::kViolation);
    operate();
    reading_.brakes_closed = true;
    state_.faults = to_bit(ArmFault::kEncoderImplausible);
    for (std::int64_t i = 0; i <= kBrakes.closes_within.ns / kFrame.ns; ++i) {
        ASSERT_TRUE(step().torque_enable) << i;
    }

    EXPECT_FALSE(step().torque_enable);
}

TEST_F(SafetySupervisorTest, BrakesCloseUnderTorqueBeforeItIsSwitchedOff) {
    verifies("SWR-SAF-018", Technique::kStateTransition);
    operate();
    state_.is_standing = false;
    state_.faults = to_bit(ArmFault::kEncoderImplausible);
    EXPECT_TRUE(step().brake_release);

    state_.is_standing = true;
    const StopCommand closing = step();
    EXPECT_EQ(closing.state, SafeState::kProtectiveStopSs1);
    EXPECT_TRUE(closing.torque_enable);
    EXPECT_FALSE(closing.brake_release);
    state_.is_standing = false;
    EXPECT_FALSE(step().brake_release) << "a twitch does not open them again";
    state_.is_standing = true;
    reading_.brakes_closed = true;
    EXPECT_FALSE(step().torque_enable);
}

TEST_F(SafetySupervisorTest, BrakesThatNeverReportEndInALockedHold) {
    verifies("SWR-SAF-028", Technique::kFaultInjection);
    operate();
    state_.faults = to_bit(ArmFault::kEncoderImplausible);
    for (std::int64_t i = 0; i <= kBrakes.closes_within.ns / kFrame.ns + 1; ++i) {
        const StopCommand stopping = step();
        ASSERT_TRUE(stopping.torque_enable) << i;
        ASSERT_EQ(stopping.torque_source, TorqueSource::kStopLoop);
    }

    const StopCommand held = step();
    EXPECT_EQ(held.state, SafeState::kLockedHold);
    EXPECT_TRUE(held.torque_enable && held.relay_close && !held.brake_release);
    EXPECT_EQ(held.torque_source, TorqueSource::kStopLoop);
    state_.faults = 0U;
    for (int i = 0; i < 10; ++i) {
        reading_.reset_button = i % 2 == 0;
        ASSERT_EQ(step().state, SafeState::kLockedHold) << "no reset ends it";
    }
}

TEST_F(SafetySupervisorTest, AnArmThatLeavesItsLockedHoldLosesTorqueByBothPaths) {
    verifies("SWR-SAF-028", Technique::kFaultInjection, Polarity::kViolation);
    operate();
    state_.faults = to_bit(ArmFault::kEncoderImplausible);
    step_until(SafeState::kLockedHold, 200);
    ASSERT_EQ(sut_.get_state(), SafeState::kLockedHold);

    state_.faults = to_bit(ArmFault::kStopNotFollowed);
    const StopCommand command = step();
    EXPECT_EQ(command.state, SafeState::kLockedOut);
    EXPECT_FALSE(command.torque_enable);
    EXPECT_FALSE(command.relay_close);
}

TEST_F(SafetySupervisorTest, ABrakeTestThatIsTooOldStopsTheArmUntilThePassOfANewOne) {
    verifies("SWR-SAF-027", Technique::kBoundaryValues, Polarity::kViolation);
    step_until(SafeState::kStandby, 400);
    const Instant tested_at = now_ - kFrame;
    now_ = tested_at + kBrakeTestInterval;
    EXPECT_EQ(step().state, SafeState::kStandby) << "the clock jumps here; what runs in each frame expires";
    EXPECT_EQ(step().state, SafeState::kSafe);
    EXPECT_TRUE(safety_.get_faults().is_latched(to_index(ArmFault::kBrakeTestOld)));
    step();
    reading_.reset_button = true;
    EXPECT_EQ(step().state, SafeState::kSelfTest) << "the reset is accepted, and begins a new test";
}

TEST_F(SafetySupervisorTest, ControlledStopThatIsIgnoredBecomesTorqueOff) {
    verifies("SWR-SAF-013", Technique::kFaultInjection, Polarity::kViolation);
    operate();
    state_.is_standing = false;
    state_.faults = to_bit(ArmFault::kEncoderImplausible);
    const auto bound = kStopBounds.ss1_within.ns / kFrame.ns;
    for (std::int64_t i = 0; i < bound; ++i) {
        ASSERT_EQ(step().state, SafeState::kProtectiveStopSs1) << i;
    }

    EXPECT_EQ(step().state, SafeState::kSafe);
}

TEST_F(SafetySupervisorTest, SeverestOfSeveralFaultsDecides) {
    verifies("SWR-SAF-013", Technique::kEquivalenceClasses, Polarity::kViolation);
    operate();
    state_.is_standing = false;

    state_.faults = to_bit(ArmFault::kEncoderImplausible) | to_bit(ArmFault::kEncoderStuck);
    EXPECT_EQ(step().state, SafeState::kSafe);
}

TEST_F(SafetySupervisorTest, SilentControllerIsAFaultAndLeavesTheWatchdogServed) {
    verifies("SWR-SAF-013", Technique::kFaultInjection, Polarity::kViolation);
    operate();
    is_controller_running_ = false;
    supervision_.on_budget_overrun(1U, kController, now_);
    const int before = watchdog_.services;

    EXPECT_EQ(step().state, SafeState::kProtectiveStopSs1) << "the gate stops the arm by itself";
    EXPECT_EQ(sut_.get_first_fault(), to_index(ArmFault::kControllerSilent));
    EXPECT_EQ(watchdog_.services, before + 1);
}

TEST_F(SafetySupervisorTest, AnEmergencyStopStopsTheArmAndAResetNeedsItsRelease) {
    verifies("SWR-SAF-030", Technique::kStateTransition);
    operate();
    reading_.panel_faults = to_bit(ArmFault::kEmergencyStop);
    EXPECT_EQ(step().state, SafeState::kProtectiveStopSs1);
    step();  // told to close
    reading_.brakes_closed = true;
    reading_.torque_enabled = false;
    step();
    ASSERT_EQ(step().state, SafeState::kSafe);
    reading_.reset_button = true;
    EXPECT_EQ(step().state, SafeState::kSafe) << "it is still pushed";
    reading_.reset_button = false;
    reading_.panel_faults = 0U;
    EXPECT_EQ(step().state, SafeState::kSafe) << "its release starts nothing";

    reading_.reset_button = true;
    EXPECT_EQ(step().state, SafeState::kSelfTest);
}

TEST_F(SafetySupervisorTest, AStopBesideAnUnknownPositionIsNotLateWhileTorqueCarriesTheArm) {
    verifies("SWR-SAF-051", Technique::kErrorGuessing);
    ASSERT_EQ(operate().state, SafeState::kOperational);
    reading_.panel_faults = to_bit(ArmFault::kEmergencyStop);
    state_.faults = to_bit(ArmFault::kEncoderDiscrepancy);
    state_.is_standing = false;
    step_until(SafeState::kSafe, 4);
    for (int i = 0; i < 50; ++i) {
        const StopCommand command = step();
        ASSERT_TRUE(command.torque_enable && !command.brake_release) << i;
        ASSERT_EQ(command.torque_source, TorqueSource::kCarry) << i;
    }
    reading_.brakes_closed = true;
    step();
    EXPECT_FALSE(step().torque_enable);
}

TEST_F(SafetySupervisorTest, AFailedSwitchRefusesTheStart) {
    verifies("SWR-SAF-031", Technique::kFaultInjection, Polarity::kViolation);
    step_until(SafeState::kStandby, 400);
    reading_.panel_faults = to_bit(ArmFault::kSwitchDiscrepancy);
    step();

    reading_.start_button = true;
    EXPECT_EQ(step().state, SafeState::kSafe);
}

TEST_F(SafetySupervisorTest, AProtectiveStopHoldsTheArmUntilItIsClosedAndStartIsPushed) {
    verifies("SWR-SAF-033", Technique::kStateTransition);
    operate();
    reading_.panel_faults = to_bit(ArmFault::kProtectiveStop);
    EXPECT_EQ(step().state, SafeState::kProtectiveStopSs2);
    const StopCommand held = step();
    EXPECT_EQ(held.state, SafeState::kStandstillHold);
    EXPECT_TRUE(held.torque_enable && held.brake_release);
    EXPECT_EQ(held.torque_source, TorqueSource::kStopLoop);
    reading_.panel_faults = 0U;
    for (int i = 0; i < 10; ++i) {
        ASSERT_EQ(step().state, SafeState::kStandstillHold) << "its end starts nothing";
    }

    reading_.start_button = true;
    const StopCommand between = step();
    reading_.start_button = false;
    EXPECT_EQ(between.state, SafeState::kStandby);
    EXPECT_TRUE(between.torque_enable);
    EXPECT_EQ(between.torque_source, TorqueSource::kStopLoop) << "the gate still holds the arm";
    const StopCommand started = step();
    EXPECT_EQ(started.state, SafeState::kOperational);
    EXPECT_EQ(started.torque_source, TorqueSource::kController);
    EXPECT_EQ(step().state, SafeState::kOperational);
}

TEST_F(SafetySupervisorTest, ALostEnableHoldsTheArmUntilStartAndNeedsNoResetInStandby) {
    verifies("SWR-SAF-035", Technique::kStateTransition);
    step_until(SafeState::kStandby, 400);
    reading_.mode = OperatingMode::kHoldToRun;
    reading_.panel_faults = to_bit(ArmFault::kEnableLost);
    EXPECT_EQ(step().state, SafeState::kStandby);
    reading_.panel_faults = 0U;
    step();
    EXPECT_EQ(operate().mode, OperatingMode::kHoldToRun);
    reading_.panel_faults = to_bit(ArmFault::kEnableLost);
    step();
    EXPECT_EQ(step().state, SafeState::kStandstillHold);
    reading_.panel_faults = 0U;
    EXPECT_EQ(step().state, SafeState::kStandstillHold);

    reading_.start_button = true;
    step();
    reading_.start_button = false;
    EXPECT_EQ(step().state, SafeState::kOperational);
}

TEST_F(SafetySupervisorTest, AChangeOfTheModeNeedsResetAndStart) {
    verifies("SWR-SAF-036", Technique::kStateTransition, Polarity::kViolation);
    step_until(SafeState::kStandby, 400);
    reading_.panel_faults = to_bit(ArmFault::kModeSelector);
    EXPECT_EQ(step().state, SafeState::kSafe);
    reading_.panel_faults = 0U;
    reading_.start_button = true;
    EXPECT_EQ(step().state, SafeState::kSafe);
    reading_.reset_button = true;
    EXPECT_EQ(step().state, SafeState::kSelfTest);
}

TEST_F(SafetySupervisorTest, TheSystemMayFollowTheSelectorInTheSelfTest) {
    verifies("SWR-SAF-062", Technique::kStateTransition);
    reading_.is_mode_changing = true;
    step();
    step();
    reading_.is_mode_changing = false;
    step_until(SafeState::kStandby, 400);
    EXPECT_EQ(sut_.get_state(), SafeState::kStandby) << "no fault of the self test";
    EXPECT_EQ(operate().state, SafeState::kOperational);
}

TEST_F(SafetySupervisorTest, ASystemThatDoesNotFollowTheSelectorIsAFaultAfterTheSelfTest) {
    verifies("SWR-SAF-062", Technique::kFaultInjection, Polarity::kViolation);
    reading_.is_mode_changing = true;
    for (int i = 0; i < 400; ++i) {
        ASSERT_FALSE(step().brake_release) << i;
    }
    EXPECT_EQ(sut_.get_state(), SafeState::kSafe);
    EXPECT_EQ(sut_.get_first_fault(), to_index(ArmFault::kModeSelector));
}

TEST_F(SafetySupervisorTest, ATurnedSelectorStopsAMovingArmInEachMode) {
    verifies("SWR-SAF-062", Technique::kStateTransition, Polarity::kViolation);
    for (const OperatingMode mode :
         {OperatingMode::kHoldToRun, OperatingMode::kReducedSpeed, OperatingMode::kAutomatic}) {
        reading_.mode = mode;
        ASSERT_EQ(operate().state, SafeState::kOperational);
        reading_.is_mode_changing = true;
        state_.is_standing = false;
        EXPECT_EQ(step().state, SafeState::kProtectiveStopSs1);
        state_.is_standing = true;
        reading_.brakes_closed = true;
        reading_.torque_enabled = false;
        step_until(SafeState::kSafe, 400);
        reading_.is_mode_changing = false;
        reading_.reset_button = true;
        step();
        reading_.reset_button = false;
    }
}

TEST_F(SafetySupervisorTest, AStartWhileTheModeChangesIsRejectedUntilAReset) {
    verifies("SWR-SAF-062", Technique::kStateTransition, Polarity::kViolation);
    step_until(SafeState::kStandby, 400);
    reading_.is_mode_changing = true;
    reading_.start_button = true;
    EXPECT_EQ(step().state, SafeState::kSafe);
    reading_.is_mode_changing = false;
    reading_.start_button = false;
    EXPECT_EQ(step().state, SafeState::kSafe);
    reading_.start_button = true;
    EXPECT_EQ(step().state, SafeState::kSafe);
    reading_.reset_button = true;
    EXPECT_EQ(step().state, SafeState::kSelfTest);
}

TEST_F(SafetySupervisorTest, AFailedSelectorEndsTheSelfTestAndAFailedModeSwitchStopsTheArm) {
    verifies("SWR-SAF-062", Technique::kFaultInjection, Polarity::kViolation);
    step();
    reading_.panel_faults = to_bit(ArmFault::kModeSelector);
    EXPECT_EQ(step().state, SafeState::kSafe) << "before any torque against the brakes";
    reading_.panel_faults = 0U;
    reading_.reset_button = true;
    step();
    reading_.reset_button = false;
    ASSERT_EQ(operate().state, SafeState::kOperational);
    state_.is_standing = false;
    reading_.mode = OperatingMode::kSwitchFailed;
    reading_.panel_faults = to_bit(ArmFault::kModeSelector);
    EXPECT_EQ(step().state, SafeState::kProtectiveStopSs1);
}

TEST_F(SafetySupervisorTest, AControlThatTheModeDoesNotNeedNeitherStopsTheArmNorPreventsItsStart) {
    verifies("SWR-SAF-063", Technique::kEquivalenceClasses);
    reading_.panel_faults =
        to_bit(ArmFault::kEnableLost) | to_bit(ArmFault::kEnablingSqueezed) | to_bit(ArmFault::kRunReleased);
    ASSERT_EQ(operate().state, SafeState::kOperational);
    for (int i = 0; i < 10; ++i) {
        EXPECT_EQ(step().state, SafeState::kOperational);
    }
    reading_.mode = OperatingMode::kReducedSpeed;
    reading_.panel_faults = to_bit(ArmFault::kRunReleased);
    EXPECT_EQ(step().state, SafeState::kOperational);
    EXPECT_EQ(sut_.get_first_fault(), mamori::safety::kNoFault);
}

TEST_F(SafetySupervisorTest, AControlThatTheModeNeedsStopsTheArmAndPreventsItsStart) {
    verifies("SWR-SAF-063", Technique::kEquivalenceClasses, Polarity::kViolation);
    for (const OperatingMode mode : {OperatingMode::kHoldToRun, OperatingMode::kReducedSpeed}) {
        reading_.mode = mode;
        step_until(SafeState::kStandby, 400);
        reading_.panel_faults = to_bit(ArmFault::kEnableLost);
        reading_.start_button = true;
        EXPECT_EQ(step().state, SafeState::kStandby);
        reading_.start_button = false;
        reading_.panel_faults = 0U;
        step();
        ASSERT_EQ(operate().state, SafeState::kOperational);
        reading_.panel_faults = to_bit(ArmFault::kEnablingSqueezed);
        state_.is_standing = false;
        EXPECT_EQ(step().state, SafeState::kProtectiveStopSs1);
        state_.is_standing = true;
        reading_.brakes_closed = true;
        reading_.torque_enabled = false;
        step_until(SafeState::kSafe, 400);
        reading_.panel_faults = 0U;
        reading_.reset_button = true;
        step();
        reading_.reset_button = false;
    }
    reading_.mode = OperatingMode::kHoldToRun;
    ASSERT_EQ(operate().state, SafeState::kOperational);
    reading_.panel_faults = to_bit(ArmFault::kRunReleased);
    EXPECT_EQ(step().state, SafeState::kProtectiveStopSs2);
}

TEST_F(SafetySupervisorTest, AModeThatIsNoneDemandsStoForEachFault) {
    verifies("SWR-SAF-063", Technique::kBoundaryValues, Polarity::kViolation);
    ASSERT_EQ(operate().state, SafeState::kOperational);
    reading_.mode = static_cast<OperatingMode>(4U);
    reading_.panel_faults = to_bit(ArmFault::kRunReleased);

    EXPECT_EQ(step().state, SafeState::kSafe);
}

TEST_F(SafetySupervisorTest, StartDoesNothingWhileTheProtectiveStopIsOpen) {
    verifies("SWR-SAF-033", Technique::kErrorGuessing, Polarity::kViolation);
    step_until(SafeState::kStandby, 400);
    reading_.panel_faults = to_bit(ArmFault::kProtectiveStop);
    reading_.start_button = true;
    EXPECT_EQ(step().state, SafeState::kStandby) << "and needs no reset";
    reading_.panel_faults = 0U;
    reading_.start_button = false;
    EXPECT_EQ(step().state, SafeState::kStandby);
    operate();
    reading_.panel_faults = to_bit(ArmFault::kProtectiveStop);
    step_until(SafeState::kStandstillHold, 3);

    for (int i = 0; i < 10; ++i) {
        reading_.start_button = i % 2 == 0;
        reading_.reset_button = i % 3 == 0;
        ASSERT_EQ(step().state, SafeState::kStandstillHold) << i;
    }
}

TEST_F(SafetySupervisorTest, AnEmergencyStopDuringAHoldNeedsItsReset) {
    verifies("SWR-SAF-033", Technique::kStateTransition, Polarity::kViolation);
    operate();
    reading_.panel_faults = to_bit(ArmFault::kProtectiveStop);
    step_until(SafeState::kStandstillHold, 3);
    reading_.panel_faults |= to_bit(ArmFault::kEmergencyStop);
    EXPECT_EQ(step().state, SafeState::kProtectiveStopSs1);
    step();
    reading_.brakes_closed = true;
    reading_.torque_enabled = false;
    step_until(SafeState::kSafe, 3);
    reading_.panel_faults = 0U;
    step();

    reading_.start_button = true;
    EXPECT_EQ(step().state, SafeState::kSafe) << "start is no reset there";
    reading_.start_button = false;
    EXPECT_EQ(step().state, SafeState::kSafe);
}

TEST_F(SafetySupervisorTest, ReaderThatFallsSilentStopsTorqueInItsFrame) {
    verifies("SWR-SAF-019", Technique::kFaultInjection, Polarity::kViolation);
    operate();

    is_reader_running_ = false;
    EXPECT_FALSE(step().torque_enable);
    EXPECT_EQ(sut_.get_first_fault(), to_index(ArmFault::kMeasurementStale));
}

TEST_F(SafetySupervisorTest, MonitorThatFallsSilentStopsTorqueInItsFrame) {
    verifies("SWR-SAF-019", Technique::kFaultInjection, Polarity::kViolation);
    operate();

    is_monitor_running_ = false;
    EXPECT_FALSE(step().torque_enable) << "what was judged a frame ago says nothing";
    EXPECT_EQ(sut_.get_first_fault(), to_index(ArmFault::kMeasurementStale));
}

TEST_F(SafetySupervisorTest, MeasurementOfEachFrameIsNoFault) {
    verifies("SWR-SAF-019");
    operate();

    for (int i = 0; i < 100; ++i) {
        ASSERT_EQ(step().state, SafeState::kOperational) << i;
    }
}

TEST_F(SafetySupervisorTest, ResetBringsTheMachineBackOnlyWhenTheFaultIsGone) {
    verifies("SWR-SAF-013", Technique::kStateTransition, Polarity::kViolation);
    operate();
    state_.faults = to_bit(ArmFault::kOverspeed);
    step_until(SafeState::kSafe, 10);
    reading_.torque_enabled = false;
    reading_.brakes_closed = true;
    reading_.reset_button = true;
    EXPECT_EQ(step().state, SafeState::kSafe) << "still present";
    state_.faults = 0U;
    EXPECT_EQ(step().state, SafeState::kSafe) << "no new push";

    reading_.reset_button = false;
    step();
    reading_.reset_button = true;
    EXPECT_EQ(step().state, SafeState::kSelfTest);
}

TEST_F(SafetySupervisorTest, OnePushBringsTheMachineBackOnceTheControllerRunsAgain) {
    verifies("SWR-SAF-013", Technique::kStateTransition);
    operate();
    supervision_.on_budget_overrun(1U, kController, now_);
    step();
    step();  // told to close
    reading_.brakes_open = false;
    reading_.brakes_closed = true;
    step();
    reading_.torque_enabled = false;
    ASSERT_EQ(sut_.get_state(), SafeState::kSafe);
    for (int i = 0; i < 5; ++i) {
        supervision_.on_budget_overrun(1U, kController, now_);
        reading_.reset_button = i == 3;
        ASSERT_EQ(step().state, SafeState::kSafe) << "still hanging, push in frame 3";
    }

    for (std::uint32_t i = 0U; i < mamori::safety::alive().expired_cycles; ++i) {
        ASSERT_EQ(step().state, SafeState::kSafe) << "healing " << i;
    }
    reading_.reset_button = true;
    EXPECT_EQ(step().state, SafeState::kSelfTest);
}

TEST_F(SafetySupervisorTest, WatchdogIsServedWhileTheSafetyPartitionIsHealthy) {
    verifies("SWR-SAF-015");
    for (int i = 1; i <= 50; ++i) {
        step();
        EXPECT_EQ(watchdog_.services, i);
    }
}

TEST_F(SafetySupervisorTest, WatchdogIsNotServedOnceASafetyComponentFailed) {
    verifies("SWR-SAF-015", Technique::kFaultInjection, Polarity::kViolation);
    operate();
    supervision_.on_budget_overrun(0U, kOther, now_);
    const int before = watchdog_.services;
    step();
    EXPECT_EQ(watchdog_.services, before);
    step();
    EXPECT_EQ(watchdog_.services, before) << "running again does not help";
}

TEST_F(SafetySupervisorTest, TorqueThatCannotBeSwitchedOffIsLeftToTheWatchdog) {
    verifies("SWR-SAF-015", Technique::kFaultInjection, Polarity::kViolation);
    operate();
    state_.faults = to_bit(ArmFault::kPowerLost);
    step();
    const auto tolerated = kTorqueFeedbackTime.ns / kFrame.ns;
    for (std::int64_t i = 0; i < tolerated; ++i) {
        ASSERT_EQ(step().state, SafeState::kSafe) << i;
    }
    const int before = watchdog_.services;

    EXPECT_EQ(step().state, SafeState::kLockedOut);
    EXPECT_EQ(watchdog_.services, before);
}

TEST_F(SafetySupervisorTest, AStopThatTheGateDoesNotMakeIsFoundAndLosesItsTorque) {
    verifies("SWR-SAF-028", Technique::kFaultInjection, Polarity::kViolation);
    operate();
    state_.is_standing = false;
    is_gate_running_ = false;  // what it gave to the drives stays: torque of the controller
    feed(sut_.drive, DriveCommand{{}, true, true, true, TorqueSource::kController, {}});
    state_.faults = to_bit(ArmFault::kEncoderImplausible);
    step_until(SafeState::kSafe, 20);
    EXPECT_EQ(sut_.get_state(), SafeState::kSafe);
    EXPECT_TRUE(safety_.get_faults().is_latched(to_index(ArmFault::kReactionLate)));
}

}  // namespace
}  // namespace safe_arm
