// SPDX-License-Identifier: Apache-2.0
// Goal: torque holds the machine until its brakes bite wherever there is time for it, and never longer; where
// torque is to go at once, it goes. Method: both sides of the closing time, with and without contacts, alone
// and together with the safe-state machine.
#include "mamori/safety/reaction/brake_sequence.hpp"

#include <cstdint>

#include "mamori/trace/verifies.hpp"
#include "mamori/verification/failed_check.hpp"

namespace mamori::safety {
namespace {

using namespace verification;

constexpr Duration kCloses{30};
constexpr BrakeLimits kWithContacts{kCloses, true};
constexpr BrakeLimits kWithoutContacts{kCloses, false};
constexpr StopBounds kBounds{Duration{100}, Duration{200}};
constexpr StopOutputs kOff{false, false, false, false};
constexpr StopOutputs kStopping{true, true, true, false};
constexpr StopOutputs kStoppingOnBrakes{true, false, true, false};
constexpr StopOutputs kHolding{true, true, true, true};
constexpr StopOutputs kHandingOver{true, false, true, true};

class BrakeSequenceTest : public ::testing::Test {
  protected:
    /// An SS1 whose machine stands since 1000: the brakes were told to close.
    static void stand_in_ss1(BrakeSequence& sut) {
        ASSERT_TRUE(sut.apply(SafeState::kProtectiveStopSs1, Instant{900}) == kStopping);
        ASSERT_FALSE(sut.confirm(SafeState::kProtectiveStopSs1, true, false, Instant{1000}));
        ASSERT_TRUE(sut.apply(SafeState::kProtectiveStopSs1, Instant{1000}) == kStoppingOnBrakes);
    }
    /// A standby that was entered from the hold at 1000.
    static void leave_hold(BrakeSequence& sut) {
        ASSERT_TRUE(sut.confirm(SafeState::kStandstillHold, true, false, Instant{900}));
        ASSERT_TRUE(sut.apply(SafeState::kStandstillHold, Instant{900}) == kHolding);
        static_cast<void>(sut.confirm(SafeState::kStandstillHold, true, false, Instant{1000}));
        ASSERT_TRUE(sut.apply(SafeState::kStandby, Instant{1000}) == kHandingOver);
    }

