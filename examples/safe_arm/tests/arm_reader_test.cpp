// SPDX-License-Identifier: Apache-2.0
// Goal: counts become radians, feedback is passed on. Method: a process image filled here.
#include "arm_reader.hpp"

#include "arm_faults.hpp"
#include "feed.hpp"
#include "mamori/trace/verifies.hpp"

namespace safe_arm {
namespace {

using mamori::Status;
using namespace mamori::verification;

class ArmReaderTest : public ::testing::Test {
  protected:
    static EncoderScale make_scale() {
        EncoderScale scale{};
        scale.a_counts_per_rad.fill(1000.0);
        scale.b_counts_per_rad.fill(100.0);
        return scale;
    }
    mamori::safety::ArmInputs inputs_{};
    ArmReader sut_{inputs_};
};

TEST_F(ArmReaderTest, CountsBecomeRadiansAndFeedbackIsPassedOn) {
    verifies("SWR-SAF-004");
    ASSERT_EQ(sut_.configure(make_scale()), Status::kOk);
    inputs_.encoder_a_counts[2] = -1500;
    inputs_.encoder_b_counts[6] = 25;
    inputs_.reference_closed[2] = true;
    inputs_.drive_clock_ns = 77;
    inputs_.brake_closed.fill(true);
    inputs_.power_good = true;
    inputs_.measured_torque_nm[1] = 4.5;

    ASSERT_EQ(sut_.on_execute({}), Status::kOk);
    const JointReading reading = take(sut_.reading);
    EXPECT_EQ(reading.position_a_rad[2], -1.5);
    EXPECT_EQ(reading.position_b_rad[6], 0.25);
    EXPECT_TRUE(reading.brakes_closed);
    EXPECT_FALSE(reading.brakes_open);
    EXPECT_TRUE(reading.power_good);
    EXPECT_EQ(reading.measured_torque_nm[1], 4.5);
    EXPECT_TRUE(reading.reference_closed[2]);
    EXPECT_FALSE(reading.reference_closed[3]);
    EXPECT_EQ(reading.drive_clock_ns, 77);
}

TEST_F(ArmReaderTest, ThePanelIsEvaluatedInEachFrame) {
    verifies("SWR-SAF-030", Technique::kInterface);
    ASSERT_EQ(sut_.configure(make_scale()), Status::kOk);
    inputs_.start_button = true;
    inputs_.enabling_closed.fill(true);
    inputs_.mode_selected[1] = true;
    const std::array<bool, 4U> pushed{false, true, true, false};
    for (std::size_t i = 0U; i < pushed.size(); ++i) {
        inputs_.reset_button = pushed[i];
        ASSERT_EQ(sut_.on_execute({0, mamori::Instant{} + kPushMin * static_cast<std::int64_t>(i)}),
                  Status::kOk);
    }
    const JointReading reading = take(sut_.reading);
    EXPECT_EQ(reading.panel_faults, to_bit(ArmFault::kEmergencyStop) | to_bit(ArmFault::kProtectiveStop))
        << "an image that was not filled";
    EXPECT_TRUE(reading.reset_button);
    EXPECT_EQ(reading.mode, OperatingMode::kReducedSpeed);
    EXPECT_FALSE(reading.start_button);
}

TEST_F(ArmReaderTest, OneClosedBrakeIsNotOpenBrakes) {
    verifies("SWR-SAF-004", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_EQ(sut_.configure(make_scale()), Status::kOk);
    ASSERT_EQ(sut_.on_execute({}), Status::kOk);
    EXPECT_TRUE(take(sut_.reading).brakes_open);
    inputs_.brake_closed[0] = true;

    ASSERT_EQ(sut_.on_execute({}), Status::kOk);
    EXPECT_FALSE(take(sut_.reading).brakes_open);
}

TEST_F(ArmReaderTest, OneOpenBrakeIsNotClosedBrakes) {
    verifies("SWR-SAF-004", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_EQ(sut_.configure(make_scale()), Status::kOk);
    inputs_.brake_closed.fill(true);
    inputs_.brake_closed[5] = false;

    ASSERT_EQ(sut_.on_execute({}), Status::kOk);
    EXPECT_FALSE(take(sut_.reading).brakes_closed);
}

TEST_F(ArmReaderTest, ReaderWithoutAUsableResolutionRefusesToStart) {
    verifies("SWR-SAF-004", Technique::kBoundaryValues, Polarity::kViolation);
    EXPECT_EQ(sut_.on_activated({}), Status::kPreconditionNotMet);
    EncoderScale scale = make_scale();
    scale.b_counts_per_rad[3] = 0.0;
    EXPECT_EQ(sut_.configure(scale), Status::kBadParameter);
    EXPECT_EQ(sut_.on_activated({}), Status::kPreconditionNotMet);

    ASSERT_EQ(sut_.configure(make_scale()), Status::kOk);
    EXPECT_EQ(sut_.on_activated({}), Status::kOk);
}

}  // namespace
}  // namespace safe_arm
