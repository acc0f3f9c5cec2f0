// SPDX-License-Identifier: Apache-2.0
#include "loss_judge.hpp"

#include <algorithm>

namespace mamori::lost_service {

LossVerdict judge_losses(const std::vector<LossTrial>& trials, const std::vector<Stall>& stalls,
                         Duration timeout) {
    LossVerdict verdict;
    for (const LossTrial& trial : trials) {
        verdict.requested += trial.loss != Loss::kNone ? 1U : 0U;
        if (trial.is_closed && (!trial.is_injected || trial.closed_at < trial.injected_at)) {
            if (calc_longest_loss(stalls, trial.asked_at, trial.closed_at) >= kLongStall) {
                ++verdict.by_host;
            } else if (overlaps(stalls, trial.asked_at, trial.closed_at)) {
                ++verdict.suspected;
            } else {
                ++verdict.invented;
                verdict.unexplained.push_back(trial);
            }
            continue;
        }
        if (!trial.is_injected) {
            continue;
        }
        // A service that comes too early is wrong at once; else the watchdog's time began with the last one,
        // and is over at this instant at the latest.
        const bool is_at_once = trial.loss == Loss::kRunaway;
        const Instant over = is_at_once ? trial.injected_at : trial.taken_at + timeout;
        if (!trial.is_closed && trial.ended_at - over <= kTick) {
            ++verdict.by_host;
            continue;
        }
        ++verdict.injected;
        if (!trial.is_closed) {
            ++verdict.unanswered;
            verdict.unexplained.push_back(trial);
            continue;
        }
        ++verdict.answered;
        verdict.reaction_ns.push_back(std::max((trial.closed_at - over).ns, std::int64_t{0}));
        if (!is_at_once && trial.closed_at - trial.asked_at <= timeout) {
            ++verdict.early;
        } else if (trial.closed_at - over > kTick &&
                   trial.closed_at - over - calc_longest_loss(stalls, over, trial.closed_at) <= kTick) {
            ++verdict.late_by_host;
        } else if (trial.closed_at - over > kTick && overlaps(stalls, over, trial.closed_at)) {
            ++verdict.suspected;
        } else if (trial.closed_at - over > kTick) {
            ++verdict.late;
            verdict.unexplained.push_back(trial);
        }
    }
    return verdict;
}

}  // namespace mamori::lost_service
