// SPDX-License-Identifier: Apache-2.0
#include "mamori/safety/self_test/clock_check.hpp"

namespace mamori::safety {

void ClockCheck::begin() noexcept {
    ratio_ = ClockRatio(limits_);
    step_ = 0U;
}

SelfTestStatus ClockCheck::step() noexcept {
    const Instant reference = reference_.read();
    const ClockVerdict verdict = ratio_.step(reference, checked_.read());
    ++step_;
    if (verdict == ClockVerdict::kViolated) {
        return SelfTestStatus::kFailed;
    }
    if (step_ < step_count_) {
        return SelfTestStatus::kRunning;
    }
    return verdict == ClockVerdict::kGood ? SelfTestStatus::kPassed : SelfTestStatus::kFailed;
}

}  // namespace mamori::safety
