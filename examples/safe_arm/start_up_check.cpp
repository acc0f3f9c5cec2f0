// SPDX-License-Identifier: Apache-2.0
#include "start_up_check.hpp"

#include "mamori/safety/base/elapsed.hpp"

namespace safe_arm {

using mamori::Duration;
using mamori::Instant;
using mamori::safety::SelfTestStatus;

void StartUpCheck::begin(Instant now) noexcept {
    *this = StartUpCheck{};
    step_began_ = now;
}

SelfTestStatus StartUpCheck::step(const StartUpFacts& facts, Instant now) noexcept {
    const bool is_sound = step_ == StartUpStep::kQuiet || (facts.is_good && facts.reading.brakes_closed);
    has_failed_ = has_failed_ || !is_sound || mamori::safety::is_over(step_began_, now, get_time_max());
    if (has_failed_) {
        push_ = 0.0;
        return SelfTestStatus::kFailed;
    }
    if (step_ != StartUpStep::kPassed && is_reached(facts, now)) {
        step_ = static_cast<StartUpStep>(static_cast<unsigned>(step_) + 1U);
        step_began_ = now;
        place_rad_ = step_ == StartUpStep::kPushForwards ? facts.reading.position_a_rad : place_rad_;
    }
    return has_failed_ ? SelfTestStatus::kFailed
                       : (step_ == StartUpStep::kPassed ? SelfTestStatus::kPassed : SelfTestStatus::kRunning);
}

Duration StartUpCheck::get_time_max() const noexcept {
    switch (step_) {
        case StartUpStep::kQuiet:
        case StartUpStep::kPassed:
            return kSelfTestTime;
        case StartUpStep::kPushForwards:
        case StartUpStep::kPushBackwards:
            return kBrakeTestRamp + kBrakeTestHold + kPathTime;
        case StartUpStep::kTorqueOn:
        case StartUpStep::kRelayOpens:
        case StartUpStep::kRelayCloses:
        case StartUpStep::kTorqueOff:
            break;
    }
    return kPathTime;
}

bool StartUpCheck::is_reached(const StartUpFacts& facts, Instant now) noexcept {
    const JointReading& reading = facts.reading;
    switch (step_) {
        case StartUpStep::kQuiet: {
            const bool is_quiet =
                facts.is_good && reading.brakes_closed && !reading.torque_enabled && reading.relay_closed;
            good_frames_ = is_quiet ? good_frames_ + 1U : 0U;
            return good_frames_ >= kSelfTestFrames && now - step_began_ >= kQuietTime;
        }
        case StartUpStep::kTorqueOn:
        case StartUpStep::kRelayCloses:
            return reading.torque_enabled && reading.relay_closed;
        case StartUpStep::kRelayOpens:
            return !reading.torque_enabled && !reading.relay_closed;
        case StartUpStep::kPushForwards:
        case StartUpStep::kPushBackwards:
            return is_push_over(reading, now);
        case StartUpStep::kTorqueOff:
            return !reading.torque_enabled;
        case StartUpStep::kPassed:
            break;
    }
    return false;
}

/// The drives may not be gone: without their torque no brake is tested.
bool StartUpCheck::is_push_over(const JointReading& reading, Instant now) noexcept {
    for (std::size_t j = 0U; j < kArmJointCount; ++j) {
        const bool has_yielded =
            !mamori::safety::is_within(reading.position_a_rad[j] - place_rad_[j], kBrakeTestTravelRad);
        has_failed_ = has_failed_ || has_yielded || !reading.torque_enabled;
    }
    const Duration elapsed = now - step_began_;
    const bool is_over = elapsed >= kBrakeTestRamp + kBrakeTestHold;
    const double share = mamori::to_seconds(elapsed) / mamori::to_seconds(kBrakeTestRamp);
    const double push = has_failed_ || is_over ? 0.0 : (share < 1.0 ? share : 1.0);
    push_ = step_ == StartUpStep::kPushForwards ? push : -push;
    return is_over;
}

}  // namespace safe_arm
