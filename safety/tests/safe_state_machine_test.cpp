// SPDX-License-Identifier: Apache-2.0
// Goal: stops are confirmed or escalate in time, the most urgent event wins, and only a deliberate push under
// its conditions starts or resets. Method: both sides of each bound, each condition withheld, every bit
// flipped.
#include "mamori/safety/reaction/safe_state_machine.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <type_traits>

#include "mamori/safety/reaction/stop_outputs.hpp"
#include "mamori/trace/verifies.hpp"
#include "mamori/verification/failed_check.hpp"

namespace mamori::safety {
namespace {

using namespace verification;

class SafeStateMachineTest : public ::testing::Test {
  protected:
    SafeStateMachineTest() {
        inputs_.demand = Reaction::kNone;
        inputs_.standstill = true;
        inputs_.faults_cleared = true;
        inputs_.start_permitted = true;
    }

    SafeState step() {
        inputs_.now = inputs_.now + Duration{1};
        return sut_.step(inputs_);
    }
    SafeState push_start() {
        inputs_.start_button = false;
        static_cast<void>(step());
        inputs_.start_button = true;
        return step();
    }
    SafeState push_reset() {
        inputs_.reset_button = false;
        static_cast<void>(step());
        inputs_.reset_button = true;
        return step();
    }
    void pass_self_test() {
        inputs_.self_test = SelfTestStatus::kRunning;
        static_cast<void>(step());
        inputs_.self_test = SelfTestStatus::kPassed;
        ASSERT_EQ(step(), SafeState::kStandby);
    }
    /// Moving, nobody touches a button.
    void operate() {
        pass_self_test();
        ASSERT_EQ(push_start(), SafeState::kOperational);
        inputs_.start_button = false;
        inputs_.standstill = false;
        ASSERT_EQ(step(), SafeState::kOperational);
    }
    SafeState demand(Reaction reaction) {
        inputs_.demand = reaction;
        inputs_.faults_cleared = false;
        return step();
    }
    SafeState clear_and_reset() {
        inputs_.demand = Reaction::kNone;
        inputs_.faults_cleared = true;
        return push_reset();
    }
    /// Advances so that the next step is `elapsed` after the entry into the present state.
    SafeState step_at(Duration elapsed) {
        inputs_.now = sut_.get_entered_at() + elapsed - Duration{1};
        return step();
    }

