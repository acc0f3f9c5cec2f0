// SPDX-License-Identifier: Apache-2.0
// Goal: brakes that do not close in time are a fault, and torque holds a machine that stands and can be held;
// nothing else keeps torque. Method: stops whose contacts stay silent, on both sides of each bound.
#include "safety_cycle_fixture.hpp"

namespace mamori::safety::testing_of_cycle {
namespace {

class FailedBrakesTest : public SafetyCycleTest {
  protected:
    /// In an SS1; the contacts stay silent. The machine stands from now on when `is_standing`.
    void stop(bool is_standing, bool can_hold) {
        operate();
        is_contact_silent_ = true;
        sut_.inputs.can_hold = can_hold;
        set_present(Fault::kSlip, true);
        for (int i = 0; i < 3 && sut_.get_state() != SafeState::kProtectiveStopSs1; ++i) {
            step();
        }
        ASSERT_EQ(sut_.get_state(), SafeState::kProtectiveStopSs1);
        sut_.inputs.is_standing = is_standing;
    }
    SafeState step_for(int frames) {
        for (int i = 0; i < frames; ++i) {
            step();
        }
        return sut_.get_state();
    }
};

TEST_F(SafetyCycleTest, BrakesThatConfirmTheirClosingInTimeAreNoFault) {
    verifies("SWR-CYC-004", Technique::kBoundaryValues);
    sut_.inputs.are_brakes_closed = false;
    is_obeying_ = false;
    for (int i = 0; i <= 10; ++i) {
        step();
    }
    sut_.inputs.are_brakes_closed = true;
    step();
    step();
    EXPECT_FALSE(is_latched(Fault::kBrake));
}

TEST_F(SafetyCycleTest, BrakesThatDoNotConfirmTheirClosingInTimeAreAFault) {
    verifies("SWR-CYC-004", Technique::kFaultInjection, Polarity::kViolation);
    sut_.inputs.are_brakes_closed = false;
    is_obeying_ = false;
    for (int i = 0; i <= 10; ++i) {
        step();
        ASSERT_FALSE(is_latched(Fault::kBrake)) << i;
    }
    step();
    EXPECT_TRUE(is_latched(Fault::kBrake)) << "told at 0 ms, due at 10 ms";
}

TEST_F(FailedBrakesTest, AMachineThatCanBeHeldKeepsItsTorqueAndStaysLocked) {
    verifies("SWR-CYC-008");
    ASSERT_NO_FATAL_FAILURE(stop(true, true));

    EXPECT_EQ(step_for(11), SafeState::kProtectiveStopSs1) << "told in the first frame, due 10 ms later";
    EXPECT_EQ(step(), SafeState::kLockedHold);
    EXPECT_TRUE(sut_.outputs.torque_enable && sut_.outputs.hold_requested && !sut_.outputs.brake_release);
    set_present(Fault::kSlip, false);
    step_for(20);
    sut_.inputs.reset_button = true;
    EXPECT_EQ(step_for(5), SafeState::kLockedHold) << "no reset ends it";
    set_present(Fault::kFast, true);
    EXPECT_EQ(step(), SafeState::kLockedOut) << "STO";
    EXPECT_FALSE(sut_.outputs.torque_enable);
}

TEST_F(FailedBrakesTest, AMachineThatStopsLateIsHeldAtTheBoundOfItsStop) {
    verifies("SWR-CYC-008", Technique::kBoundaryValues);
    ASSERT_NO_FATAL_FAILURE(stop(false, true));
    step_for(14);
    sut_.inputs.is_standing = true;

    EXPECT_EQ(step_for(5), SafeState::kProtectiveStopSs1);
    EXPECT_EQ(step(), SafeState::kLockedHold) << "at 20 ms, the brakes have had only 5 ms";
}

TEST_F(FailedBrakesTest, AMachineThatCannotBeHeldOrMovesLosesItsTorqueAtTheBound) {
    verifies("SWR-CYC-008", Technique::kEquivalenceClasses, Polarity::kViolation);
    for (const bool can_hold : {false, true}) {
        const bool is_standing = !can_hold;
        SafetyStorage<kSystem> storage;
        SafetyState state{storage, watchdog_};
        FakeMachine machine{state, nullptr};
        ASSERT_EQ(machine.initialize(), Status::kOk);
        Instant now{};
        const auto run = [&](int frames) {
            for (int i = 0; i < frames; ++i) {
                for (std::size_t c = 0U; c < kSystem.components.size(); ++c) {
                    state.get_observer().get_records()[c].note_run(now, now + 10_us);
                }
                EXPECT_EQ(machine.on_execute({0, now}), Status::kOk);
                machine.inputs.applied = machine.outputs;
                machine.inputs.has_torque = machine.outputs.torque_enable;
                now = now + kFrame;
            }
        };
        machine.inputs.is_standing = true;
        machine.inputs.are_brakes_closed = true;
        machine.inputs.may_start = true;
        run(4);
        machine.inputs.start_button = true;
        run(1);
        ASSERT_EQ(machine.get_state(), SafeState::kOperational);
        machine.inputs.are_brakes_closed = false;
        machine.inputs.is_standing = is_standing;
        machine.inputs.can_hold = can_hold;
        machine.present[static_cast<std::size_t>(Fault::kSlip)] = true;
        run(3);
        ASSERT_EQ(machine.get_state(), SafeState::kProtectiveStopSs1);

        run(19);
        EXPECT_EQ(machine.get_state(), SafeState::kProtectiveStopSs1) << can_hold;
        run(1);
        EXPECT_EQ(machine.get_state(), SafeState::kSafe) << can_hold;
    }
}

TEST_F(FailedBrakesTest, BrakesThatCloseLetTheStopEndWithoutTorque) {
    verifies("SWR-CYC-008", Technique::kEquivalenceClasses, Polarity::kViolation);
    ASSERT_NO_FATAL_FAILURE(stop(true, true));
    step_for(5);
    is_contact_silent_ = false;

    step_for(2);
    EXPECT_EQ(sut_.get_state(), SafeState::kSafe);
    EXPECT_FALSE(sut_.outputs.torque_enable);
}

TEST_F(FailedBrakesTest, TheSelfTestGetsTorqueAgainstClosedBrakesAndNothingElseDoes) {
    verifies("SWR-CYC-009", Technique::kStateTransition);
    sut_.self_test = SelfTestStatus::kRunning;
    sut_.is_testing_torque = true;
    for (int i = 0; i < 10; ++i) {
        ASSERT_EQ(step(), SafeState::kSelfTest);
        ASSERT_TRUE(sut_.outputs.torque_enable && !sut_.outputs.brake_release) << i;
    }
    sut_.is_testing_torque = false;
    step();
    EXPECT_FALSE(sut_.outputs.torque_enable);
}

TEST_F(FailedBrakesTest, ATestThatAsksForTorqueElsewhereGetsNone) {
    verifies("SWR-CYC-009", Technique::kStateTransition, Polarity::kViolation);
    sut_.is_testing_torque = true;
    step();
    ASSERT_EQ(step(), SafeState::kStandby);
    EXPECT_FALSE(sut_.outputs.torque_enable);
    set_present(Fault::kFast, true);
    ASSERT_EQ(step(), SafeState::kSafe);
    EXPECT_FALSE(sut_.outputs.torque_enable);
}

TEST_F(FailedBrakesTest, AFaultInTheSelfTestEndsItsTorque) {
    verifies("SWR-CYC-009", Technique::kFaultInjection, Polarity::kViolation);
    sut_.self_test = SelfTestStatus::kRunning;
    sut_.is_testing_torque = true;
    step_for(3);
    set_present(Fault::kFast, true);

    EXPECT_EQ(step(), SafeState::kSafe);
    EXPECT_FALSE(sut_.outputs.torque_enable);
}

class BrakesFirstTest : public SafetyCycleTest {
  protected:
    /// The position is lost in operation; the contacts stay silent.
    void lose(bool can_hold) {
        operate();
        is_contact_silent_ = true;
        sut_.inputs.can_hold = can_hold;
        set_present(Fault::kLost, true);
        step();
        ASSERT_EQ(sut_.get_state(), SafeState::kSafe);
        ASSERT_FALSE(sut_.outputs.brake_release);
    }
    bool has_torque_after(int frames) {
        for (int i = 0; i < frames; ++i) {
            step();
        }
        return sut_.outputs.torque_enable;
    }
};

TEST_F(BrakesFirstTest, TorqueCarriesTheMachineUntilTheContactsReportClosed) {
    verifies("SWR-CYC-030");
    ASSERT_NO_FATAL_FAILURE(lose(true));
    EXPECT_TRUE(sut_.outputs.torque_enable && sut_.outputs.stop_requested);
    EXPECT_TRUE(has_torque_after(5));
    sut_.inputs.are_brakes_closed = true;
    EXPECT_FALSE(has_torque_after(1));
    EXPECT_FALSE(has_torque_after(1)) << "silent again: torque does not return";
    EXPECT_FALSE(is_latched(Fault::kLate)) << "the reaction began with the brakes";
}

TEST_F(BrakesFirstTest, SilentContactsKeepTheTorqueForTheClosingTimeOnly) {
    verifies("SWR-CYC-030", Technique::kBoundaryValues, Polarity::kViolation);
    ASSERT_NO_FATAL_FAILURE(lose(true));
    EXPECT_TRUE(has_torque_after(9)) << "told at 0 ms, closed within 10 ms";
    EXPECT_FALSE(has_torque_after(1));
    EXPECT_FALSE(has_torque_after(10));
}

TEST_F(BrakesFirstTest, ContactsThatReportOpenOnceAreBelieved) {
    verifies("SWR-CYC-037");
    ASSERT_NO_FATAL_FAILURE(lose(true));
    EXPECT_TRUE(has_torque_after(1));
    sut_.inputs.are_brakes_closed = true;
    EXPECT_FALSE(has_torque_after(1));
}

TEST_F(BrakesFirstTest, ContactsStuckAtClosedEndTheTorqueWithTheClosingTimeOnly) {
    verifies("SWR-CYC-037", Technique::kFaultInjection, Polarity::kViolation);
    operate();
    sut_.inputs.can_hold = true;
    set_present(Fault::kLost, true);
    for (int i = 0; i < 12; ++i) {
        sut_.inputs.are_brakes_closed = true;
        EXPECT_EQ(has_torque_after(1), i < 10) << i << " ms after the command, closed within 10 ms";
        EXPECT_EQ(sut_.get_state(), SafeState::kSafe);
    }
}

TEST_F(BrakesFirstTest, AnyOtherCauseOfStoEndsTheTorqueAtOnce) {
    verifies("SWR-CYC-030", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_NO_FATAL_FAILURE(lose(true));
    ASSERT_TRUE(has_torque_after(2));
    set_present(Fault::kFast, true);
    EXPECT_FALSE(has_torque_after(1));
    set_present(Fault::kFast, false);
    EXPECT_FALSE(has_torque_after(1));
}

TEST_F(BrakesFirstTest, AMachineThatCannotBeHeldLosesItsTorqueAtOnce) {
    verifies("SWR-CYC-030", Technique::kEquivalenceClasses, Polarity::kViolation);
    ASSERT_NO_FATAL_FAILURE(lose(false));
    EXPECT_FALSE(sut_.outputs.torque_enable);
    sut_.inputs.can_hold = true;
    EXPECT_FALSE(has_torque_after(1)) << "torque that is off does not return";
}

TEST_F(BrakesFirstTest, AnotherFaultKeepsNoTorque) {
    verifies("SWR-CYC-030", Technique::kStateTransition, Polarity::kViolation);
    operate();
    is_contact_silent_ = true;
    sut_.inputs.can_hold = true;
    set_present(Fault::kFast, true);
    EXPECT_FALSE(has_torque_after(1)) << "a drive that is not trusted";
    set_present(Fault::kLost, true);
    EXPECT_FALSE(has_torque_after(1));
}

TEST_F(BrakesFirstTest, WithoutTorqueBeforeNoneIsGiven) {
    verifies("SWR-CYC-030", Technique::kStateTransition, Polarity::kViolation);
    for (int i = 0; i < 5 && sut_.get_state() != SafeState::kStandby; ++i) {
        step();
    }
    is_contact_silent_ = true;
    sut_.inputs.can_hold = true;
    set_present(Fault::kLost, true);
    EXPECT_FALSE(has_torque_after(3));
    EXPECT_EQ(sut_.get_state(), SafeState::kSafe);
}

TEST_F(BrakesFirstTest, InAStopTheClosingTimeCountsFromTheCommandToTheBrakes) {
    verifies("SWR-CYC-030", Technique::kBoundaryValues, Polarity::kViolation);
    operate();
    is_contact_silent_ = true;
    sut_.inputs.can_hold = true;
    set_present(Fault::kSlip, true);
    for (int i = 0; i < 3; ++i) {
        step();
    }
    sut_.inputs.is_standing = true;
    ASSERT_TRUE(has_torque_after(6)) << "told in the first of these frames";
    set_present(Fault::kLost, true);
    ASSERT_TRUE(has_torque_after(1));
    ASSERT_EQ(sut_.get_state(), SafeState::kSafe);
    EXPECT_TRUE(has_torque_after(3));
    EXPECT_FALSE(has_torque_after(1));
}

TEST_F(BrakesFirstTest, AMilderFaultThatFollowsIsNoLateReaction) {
    verifies("SWR-CYC-030", Technique::kStateTransition);
    ASSERT_NO_FATAL_FAILURE(lose(true));
    set_present(Fault::kSlip, true);
    EXPECT_TRUE(has_torque_after(8));
    EXPECT_TRUE(is_latched(Fault::kSlip));
    EXPECT_FALSE(is_latched(Fault::kLate));
}

TEST_F(BrakesFirstTest, AClockThatRunsBackwardsEndsTheTorque) {
    verifies("SWR-CYC-030", Technique::kErrorGuessing, Polarity::kViolation);
    ASSERT_NO_FATAL_FAILURE(lose(true));
    now_ = now_ - 5_ms;
    EXPECT_FALSE(has_torque_after(1));
    EXPECT_EQ(sut_.get_state(), SafeState::kLockedOut);
}

TEST_F(BrakesFirstTest, BrakesThatStayOpenAreALateReaction) {
    verifies("SWR-CYC-005", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_NO_FATAL_FAILURE(operate());
    is_obeying_ = false;
    sut_.inputs.can_hold = true;
    set_present(Fault::kLost, true);
    for (int i = 0; i < 4; ++i) {
        step();
        ASSERT_FALSE(is_latched(Fault::kLate)) << i;
    }
    step();
    EXPECT_TRUE(is_latched(Fault::kLate));
}

}  // namespace
}  // namespace mamori::safety::testing_of_cycle
