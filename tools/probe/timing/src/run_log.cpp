// SPDX-License-Identifier: Apache-2.0
#include "mamori/timing/run_log.hpp"

namespace mamori::timing {

void RunLog::add_opening(const OpeningRow& row) noexcept {
    if (opening_count_ == openings_.size()) {
        ++lost_count_;
        return;
    }
    openings_[opening_count_] = row;
    ++opening_count_;
}

StepRow* RunLog::take_steps(Instant release, std::size_t component, std::size_t count,
                            WindowHost::Pass pass) noexcept {
    if (count > steps_.size() - step_count_) {
        lost_count_ += count;
        return nullptr;
    }
    StepRow* const first = &steps_[step_count_];
    for (std::size_t i = 0U; i < count; ++i) {
        first[i].release = release;
        first[i].component = component + i;
        first[i].pass = pass;
    }
    step_count_ += count;
    return first;
}

}  // namespace mamori::timing
