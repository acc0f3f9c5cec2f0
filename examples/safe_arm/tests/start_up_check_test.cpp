// SPDX-License-Identifier: Apache-2.0
// Goal: the arm starts only after both switch-off paths and each brake have been tested. Method: devices that
// follow the commands of the test, or one of them that does not.
#include "start_up_check.hpp"

#include <functional>

#include "mamori/trace/verifies.hpp"

namespace safe_arm {
namespace {

using mamori::Instant;
using mamori::safety::SelfTestStatus;
using namespace mamori::verification;

class StartUpCheckTest : public ::testing::Test {
  protected:
    void SetUp() override {
        sut_.begin(now_);
        facts_.is_good = true;
        facts_.reading.brakes_closed = true;
    }
    /// Frames until a result. The devices follow; `disturb` changes what they show.
    SelfTestStatus run(const std::function<void()>& disturb = [] {}) {
        for (int i = 0; i < 600; ++i) {
            // A fresh relay closes in the first frame.
            facts_.reading.relay_closed = i > 0 && sut_.is_relay_wanted();
            facts_.reading.torque_enabled = sut_.is_torque_wanted() && facts_.reading.relay_closed;
            const double yield_rad = sut_.get_push() * yield_max_rad_;
            facts_.reading.position_a_rad.fill(0.5 + yield_rad);
            disturb();
            const SelfTestStatus status = sut_.step(facts_, now_);
            has_torque_without_test_ =
                has_torque_without_test_ || (sut_.is_torque_wanted() && status != SelfTestStatus::kRunning);
            highest_ = sut_.get_push() > highest_ ? sut_.get_push() : highest_;
            lowest_ = sut_.get_push() < lowest_ ? sut_.get_push() : lowest_;
            if (status != SelfTestStatus::kRunning) {
                return status;
            }
            now_ = now_ + kFrame;
        }
        return SelfTestStatus::kRunning;
    }
    void expect_failed(StartUpStep step, const std::function<void()>& disturb) {
        EXPECT_EQ(run(disturb), SelfTestStatus::kFailed);
        EXPECT_EQ(sut_.get_step(), step);
        EXPECT_FALSE(sut_.is_torque_wanted());
        EXPECT_EQ(sut_.get_push(), 0.0);
        EXPECT_EQ(sut_.step(facts_, now_), SelfTestStatus::kFailed) << "once is for good";
    }

