// SPDX-License-Identifier: Apache-2.0
#include "judge.hpp"

#include <algorithm>

namespace mamori::time_faults {
namespace {

/// Reports in the order of their instants, each of which must have its reason.
class Judge final {
  public:
    Judge(const Plan& plan, const Course& course)
        : plan_(plan),
          reports_(course.reports),
          stalls_(course.stalls),
          late_looks_(course.late_looks),
          ends_(course.ends) {
        explained_.resize(reports_.size(), false);
    }

    /// Everything that is reported from the deed's begin to a tick after its end, about its window, is its
    /// doing; time that the machine took away meanwhile does not count. A guard that is stuck with it reports
    /// later, and the windows after it open late.
    void judge(const Deed& deed, Verdict& verdict) {
        const Instant last = calc_last(deed);
        const Report* first = nullptr;
        bool is_misnamed = false;
        for (std::size_t i = find(deed.begin); i < reports_.size() && reports_[i].at <= last; ++i) {
            const Report& report = reports_[i];
            const bool is_stuck = deed.cause == Cause::kStuckGuard;
            const bool is_own =
                report.window == plan_.window_of[deed.component] && report.component == deed.component;
            if (is_own && (!is_stuck || !is_cut_short(report) || is_of_frame(report, deed.begin))) {
                explained_[i] = true;
                first = first == nullptr ? &report : first;
            } else if (!report.is_overrun || (is_stuck && is_cut_short(report))) {
                explained_[i] = explained_[i] || is_stuck;
            } else {
                is_misnamed = true;
            }
        }
        if (first == nullptr && deed.cause == Cause::kLock && deed.end - deed.begin <= plan_.budget) {
            return;  // the machine stood still until the mutex was free again
        }
        ++verdict.injected;
        verdict.locked_out += deed.cause == Cause::kLock ? 1U : 0U;
        if (first == nullptr) {
            ++(is_misnamed ? verdict.misnamed : verdict.unseen);
            verdict.overlooked.push_back(deed);
            return;
        }
        ++verdict.seen;
        verdict.locked_out_seen += deed.cause == Cause::kLock ? 1U : 0U;
        if (deed.cause == Cause::kStuckGuard) {
            return;  // its time is that of the watch
        }
        const Instant deadline = first->woke + plan_.budget;
        const Duration detection = first->at - deadline;
        verdict.detection_ns.push_back(detection.ns);
        if (detection > kTick) {
            ++(overlaps(stalls_, deadline, first->at) ? verdict.tardy_by_host : verdict.tardy);
        }
    }

    /// The opening that was held back is reported as late; those after it, until the grid is met again, too.
    /// One of them may open just before its close, and then what is left of its budget is too short for
    /// anything.
    void judge(const Delay& delay, Verdict& verdict) {
        ++verdict.injected;
        bool is_seen = false;
        for (std::size_t i = find(delay.release); i < reports_.size() && reports_[i].release <= delay.end;
             ++i) {
            if (!reports_[i].is_overrun || is_cut_short(reports_[i])) {
                explained_[i] = true;
                is_seen = is_seen || (!reports_[i].is_overrun && reports_[i].window == delay.window &&
                                      reports_[i].release == delay.release);
            }
        }
        ++(is_seen ? verdict.seen : verdict.unseen);
    }

    /// What is left is the machine's doing or nobody's. A window that is reported in two frames in a row is
    /// reported for one reason: its work was not back yet.
    void judge_rest(Verdict& verdict) {
        Instant told{-1};
        Instant covered{-1};  // up to here the host is the cause: what was due before shares it
        bool is_aside = false;
        for (std::size_t i = 0U; i < reports_.size(); ++i) {
            const Report& report = reports_[i];
            if (explained_[i] || is_aftermath(i)) {
                explained_[i] = true;
            } else if (calc_longest_loss(late_looks_, report.release, report.at) >= kLossMin ||
                       (is_aside && report.release <= covered)) {
                explained_[i] = true;
                is_aside = true;
                covered = report.at;
                ++verdict.by_host;
            } else if (is_suspected(report) || report.release <= covered) {
                explained_[i] = true;
                is_aside = false;
                covered = report.at;
                ++verdict.suspected;
            } else {
                ++verdict.invented;
                verdict.times += report.release > told ? 1U : 0U;
                told = report.at;
                verdict.unexplained.push_back(report);
            }
        }
    }

