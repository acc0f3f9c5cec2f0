// SPDX-License-Identifier: Apache-2.0
#include "mamori/safety/redundancy/discrepancy.hpp"

#include "mamori/safety/base/elapsed.hpp"

namespace mamori::safety {

Discrepancy DiscrepancyTimer::step(bool do_disagree, Instant now) noexcept {
    const bool has_run_backwards = now < stepped_at_;
    stepped_at_ = now;
    if (!is_present_) {
        since_ = now;
    }
    is_present_ = do_disagree;
    is_latched_ = is_latched_ || has_run_backwards || (do_disagree && is_over(since_, now, limit_));
    return get();
}

Status DiscrepancyTimer::acknowledge() noexcept {
    if (is_latched_ && is_present_) {
        return Status::kPreconditionNotMet;
    }
    is_latched_ = false;
    return Status::kOk;
}

}  // namespace mamori::safety