    StartUpCheck sut_{};
    StartUpFacts facts_{};
    Instant now_{1000000000};
    double yield_max_rad_{0.002};
    double highest_{0.0};
    double lowest_{0.0};
    bool has_torque_without_test_{false};
};

TEST_F(StartUpCheckTest, SoundDevicesPassAndEachDrivePushesWithItsLimitInBothDirections) {
    verifies("SWR-SAF-027", Technique::kStateTransition);
    EXPECT_EQ(run(), SelfTestStatus::kPassed);
    EXPECT_EQ(highest_, 1.0);
    EXPECT_EQ(lowest_, -1.0);
    EXPECT_FALSE(has_torque_without_test_);
    EXPECT_LT(now_ - Instant{1000000000}, 200_ms);
    EXPECT_GE(now_ - Instant{1000000000},
              kQuietTime + kBrakeTestRamp + kBrakeTestHold + kBrakeTestRamp + kBrakeTestHold);
}

TEST_F(StartUpCheckTest, ABrakeThatYieldsFailsInEitherDirection) {
    verifies("SWR-SAF-027", Technique::kFaultInjection, Polarity::kViolation);
    for (const StartUpStep step : {StartUpStep::kPushForwards, StartUpStep::kPushBackwards}) {
        for (std::size_t joint = 0U; joint < kArmJointCount; ++joint) {
            sut_.begin(now_);
            expect_failed(step, [&] {
                if (sut_.get_step() == step) {
                    facts_.reading.position_a_rad[joint] = 0.5 + kBrakeTestTravelRad * 1.001;
                }
            });
        }
    }
}

TEST_F(StartUpCheckTest, ABrakeThatYieldsUpToItsLimitPasses) {
    verifies("SWR-SAF-027", Technique::kBoundaryValues);
    yield_max_rad_ = kBrakeTestTravelRad * 0.999;
    EXPECT_EQ(run(), SelfTestStatus::kPassed);
}

TEST_F(StartUpCheckTest, APushWithoutTorqueTestsNothingAndFails) {
    verifies("SWR-SAF-027", Technique::kFaultInjection, Polarity::kViolation);
    expect_failed(StartUpStep::kPushForwards, [&] {
        facts_.reading.torque_enabled = facts_.reading.torque_enabled && sut_.get_push() == 0.0;
    });
}

TEST_F(StartUpCheckTest, EachPathThatDoesNotSwitchOffFails) {
    verifies("SWR-SAF-026", Technique::kFaultInjection, Polarity::kViolation);
    expect_failed(StartUpStep::kRelayOpens, [&] {
        if (sut_.get_step() == StartUpStep::kRelayOpens) {
            facts_.reading.relay_closed = true;
            facts_.reading.torque_enabled = true;
        }
    });
    sut_.begin(now_);
    expect_failed(StartUpStep::kRelayOpens, [&] {
        facts_.reading.relay_closed =
            facts_.reading.relay_closed || sut_.get_step() == StartUpStep::kRelayOpens;
    });
    sut_.begin(now_);
    expect_failed(StartUpStep::kTorqueOff, [&] {
        facts_.reading.torque_enabled =
            facts_.reading.torque_enabled || sut_.get_step() == StartUpStep::kTorqueOff;
    });
}

TEST_F(StartUpCheckTest, DrivesOrARelayThatDoNotSwitchOnFail) {
    verifies("SWR-SAF-026", Technique::kFaultInjection, Polarity::kViolation);
    expect_failed(StartUpStep::kTorqueOn, [&] { facts_.reading.torque_enabled = false; });
    sut_.begin(now_);
    expect_failed(StartUpStep::kRelayCloses, [&] {
        facts_.reading.relay_closed =
            facts_.reading.relay_closed && sut_.get_step() != StartUpStep::kRelayCloses;
    });
    sut_.begin(now_);
    expect_failed(StartUpStep::kQuiet, [&] { facts_.reading.relay_closed = false; });
}

TEST_F(StartUpCheckTest, APathMayAnswerUpToItsTime) {
    verifies("SWR-SAF-026", Technique::kBoundaryValues);
    Instant opens_at{};
    EXPECT_EQ(run([&] {
                  if (sut_.get_step() == StartUpStep::kRelayOpens) {
                      opens_at = opens_at == Instant{} ? now_ - kFrame : opens_at;
                      const bool is_late = now_ - opens_at < kPathTime;
                      facts_.reading.relay_closed = is_late;
                      facts_.reading.torque_enabled = is_late;
                  }
              }),
              SelfTestStatus::kPassed);
}

TEST_F(StartUpCheckTest, APathThatAnswersAfterItsTimeFails) {
    verifies("SWR-SAF-026", Technique::kBoundaryValues, Polarity::kViolation);
    for (const StartUpStep step : {StartUpStep::kRelayOpens, StartUpStep::kTorqueOff}) {
        sut_.begin(now_);
        Instant began{};
        expect_failed(step, [&] {
            if (sut_.get_step() == step) {
                began = began == Instant{} ? now_ - kFrame : began;
                const bool is_late = now_ - began <= kPathTime;
                facts_.reading.torque_enabled = is_late;
                facts_.reading.relay_closed = is_late || step == StartUpStep::kTorqueOff;
            }
        });
    }
}

TEST_F(StartUpCheckTest, AFaultOrAnOpenBrakeDuringTheTestsFails) {
    verifies("SWR-SAF-026", Technique::kFaultInjection, Polarity::kViolation);
    for (const bool is_brake : {false, true}) {
        sut_.begin(now_);
        facts_.is_good = true;
        facts_.reading.brakes_closed = true;
        expect_failed(StartUpStep::kPushForwards, [&] {
            const bool is_wrong = sut_.get_step() == StartUpStep::kPushForwards;
            facts_.is_good = is_brake || !is_wrong;
            facts_.reading.brakes_closed = !is_brake || !is_wrong;
        });
    }
}

TEST_F(StartUpCheckTest, TheQuietFramesComeInARowAndNotBeforeTheirTime) {
    verifies("SWR-SAF-026", Technique::kBoundaryValues, Polarity::kViolation);
    int frame = 0;
    EXPECT_EQ(run([&] { facts_.is_good = ++frame != 30; }), SelfTestStatus::kPassed);
    sut_.begin(now_);
    const Instant began = now_;
    Instant first_torque{};
    EXPECT_EQ(run([&] {
                  if (sut_.is_torque_wanted() && first_torque == Instant{}) {
                      first_torque = now_;
                  }
              }),
              SelfTestStatus::kPassed);
    EXPECT_EQ(first_torque - began, kQuietTime + kFrame);
}

}  // namespace
}  // namespace safe_arm
