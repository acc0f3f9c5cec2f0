// SPDX-License-Identifier: Apache-2.0
#include "wrong_controller.hpp"

#include <cmath>
#include <cstring>

#include "arm_limits.hpp"

namespace safe_arm {
namespace {

constexpr double kTwoPi = 6.283185307179586;
/// Gain of kFast and of kUndamped: share of the torque limit per share of the safe speed.
constexpr double kSpeedGain = 2.0;

double invert_bit(double value, std::uint32_t bit) noexcept {
    std::uint64_t bits = 0U;
    std::memcpy(&bits, &value, sizeof(bits));
    bits ^= std::uint64_t{1U} << bit;
    std::memcpy(&value, &bits, sizeof(bits));
    return value;
}

}  // namespace

WrongController::WrongController(std::uint64_t number) noexcept : random_(number) {
    kind_ = static_cast<Wrong>(number % static_cast<std::uint64_t>(Wrong::kCount));
    const bool is_one_joint = draw() % 4U != 0U;
    const std::size_t joint = draw() % kArmJointCount;
    for (std::size_t j = 0U; j < kArmJointCount; ++j) {
        joints_[j] = !is_one_joint || j == joint;
    }
    is_echoing_ = draw() % 4U != 0U;
    is_once_ = draw() % 2U != 0U;
    bit_ = static_cast<std::uint32_t>(draw() % 64U);
    delay_ = 1U + draw() % (kDelayMax - 1U);
    share_ = draw(-1.0, 1.0);
    // From 0.5 to 200 Hz, each decade as often.
    frequency_hz_ = 0.5 * std::exp(draw(0.0, std::log(400.0)));
}

/// Source: S. Vigna, SplitMix64 (public domain): an additive sequence and a mixing function.
std::uint64_t WrongController::draw() noexcept {
    random_ += 0x9E3779B97F4A7C15U;
    std::uint64_t mixed = random_;
    mixed = (mixed ^ (mixed >> 30U)) * 0xBF58476D1CE4E5B9U;
    mixed = (mixed ^ (mixed >> 27U)) * 0x94D049BB133111EBU;
    return mixed ^ (mixed >> 31U);
}

double WrongController::draw(double low, double high) noexcept {
    constexpr double kStep = 1.0 / 9007199254740992.0;  // 2^-53
    return low + (high - low) * static_cast<double>(draw() >> 11U) * kStep;
}

void WrongController::corrupt(TorqueCommand& command, const JointState& measured) noexcept {
    past_nm_[frame_ % kDelayMax] = command.torque_nm;
    for (std::size_t j = 0U; j < kArmJointCount; ++j) {
        if (joints_[j]) {
            command.torque_nm[j] = corrupt(command.torque_nm[j], j, measured.velocity_rad_s[j]);
        }
    }
    if (is_echoing_) {
        command.setpoint_rad = measured.position_rad;
    }
    ++frame_;
}

double WrongController::corrupt(double torque_nm, std::size_t joint, double speed_rad_s) noexcept {
    const double limit_nm = kTorqueLimitNm[joint];
    const double speed_share = speed_rad_s / kSafeSpeedRadS[joint];
    const double time_s = static_cast<double>(frame_) * kFrameS;
    switch (kind_) {
        case Wrong::kConstant:
            return share_ * limit_nm;
        case Wrong::kZero:
            return 0.0;
        case Wrong::kFlipped:
            return -torque_nm;
        case Wrong::kBiased:
            return torque_nm + share_ * limit_nm;
        case Wrong::kDelayed:
            return past_nm_[(frame_ + kDelayMax - (frame_ < delay_ ? frame_ : delay_)) % kDelayMax][joint];
        case Wrong::kBitFlipped:
            return is_once_ && frame_ != 0U ? torque_nm : invert_bit(torque_nm, bit_);
        case Wrong::kResonant:
            return torque_nm + share_ * limit_nm * std::sin(kTwoPi * frequency_hz_ * time_s);
        case Wrong::kUndamped:
            return torque_nm + std::fabs(share_) * kSpeedGain * limit_nm * speed_share;
        case Wrong::kFullSwing:
            return speed_rad_s * share_ > 0.0 ? limit_nm : -limit_nm;
        case Wrong::kNoise:
            return torque_nm + draw(-share_, share_) * limit_nm;
        case Wrong::kRamp:
            return torque_nm + share_ * limit_nm * time_s * frequency_hz_;
        case Wrong::kFast: {
            const double wanted_share = (share_ > 0.0 ? 1.0 : -1.0) * (0.7 + 0.4 * std::fabs(share_));
            return torque_nm + kSpeedGain * limit_nm * (wanted_share - speed_share);
        }
        case Wrong::kCount:
            break;
    }
    return torque_nm;
}

}  // namespace safe_arm
