// SPDX-License-Identifier: Apache-2.0
#include "mamori/safety/assumptions/assumption_checks.hpp"

namespace mamori::safety {

SelfTestStatus TickSourceCheck::check() noexcept {
    const Instant reference = reference_.read();
    const ClockVerdict verdict = ratio_.step(reference, tick_.read());
    if (verdict == ClockVerdict::kViolated) {
        return SelfTestStatus::kFailed;
    }
    return verdict == ClockVerdict::kGood ? SelfTestStatus::kPassed : SelfTestStatus::kRunning;
}

SelfTestStatus ProvisionCheck::check() noexcept {
    if (provision_.is_in_effect()) {
        was_in_effect_ = true;
        return SelfTestStatus::kPassed;
    }
    return was_in_effect_ ? SelfTestStatus::kFailed : SelfTestStatus::kRunning;
}

SelfTestStatus SelfTestCheck::check() noexcept {
    if (!has_begun_) {
        has_begun_ = true;
        test_.begin();
    }
    if (status_ == SelfTestStatus::kRunning) {
        status_ = test_.step();
    }
    return status_;
}

}  // namespace mamori::safety
