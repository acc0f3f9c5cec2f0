// SPDX-License-Identifier: Apache-2.0
// Goal: the controller follows its path, stops along it, and holds the measured position without torque.
// Method: a short table, frame after frame, with the arm assumed to be where the setpoint was.
#include "motion_controller.hpp"

#include <cmath>
#include <fstream>

#include "arm_limits.hpp"
#include "feed.hpp"
#include "mamori/simbody_sim/computed_torque_controller.hpp"
#include "mamori/trace/verifies.hpp"

namespace safe_arm {
namespace {

using mamori::Instant;
using mamori::Status;
using mamori::safety::SafeState;
using namespace mamori::verification;

constexpr Instant kBegin{10000000};

class MotionControllerTest : public ::testing::Test {
  protected:
    void SetUp() override {
        const std::string path = ::testing::TempDir() + "motion_controller_test.dat";
        std::ofstream{path} << "0 0 0 0 0 0 0 0\n1 0.5 0.5 0.5 0.5 0.5 0.5 0.5\n2 1 1 1 1 1 1 1\n";
        std::string error;
        ASSERT_TRUE(track_.read(path, kFrameS, error)) << error;
        const mamori::sim::LoadedModel loaded = mamori::sim::load_arm_model(SAFE_ARM_MODEL_FILE);
        ASSERT_TRUE(loaded.model.has_value()) << loaded.error;
        law_ = std::make_unique<mamori::sim::ComputedTorqueController>(*loaded.model);
        EXPECT_EQ(sut_.on_activated({1, now_}), Status::kPreconditionNotMet) << "not configured";
        sut_.configure(track_, *law_, kBegin);
        ASSERT_EQ(sut_.on_activated({1, now_}), Status::kOk);
    }
    TorqueCommand step(SafeState state, bool torque_enable) {
        feed(sut_.state, measured_);
        StopCommand stop{state, torque_enable, torque_enable};
        stop.mode = mode_;
        feed(sut_.stop, stop);
        EXPECT_EQ(sut_.on_execute({1, now_}), Status::kOk);
        now_ = now_ + kFrame;
        const TorqueCommand command = take(sut_.command);
        measured_.position_rad = command.setpoint_rad;
        return command;
    }
    TorqueCommand play(int frames) {
        TorqueCommand command{};
        for (int i = 0; i < frames; ++i) {
            command = step(SafeState::kOperational, true);
        }
        return command;
    }

    MotionTrack track_;
    std::unique_ptr<mamori::sim::ComputedTorqueController> law_;
    MotionController sut_;
    JointState measured_{};
    Instant now_{};
    OperatingMode mode_{OperatingMode::kAutomatic};
};

TEST_F(MotionControllerTest, EachMessageCarriesItsNumberAndInstant) {
    verifies("SWR-SAF-001");
    const TorqueCommand first = step(SafeState::kStandby, false);
    const TorqueCommand second = step(SafeState::kStandby, false);

    EXPECT_EQ(second.sequence, first.sequence + 1U);
    EXPECT_EQ(first.sent_at_ns, 0);
    EXPECT_EQ(second.sent_at_ns, kFrame.ns);
}

TEST_F(MotionControllerTest, DuringAStopTheSetpointIsTheMeasuredPositionAndThePathEnds) {
    verifies("SWR-SAF-012", Technique::kStateTransition);
    now_ = kBegin;
    play(10);
    measured_.position_rad.fill(0.3);
    feed(sut_.state, measured_);
    feed(sut_.stop, StopCommand{SafeState::kStandstillHold, true, true, true});
    ASSERT_EQ(sut_.on_execute({1, now_}), Status::kOk);
    EXPECT_EQ(take(sut_.command).setpoint_rad, measured_.position_rad);

    EXPECT_EQ(play(10).setpoint_rad, measured_.position_rad) << "it is not at the beginning of the path";
}

TEST_F(MotionControllerTest, InASlowModeThePathIsTheSameAndSlower) {
    verifies("SWR-SAF-012", Technique::kEquivalenceClasses);
    now_ = kBegin;
    mode_ = OperatingMode::kReducedSpeed;
    // The path moves by 0.5 rad per second.
    EXPECT_NEAR(play(2000).setpoint_rad[3], 0.5 * 2.0 * kReducedPathRate, 1.0e-3);
}

TEST_F(MotionControllerTest, WithoutTorqueTheSetpointIsTheMeasuredPosition) {
    verifies("SWR-SAF-012");
    measured_.position_rad.fill(0.3);

    EXPECT_EQ(step(SafeState::kStandby, false).setpoint_rad, measured_.position_rad);
    EXPECT_NEAR(step(SafeState::kOperational, true).setpoint_rad[6], 0.3, 1e-12)
        << "holds before the motion begins";
}

TEST_F(MotionControllerTest, PathIsFollowedFromItsInstantOn) {
    verifies("SWR-SAF-012");
    step(SafeState::kStandby, false);
    play(9);
    EXPECT_NEAR(step(SafeState::kOperational, true).setpoint_rad[0],
                track_.calc_point(kFrameS).position_rad[0], 1e-12);

    EXPECT_NEAR(play(499).setpoint_rad[0], track_.calc_point(500 * kFrameS).position_rad[0], 1e-9);
}

TEST_F(MotionControllerTest, PathIsNotBegunAwayFromItsFirstPoint) {
    verifies("SWR-SAF-012", Technique::kErrorGuessing);
    measured_.position_rad.fill(0.3);
    step(SafeState::kStandby, false);

    EXPECT_NEAR(play(100).setpoint_rad[0], 0.3, 1e-12);
}

}  // namespace
}  // namespace safe_arm