  private:
    /// A tick of the machine's own time after the end of a deed.
    Instant calc_last(const Deed& deed) const {
        Instant last = deed.end + kTick;
        Instant before = deed.end;
        while (last > before) {
            before = last;
            last = deed.end + kTick + calc_loss(late_looks_, deed.end, last);
        }
        return last;
    }
    /// The window opened so late that less than its budget was left to its close.
    bool is_cut_short(const Report& report) const {
        return report.woke + plan_.budget > report.release + plan_.window_lengths[report.window];
    }
    /// The host took half of the budget in pieces, or kept the ready runner off for as long, or a whole
    /// budget since the frame before; or the component was ready for half of its budget and did not run, and
    /// the report did not come too early for that.
    bool is_suspected(const Report& report) const {
        if (is_runner_kept_off(report.kept_off, report.woke - report.release) ||
            calc_loss(late_looks_, report.release, report.at) >= kLossMin ||
            calc_loss(late_looks_, report.release - kTick, report.at) >= plan_.budget) {
            return true;
        }
        if (!report.is_overrun || !ends_.covers(report.release)) {
            return false;
        }
        const Instant close = report.release + plan_.window_lengths[report.window];
        return report.at >= std::min(report.woke + plan_.budget, close) &&
               ends_.get_kept_off(report.component, report.release) >= kLossMin;
    }
    static bool is_of_frame(const Report& report, Instant at) {
        return report.release <= at && at < report.release + kTick;
    }
    bool is_aftermath(std::size_t index) const {
        const Report& report = reports_[index];
        for (std::size_t i = index; i > 0U && reports_[i - 1U].release + kTick >= report.release; --i) {
            const Report& before = reports_[i - 1U];
            if (before.is_overrun && report.is_overrun && before.window == report.window &&
                before.release + kTick == report.release) {
                return explained_[i - 1U];
            }
        }
        return false;
    }
    /// The first report at `from` or later.
    std::size_t find(Instant from) const {
        const auto place = std::lower_bound(reports_.begin(), reports_.end(), from,
                                            [](const Report& report, Instant at) { return report.at < at; });
        return static_cast<std::size_t>(place - reports_.begin());
    }

    const Plan& plan_;
    const std::vector<Report>& reports_;
    const std::vector<Stall>& stalls_;
    const std::vector<Stall>& late_looks_;
    const Ends& ends_;
    std::vector<bool> explained_;
};

}  // namespace

verification::RunEvidence Verdict::get_report_evidence() const noexcept {
    constexpr std::uint64_t kWindows = 3U;
    return {misnamed + unseen, times + tardy, suspected, by_host + tardy_by_host,
            frames * kWindows, injected,      requested, host};
}

verification::RunEvidence Verdict::get_watch_evidence() const noexcept {
    verification::RunEvidence evidence;
    evidence.violations = watch.misnamed + watch.unseen;
    evidence.unexplained = watch.invented + watch.tardy;
    evidence.set_aside = watch.by_host + watch.tardy_by_host;
    evidence.instances = frames;
    evidence.host = host;
    return evidence;
}

verification::RunEvidence Verdict::get_evidence() const noexcept {
    verification::RunEvidence evidence = get_report_evidence();
    const verification::RunEvidence other = get_watch_evidence();
    evidence.violations += other.violations + (are_pages_well() ? 0U : 1U);
    evidence.unexplained += other.unexplained;
    evidence.set_aside += other.set_aside;
    return evidence;
}

Verdict judge(const Plan& plan, const Course& course) {
    Verdict verdict;
    verdict.host = course.host;
    Judge judge{plan, course};
    for (const Deed& deed : course.deeds) {
        judge.judge(deed, verdict);
    }
    for (const Delay& delay : course.delays) {
        judge.judge(delay, verdict);
    }
    judge.judge_rest(verdict);
    std::vector<Stall> stalls = course.stalls;
    stalls.insert(stalls.end(), course.runner_delays.begin(), course.runner_delays.end());
    std::sort(stalls.begin(), stalls.end(),
              [](const Stall& left, const Stall& right) { return left.end < right.end; });
    verdict.watch = judge_watch(plan.watch, course.watch, stalls);
    verdict.injected += verdict.watch.clock_faults_seen;
    verdict.seen += verdict.watch.clock_faults_seen;
    return verdict;
}

}  // namespace mamori::time_faults
