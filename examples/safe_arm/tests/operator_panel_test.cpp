// SPDX-License-Identifier: Apache-2.0
// Goal: a demand of either channel counts at once, a failed channel stays failed until both have worked, and
// a button that sticks does nothing. Method: the panel alone, frame after frame, with inputs made here.
#include "operator_panel.hpp"

#include "arm_faults.hpp"
#include "mamori/trace/verifies.hpp"

namespace safe_arm {
namespace {

using mamori::Duration;
using mamori::Instant;
using namespace mamori::verification;

class OperatorPanelTest : public ::testing::Test {
  protected:
    void SetUp() override {
        inputs_.emergency_stop_closed.fill(true);
        inputs_.protective_stop_closed.fill(true);
        inputs_.enabling_closed.fill(true);
        inputs_.run_button = true;
        inputs_.mode_selected[0] = true;
        step();
    }
    PanelState step() {
        now_ = now_ + kFrame;
        return sut_.step(inputs_, mode_, now_);
    }
    /// @return the faults of the last frame.
    std::uint32_t step_for(Duration time) {
        std::uint32_t faults = 0U;
        for (std::int64_t i = 0; i < time.ns / kFrame.ns; ++i) {
            faults = step().faults;
        }
        return faults;
    }
    std::uint32_t set_emergency_stop(bool is_a_closed, bool is_b_closed, Duration time) {
        inputs_.emergency_stop_closed = {is_a_closed, is_b_closed};
        return step_for(time);
    }
    /// Pushes a button for a time. @return the frame of the release.
    PanelState push(bool mamori::safety::ArmInputs::* button, Duration time) {
        inputs_.*button = true;
        step_for(time);
        inputs_.*button = false;
        return step();
    }
    PanelState push_reset() { return push(&mamori::safety::ArmInputs::reset_button, kPushMin); }

    PanelState select(OperatingMode mode) {
        // The contacts are in the reverse order of the modes.
        inputs_.mode_selected = {};
        inputs_.mode_selected[2U - static_cast<std::size_t>(mode)] = true;
        return step();
    }