    SafeStateInputs inputs_{};
    SafeStateMachine sut_{{Duration{100}, Duration{200}}};
};

TEST_F(SafeStateMachineTest, ConfirmedStopSs2HoldsAndConfirmedStopSs1CutsTorque) {
    verifies("SWR-FSM-004");
    operate();
    ASSERT_EQ(demand(Reaction::kSs2), SafeState::kProtectiveStopSs2);
    EXPECT_EQ(step(), SafeState::kProtectiveStopSs2);
    inputs_.standstill = true;
    EXPECT_EQ(step(), SafeState::kStandstillHold);

    EXPECT_EQ(demand(Reaction::kSs1), SafeState::kProtectiveStopSs1);
    EXPECT_EQ(step(), SafeState::kSafe);
}

TEST_F(SafeStateMachineTest, StopSs2ThatIsNotConfirmedBecomesSs1AtItsBound) {
    verifies("SWR-FSM-004", Technique::kBoundaryValues, Polarity::kViolation);
    operate();
    ASSERT_EQ(demand(Reaction::kSs2), SafeState::kProtectiveStopSs2);

    EXPECT_EQ(step_at(Duration{99}), SafeState::kProtectiveStopSs2);
    EXPECT_EQ(step_at(Duration{100}), SafeState::kProtectiveStopSs1);
}

TEST_F(SafeStateMachineTest, StopSs1ThatIsNotConfirmedCutsTorqueAtItsBound) {
    verifies("SWR-FSM-004", Technique::kBoundaryValues, Polarity::kViolation);
    operate();
    ASSERT_EQ(demand(Reaction::kSs1), SafeState::kProtectiveStopSs1);

    EXPECT_EQ(step_at(Duration{199}), SafeState::kProtectiveStopSs1);
    EXPECT_EQ(step_at(Duration{200}), SafeState::kSafe);
}

TEST_F(SafeStateMachineTest, FailedBrakesKeepTorqueUntilStoLocksOut) {
    verifies("SWR-FSM-037", Technique::kStateTransition);
    operate();
    ASSERT_EQ(demand(Reaction::kSs1), SafeState::kProtectiveStopSs1);
    inputs_.brakes_failed = true;

    EXPECT_EQ(step_at(Duration{200}), SafeState::kLockedHold)
        << "at the bound, the hold comes before the timeout";
    inputs_.brakes_failed = false;
    inputs_.standstill = true;
    EXPECT_EQ(clear_and_reset(), SafeState::kLockedHold);
    EXPECT_EQ(demand(Reaction::kSto), SafeState::kLockedOut);
}

TEST_F(SafeStateMachineTest, StopThatIsNeverConfirmedEscalatesToTorqueOff) {
    verifies("SWR-FSM-004", Technique::kFaultInjection, Polarity::kViolation);
    operate();
    ASSERT_EQ(demand(Reaction::kSs2), SafeState::kProtectiveStopSs2);
    const Instant demanded_at = inputs_.now;
    while (sut_.get_state() != SafeState::kSafe && inputs_.now < demanded_at + Duration{1000}) {
        static_cast<void>(step());
    }

    EXPECT_EQ(inputs_.now - demanded_at, Duration{300}) << "the sum of both bounds";
}

TEST_F(SafeStateMachineTest, StopIsConfirmedAtItsBoundAndNotAfterIt) {
    verifies("SWR-FSM-004", Technique::kBoundaryValues, Polarity::kViolation);
    operate();
    ASSERT_EQ(demand(Reaction::kSs2), SafeState::kProtectiveStopSs2);
    SafeStateMachine late = sut_;
    inputs_.standstill = true;

    EXPECT_EQ(step_at(Duration{100}), SafeState::kStandstillHold);
    inputs_.now = late.get_entered_at() + Duration{101};
    EXPECT_EQ(late.step(inputs_), SafeState::kProtectiveStopSs1);
}

TEST_F(SafeStateMachineTest, ClockThatRunsBackwardsEscalates) {
    verifies("SWR-FSM-004", Technique::kFaultInjection, Polarity::kViolation);
    operate();
    ASSERT_EQ(demand(Reaction::kSs1), SafeState::kProtectiveStopSs1);

    EXPECT_EQ(step_at(Duration{-1}), SafeState::kSafe);
}

TEST_F(SafeStateMachineTest, LeavingTheHeldPositionIsAStopSs1) {
    verifies("SWR-FSM-004", Technique::kFaultInjection, Polarity::kViolation);
    operate();
    ASSERT_EQ(demand(Reaction::kSs2), SafeState::kProtectiveStopSs2);
    inputs_.standstill = true;
    ASSERT_EQ(step(), SafeState::kStandstillHold);

    inputs_.standstill = false;
    EXPECT_EQ(step(), SafeState::kProtectiveStopSs1);
}

TEST_F(SafeStateMachineTest, StopWithoutABoundGoesToTheAssertionHandler) {
    verifies("SWR-FSM-004", Technique::kBoundaryValues, Polarity::kViolation);

    EXPECT_CHECK_FAILS((SafeStateMachine{{Duration{0}, Duration{1}}}), "safe_state_machine.hpp", 1);
    EXPECT_CHECK_FAILS((SafeStateMachine{{Duration{1}, Duration{0}}}), "safe_state_machine.hpp", 1);
}

TEST_F(SafeStateMachineTest, DegradedMachineMovesOnUntilAPersonRestoresIt) {
    verifies("SWR-FSM-005", Technique::kStateTransition);
    operate();
    ASSERT_EQ(demand(Reaction::kDegrade), SafeState::kDegraded);
    inputs_.demand = Reaction::kNone;
    inputs_.faults_cleared = true;
    EXPECT_EQ(step(), SafeState::kDegraded) << "not by itself";

    EXPECT_EQ(push_reset(), SafeState::kOperational);
}

TEST_F(SafeStateMachineTest, WorstOfSeveralEventsInOneCycleWins) {
    verifies("SWR-FSM-005", Technique::kEquivalenceClasses, Polarity::kViolation);
    pass_self_test();
    inputs_.start_button = false;
    ASSERT_EQ(step(), SafeState::kStandby);
    inputs_.start_button = true;
    inputs_.demand = Reaction::kSto;
    EXPECT_EQ(step(), SafeState::kSafe) << "a start together with a demand is no start";

    inputs_.self_test = SelfTestStatus::kFailed;
    EXPECT_EQ(step(), SafeState::kLockedOut) << "a failed self test is worse than the demand";
}

TEST_F(SafeStateMachineTest, LockOutIsWorseThanEveryOtherEvent) {
    verifies("SWR-FSM-005", Technique::kEquivalenceClasses, Polarity::kViolation);
    operate();
    inputs_.lock_out = true;

    EXPECT_EQ(demand(Reaction::kSs2), SafeState::kLockedOut);
    inputs_.lock_out = false;
    EXPECT_EQ(clear_and_reset(), SafeState::kLockedOut);
}

TEST_F(SafeStateMachineTest, LesserDemandInASevererStopIsIgnored) {
    verifies("SWR-FSM-005", Technique::kStateTransition, Polarity::kViolation);
    operate();
    ASSERT_EQ(demand(Reaction::kSs1), SafeState::kProtectiveStopSs1);

    EXPECT_EQ(demand(Reaction::kSs2), SafeState::kProtectiveStopSs1);
    EXPECT_EQ(demand(Reaction::kDegrade), SafeState::kProtectiveStopSs1);
    EXPECT_EQ(demand(Reaction::kNone), SafeState::kProtectiveStopSs1);
    EXPECT_EQ(demand(Reaction::kSto), SafeState::kSafe);
}

TEST_F(SafeStateMachineTest, CorruptedDemandCountsAsTheSeverest) {
    verifies("SWR-FSM-005", Technique::kFaultInjection, Polarity::kViolation);
    operate();

    EXPECT_EQ(demand(static_cast<Reaction>(0x55)), SafeState::kSafe);
}

TEST_F(SafeStateMachineTest, DeliberatePushesLeadFromSafeBackToOperation) {
    verifies("SWR-FSM-006");
    operate();
    ASSERT_EQ(demand(Reaction::kSto), SafeState::kSafe);
    inputs_.standstill = true;

    EXPECT_EQ(clear_and_reset(), SafeState::kSelfTest);
    pass_self_test();
    EXPECT_EQ(push_start(), SafeState::kOperational);
}

TEST_F(SafeStateMachineTest, HealedFaultDoesNotLeaveTheSafeState) {
    verifies("SWR-FSM-006", Technique::kFaultInjection, Polarity::kViolation);
    operate();
    ASSERT_EQ(demand(Reaction::kSto), SafeState::kSafe);
    inputs_.demand = Reaction::kNone;
    inputs_.faults_cleared = true;
    inputs_.standstill = true;

    for (int cycle = 0; cycle < 1000; ++cycle) {
        ASSERT_EQ(step(), SafeState::kSafe);
    }
}

TEST_F(SafeStateMachineTest, ButtonHeldAtPowerUpIsNoPush) {
    verifies("SWR-FSM-006", Technique::kErrorGuessing, Polarity::kViolation);
    inputs_.start_button = true;
    pass_self_test();

    for (int cycle = 0; cycle < 1000; ++cycle) {
        ASSERT_EQ(step(), SafeState::kStandby);
    }
    EXPECT_EQ(push_start(), SafeState::kOperational) << "released and pushed again";
}

TEST_F(SafeStateMachineTest, PushInTheWrongStateIsNotKeptForALaterOne) {
    verifies("SWR-FSM-006", Technique::kErrorGuessing, Polarity::kViolation);
    static_cast<void>(step());
    inputs_.start_button = true;
    static_cast<void>(step());

    pass_self_test();
    EXPECT_EQ(step(), SafeState::kStandby);
}

TEST_F(SafeStateMachineTest, ResetNeedsEachOfItsConditions) {
    verifies("SWR-FSM-006", Technique::kEquivalenceClasses, Polarity::kViolation);
    operate();
    ASSERT_EQ(demand(Reaction::kSto), SafeState::kSafe);
    inputs_.standstill = true;

    inputs_.faults_cleared = true;
    EXPECT_EQ(push_reset(), SafeState::kSafe) << "still demanded";
    inputs_.demand = Reaction::kDegrade;
    EXPECT_EQ(push_reset(), SafeState::kSafe) << "something is still demanded";
    inputs_.demand = Reaction::kNone;
    inputs_.faults_cleared = false;
    EXPECT_EQ(push_reset(), SafeState::kSafe) << "faults latched";
    inputs_.faults_cleared = true;
    inputs_.standstill = false;
    EXPECT_EQ(push_reset(), SafeState::kSafe) << "not at standstill";
    inputs_.standstill = true;
    EXPECT_EQ(step(), SafeState::kSafe) << "the push came too early and is gone";
    EXPECT_EQ(push_reset(), SafeState::kSelfTest);
}

TEST_F(SafeStateMachineTest, StartNeedsEachOfItsConditions) {
    verifies("SWR-FSM-006", Technique::kEquivalenceClasses, Polarity::kViolation);
    pass_self_test();

    inputs_.start_permitted = false;
    EXPECT_EQ(push_start(), SafeState::kStandby) << "the start would be a jump";
    inputs_.start_permitted = true;
    inputs_.standstill = false;
    EXPECT_EQ(push_start(), SafeState::kStandby) << "not at standstill";
    inputs_.standstill = true;
    inputs_.faults_cleared = false;
    EXPECT_EQ(push_start(), SafeState::kStandby) << "faults latched";
    inputs_.faults_cleared = true;
    inputs_.demand = Reaction::kDegrade;
    EXPECT_EQ(push_start(), SafeState::kStandby) << "something is demanded";
    inputs_.demand = Reaction::kNone;
    EXPECT_EQ(step(), SafeState::kStandby) << "the push came too early and is gone";
    EXPECT_EQ(push_start(), SafeState::kOperational);
}

TEST_F(SafeStateMachineTest, DefaultInputsPermitNothing) {
    verifies("SWR-FSM-006", Technique::kErrorGuessing, Polarity::kViolation);
    operate();

    SafeStateInputs nothing;
    nothing.now = inputs_.now;
    EXPECT_FALSE(nothing.start_button || nothing.reset_button || nothing.standstill);
    EXPECT_FALSE(nothing.faults_cleared || nothing.start_permitted);
    EXPECT_FALSE(nothing.lock_out) << "an event, and no permission";
    EXPECT_EQ(nothing.self_test, SelfTestStatus::kRunning);
    EXPECT_EQ(sut_.step(nothing), SafeState::kSafe);
}

TEST_F(SafeStateMachineTest, PassThatIsThereBeforeTheTestRanDoesNotCount) {
    verifies("SWR-FSM-008", Technique::kErrorGuessing, Polarity::kViolation);
    inputs_.self_test = SelfTestStatus::kPassed;

    for (int cycle = 0; cycle < 100; ++cycle) {
        ASSERT_EQ(step(), SafeState::kSelfTest);
    }
    pass_self_test();
}

TEST(RisingEdgeTest, LevelThatIsHighFromTheFirstCycleOnHasNotRisen) {
    verifies("SWR-FSM-006", Technique::kBoundaryValues, Polarity::kViolation);
    RisingEdge sut;

    EXPECT_FALSE(sut.step(true));
    EXPECT_FALSE(sut.step(true));
    EXPECT_FALSE(sut.step(false));
    EXPECT_TRUE(sut.step(true));
    EXPECT_FALSE(sut.step(true)) << "once";
}

TEST_F(SafeStateMachineTest, UndisturbedMachineIsConsistentInEveryState) {
    verifies("SWR-FSM-007");
    EXPECT_TRUE(sut_.is_consistent());
    operate();
    EXPECT_TRUE(sut_.is_consistent());
    ASSERT_EQ(demand(Reaction::kSs1), SafeState::kProtectiveStopSs1);
    EXPECT_TRUE(sut_.is_consistent());
}

TEST_F(SafeStateMachineTest, EveryFlippedBitLeavesTheStateAsItWasOrLocksOut) {
    verifies("SWR-FSM-007", Technique::kFaultInjection, Polarity::kViolation);
    static_assert(std::is_trivially_copyable_v<SafeStateMachine>);
    operate();
    std::size_t locked_out = 0U;

    for (std::size_t bit = 0U; bit < sizeof(SafeStateMachine) * 8U; ++bit) {
        std::array<unsigned char, sizeof(SafeStateMachine)> image{};
        std::memcpy(image.data(), &sut_, image.size());
        image[bit / 8U] = static_cast<unsigned char>(image[bit / 8U] ^ (1U << (bit % 8U)));
        SafeStateMachine corrupted = sut_;
        std::memcpy(static_cast<void*>(&corrupted), image.data(), image.size());
        if (corrupted.is_consistent()) {
            ASSERT_EQ(corrupted.get_state(), SafeState::kOperational) << "bit " << bit;
            continue;
        }
        ++locked_out;
        EXPECT_EQ(corrupted.get_state(), SafeState::kLockedOut) << "bit " << bit;
        EXPECT_FALSE(calc_stop_outputs(corrupted.get_state()).torque_enable);
        EXPECT_EQ(corrupted.step(inputs_), SafeState::kLockedOut) << "bit " << bit;
        EXPECT_TRUE(corrupted.is_consistent()) << "locked out for good";
    }
    EXPECT_EQ(locked_out, 16U) << "each bit of the state and of its complement";
}

TEST_F(SafeStateMachineTest, FormsThatAgreeOnNoStateLockOut) {
    verifies("SWR-FSM-007", Technique::kFaultInjection, Polarity::kViolation);
    operate();
    std::array<unsigned char, sizeof(SafeStateMachine)> image{};
    std::memcpy(image.data(), &sut_, image.size());
    const auto state = static_cast<unsigned char>(SafeState::kOperational);
    const auto complement = static_cast<unsigned char>(~state);
    const std::array<unsigned char, 2U> forms{state, complement};
    const auto place = std::search(image.begin(), image.end(), forms.begin(), forms.end());
    ASSERT_NE(place, image.end());
    std::size_t named = 0U;

    for (unsigned int value = 0U; value <= 0xFFU; ++value) {
        *place = static_cast<unsigned char>(value);
        *(place + 1) = static_cast<unsigned char>(~value);
        SafeStateMachine corrupted = sut_;
        std::memcpy(static_cast<void*>(&corrupted), image.data(), image.size());
        if (corrupted.is_consistent()) {
            ++named;
            continue;
        }
        EXPECT_EQ(corrupted.get_state(), SafeState::kLockedOut) << "value " << value;
        EXPECT_EQ(corrupted.step(inputs_), SafeState::kLockedOut) << "value " << value;
    }
    EXPECT_EQ(named, kSafeStateCount);
}

TEST_F(SafeStateMachineTest, ClearedMemoryIsLockedOut) {
    verifies("SWR-FSM-007", Technique::kFaultInjection, Polarity::kViolation);
    operate();

    std::memset(static_cast<void*>(&sut_), 0, sizeof sut_);
    EXPECT_EQ(sut_.get_state(), SafeState::kLockedOut);
    EXPECT_EQ(step(), SafeState::kLockedOut);
}

TEST_F(SafeStateMachineTest, StandbyIsReachedThroughAPassedSelfTest) {
    verifies("SWR-FSM-008");
    EXPECT_EQ(sut_.get_state(), SafeState::kSelfTest);
    EXPECT_EQ(step(), SafeState::kSelfTest);
    EXPECT_EQ(sut_.get_entered_at(), inputs_.now);

    inputs_.self_test = SelfTestStatus::kPassed;
    EXPECT_EQ(step(), SafeState::kStandby);
    EXPECT_EQ(sut_.get_entered_at(), inputs_.now);
}

TEST_F(SafeStateMachineTest, ResultOfAnEarlierSelfTestDoesNotCount) {
    verifies("SWR-FSM-008", Technique::kErrorGuessing, Polarity::kViolation);
    operate();
    ASSERT_EQ(demand(Reaction::kSto), SafeState::kSafe);
    inputs_.standstill = true;
    ASSERT_EQ(inputs_.self_test, SelfTestStatus::kPassed);
    ASSERT_EQ(clear_and_reset(), SafeState::kSelfTest);

    for (int cycle = 0; cycle < 100; ++cycle) {
        ASSERT_EQ(step(), SafeState::kSelfTest);
    }
    pass_self_test();
}

TEST_F(SafeStateMachineTest, FailedSelfTestLocksOutAtPowerUpAndLater) {
    verifies("SWR-FSM-008", Technique::kFaultInjection, Polarity::kViolation);
    SafeStateMachine at_power_up{{Duration{1}, Duration{1}}};
    SafeStateInputs failed = inputs_;
    failed.self_test = SelfTestStatus::kFailed;
    EXPECT_EQ(at_power_up.step(failed), SafeState::kLockedOut);

    operate();
    inputs_.self_test = static_cast<SelfTestStatus>(9);
    EXPECT_EQ(step(), SafeState::kLockedOut) << "a corrupted result is a failed one";
}

}  // namespace
}  // namespace mamori::safety
