// SPDX-License-Identifier: Apache-2.0
// Goal: the plant behind a link follows the frames of the kernel, holds the outputs over missing ones, and
// removes torque and closes the brakes by itself when messages stop. Method: the real plant, messages by
// hand.
#include "hil_plant.hpp"

#include <gtest/gtest.h>

#include "mamori/simbody_sim/arm_model.hpp"
#include "mamori/trace/verifies.hpp"

namespace safe_arm {
namespace {

using mamori::Instant;
using namespace mamori::verification;

class HilPlantTest : public ::testing::Test {
  protected:
    HilPlantTest() { plant_.reset({}); }

    static DriveFrame make_frame(std::uint32_t frame, std::uint32_t services = 1U) {
        DriveFrame result{};
        result.frame = frame;
        result.watchdog_services = services;
        result.outputs.torque_enable = true;
        result.outputs.brake_release = true;
        result.outputs.relay_close = true;
        result.report.is_stopping = false;
        return result;
    }
    /// Frames 0 .. count - 1, each with a service of the watchdog.
    void run(std::uint32_t count) {
        for (std::uint32_t frame = 0U; frame < count; ++frame) {
            sut_.take(make_frame(frame, frame + 1U));
        }
    }

    mamori::sim::LoadedModel loaded_ = mamori::sim::load_arm_model(SAFE_ARM_MODEL_FILE);
    mamori::sim::ArmPlant plant_{loaded_.model.value()};
    mamori::sim::FaultPlan fault_{};
    RunRecord record_{{}, loaded_.model.value(), fault_, Instant{}, Instant{}};
    HilPlant sut_{plant_, fault_, record_};
};

TEST_F(HilPlantTest, StandsUntilTheFirstFrameAndPassesOneFrameForEach) {
    verifies("SWR-HIL-003", Technique::kRequirementsBased, Polarity::kNominal);
    EXPECT_EQ(sut_.answer().answered_ns, 0);
    EXPECT_FALSE(sut_.is_linked());
    EXPECT_EQ(sut_.get_frame_count(), 0U);

    run(3U);
    EXPECT_TRUE(sut_.is_linked());
    EXPECT_EQ(sut_.get_frame_count(), 3U);
    EXPECT_EQ(sut_.answer().answered_ns, 2 * kFrame.ns);
    EXPECT_TRUE(sut_.answer().inputs.power_good);
}

TEST_F(HilPlantTest, MissingFramesPassWithTheLastOutputs) {
    verifies("SWR-HIL-003", Technique::kFaultInjection, Polarity::kViolation);
    run(40U);
    ASSERT_TRUE(sut_.answer().inputs.torque_enabled);
    sut_.take(make_frame(43U, 44U));

    EXPECT_EQ(sut_.get_frame_count(), 44U);
    EXPECT_TRUE(sut_.answer().inputs.torque_enabled);
}

TEST_F(HilPlantTest, AFrameOfThePastPassesNoTime) {
    verifies("SWR-HIL-003", Technique::kBoundaryValues, Polarity::kViolation);
    run(5U);
    sut_.take(make_frame(3U, 6U));
    EXPECT_EQ(sut_.get_frame_count(), 5U);
    sut_.take(make_frame(5U, 7U));
    EXPECT_EQ(sut_.get_frame_count(), 6U);
}

TEST_F(HilPlantTest, WithoutMessagesTorqueEndsAfterTheTimeOutAndStaysAway) {
    verifies("SWR-HIL-003", Technique::kFaultInjection, Polarity::kViolation);
    run(100U);
    ASSERT_TRUE(sut_.answer().inputs.torque_enabled);
    sut_.lose_link();

    EXPECT_EQ(*sut_.get_lost_at(), Instant{100 * kFrame.ns});
    EXPECT_EQ(*sut_.get_closed_at() - *sut_.get_lost_at(), kDriveSilenceMax);
    for (int i = 0; i < 100; ++i) {
        sut_.run_alone();
    }
    const std::uint64_t before = sut_.get_frame_count();
    sut_.take(make_frame(300U, 400U));  // too late: only a power cycle helps
    sut_.run_alone();
    EXPECT_EQ(sut_.get_frame_count(), before + 1U);
    EXPECT_FALSE(sut_.answer().inputs.torque_enabled);
    for (const bool is_closed : sut_.answer().inputs.brake_closed) {
        EXPECT_TRUE(is_closed);
    }
}

TEST_F(HilPlantTest, WithoutServicesTheWatchdogRelayOpensAlthoughMessagesArrive) {
    verifies("SWR-HIL-003", Technique::kFaultInjection, Polarity::kViolation);
    run(100U);
    for (std::uint32_t frame = 100U; frame < 200U; ++frame) {
        sut_.take(make_frame(frame, 100U));
    }

    EXPECT_TRUE(sut_.is_linked());
    EXPECT_FALSE(sut_.answer().inputs.torque_enabled);
    EXPECT_TRUE(sut_.answer().inputs.brake_closed[1]);
}

}  // namespace
}  // namespace safe_arm
