// SPDX-License-Identifier: Apache-2.0
/// @file
/// Controllers that are wrong, for fault injection: each number is another one. Messages and their times stay
/// valid, so only the content can show it.
///
/// @satisfies SWR-SAF-044      Design: docs/design/safe_arm.md#wrong-controllers
#ifndef EXAMPLES_SAFE_ARM_WRONG_CONTROLLER_HPP
#define EXAMPLES_SAFE_ARM_WRONG_CONTROLLER_HPP

#include <array>
#include <cstdint>

#include "messages.hpp"

namespace safe_arm {

/// What a wrong controller does with the torque of the sound one; a share is of the torque limit.
enum class Wrong : std::uint8_t {
    kConstant,    ///< a constant share
    kZero,        ///< no torque
    kFlipped,     ///< opposite sign
    kBiased,      ///< plus a constant share
    kDelayed,     ///< the torque of an earlier frame
    kBitFlipped,  ///< one bit of the number is inverted, always or once
    kResonant,    ///< plus a sine
    kUndamped,    ///< plus a torque in the direction of the speed
    kFullSwing,   ///< the limit in the direction of the speed
    kNoise,       ///< plus a random share in each frame
    kRamp,        ///< plus a share that grows
    kFast,        ///< drives the joint at a constant speed near its limit
    kCount,
};

/// Thread safety: none. Time: O(joints). Memory: the torques of kDelayMax frames, no heap. The same number
/// gives the same torques.
class WrongController final {
  public:
    static constexpr std::size_t kDelayMax = 64U;

    explicit WrongController(std::uint64_t number) noexcept;

    /// One frame. @param[in,out] command of the sound controller. @param[in] measured as the controller sees
    /// it.
    void corrupt(TorqueCommand& command, const JointState& measured) noexcept;

    Wrong get_kind() const noexcept { return kind_; }

  private:
    std::uint64_t draw() noexcept;
    /// Uniform in [low, high).
    double draw(double low, double high) noexcept;
    double corrupt(double torque_nm, std::size_t joint, double speed_rad_s) noexcept;

    std::uint64_t random_;
    Wrong kind_{};
    std::array<bool, kArmJointCount> joints_{};  ///< that it concerns
    bool is_echoing_{false};                     ///< reports the measured position as its setpoint
    bool is_once_{false};
    std::uint32_t bit_{0U};
    std::size_t delay_{1U};
    double share_{0.0};
    double frequency_hz_{0.0};
    std::uint64_t frame_{0U};
    std::array<JointVector, kDelayMax> past_nm_{};
};

}  // namespace safe_arm

#endif  // EXAMPLES_SAFE_ARM_WRONG_CONTROLLER_HPP
