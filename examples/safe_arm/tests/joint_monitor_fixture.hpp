// SPDX-License-Identifier: Apache-2.0
/// @file
/// The monitor, one frame after the other, with readings, messages and drive commands made by the test.
#ifndef EXAMPLES_SAFE_ARM_TESTS_JOINT_MONITOR_FIXTURE_HPP
#define EXAMPLES_SAFE_ARM_TESTS_JOINT_MONITOR_FIXTURE_HPP

#include "arm_limits.hpp"
#include "feed.hpp"
#include "joint_monitor.hpp"
#include "mamori/trace/verifies.hpp"

namespace safe_arm {

/// Just inside and just outside of a limit.
inline constexpr double kInside = 0.999;
inline constexpr double kOutside = 1.001;

class JointMonitorTest : public ::testing::Test {
  protected:
    void SetUp() override {
        reading_.mode = OperatingMode::kAutomatic;
        reading_.power_good = true;
        reading_.brakes_closed = false;
        reading_.brakes_open = true;
        reading_.torque_enabled = true;
        drive_.torque_enable = true;
        drive_.brake_release = true;
        ASSERT_EQ(sut_.on_activated({0, now_}), mamori::Status::kOk);
    }

    /// One frame with the fixture's reading, command and drive values.
    JointState step() {
        feed(sut_.reading, reading_);
        feed(sut_.command, command_);
        feed(sut_.drive, drive_);
        EXPECT_EQ(sut_.on_execute({0, now_}), mamori::Status::kOk);
        now_ = now_ + kFrame;
        return take(sut_.state);
    }
    void place(std::size_t joint, double position_rad) {
        reading_.position_a_rad[joint] = position_rad;
        reading_.position_b_rad[joint] = position_rad;
        reading_.reference_closed[joint] = position_rad > 0.0;
        command_.setpoint_rad[joint] = position_rad;
    }
    /// Moves a joint at constant speed for `frames` frames; returns the last state.
    JointState move(std::size_t joint, double speed_rad_s, int frames) {
        JointState last{};
        for (int i = 0; i < frames; ++i) {
            place(joint, reading_.position_a_rad[joint] + speed_rad_s * kFrameS);
            last = step();
        }
        return last;
    }

    /// Torque off, closed brakes.
    void rest() {
        drive_ = {};
        reading_.torque_enabled = false;
        reading_.brakes_closed = true;
        reading_.brakes_open = false;
    }

    JointMonitor sut_;
    JointReading reading_{};
    TorqueCommand command_{};
    DriveCommand drive_{};
    mamori::Instant now_{1000000000};
};

}  // namespace safe_arm

#endif  // EXAMPLES_SAFE_ARM_TESTS_JOINT_MONITOR_FIXTURE_HPP
