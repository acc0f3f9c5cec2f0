// SPDX-License-Identifier: Apache-2.0
// Goal: no limit of the safety concept changes by mistake: the tests of the components use the limits by
// name, so they follow each change. Method: double entry; each limit is stated here a second time.
#include "arm_limits.hpp"

#include <gtest/gtest.h>

#include "mamori/trace/verifies.hpp"

namespace safe_arm {
namespace {

using namespace mamori::verification;

using mamori::safety::kArmJointCount;
using Joints = mamori::safety::JointVector;

TEST(ArmLimitsTest, MotionIsLimitedAsDecided) {
    verifies("SWR-SAF-007");
    EXPECT_EQ(kNoLoadSpeedRadS, (Joints{1.0, 1.0, 2.0, 2.0, 6.28, 6.28, 6.28}));
    EXPECT_EQ(kSafeSpeedRadS, (Joints{0.9, 0.9, 1.8, 1.8, 5.65, 5.65, 5.65}));
    EXPECT_EQ(kSafePositionRad, (Joints{3.05, 1.6, 3.0, 2.35, 4.41, 2.84, 4.41}));
    for (std::size_t j = 0U; j < kArmJointCount; ++j) {
        EXPECT_EQ(kSafeRange[j].min, -kSafePositionRad[j]) << j;
        EXPECT_EQ(kSafeRange[j].max, kSafePositionRad[j]) << j;
    }
    EXPECT_EQ(kTorqueLimitNm, (Joints{232.0, 232.0, 100.0, 100.0, 14.5, 14.5, 14.5}));
    EXPECT_DOUBLE_EQ(kTorqueDeviationNm[0], 34.8);
    EXPECT_DOUBLE_EQ(kTorqueDeviationNm[6], 2.175);
    EXPECT_EQ(kFollowingErrorRad, 0.03);
    EXPECT_EQ(kOverspeedFrames, 2U);
    EXPECT_EQ(kTorqueDeviationFrames, 3U);
    EXPECT_EQ(kTorqueFeedbackTime, 20_ms);
    EXPECT_EQ(kStopTime, 90_ms);
}

TEST(ArmLimitsTest, ReducedSpeedIsLimitedAsDecided) {
    verifies("SWR-SAF-037");
    EXPECT_EQ(kReducedSpeedRadS, (Joints{0.07, 0.07, 0.07, 0.07, 0.15, 0.15, 0.15}));
    EXPECT_EQ(kFlangeSpeedMax, 0.25);
    EXPECT_EQ(kReducedPathRate, 0.025);
}

TEST(ArmLimitsTest, SpeedIsPredictedAsDecided) {
    verifies("SWR-SAF-043");
    EXPECT_EQ(kSpeedPrediction, 2.0);
}

TEST(ArmLimitsTest, ChannelsAreComparedAsDecided) {
    verifies("SWR-SAF-006");
    EXPECT_EQ(kMaxStepRad, (Joints{0.0016, 0.0016, 0.0028, 0.0028, 0.008, 0.008, 0.008}));
    EXPECT_DOUBLE_EQ(kMaxStepBRad[0], 0.0072);
    EXPECT_DOUBLE_EQ(kMaxStepBRad[6], 0.02);
    EXPECT_EQ(kDiscrepancyFrames, 2U);
    EXPECT_EQ(kDiscrepancyRad, 0.004);
    EXPECT_EQ(kStuckTravelRad, 0.004);
}

TEST(ArmLimitsTest, ControllerIsLimitedAsDecided) {
    verifies("SWR-SAF-042");
    EXPECT_EQ(kControllerShareNm, (Joints{60.0, 80.0, 25.0, 35.0, 4.0, 4.0, 4.0}));
    EXPECT_EQ(kControllerStepNm, (Joints{5.0, 8.0, 2.5, 3.5, 0.3, 0.3, 0.3}));
    EXPECT_EQ(kGravityDifferenceNm, 0.05);
    EXPECT_EQ(kBumplessRad, 0.002);
    EXPECT_EQ(kControllerMax, 350_us);
}

TEST(ArmLimitsTest, MessagesAgeAsDecided) {
    verifies("SWR-SAF-008");
    EXPECT_EQ(kFrame, 1_ms);
    EXPECT_EQ(kFrameS, 0.001);
    EXPECT_EQ(kCommandLossesMax, 2U);
    EXPECT_EQ(kCommandAgeMax, 3_ms);
    EXPECT_EQ(kBrakeFeedbackTime, 100_ms);
}

TEST(ArmLimitsTest, StopIsBoundAsDecided) {
    verifies("SWR-SAF-025");
    EXPECT_EQ(kStopBounds.ss2_within, 500_ms);
    EXPECT_EQ(kStopBounds.ss1_within, 500_ms);
    EXPECT_EQ(kStopRampS, 0.25);
    EXPECT_EQ(kStopStiffness, (Joints{6000.0, 6000.0, 2500.0, 2500.0, 200.0, 200.0, 200.0}));
    EXPECT_EQ(kStopDamping, (Joints{330.0, 330.0, 95.0, 95.0, 5.0, 5.0, 5.0}));
    EXPECT_EQ(kStandstillRadS, 0.02);
    EXPECT_EQ(kStandstillTime, 50_ms);
}

TEST(ArmLimitsTest, StopIsMonitoredAsDecided) {
    verifies("SWR-SAF-029");
    EXPECT_EQ(kStopDeviationRad, 0.03);
    EXPECT_EQ(kRestTravelRad, 0.005);
    EXPECT_EQ(kBrakes.closes_within, 100_ms);
}

TEST(ArmLimitsTest, ClockAndModelAreComparedAsDecided) {
    verifies("SWR-SAF-049");
    EXPECT_EQ(kClockLimits.window, 100_ms);
    EXPECT_EQ(kClockLimits.deviation_ppm, 50'000U);
    EXPECT_EQ(kModelDifferenceNm, (Joints{2.0, 4.0, 1.2, 2.5, 0.25, 0.3, 0.25}));
    EXPECT_EQ(kInertiaRoot, (Joints{2.0, 2.0, 1.0, 1.0, 0.32, 0.32, 0.32}));
    EXPECT_EQ(kFrictionNmSRad, (Joints{5.0, 5.0, 1.0, 1.0, 0.05, 0.05, 0.05}));
    EXPECT_EQ(kModelTimeS, 0.5);
    EXPECT_EQ(kReferenceRad, 0.02);
}

TEST(ArmLimitsTest, StartUpTestsAreAsDecided) {
    verifies("SWR-SAF-026");
    EXPECT_EQ(kPathTime, 20_ms);
    EXPECT_EQ(kBrakeTestRamp, 20_ms);
    EXPECT_EQ(kBrakeTestHold, 30_ms);
    EXPECT_EQ(kBrakeTestTravelRad, 0.0025);
    EXPECT_EQ(kBrakeTestInterval, mamori::Duration{28'800'000'000'000});
    EXPECT_EQ(kQuietTime, 40_ms);
    EXPECT_EQ(kSelfTestFrames, 20U);
    EXPECT_EQ(kSelfTestTime, 500_ms);
}

TEST(ArmLimitsTest, OperatorHasTheDecidedTime) {
    verifies("SWR-SAF-032");
    EXPECT_EQ(kSwitchDiscrepancyTime, 100_ms);
    EXPECT_EQ(kPushMin, 20_ms);
    EXPECT_EQ(kPushMax, 3000_ms);
}

TEST(ArmLimitsTest, PartitionIsSupervisedAsDecided) {
    verifies("SWR-SAF-015");
    EXPECT_EQ(kSafetyComponentMax, 100_us);
    EXPECT_EQ(kLatenessMax, 50_us);
    EXPECT_EQ(kWatchdogTimeout, 5_ms);
    EXPECT_EQ(kWatchdogWindow.shortest, 500_us);
    EXPECT_EQ(kWatchdogWindow.longest, 4_ms);
}

}  // namespace
}  // namespace safe_arm
