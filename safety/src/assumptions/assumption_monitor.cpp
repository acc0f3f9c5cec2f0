// SPDX-License-Identifier: Apache-2.0
#include "mamori/safety/assumptions/assumption_monitor.hpp"

#include "mamori/safety/base/elapsed.hpp"

namespace mamori::safety {

SelfTestStatus AssumptionMonitor::step(Instant now) noexcept {
    if (status_ == SelfTestStatus::kFailed) {
        return status_;
    }
    if (!has_begun_) {
        has_begun_ = true;
        began_ = now;
    }
    SelfTestStatus all = SelfTestStatus::kPassed;
    for (const AssumptionRow& row : rows_) {
        SelfTestStatus one = row.check->check();
        if (one == SelfTestStatus::kRunning && is_over(began_, now, row.within)) {
            one = SelfTestStatus::kFailed;
        }
        if (one >= SelfTestStatus::kFailed && failed_.assumption == kNoAssumption) {
            failed_ = row;
        }
        all = combine(all, one);
    }
    status_ = all;
    return status_;
}

}  // namespace mamori::safety
