// SPDX-License-Identifier: Apache-2.0
// Goal: torque is on, and brakes are open, in the five moving or holding states and in no other; a locked
// hold has torque against brakes that failed. Method: every value that fits into the state's byte.
#include "mamori/safety/reaction/stop_outputs.hpp"

#include "mamori/trace/verifies.hpp"

namespace mamori::safety {
namespace {

using namespace verification;

constexpr StopOutputs kTorqueOff{false, false, false, false};
constexpr StopOutputs kMoving{true, true, false, false};
constexpr StopOutputs kStopping{true, true, true, false};
constexpr StopOutputs kHolding{true, true, true, true};
constexpr StopOutputs kLockedHolding{true, false, true, true};

TEST(StopOutputsTest, MovingStatesHaveTorqueAndTellTheControllerWhatIsWanted) {
    verifies("SWR-FSM-009");

    EXPECT_TRUE(calc_stop_outputs(SafeState::kOperational) == kMoving);
    EXPECT_TRUE(calc_stop_outputs(SafeState::kDegraded) == kMoving);
    EXPECT_TRUE(calc_stop_outputs(SafeState::kProtectiveStopSs2) == kStopping);
    EXPECT_TRUE(calc_stop_outputs(SafeState::kProtectiveStopSs1) == kStopping);
    EXPECT_TRUE(calc_stop_outputs(SafeState::kStandstillHold) == kHolding);
    EXPECT_TRUE(calc_stop_outputs(SafeState::kLockedHold) == kLockedHolding);
}

TEST(StopOutputsTest, EveryOtherValueOfTheByteCutsTorqueAndClosesBrakes) {
    verifies("SWR-FSM-009", Technique::kFaultInjection, Polarity::kViolation);

    int safe_values = 0;
    for (unsigned value = 0U; value <= 255U; ++value) {
        const bool has_torque = (value >= 3U && value <= 7U) || value == 10U;
        if (!has_torque) {
            EXPECT_TRUE(calc_stop_outputs(static_cast<SafeState>(value)) == kTorqueOff) << value;
            ++safe_values;
        }
    }
    EXPECT_EQ(safe_values, 250);
}

TEST(StopOutputsTest, OneCommandThatDiffersIsAnotherRow) {
    verifies("SWR-FSM-009", Technique::kEquivalenceClasses, Polarity::kViolation);

    EXPECT_FALSE(kMoving == (StopOutputs{false, true, false, false}));
    EXPECT_FALSE(kMoving == (StopOutputs{true, false, false, false}));
    EXPECT_FALSE(kMoving == kStopping);
    EXPECT_FALSE(kMoving == kHolding);
    EXPECT_FALSE(kStopping == kHolding);
}

TEST(StopOutputsTest, RowWithTorqueAgainstAClosedBrakeOrWithoutTorqueUnderAnOpenOneIsRefused) {
    verifies("SWR-FSM-009", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_TRUE(detail::do_torque_and_brakes_agree(kStopOutputs));

    for (const StopOutputs& wrong :
         {StopOutputs{true, false, false, false}, StopOutputs{false, true, false, false}}) {
        for (std::size_t row = 0U; row < kSafeStateCount; ++row) {
            const bool is_held = static_cast<SafeState>(row + 1U) == SafeState::kLockedHold;
            auto outputs = kStopOutputs;
            outputs[row] = wrong;
            EXPECT_EQ(detail::do_torque_and_brakes_agree(outputs), is_held && wrong.torque_enable) << row;
        }
    }
}

TEST(StopOutputsTest, AHoldWithoutAStopIsRefused) {
    verifies("SWR-FSM-009", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_TRUE(detail::is_hold_a_stop(kStopOutputs));

    for (std::size_t row = 0U; row < kSafeStateCount; ++row) {
        auto outputs = kStopOutputs;
        outputs[row] = {true, true, false, true};
        EXPECT_FALSE(detail::is_hold_a_stop(outputs)) << row;
    }
}

TEST(StopOutputsTest, DefaultIsTheSafeState) {
    verifies("SWR-FSM-009", Technique::kErrorGuessing, Polarity::kViolation);

    EXPECT_TRUE(StopOutputs{} == kTorqueOff);
}

}  // namespace
}  // namespace mamori::safety