    BrakeSequence with_contacts_{kWithContacts};
    BrakeSequence without_contacts_{kWithoutContacts};
};

TEST_F(BrakeSequenceTest, BrakesCloseUnderTorqueFromTheFirstStandstillOfAnSs1On) {
    verifies("SWR-FSM-026");
    stand_in_ss1(with_contacts_);

    EXPECT_FALSE(with_contacts_.confirm(SafeState::kProtectiveStopSs1, false, false, Instant{1001}));
    EXPECT_TRUE(with_contacts_.apply(SafeState::kProtectiveStopSs1, Instant{1001}) == kStoppingOnBrakes)
        << "once begun, the closing goes on";
}

TEST_F(BrakeSequenceTest, BrakesStayOpenWhileAnSs1Moves) {
    verifies("SWR-FSM-026", Technique::kStateTransition, Polarity::kViolation);

    for (std::int64_t now = 0; now < 1000; ++now) {
        ASSERT_FALSE(with_contacts_.confirm(SafeState::kProtectiveStopSs1, false, false, Instant{now}));
        ASSERT_TRUE(with_contacts_.apply(SafeState::kProtectiveStopSs1, Instant{now}) == kStopping);
    }
}

TEST_F(BrakeSequenceTest, StopOfBeforeDoesNotCloseTheBrakesOfTheNextOne) {
    verifies("SWR-FSM-026", Technique::kStateTransition, Polarity::kViolation);
    stand_in_ss1(with_contacts_);
    ASSERT_TRUE(with_contacts_.apply(SafeState::kSafe, Instant{1100}) == kOff);
    static_cast<void>(with_contacts_.apply(SafeState::kOperational, Instant{1200}));

    EXPECT_FALSE(with_contacts_.confirm(SafeState::kProtectiveStopSs1, false, false, Instant{1300}));
    EXPECT_TRUE(with_contacts_.apply(SafeState::kProtectiveStopSs1, Instant{1300}) == kStopping);
}

TEST_F(BrakeSequenceTest, Ss1IsConfirmedWhenItsBrakesReport) {
    verifies("SWR-FSM-027");
    stand_in_ss1(with_contacts_);

    EXPECT_FALSE(with_contacts_.confirm(SafeState::kProtectiveStopSs1, true, false, Instant{1010}));
    EXPECT_TRUE(with_contacts_.confirm(SafeState::kProtectiveStopSs1, true, true, Instant{1011}));
}

TEST_F(BrakeSequenceTest, Ss1IsNotConfirmedWithoutStandstillNorWithoutTheReport) {
    verifies("SWR-FSM-027", Technique::kEquivalenceClasses, Polarity::kViolation);
    stand_in_ss1(with_contacts_);

    EXPECT_FALSE(with_contacts_.confirm(SafeState::kProtectiveStopSs1, false, true, Instant{1011}));
    EXPECT_FALSE(with_contacts_.confirm(SafeState::kProtectiveStopSs1, true, false, Instant{5000}))
        << "contacts that stay silent are not replaced by time";
}

TEST_F(BrakeSequenceTest, BrakesWithoutContactsCountAsClosedFromTheirTimeOn) {
    verifies("SWR-FSM-027", Technique::kBoundaryValues, Polarity::kViolation);
    stand_in_ss1(without_contacts_);

    EXPECT_FALSE(without_contacts_.confirm(SafeState::kProtectiveStopSs1, true, true, Instant{1029}))
        << "and nobody listens to what is not there";
    EXPECT_TRUE(without_contacts_.confirm(SafeState::kProtectiveStopSs1, true, false, Instant{1030}));
}

TEST_F(BrakeSequenceTest, ClockThatRunsBackwardsConfirmsNothing) {
    verifies("SWR-FSM-027", Technique::kFaultInjection, Polarity::kViolation);
    stand_in_ss1(without_contacts_);

    EXPECT_FALSE(without_contacts_.confirm(SafeState::kProtectiveStopSs1, true, false, Instant{-9000}));
}

TEST_F(BrakeSequenceTest, ContactStuckAtClosedConfirmsNothingBeforeTheClosingTime) {
    verifies("SWR-FSM-036", Technique::kFaultInjection, Polarity::kViolation);
    static_cast<void>(with_contacts_.confirm(SafeState::kProtectiveStopSs1, false, true, Instant{999}));
    static_cast<void>(with_contacts_.apply(SafeState::kProtectiveStopSs1, Instant{999}));

    EXPECT_FALSE(with_contacts_.confirm(SafeState::kProtectiveStopSs1, true, true, Instant{1000}))
        << "the cycle of the command";
    EXPECT_TRUE(with_contacts_.apply(SafeState::kProtectiveStopSs1, Instant{1000}) == kStoppingOnBrakes);
    EXPECT_FALSE(with_contacts_.confirm(SafeState::kProtectiveStopSs1, true, true, Instant{1029}));
    EXPECT_TRUE(with_contacts_.confirm(SafeState::kProtectiveStopSs1, true, true, Instant{1030}));
}

TEST_F(BrakeSequenceTest, ContactStuckAtClosedTakesNoTorqueFromTheHandOver) {
    verifies("SWR-FSM-036", Technique::kFaultInjection, Polarity::kViolation);
    static_cast<void>(with_contacts_.confirm(SafeState::kStandstillHold, true, true, Instant{900}));
    ASSERT_TRUE(with_contacts_.apply(SafeState::kStandstillHold, Instant{900}) == kHolding);
    static_cast<void>(with_contacts_.confirm(SafeState::kStandstillHold, true, true, Instant{1000}));

    EXPECT_TRUE(with_contacts_.apply(SafeState::kStandby, Instant{1000}) == kHandingOver);
    static_cast<void>(with_contacts_.confirm(SafeState::kStandby, true, true, Instant{1029}));
    EXPECT_TRUE(with_contacts_.apply(SafeState::kStandby, Instant{1029}) == kHandingOver);
    static_cast<void>(with_contacts_.confirm(SafeState::kStandby, true, true, Instant{1030}));
    EXPECT_TRUE(with_contacts_.apply(SafeState::kStandby, Instant{1030}) == kOff);
}

TEST_F(BrakeSequenceTest, ContactThatReportedOpenBeforeOrAfterTheCommandConfirmsAtOnce) {
    verifies("SWR-FSM-036", Technique::kEquivalenceClasses);
    stand_in_ss1(with_contacts_);
    EXPECT_TRUE(with_contacts_.confirm(SafeState::kProtectiveStopSs1, true, true, Instant{1001}))
        << "open in the cycle of the command";

    BrakeSequence opened_late{kWithContacts};
    static_cast<void>(opened_late.confirm(SafeState::kProtectiveStopSs1, true, true, Instant{1000}));
    static_cast<void>(opened_late.apply(SafeState::kProtectiveStopSs1, Instant{1000}));
    static_cast<void>(opened_late.confirm(SafeState::kProtectiveStopSs1, true, false, Instant{1001}));
    EXPECT_TRUE(opened_late.confirm(SafeState::kProtectiveStopSs1, true, true, Instant{1002}))
        << "open after the command";
}

TEST_F(BrakeSequenceTest, ContactThatOpenedInAnEarlierStopProvesNothingForThisOne) {
    verifies("SWR-FSM-036", Technique::kStateTransition, Polarity::kViolation);
    stand_in_ss1(with_contacts_);
    ASSERT_TRUE(with_contacts_.confirm(SafeState::kProtectiveStopSs1, true, true, Instant{1010}));
    static_cast<void>(with_contacts_.apply(SafeState::kSafe, Instant{1010}));
    static_cast<void>(with_contacts_.confirm(SafeState::kStandby, true, true, Instant{2000}));
    static_cast<void>(with_contacts_.apply(SafeState::kOperational, Instant{2000}));
    static_cast<void>(with_contacts_.confirm(SafeState::kOperational, true, true, Instant{3000}));
    static_cast<void>(with_contacts_.apply(SafeState::kProtectiveStopSs1, Instant{3000}));

    EXPECT_FALSE(with_contacts_.confirm(SafeState::kProtectiveStopSs1, true, true, Instant{3001}));
    EXPECT_FALSE(with_contacts_.confirm(SafeState::kProtectiveStopSs1, true, true, Instant{3030}));
    EXPECT_TRUE(with_contacts_.confirm(SafeState::kProtectiveStopSs1, true, true, Instant{3031}));
}

TEST_F(BrakeSequenceTest, OtherStatesAreConfirmedByStandstillAlone) {
    verifies("SWR-FSM-027", Technique::kStateTransition);

    for (unsigned value = 0U; value <= 255U; ++value) {
        const auto state = static_cast<SafeState>(value);
        if (state != SafeState::kProtectiveStopSs1) {
            EXPECT_TRUE(with_contacts_.confirm(state, true, false, Instant{0})) << value;
            EXPECT_FALSE(with_contacts_.confirm(state, false, true, Instant{0})) << value;
        }
    }
}

TEST_F(BrakeSequenceTest, TorqueHoldsOnAfterTheHoldUntilTheBrakesReport) {
    verifies("SWR-FSM-028");
    leave_hold(with_contacts_);

    static_cast<void>(with_contacts_.confirm(SafeState::kStandby, true, false, Instant{1010}));
    EXPECT_TRUE(with_contacts_.apply(SafeState::kStandby, Instant{1010}) == kHandingOver);
    static_cast<void>(with_contacts_.confirm(SafeState::kStandby, true, true, Instant{1011}));
    EXPECT_TRUE(with_contacts_.apply(SafeState::kStandby, Instant{1011}) == kOff);
    static_cast<void>(with_contacts_.confirm(SafeState::kStandby, true, false, Instant{1012}));
    EXPECT_TRUE(with_contacts_.apply(SafeState::kStandby, Instant{1012}) == kOff) << "not again";
}

TEST_F(BrakeSequenceTest, TorqueAfterTheHoldEndsWithTheClosingTime) {
    verifies("SWR-FSM-028", Technique::kBoundaryValues, Polarity::kViolation);
    leave_hold(with_contacts_);
    leave_hold(without_contacts_);

    EXPECT_TRUE(with_contacts_.apply(SafeState::kStandby, Instant{1029}) == kHandingOver);
    EXPECT_TRUE(with_contacts_.apply(SafeState::kStandby, Instant{1030}) == kOff);
    EXPECT_TRUE(without_contacts_.apply(SafeState::kStandby, Instant{1029}) == kHandingOver);
    EXPECT_TRUE(without_contacts_.apply(SafeState::kStandby, Instant{1030}) == kOff);
}

TEST_F(BrakeSequenceTest, ClockThatRunsBackwardsTakesTheTorqueAway) {
    verifies("SWR-FSM-028", Technique::kFaultInjection, Polarity::kViolation);
    leave_hold(with_contacts_);

    EXPECT_TRUE(with_contacts_.apply(SafeState::kStandby, Instant{999}) == kOff);
}

TEST_F(BrakeSequenceTest, EveryStateThatIsNotStandbyAfterTheHoldHasItsOwnTorqueAtOnce) {
    verifies("SWR-FSM-028", Technique::kStateTransition, Polarity::kViolation);

    for (unsigned value = 0U; value <= 255U; ++value) {
        const auto state = static_cast<SafeState>(value);
        BrakeSequence held{kWithContacts};
        ASSERT_TRUE(held.apply(SafeState::kStandstillHold, Instant{900}) == kHolding);
        BrakeSequence handing_over{kWithContacts};
        leave_hold(handing_over);
        if (state != SafeState::kStandby) {
            const bool has_torque = calc_stop_outputs(state).torque_enable;
            EXPECT_EQ(held.apply(state, Instant{1001}).torque_enable, has_torque) << value;
            EXPECT_EQ(handing_over.apply(state, Instant{1001}).torque_enable, has_torque) << value;
        }
    }
}

TEST_F(BrakeSequenceTest, StandbyThatFollowsTheSelfTestHasNoTorque) {
    verifies("SWR-FSM-028", Technique::kStateTransition, Polarity::kViolation);
    ASSERT_TRUE(with_contacts_.apply(SafeState::kSelfTest, Instant{10}) == kOff);

    EXPECT_TRUE(with_contacts_.apply(SafeState::kStandby, Instant{11}) == kOff);
}

TEST_F(BrakeSequenceTest, StandbyInTheFirstCycleHasNoTorque) {
    verifies("SWR-FSM-028", Technique::kBoundaryValues, Polarity::kViolation);

    EXPECT_TRUE(with_contacts_.apply(SafeState::kStandby, Instant{0}) == kOff);
    EXPECT_TRUE(without_contacts_.apply(SafeState::kStandby, Instant{0}) == kOff);
}

TEST_F(BrakeSequenceTest, BrakesThatDoNotReportInTimeAreOverdue) {
    verifies("SWR-FSM-029", Technique::kBoundaryValues, Polarity::kViolation);
    stand_in_ss1(with_contacts_);

    EXPECT_FALSE(with_contacts_.is_overdue(Instant{1030}));
    EXPECT_TRUE(with_contacts_.is_overdue(Instant{1031}));
    EXPECT_TRUE(with_contacts_.is_overdue(Instant{999})) << "a clock that ran backwards";
    static_cast<void>(with_contacts_.apply(SafeState::kSafe, Instant{1031}));
    EXPECT_TRUE(with_contacts_.is_overdue(Instant{1031})) << "the command is as old as before";
}

TEST_F(BrakeSequenceTest, BrakesAreWatchedFromTheFirstCycleOn) {
    verifies("SWR-FSM-029", Technique::kBoundaryValues, Polarity::kViolation);
    EXPECT_FALSE(with_contacts_.is_overdue(Instant{5000})) << "told nothing yet";
    static_cast<void>(with_contacts_.apply(SafeState::kSelfTest, Instant{5000}));

    EXPECT_FALSE(with_contacts_.is_overdue(Instant{5030}));
    EXPECT_TRUE(with_contacts_.is_overdue(Instant{5031}));
}

TEST_F(BrakeSequenceTest, BrakesThatReportAreOpenOrCannotReportAreNotOverdue) {
    verifies("SWR-FSM-029");
    stand_in_ss1(with_contacts_);
    stand_in_ss1(without_contacts_);

    EXPECT_FALSE(without_contacts_.is_overdue(Instant{5000}));
    static_cast<void>(with_contacts_.confirm(SafeState::kProtectiveStopSs1, true, true, Instant{1010}));
    EXPECT_FALSE(with_contacts_.is_overdue(Instant{5000}));
    static_cast<void>(with_contacts_.confirm(SafeState::kOperational, true, false, Instant{1010}));
    static_cast<void>(with_contacts_.apply(SafeState::kOperational, Instant{1010}));
    EXPECT_FALSE(with_contacts_.is_overdue(Instant{5000}));
}

TEST_F(BrakeSequenceTest, BrakesCloseFromTheirCommandUntilTheyHaveBittenOrTheirTimeHasElapsed) {
    verifies("SWR-CYC-037", Technique::kBoundaryValues);
    for (BrakeSequence* const sut : {&with_contacts_, &without_contacts_}) {
        EXPECT_TRUE(sut->apply(SafeState::kOperational, Instant{1000}) ==
                    StopOutputs({true, true, false, false}));
        EXPECT_FALSE(sut->is_closing(Instant{1000})) << "told nothing yet";
        EXPECT_TRUE(sut->apply(SafeState::kSafe, Instant{1000}) == kOff);
        EXPECT_TRUE(sut->is_closing(Instant{1000}));
        EXPECT_TRUE(sut->is_closing(Instant{1029}));
        EXPECT_FALSE(sut->is_closing(Instant{1030}));
        EXPECT_FALSE(sut->is_closing(Instant{999})) << "a clock that ran backwards";
    }
    static_cast<void>(with_contacts_.confirm(SafeState::kSafe, true, false, Instant{1001}));
    static_cast<void>(with_contacts_.confirm(SafeState::kSafe, true, true, Instant{1002}));
    EXPECT_FALSE(with_contacts_.is_closing(Instant{1002}));
}

TEST_F(BrakeSequenceTest, BrakesCloseInTheCycleInWhichTorqueGoes) {
    verifies("SWR-FSM-034");

    for (const SafeState state :
         {SafeState::kSelfTest, SafeState::kStandby, SafeState::kSafe, SafeState::kLockedOut}) {
        ASSERT_TRUE(with_contacts_.apply(SafeState::kOperational, Instant{900}).brake_release);
        EXPECT_TRUE(with_contacts_.apply(state, Instant{901}) == kOff) << get_name(state);
    }
}

TEST_F(BrakeSequenceTest, NumberThatIsNoStateHasNeitherTorqueNorOpenBrakes) {
    verifies("SWR-FSM-034", Technique::kFaultInjection, Polarity::kViolation);

    for (const unsigned value : {0U, 11U, 255U}) {
        ASSERT_TRUE(without_contacts_.apply(SafeState::kOperational, Instant{900}).brake_release);
        EXPECT_TRUE(without_contacts_.apply(static_cast<SafeState>(value), Instant{901}) == kOff) << value;
    }
}

TEST_F(BrakeSequenceTest, ClosingTimeOfNoLengthGoesToTheAssertionHandler) {
    verifies("SWR-FSM-026", Technique::kBoundaryValues, Polarity::kViolation);

    EXPECT_CHECK_FAILS((BrakeSequence{{Duration{0}, true}}), "brake_sequence.hpp", 1);
}

TEST_F(BrakeSequenceTest, BoundOfAnSs1MustBeLongerThanTheClosing) {
    verifies("SWR-FSM-026", Technique::kBoundaryValues, Polarity::kViolation);

    EXPECT_TRUE(have_brakes_time({Duration{1}, Duration{31}}, kWithContacts));
    EXPECT_FALSE(have_brakes_time({Duration{99}, Duration{30}}, kWithContacts));
}

/// The safe-state machine with brakes that close `closes_after` their command.
class BrakedMachine {
  public:
    explicit BrakedMachine(Duration closes_after) : closes_after_(closes_after) {
        inputs.demand = Reaction::kNone;
        inputs.faults_cleared = true;
        inputs.start_permitted = true;
    }

