// SPDX-License-Identifier: Apache-2.0
// Goal: no machine is run whose limits do not enclose the safe limits. Method: the shipped model, changed one
// figure at a time.
#include "model_check.hpp"

#include "arm_limits.hpp"
#include "mamori/trace/verifies.hpp"

namespace safe_arm {
namespace {

using namespace mamori::verification;

class ModelCheckTest : public ::testing::Test {
  protected:
    void SetUp() override {
        const mamori::sim::LoadedModel loaded = mamori::sim::load_arm_model(SAFE_ARM_MODEL_FILE);
        ASSERT_TRUE(loaded.model.has_value()) << loaded.error;
        model_ = *loaded.model;
    }
    void expect_refused(const std::string& joint, const std::string& figure) const {
        const std::string refusal = check_model(model_);
        EXPECT_NE(refusal.find("joint " + joint), std::string::npos) << refusal;
        EXPECT_NE(refusal.find(figure), std::string::npos) << refusal;
    }

    mamori::sim::ArmModel model_;
};

TEST_F(ModelCheckTest, ShippedModelEnclosesTheSafeLimits) {
    verifies("SWR-SAF-003");
    EXPECT_EQ(check_model(model_), "");
}

TEST_F(ModelCheckTest, MachineSlowerThanItsLimitIsRefused) {
    verifies("SWR-SAF-003", Technique::kBoundaryValues, Polarity::kViolation);
    model_.joints[1].speed_limit_rad_s = kNoLoadSpeedRadS[1];
    EXPECT_EQ(check_model(model_), "");

    model_.joints[1].speed_limit_rad_s = kNoLoadSpeedRadS[1] - 1.0e-9;
    expect_refused("J2", "speed_limit_rad_s");
}

TEST_F(ModelCheckTest, MachineWhoseFlangeIsTooFastAtReducedSpeedIsRefused) {
    verifies("SWR-SAF-037", Technique::kBoundaryValues, Polarity::kViolation);
    // 0.24985 m/s: the rest allows 0.5 mm for the four joints before the last links.
    model_.joints[6].offset_m[2] += 0.0002;
    EXPECT_EQ(check_model(model_), "");

    model_.joints[6].offset_m[2] += 0.0003;
    expect_refused("J7", "speed of the flange");
}

TEST_F(ModelCheckTest, MachineFasterThanThePlausibleStepIsRefused) {
    verifies("SWR-SAF-003", Technique::kBoundaryValues, Polarity::kViolation);
    model_.joints[6].speed_limit_rad_s = kMaxStepRad[6] / kFrameS;
    expect_refused("J7", "speed_limit_rad_s");
}

TEST_F(ModelCheckTest, RangeOnEitherSideTorqueAndCoarseEncoderAreJudged) {
    verifies("SWR-SAF-003", Technique::kBoundaryValues, Polarity::kViolation);
    const mamori::sim::ArmModel sound = model_;
    model_.joints[2].position_min_rad = -kSafePositionRad[2];
    expect_refused("J3", "position range");
    model_ = sound;
    model_.joints[2].position_max_rad = kSafePositionRad[2];
    expect_refused("J3", "position range");
    model_ = sound;
    model_.joints[6].brake.closing_delay = kStopTime - model_.sto_delay - kFrame;
    expect_refused("J7", "closing of the brake");
    model_ = sound;
    model_.joints[3].torque_limit_nm = 100.5;
    expect_refused("J4", "torque_limit_nm");
    model_ = sound;
    model_.joints[4].encoder_b_counts_per_rad = 4.0 / kDiscrepancyRad;
    expect_refused("J5", "encoder step");
}

TEST_F(ModelCheckTest, AnArmWithOtherGravityTorquesIsRefused) {
    verifies("SWR-SAF-045", Technique::kBoundaryValues, Polarity::kViolation);
    const mamori::sim::ArmModel sound = model_;
    for (std::size_t j = 1U; j < kArmJointCount; ++j) {
        model_ = sound;
        model_.joints[j].link.mass_kg += 0.2;
        EXPECT_NE(check_model(model_).find("torque against gravity"), std::string::npos) << j;
        model_ = sound;
        model_.joints[j].link.center_of_mass_m[2] += 0.1;
        EXPECT_NE(check_model(model_).find("torque against gravity"), std::string::npos) << j;
        model_ = sound;
        model_.joints[j].link.mass_kg += 1.0e-4;
        EXPECT_EQ(check_model(model_), "") << j;
    }
}

}  // namespace
}  // namespace safe_arm
