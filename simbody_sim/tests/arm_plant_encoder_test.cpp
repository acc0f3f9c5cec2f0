// SPDX-License-Identifier: Apache-2.0
// Goal: two encoder channels show the true position in counts of their own, and fail as told.
#include <limits>

#include "arm_test_support.hpp"

namespace mamori::sim {
namespace {

using namespace test;

class ArmPlantEncoderTest : public ::testing::Test {
  protected:
    /// The closed brakes keep the pose to within a millirad, the truth is read exactly.
    void move_to(const JointVector& q) {
        sut_.reset(q);
        ASSERT_EQ(sut_.positions(), q);
    }

    const ArmModel model_ = load_shipped_model();
    ArmPlant sut_{model_};
};

TEST_F(ArmPlantEncoderTest, BothChannelsShowThePositionToHalfACountEach) {
    verifies("SWR-SIM-009");
    Numbers numbers(7U);

    for (int pose = 0; pose < 100; ++pose) {
        move_to(numbers.draw_vector(-1.6, 1.6));
        const safety::ArmInputs& inputs = sut_.sample();
        for (std::size_t i = 0U; i < kArmJointCount; ++i) {
            const double a = inputs.encoder_a_counts[i] / model_.joints[i].encoder_a_counts_per_rad;
            const double b = inputs.encoder_b_counts[i] / model_.joints[i].encoder_b_counts_per_rad;
            EXPECT_LE(std::abs(a - sut_.positions()[i]), 0.501 / model_.joints[i].encoder_a_counts_per_rad);
            EXPECT_LE(std::abs(b - sut_.positions()[i]), 0.501 / model_.joints[i].encoder_b_counts_per_rad);
        }
    }
}

TEST_F(ArmPlantEncoderTest, ChannelsHaveResolutionsOfTheirOwn) {
    verifies("SWR-SIM-009", Technique::kBoundaryValues);
    const double a_per_rad = model_.joints[2].encoder_a_counts_per_rad;
    const double b_per_rad = model_.joints[2].encoder_b_counts_per_rad;
    ASSERT_GT(a_per_rad, 2.0 * b_per_rad);

    JointVector q{};
    q[2] = 0.51 / a_per_rad;
    move_to(q);
    EXPECT_EQ(sut_.sample().encoder_a_counts[2], 1);
    EXPECT_EQ(sut_.sample().encoder_b_counts[2], 0);
    q[2] = 0.49 / a_per_rad;
    move_to(q);
    EXPECT_EQ(sut_.sample().encoder_a_counts[2], 0);
    q[2] = -0.51 / b_per_rad;
    move_to(q);
    EXPECT_EQ(sut_.sample().encoder_b_counts[2], -1);
}

TEST_F(ArmPlantEncoderTest, APositionOutsideTheCountSaturates) {
    verifies("SWR-SIM-009", Technique::kBoundaryValues);
    sut_.faults().encoder_a[0].bias_rad = 1.0e9;
    sut_.faults().encoder_b[0].bias_rad = -1.0e9;

    EXPECT_EQ(sut_.sample().encoder_a_counts[0], std::numeric_limits<std::int32_t>::max());
    EXPECT_EQ(sut_.sample().encoder_b_counts[0], std::numeric_limits<std::int32_t>::min());
}

TEST_F(ArmPlantEncoderTest, AFrozenChannelKeepsItsCountWhileTheOtherFollowsAndRecovers) {
    verifies("SWR-SIM-012", Technique::kFaultInjection);
    move_to(kBentPose);
    const std::int32_t before = sut_.sample().encoder_a_counts[1];

    sut_.faults().encoder_a[1].frozen = true;
    safety::ArmOutputs fall;
    fall.brake_release = true;
    fall.relay_close = true;
    ASSERT_EQ(sut_.step(fall, 300_ms), Status::kOk);
    EXPECT_EQ(sut_.sample().encoder_a_counts[1], before);
    const double b_rad = sut_.sample().encoder_b_counts[1] / model_.joints[1].encoder_b_counts_per_rad;
    EXPECT_NEAR(b_rad, sut_.positions()[1], 1.0e-4);
    EXPECT_GT(std::abs(b_rad - kBentPose[1]), 0.05);

    sut_.faults().encoder_a[1].frozen = false;
    EXPECT_NE(sut_.sample().encoder_a_counts[1], before);
}

TEST_F(ArmPlantEncoderTest, AFlippedBitAndABiasChangeTheCountOfTheirChannelOnly) {
    verifies("SWR-SIM-012", Technique::kFaultInjection);
    move_to(kBentPose);
    const safety::ArmInputs sound = sut_.sample();

    sut_.faults().encoder_b[3].flipped_bit = 12U;
    EXPECT_EQ(sut_.sample().encoder_b_counts[3], sound.encoder_b_counts[3] ^ (1 << 12));
    EXPECT_EQ(sut_.sample().encoder_a_counts, sound.encoder_a_counts);

    sut_.faults().encoder_b[3].flipped_bit = 31U;
    EXPECT_LT(sut_.sample().encoder_b_counts[3], 0);

    sut_.faults() = {};
    sut_.faults().encoder_a[0].bias_rad = 0.1;
    EXPECT_NEAR(sut_.sample().encoder_a_counts[0] - sound.encoder_a_counts[0],
                0.1 * model_.joints[0].encoder_a_counts_per_rad, 1.0);
    EXPECT_EQ(sut_.sample().encoder_b_counts, sound.encoder_b_counts);
}

TEST_F(ArmPlantEncoderTest, AReferenceSwitchShowsTheTrueSideOfZero) {
    verifies("SWR-ARM-001", Technique::kBoundaryValues);
    sut_.faults().encoder_a[1].bias_rad = -1.0;
    sut_.faults().encoder_b[1].bias_rad = -1.0;
    for (const double position_rad : {-1e-9, 0.0, 1e-9}) {
        JointVector pose{};
        pose[1] = position_rad;
        sut_.reset(pose);
        EXPECT_EQ(sut_.sample().reference_closed[1], position_rad > 0.0) << position_rad;
        EXPECT_FALSE(sut_.sample().reference_closed[0]);
    }
}

TEST_F(ArmPlantEncoderTest, TheClockOfTheDrivesShowsTheTimeOfThePlant) {
    verifies("SWR-ARM-001");
    EXPECT_EQ(sut_.sample().drive_clock_ns, 0);
    ASSERT_EQ(sut_.step({}, 3_ms), Status::kOk);
    EXPECT_EQ(sut_.sample().drive_clock_ns, 3000000);
}

}  // namespace
}  // namespace mamori::sim