    StopOutputs step() {
        inputs.now = inputs.now + Duration{1};
        closing_for_ = outputs_.brake_release ? Duration{0} : closing_for_ + Duration{1};
        are_closed = closing_for_ >= closes_after_;
        inputs.standstill = brakes_.confirm(machine.get_state(), is_standing, are_closed, inputs.now);
        outputs_ = brakes_.apply(machine.step(inputs), inputs.now);
        return outputs_;
    }
    void operate() {
        is_standing = true;
        static_cast<void>(step());
        inputs.self_test = SelfTestStatus::kPassed;
        static_cast<void>(step());
        inputs.start_button = true;
        static_cast<void>(step());
        is_standing = false;
        ASSERT_EQ(machine.get_state(), SafeState::kOperational);
    }

    SafeStateInputs inputs{};
    SafeStateMachine machine{kBounds};
    bool is_standing{false};
    bool are_closed{true};

  private:
    BrakeSequence brakes_{kWithContacts};
    StopOutputs outputs_{};
    Duration closes_after_;
    Duration closing_for_{1000};
};

TEST(BrakedMachineTest, TorqueOfAnSs1GoesInTheCycleInWhichTheBrakesReport) {
    verifies("SWR-FSM-026", Technique::kInterface);
    BrakedMachine sut{Duration{20}};
    sut.operate();
    sut.inputs.demand = Reaction::kSs1;
    ASSERT_TRUE(sut.step() == kStopping);
    sut.is_standing = true;

    for (int cycle = 0; cycle < 20; ++cycle) {
        ASSERT_TRUE(sut.step() == kStoppingOnBrakes) << cycle;
    }
    EXPECT_TRUE(sut.step() == kOff);
    EXPECT_EQ(sut.machine.get_state(), SafeState::kSafe);
}

TEST(BrakedMachineTest, BrakesThatNeverReportEndWithTheBoundOfTheSs1) {
    verifies("SWR-FSM-026", Technique::kFaultInjection, Polarity::kViolation);
    BrakedMachine sut{Duration{1'000'000}};
    sut.operate();
    sut.inputs.demand = Reaction::kSs1;
    ASSERT_TRUE(sut.step() == kStopping);
    const Instant demanded_at = sut.inputs.now;
    sut.is_standing = true;
    while (sut.step().torque_enable && sut.inputs.now < demanded_at + Duration{1000}) {
    }

    EXPECT_EQ(sut.inputs.now - demanded_at, kBounds.ss1_within);
    EXPECT_EQ(sut.machine.get_state(), SafeState::kSafe);
}

TEST(BrakedMachineTest, StoDoesNotWaitForTheBrakes) {
    verifies("SWR-FSM-028", Technique::kInterface, Polarity::kViolation);
    BrakedMachine sut{Duration{20}};
    sut.operate();
    sut.inputs.demand = Reaction::kSs1;
    ASSERT_TRUE(sut.step() == kStopping);
    sut.is_standing = true;
    ASSERT_TRUE(sut.step() == kStoppingOnBrakes);

    sut.inputs.demand = Reaction::kSto;
    EXPECT_TRUE(sut.step() == kOff);
}

TEST(BrakedMachineTest, BrakesOpenInTheCycleOfTheStart) {
    verifies("SWR-FSM-035", Technique::kInterface);
    BrakedMachine sut{Duration{20}};
    sut.is_standing = true;
    ASSERT_FALSE(sut.step().brake_release);
    sut.inputs.self_test = SelfTestStatus::kPassed;
    ASSERT_FALSE(sut.step().brake_release);
    ASSERT_FALSE(sut.step().brake_release) << "standby alone opens nothing";

    sut.inputs.start_button = true;
    EXPECT_TRUE(sut.step().brake_release);
    EXPECT_EQ(sut.machine.get_state(), SafeState::kOperational);
}

TEST(BrakedMachineTest, PushDoesNotOpenTheBrakesOfAnSs1) {
    verifies("SWR-FSM-035", Technique::kInterface, Polarity::kViolation);
    BrakedMachine sut{Duration{20}};
    sut.operate();
    sut.inputs.demand = Reaction::kSs1;
    ASSERT_TRUE(sut.step() == kStopping);
    sut.is_standing = true;
    ASSERT_TRUE(sut.step() == kStoppingOnBrakes);

    sut.is_standing = false;
    sut.inputs.demand = Reaction::kNone;
    sut.inputs.start_button = false;
    for (int cycle = 0; cycle < 250; ++cycle) {
        ASSERT_FALSE(sut.step().brake_release) << cycle;
        sut.inputs.start_button = !sut.inputs.start_button;
    }
    EXPECT_EQ(sut.machine.get_state(), SafeState::kSafe);
}

TEST_F(BrakeSequenceTest, BrakesAreWaitedForFromTheirCommandUntilTheirContactsReport) {
    verifies("SWR-FSM-029", Technique::kStateTransition);
    BrakeSequence sut{{Duration{10}, true}};
    EXPECT_FALSE(sut.is_waiting());
    static_cast<void>(sut.confirm(SafeState::kSafe, true, false, Instant{0}));
    static_cast<void>(sut.apply(SafeState::kSafe, Instant{0}));
    EXPECT_TRUE(sut.is_waiting());
    EXPECT_FALSE(sut.is_overdue(Instant{10}));
    EXPECT_TRUE(sut.is_overdue(Instant{11}));
    static_cast<void>(sut.confirm(SafeState::kSafe, true, true, Instant{11}));
    EXPECT_FALSE(sut.is_waiting());

    static_cast<void>(without_contacts_.apply(SafeState::kSafe, Instant{0}));
    EXPECT_FALSE(without_contacts_.is_waiting());
}

}  // namespace
}  // namespace mamori::safety
