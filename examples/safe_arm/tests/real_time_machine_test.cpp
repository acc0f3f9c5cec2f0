// SPDX-License-Identifier: Apache-2.0
// Goal: the simulated arm takes no time from a window: who opens the windows waits for nothing, and frames in
// which the arm was not ready are counted. Method: the real arm, held in the middle of a step by its
// observer.
#include "real_time_machine.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "mamori/simbody_sim/arm_model.hpp"
#include "mamori/trace/verifies.hpp"
#include "safe_arm_system.hpp"

namespace safe_arm {
namespace {

using mamori::Instant;
using mamori::WindowOutcome;
using namespace mamori::verification;
using Opening = mamori::FrameSchedule::Opening;

class Holder final : public mamori::sim::PlantObserver {
  public:
    void on_substep(Instant, const JointVector&, const JointVector&) override {
        while (is_holding) {
            std::this_thread::yield();
        }
        ++substep_count;
    }
    std::atomic<bool> is_holding{false};
    std::atomic<int> substep_count{0};
};

class RealTimeMachineTest : public ::testing::Test {
  protected:
    void SetUp() override {
        ASSERT_TRUE(loaded_.model.has_value()) << loaded_.error;
        plant_.set_observer(&holder_);
    }
    void TearDown() override { holder_.is_holding = false; }

    /// The start button stands for the process image: the arm never presses it this early.
    bool is_image_renewed(std::int64_t frame) {
        inputs.start_button = true;
        sut_.before_opening(Opening{kFirstWindow, Instant{frame * kFrame.ns}}, Instant{frame * kFrame.ns});
        return !inputs.start_button;
    }
    void end_frame(std::int64_t frame) {
        sut_.after_opening(Opening{kLastWindow, Instant{frame * kFrame.ns + 800'000}},
                           WindowOutcome::kCompleted);
    }

    mamori::sim::LoadedModel loaded_ = mamori::sim::load_arm_model(SAFE_ARM_MODEL_FILE);
    mamori::sim::ArmPlant plant_{loaded_.model.value()};
    Holder holder_;
    RealTimeMachine sut_{plant_};
};

TEST_F(RealTimeMachineTest, TheArmMovesOnByOneFrameBetweenTheLastWindowAndTheNextFirstOne) {
    verifies("SWR-TIM-004");
    EXPECT_TRUE(is_image_renewed(0)) << "before anything has run";
    end_frame(0);
    while (holder_.substep_count < 4) {
        std::this_thread::yield();
    }
    while (!is_image_renewed(1)) {
        std::this_thread::yield();
    }
    EXPECT_EQ(plant_.now(), Instant{kFrame.ns});
    EXPECT_TRUE(sut_.is_plant_sound());
}

TEST_F(RealTimeMachineTest, AnArmThatIsNotReadyIsCountedAndNobodyWaitsForIt) {
    verifies("SWR-TIM-004", Technique::kFaultInjection, Polarity::kViolation);
    holder_.is_holding = true;
    end_frame(0);

    EXPECT_FALSE(is_image_renewed(1)) << "the old sample stays";
    end_frame(1);
    EXPECT_FALSE(is_image_renewed(2));
    EXPECT_EQ(sut_.get_late_count(), 2U);

    holder_.is_holding = false;
    while (!is_image_renewed(3)) {
        std::this_thread::yield();
    }
    EXPECT_EQ(plant_.now(), Instant{kFrame.ns}) << "its time stood still for the frame that it missed";
}

TEST_F(RealTimeMachineTest, OtherWindowsTouchNoDevice) {
    verifies("SWR-TIM-004", Technique::kInterface);
    inputs.start_button = true;
    sut_.before_opening(Opening{kFirstWindow + 1U, Instant{300'000}}, Instant{300'000});
    EXPECT_TRUE(inputs.start_button);
    sut_.after_opening(Opening{kLastWindow - 1U, Instant{700'000}}, WindowOutcome::kCompleted);
    EXPECT_TRUE(is_image_renewed(1));
    EXPECT_EQ(holder_.substep_count, 0);
}

}  // namespace
}  // namespace safe_arm
