// SPDX-License-Identifier: Apache-2.0
#include "mamori/safety/e2e/hardened_sequence.hpp"

#include "mamori/safety/e2e/frame_cause.hpp"
#include "mamori/safety/e2e/sequence.hpp"

namespace mamori::safety {

CheckStatus HardenedSequence::judge(std::uint32_t counter) noexcept {
    lost_count_ = 0U;
    if (is_closed_) {
        return CheckStatus::kWrongSequence;
    }
    if (!is_synchronised_) {
        extend_run(counter);
        return CheckStatus::kWrongSequence;
    }
    const CheckStatus status = judge_against_baseline(counter);
    if (status != CheckStatus::kWrongSequence) {
        run_ = 0U;  // the sender that was followed so far still lives, or its frame came twice
        return status;
    }
    if (limits_.resynchronisation == Resynchronisation::kByRun) {
        extend_run(counter);
    } else if (is_order_lost(counter)) {
        is_synchronised_ = false;
        is_closed_ = true;
    }
    return CheckStatus::kWrongSequence;
}

/// Whether a refused frame shows a gap. A frame up to half the counter ahead does. Any other is behind, so a
/// replay, unless the sender may have come that far meanwhile.
bool HardenedSequence::is_order_lost(std::uint32_t counter) const noexcept {
    const std::uint32_t half = counter_max_ / 2U;
    const std::uint32_t absence_max = half < kAbsenceMax ? half : kAbsenceMax;
    return calc_counter_delta(last_, counter, counter_max_) <= half || absence_ > absence_max;
}

CheckStatus HardenedSequence::judge_against_baseline(std::uint32_t counter) noexcept {
    const std::uint32_t delta = calc_counter_delta(last_, counter, counter_max_);
    if (delta > limits_.max_delta) {
        count_absence();
        return CheckStatus::kWrongSequence;
    }
    if (delta == 0U) {
        count_absence();
        return CheckStatus::kRepeated;
    }
    last_ = counter;
    absence_ = 0U;
    lost_count_ = delta - 1U;
    return delta == 1U ? CheckStatus::kOk : CheckStatus::kOkSomeLost;
}

void HardenedSequence::extend_run(std::uint32_t counter) noexcept {
    const bool is_next = run_ > 0U && calc_counter_delta(run_end_, counter, counter_max_) == 1U;
    run_ = is_next ? run_ + 1U : 1U;
    run_end_ = counter;
    if (run_ >= limits_.resync_frames) {
        last_ = counter;
        run_ = 0U;
        absence_ = 0U;
        is_synchronised_ = true;
        saturating_increment(resync_count_);
    }
}

void HardenedSequence::restart() noexcept {
    is_synchronised_ = false;
    is_closed_ = false;
    run_ = 0U;
    lost_count_ = 0U;
}

}  // namespace mamori::safety
