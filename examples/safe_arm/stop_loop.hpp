// SPDX-License-Identifier: Apache-2.0
/// @file
/// Brings the arm to rest and holds it there under torque (SS1, SOS) without the controller. Each joint
/// follows a ramp from its speed to zero: the torque against gravity, and a spring with a damper to the ramp.
///
/// @satisfies SWR-SAF-025      Design: docs/design/safe_arm.md#stop-and-hold
#ifndef EXAMPLES_SAFE_ARM_STOP_LOOP_HPP
#define EXAMPLES_SAFE_ARM_STOP_LOOP_HPP

#include "arm_limits.hpp"
#include "messages.hpp"

namespace safe_arm {

/// Thread safety: none. Time: O(joints). Memory: no heap.
class StopLoop final {
  public:
    /// One frame. The first one begins the ramp at the measured position and speed.
    /// @param[in] measured position [rad] and speed [rad/s] of this frame.
    /// @param[in] gravity_nm torque of each joint that holds the arm there [N m].
    /// @return torque of each joint [N m], not limited.
    JointVector step(const JointState& measured, const JointVector& gravity_nm) noexcept {
        if (!is_running_) {
            is_running_ = true;
            rate_ = 1.0;
            setpoint_rad_ = measured.position_rad;
            speed_rad_s_ = measured.velocity_rad_s;
        }
        JointVector torque_nm = gravity_nm;
        for (std::size_t j = 0U; j < kArmJointCount; ++j) {
            const double speed_rad_s = speed_rad_s_[j] * rate_ * rate_;
            torque_nm[j] += kStopStiffness[j] * (setpoint_rad_[j] - measured.position_rad[j]) +
                            kStopDamping[j] * (speed_rad_s - measured.velocity_rad_s[j]);
            setpoint_rad_[j] += speed_rad_s * kFrameS;
        }
        constexpr double kStep = kFrameS / kStopRampS;
        rate_ = rate_ > kStep ? rate_ - kStep : 0.0;
        return torque_nm;
    }

    /// The next step begins a new ramp.
    void release() noexcept { is_running_ = false; }

    /// Where the ramp wants the arm at the next frame [rad].
    const JointVector& get_setpoint() const noexcept { return setpoint_rad_; }

  private:
    JointVector setpoint_rad_{};
    JointVector speed_rad_s_{};  ///< at the begin
    double rate_{0.0};           ///< of that speed
    bool is_running_{false};
};

}  // namespace safe_arm

#endif  // EXAMPLES_SAFE_ARM_STOP_LOOP_HPP
