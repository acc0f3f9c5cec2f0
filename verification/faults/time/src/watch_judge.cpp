// SPDX-License-Identifier: Apache-2.0
#include "watch_judge.hpp"

namespace mamori::time_faults {
namespace {

using ports::posix_rt::GridFault;

class WatchJudge final {
  public:
    WatchJudge(const WatchBounds& bounds, const WatchCourse& course, const std::vector<Stall>& stalls)
        : bounds_(bounds), found_(course.found), stalls_(stalls) {
        explained_.resize(found_.size(), false);
    }

    /// After its end the runner catches up, and what it still owes counts as the same.
    void judge(const Hold& hold, WatchVerdict& verdict) {
        ++verdict.holds;
        const Found* const found = find(hold.due, hold.end + bounds_.overdue, false, verdict);
        if (found == nullptr) {
            return;
        }
        if (found->finding.fault != GridFault::kOverdue) {
            ++verdict.misnamed;
            return;
        }
        ++verdict.holds_seen;
        verdict.overdue_ns.push_back((found->finding.seen - hold.due).ns);
        judge_time(hold.due, found->finding.seen, bounds_.overdue, verdict);
    }

    void judge(const ClockFault& fault, WatchVerdict& verdict) {
        ++verdict.clock_faults;
        const Found* const found = find(fault.begin, fault.end + bounds_.rate, true, verdict);
        if (found == nullptr) {
            return;
        }
        if (found->finding.fault != (fault.ppm > 0 ? GridFault::kFastClock : GridFault::kSlowClock)) {
            ++verdict.misnamed;
            return;
        }
        ++verdict.clock_faults_seen;
        verdict.rate_ns.push_back((found->finding.seen - fault.begin).ns);
        judge_time(fault.begin, found->finding.seen, bounds_.rate, verdict);
    }

    /// What is left is the machine's doing or nobody's. A machine that stands still makes no clock wrong.
    void judge_rest(WatchVerdict& verdict) const {
        for (std::size_t i = 0U; i < found_.size(); ++i) {
            if (explained_[i]) {
                continue;
            }
            if (is_by_host(found_[i])) {
                ++verdict.by_host;
            } else {
                ++verdict.invented;
                verdict.unexplained.push_back(found_[i].finding);
            }
        }
    }

  private:
    bool is_by_host(const Found& found) const {
        const ports::posix_rt::GridFinding& finding = found.finding;
        return finding.fault == GridFault::kOverdue && overlaps(stalls_, finding.due, finding.seen);
    }

    /// The first finding from `begin` to `last`; without one, what that means is counted. Where the clock is
    /// wrong, one that is overdue by the machine's doing hides it as long as it is latched.
    const Found* find(Instant begin, Instant last, bool is_about_clock, WatchVerdict& verdict) {
        bool is_masked = false;
        for (std::size_t i = 0U; i < found_.size() && found_[i].finding.seen <= last; ++i) {
            const bool is_other = explained_[i] || (is_about_clock && is_by_host(found_[i]));
            if (found_[i].finding.seen >= begin && !is_other) {
                explained_[i] = true;
                return &found_[i];
            }
            is_masked = is_masked || found_[i].cleared > begin;
        }
        ++(is_masked ? verdict.masked : verdict.unseen);
        return nullptr;
    }

    void judge_time(Instant begin, Instant seen, Duration bound, WatchVerdict& verdict) const {
        if (seen - begin > bound) {
            ++(overlaps(stalls_, begin, seen) ? verdict.tardy_by_host : verdict.tardy);
        }
    }

    const WatchBounds& bounds_;
    const std::vector<Found>& found_;
    const std::vector<Stall>& stalls_;
    std::vector<bool> explained_;
};

}  // namespace

WatchVerdict judge_watch(const WatchBounds& bounds, const WatchCourse& course,
                         const std::vector<Stall>& stalls) {
    WatchVerdict verdict;
    WatchJudge judge{bounds, course, stalls};
    for (const Hold& hold : course.holds) {
        judge.judge(hold, verdict);
    }
    for (const ClockFault& fault : course.clock_faults) {
        judge.judge(fault, verdict);
    }
    judge.judge_rest(verdict);
    return verdict;
}

}  // namespace mamori::time_faults
