// SPDX-License-Identifier: Apache-2.0
#include "mamori/safety/e2e/sequence.hpp"

namespace mamori::safety {

void SynchronisingSequence::widen() noexcept {
    if (max_delta_ < counter_max_) {
        ++max_delta_;
    }
}

void SynchronisingSequence::count_without_news() noexcept {
    if (without_news_ <= counter_max_) {
        ++without_news_;
    }
}

void SynchronisingSequence::note_silence() noexcept {
    widen();
    count_without_news();
}

void SynchronisingSequence::restart() noexcept {
    *this = SynchronisingSequence{limits_, counter_max_};
}

CheckStatus SynchronisingSequence::judge(std::uint32_t counter) noexcept {
    widen();
    if (is_first_) {
        is_first_ = false;
        max_delta_ = limits_.max_delta_init;
        last_ = counter;
        return CheckStatus::kInitial;
    }
    const std::uint32_t delta = calc_counter_delta(last_, counter, counter_max_);
    if (delta > max_delta_) {
        return refuse(counter);
    }
    if (delta == 0U) {
        count_without_news();
        return CheckStatus::kRepeated;
    }
    return accept(counter, delta);
}

CheckStatus SynchronisingSequence::accept(std::uint32_t counter, std::uint32_t delta) noexcept {
    const bool was_quiet = without_news_ > limits_.max_no_new_or_repeated;
    max_delta_ = limits_.max_delta_init;
    last_ = counter;
    lost_count_ = delta - 1U;
    without_news_ = 0U;
    if (was_quiet) {
        sync_left_ = limits_.sync_init;
        return CheckStatus::kSync;
    }
    if (sync_left_ > 0U) {
        --sync_left_;
        return CheckStatus::kSync;
    }
    return delta == 1U ? CheckStatus::kOk : CheckStatus::kOkSomeLost;
}

CheckStatus SynchronisingSequence::refuse(std::uint32_t counter) noexcept {
    without_news_ = 0U;
    sync_left_ = limits_.sync_init;
    if (limits_.sync_init > 0U) {
        max_delta_ = limits_.max_delta_init;
        last_ = counter;
    }
    return CheckStatus::kWrongSequence;
}

}  // namespace mamori::safety