    mamori::safety::ArmInputs inputs_{};
    OperatorPanel sut_{};
    OperatingMode mode_{OperatingMode::kAutomatic};  ///< of the system
    Instant now_{};
};
constexpr std::array kModes{OperatingMode::kHoldToRun, OperatingMode::kReducedSpeed,
                            OperatingMode::kAutomatic};

TEST_F(OperatorPanelTest, ClosedCircuitsDemandNothing) {
    verifies("SWR-SAF-030");

    EXPECT_EQ(step_for(1000_ms), 0U);
}

TEST_F(OperatorPanelTest, APushedEmergencyStopIsADemandUntilItIsReleased) {
    verifies("SWR-SAF-030");

    EXPECT_EQ(set_emergency_stop(false, false, kFrame), to_bit(ArmFault::kEmergencyStop));
    EXPECT_EQ(step_for(1000_ms), to_bit(ArmFault::kEmergencyStop));
    EXPECT_EQ(set_emergency_stop(true, true, kFrame), 0U);
}

TEST_F(OperatorPanelTest, EitherChannelAloneDemandsTheStopInItsFrame) {
    verifies("SWR-SAF-030", Technique::kFaultInjection, Polarity::kViolation);

    EXPECT_EQ(set_emergency_stop(false, true, kFrame), to_bit(ArmFault::kEmergencyStop));
    EXPECT_EQ(set_emergency_stop(true, true, kFrame), 0U);
    EXPECT_EQ(set_emergency_stop(true, false, kFrame), to_bit(ArmFault::kEmergencyStop));
}

TEST_F(OperatorPanelTest, EitherChannelOfTheProtectiveStopAloneDemandsItsStop) {
    verifies("SWR-SAF-030", Technique::kFaultInjection, Polarity::kViolation);
    inputs_.protective_stop_closed = {false, true};
    EXPECT_EQ(step().faults, to_bit(ArmFault::kProtectiveStop));
    inputs_.protective_stop_closed = {true, false};
    EXPECT_EQ(step_for(200_ms), to_bit(ArmFault::kProtectiveStop) | to_bit(ArmFault::kSwitchDiscrepancy));
    inputs_.protective_stop_closed = {false, false};
    EXPECT_EQ(push_reset().faults, to_bit(ArmFault::kProtectiveStop));
}

TEST_F(OperatorPanelTest, ChannelsMayDifferForTheDiscrepancyTimeAndNotLonger) {
    verifies("SWR-SAF-031", Technique::kBoundaryValues, Polarity::kViolation);
    // The first frame of a difference is at its time 0.
    EXPECT_EQ(set_emergency_stop(false, true, kSwitchDiscrepancyTime + kFrame),
              to_bit(ArmFault::kEmergencyStop));

    EXPECT_EQ(step().faults, to_bit(ArmFault::kEmergencyStop) | to_bit(ArmFault::kSwitchDiscrepancy));
}

TEST_F(OperatorPanelTest, AnOrdinaryPushIsNoDiscrepancyAndNeedsNoReset) {
    verifies("SWR-SAF-031");
    set_emergency_stop(false, true, 5_ms);
    EXPECT_EQ(set_emergency_stop(false, false, 500_ms), to_bit(ArmFault::kEmergencyStop));
    set_emergency_stop(true, false, 5_ms);

    EXPECT_EQ(set_emergency_stop(true, true, 500_ms), 0U);
}

TEST_F(OperatorPanelTest, AWeldedContactIsAcknowledgedOnlyAfterBothChannelsHaveOpened) {
    verifies("SWR-SAF-031", Technique::kFaultInjection, Polarity::kViolation);
    const std::uint32_t failed = to_bit(ArmFault::kSwitchDiscrepancy);
    set_emergency_stop(false, true, 200_ms);
    EXPECT_EQ(push_reset().faults & failed, failed) << "the channels still differ";
    set_emergency_stop(true, true, 200_ms);
    EXPECT_EQ(push_reset().faults, failed) << "they agree, and channel B has not opened";
    set_emergency_stop(false, true, 50_ms);
    set_emergency_stop(true, true, 50_ms);
    EXPECT_EQ(push_reset().faults, failed) << "nor has it now";

    set_emergency_stop(false, false, 50_ms);
    set_emergency_stop(true, true, 50_ms);
    EXPECT_EQ(step().faults, failed) << "it stays until it is acknowledged";
    EXPECT_EQ(push_reset().faults, 0U);
}

TEST_F(OperatorPanelTest, AFailureAfterARepairNeedsBothChannelsAgain) {
    verifies("SWR-SAF-031", Technique::kStateTransition, Polarity::kViolation);
    set_emergency_stop(true, false, 200_ms);
    set_emergency_stop(false, false, 50_ms);
    set_emergency_stop(true, true, 50_ms);
    ASSERT_EQ(push_reset().faults, 0U);
    set_emergency_stop(true, false, 200_ms);
    set_emergency_stop(true, true, 50_ms);

    EXPECT_EQ(push_reset().faults, to_bit(ArmFault::kSwitchDiscrepancy));
}

TEST_F(OperatorPanelTest, EachButtonCountsOnceAtItsRelease) {
    verifies("SWR-SAF-032", Technique::kBoundaryValues);
    for (const Duration time : {kPushMin, kPushMax}) {
        const PanelState started = push(&mamori::safety::ArmInputs::start_button, time);
        EXPECT_TRUE(started.start && !started.reset) << time.ns;
        EXPECT_FALSE(step().start);
        const PanelState reset = push(&mamori::safety::ArmInputs::reset_button, time);
        EXPECT_TRUE(reset.reset && !reset.start) << time.ns;
        EXPECT_FALSE(step().reset);
    }
}

TEST_F(OperatorPanelTest, APushThatIsTooShortOrTooLongDoesNothing) {
    verifies("SWR-SAF-032", Technique::kBoundaryValues, Polarity::kViolation);
    for (const Duration time : {kPushMin - kFrame, kPushMax + kFrame}) {
        EXPECT_FALSE(push(&mamori::safety::ArmInputs::start_button, time).start) << time.ns;
        EXPECT_FALSE(push(&mamori::safety::ArmInputs::reset_button, time).reset) << time.ns;
    }
    EXPECT_TRUE(push_reset().reset) << "the next one counts";
}

TEST_F(OperatorPanelTest, AStuckButtonDoesNothing) {
    verifies("SWR-SAF-032", Technique::kFaultInjection, Polarity::kViolation);
    inputs_.start_button = true;
    inputs_.reset_button = true;
    for (int i = 0; i < 10000; ++i) {
        const PanelState state = step();
        ASSERT_FALSE(state.start || state.reset) << i;
    }
}

TEST_F(OperatorPanelTest, AButtonThatIsPushedAtPowerUpDoesNothingWhenItIsReleased) {
    verifies("SWR-SAF-032", Technique::kFaultInjection, Polarity::kViolation);
    OperatorPanel panel;
    inputs_.start_button = true;
    inputs_.reset_button = true;
    panel.step(inputs_, mode_, Instant{0});
    inputs_.start_button = false;
    inputs_.reset_button = false;

    const PanelState released = panel.step(inputs_, mode_, Instant{0} + kPushMin);
    EXPECT_FALSE(released.start || released.reset);
}

TEST_F(OperatorPanelTest, EachControlIsReportedWhateverTheMode) {
    verifies("SWR-SAF-035");
    for (const OperatingMode mode : kModes) {
        mode_ = mode;
        EXPECT_EQ(select(mode).faults, 0U);
        inputs_.enabling_closed.fill(false);
        EXPECT_EQ(step_for(200_ms), to_bit(ArmFault::kEnableLost));
        inputs_.enabling_closed.fill(true);
        inputs_.run_button = false;
        EXPECT_EQ(step().faults, to_bit(ArmFault::kRunReleased));
        inputs_.run_button = true;
        inputs_.enabling_squeezed = true;
        EXPECT_EQ(step().faults, to_bit(ArmFault::kEnablingSqueezed));
        inputs_.enabling_squeezed = false;
    }
}

TEST_F(OperatorPanelTest, EitherChannelOfTheEnablingDeviceAloneStopsAndTheirDifferenceIsFound) {
    verifies("SWR-SAF-035", Technique::kFaultInjection, Polarity::kViolation);
    for (const std::array<bool, 2U>& closed :
         {std::array<bool, 2U>{true, false}, std::array<bool, 2U>{false, true}}) {
        sut_ = OperatorPanel{};
        inputs_.enabling_closed = closed;
        EXPECT_EQ(step().faults, to_bit(ArmFault::kEnableLost));
        EXPECT_EQ(step_for(200_ms), to_bit(ArmFault::kEnableLost) | to_bit(ArmFault::kSwitchDiscrepancy));
    }
}

TEST_F(OperatorPanelTest, AnotherDemandAcknowledgesNoFailedSwitch) {
    verifies("SWR-SAF-031", Technique::kErrorGuessing, Polarity::kViolation);
    inputs_.enabling_closed = {true, false};
    step_for(200_ms);
    inputs_.enabling_closed = {false, false};
    step();
    inputs_.enabling_closed = {true, true};
    inputs_.emergency_stop_closed = {false, false};
    for (int i = 0; i < 2; ++i) {
        EXPECT_EQ(step().faults, to_bit(ArmFault::kEmergencyStop) | to_bit(ArmFault::kSwitchDiscrepancy));
    }
}

TEST_F(OperatorPanelTest, TheSelectorGivesTheModeAndNoneIsTheModeOfTheSystem) {
    verifies("SWR-SAF-036");
    for (const OperatingMode mode : kModes) {
        EXPECT_EQ(select(mode).selected, mode);
        inputs_.mode_selected = {};
        EXPECT_EQ(step().selected, mode_);
    }
}

TEST_F(OperatorPanelTest, AfterAFailedSwitchEachPositionIsAFault) {
    verifies("SWR-SAF-036", Technique::kEquivalenceClasses, Polarity::kViolation);
    mode_ = OperatingMode::kSwitchFailed;
    for (const OperatingMode mode : kModes) {
        EXPECT_EQ(select(mode).faults, to_bit(ArmFault::kModeSelector));
    }
    inputs_.mode_selected = {};
    EXPECT_EQ(step().faults, to_bit(ArmFault::kModeSelector));
}

TEST_F(OperatorPanelTest, NoModeAndSeveralModesAreAFaultAfterTheirTimeUntilAReset) {
    verifies("SWR-SAF-036", Technique::kBoundaryValues, Polarity::kViolation);
    for (const std::array<bool, 3U>& contacts :
         {std::array<bool, 3U>{}, std::array<bool, 3U>{false, true, true}}) {
        inputs_.mode_selected = contacts;
        EXPECT_EQ(step_for(kSwitchDiscrepancyTime + kFrame), 0U);
        EXPECT_EQ(step().faults, to_bit(ArmFault::kModeSelector));
        EXPECT_EQ(select(mode_).faults, to_bit(ArmFault::kModeSelector));
        EXPECT_EQ(push_reset().faults, 0U);
    }
}

}  // namespace
}  // namespace safe_arm
