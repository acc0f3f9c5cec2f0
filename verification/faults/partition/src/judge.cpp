// SPDX-License-Identifier: Apache-2.0
#include "judge.hpp"

#include <algorithm>
#include <iterator>

namespace mamori::partition_faults {
namespace {

constexpr Duration kSilence{static_cast<std::int64_t>(kSilentFrames) * kFrame.ns};
/// From what the receiver found to the drive that reacts to it: within a frame, and late by another at most.
constexpr Duration kNear{2 * kFrame.ns};

bool is_good(const Look& look) noexcept {
    return look.is_answer && look.is_check_right && look.skipped <= kSkippedMax;
}

/// The last look at `until` or before that `pick` picks; nullptr: none.
template <typename Pick>
const Look* find_last(const std::vector<Look>& looks, Instant until, Pick pick) {
    auto place = std::upper_bound(looks.begin(), looks.end(), until,
                                  [](Instant at, const Look& look) { return at < look.at; });
    while (place != looks.begin()) {
        --place;
        if (pick(*place)) {
            return &*place;
        }
    }
    return nullptr;
}

/// Whether what arrived is what the reaction says it was.
bool is_explained(const Course& course, const ReactionBegin& reaction) {
    const Look* last = nullptr;
    switch (reaction.fault) {
        case PartitionFault::kSilent:
            last = find_last(course.looks, reaction.at, is_good);
            return last == nullptr || reaction.at - last->at >= kSilence;
        case PartitionFault::kFlooding:
            last = find_last(course.looks, reaction.at,
                             [](const Look& look) { return look.is_answer && look.skipped > kSkippedMax; });
            return last != nullptr && reaction.at - last->at <= kNear;
        case PartitionFault::kCorrupt:
            last = find_last(course.looks, reaction.at, [](const Look& look) {
                return look.is_refused || (look.is_answer && !look.is_check_right);
            });
            return last != nullptr && reaction.at - last->at <= kNear;
        case PartitionFault::kCount:
            break;
    }
    return false;
}

/// A process without priority gets no time now and then, which is a silence; and a safety side that stood
/// still has missed many frames.
bool is_doing_of_machine(const Course& course, const ReactionBegin& reaction) {
    if (!reaction.is_declared || !is_explained(course, reaction)) {
        return false;
    }
    const Duration missed = Duration{static_cast<std::int64_t>(kSkippedMax) * kFrame.ns} + kNear;
    return reaction.fault == PartitionFault::kSilent ||
           (reaction.fault == PartitionFault::kFlooding &&
            verification::overlaps(course.stalls, reaction.at - missed, reaction.at));
}

/// A process that is dead or stands still writes nothing; one that floods has two writers in one memory,
/// which may spoil each other's frames.
bool can_be(Kind kind, PartitionFault fault) noexcept {
    switch (kind) {
        case Kind::kKill:
        case Kind::kStop:
            return fault == PartitionFault::kSilent;
        case Kind::kFlood:
            return fault == PartitionFault::kFlooding || fault == PartitionFault::kSilent;
        case Kind::kCorrupt:
            return fault != PartitionFault::kCount;
    }
    return false;
}

/// A reaction is late only when nothing good came meanwhile: one that corrupts or floods, and gets no time to
/// do it, may send something good once more.
Outcome judge_reaction(const Course& course, const Deed& deed, const ReactionBegin& reaction) {
    if (!reaction.is_declared || !can_be(deed.kind, reaction.fault)) {
        return Outcome::kMisnamed;
    }
    const Look* const good = find_last(course.looks, reaction.at, is_good);
    const Instant cause = good != nullptr && good->at > deed.done ? good->at : deed.done;
    if (reaction.at - cause <= kBound) {
        return Outcome::kInTime;
    }
    return verification::overlaps(course.stalls, cause, reaction.at) ? Outcome::kTardyByHost
                                                                     : Outcome::kTardy;
}

void judge_reactions(const Course& course, Verdict& verdict) {
    std::size_t next = 0U;
    const auto judge_stray = [&course, &verdict](const ReactionBegin& reaction) {
        if (is_doing_of_machine(course, reaction)) {
            ++verdict.by_machine;
        } else {
            verdict.invented.push_back(reaction);
        }
    };
    for (const Deed& deed : course.deeds) {
        for (; next < course.reactions.size() && course.reactions[next].at < deed.begin; ++next) {
            judge_stray(course.reactions[next]);
        }
        Outcome outcome = deed.is_done ? Outcome::kUnseen : Outcome::kNotDone;
        if (next < course.reactions.size() && course.reactions[next].at <= deed.over) {
            const ReactionBegin& reaction = course.reactions[next];
            ++next;
            if (!is_explained(course, reaction)) {
                verdict.invented.push_back(reaction);
                outcome = Outcome::kMisnamed;
            } else if (deed.is_done) {
                outcome = judge_reaction(course, deed, reaction);
                verdict.reaction_ns[static_cast<std::size_t>(deed.kind)].push_back(
                    (reaction.at - deed.done).ns);
            }
        }
        verdict.outcomes.push_back(outcome);
    }
    for (; next < course.reactions.size(); ++next) {
        judge_stray(course.reactions[next]);
    }
    for (std::vector<std::int64_t>& times : verdict.reaction_ns) {
        std::sort(times.begin(), times.end());
    }
}

/// @param[in] sorted by their releases, of which no two are equal.
bool contains(const std::vector<Opening>& sorted, const Opening& opening) {
    const auto place =
        std::lower_bound(sorted.begin(), sorted.end(), opening.release,
                         [](const Opening& row, Instant release) { return row.release < release; });
    return place != sorted.end() && *place == opening;
}

std::vector<Opening> leave_out(const std::vector<Opening>& openings, const std::vector<Opening>& what) {
    std::vector<Opening> rest;
    rest.reserve(openings.size());
    std::copy_if(openings.begin(), openings.end(), std::back_inserter(rest),
                 [&what](const Opening& opening) { return !contains(what, opening); });
    return rest;
}

/// A window that was cut off in the frame before does not open until its work is back, which has lost its
/// priority: one reason for both, whichever it was.
bool is_aftermath(const std::vector<Opening>& excused, const Opening& opening) {
    return contains(excused, {opening.window, opening.release - kFrame});
}

/// One stall explains alone why the window moved.
bool is_by_machine(const Course& course, const TimedOpening& timed) {
    return verification::calc_longest_loss(course.late_looks, timed.opening.release, timed.end) >= kLossMin;
}

/// A shorter stall, or polls that were late again and again.
bool is_suspected(const Course& course, const TimedOpening& timed) {
    const Instant release = timed.opening.release;
    return verification::overlaps(course.stalls, release, timed.end) ||
           verification::calc_loss(course.late_looks, release, timed.end) >= kLossMin ||
           verification::calc_loss(course.late_looks, release - kFrame, timed.end) >= kSlowLossMin;
}

/// A partition does not keep a window from its processor while neither it nor any other program is there.
bool is_alone(const Course& course, const TimedOpening& timed) {
    return course.knows_foreign &&
           verification::calc_loss(course.foreign, timed.opening.release, timed.end) < kForeignMin;
}

/// Every expected window must have run, in its place. One that was missed has not, and the work of one that
/// was cut off was given up: it may have run at any time, or never.
void judge_order(const Course& course, Verdict& verdict) {
    std::vector<Opening> hurt;
    std::vector<Opening> excused;
    for (const TimedOpening& timed : course.openings) {
        if (timed.is_missed || timed.is_overrun) {
            if (is_by_machine(course, timed) || is_aftermath(excused, timed.opening)) {
                ++verdict.moved_by_host;
                excused.push_back(timed.opening);
            } else if (is_suspected(course, timed)) {
                ++verdict.moved_suspected;
                excused.push_back(timed.opening);
            } else if (is_alone(course, timed)) {
                verdict.moved_alone.push_back(timed);
                excused.push_back(timed.opening);
            } else {
                verdict.moved.push_back(timed);
            }
            hurt.push_back(timed.opening);
        }
    }
    const std::vector<Opening> ran = leave_out(course.ran, hurt);
    std::size_t next = 0U;
    for (const Opening& expected : leave_out(course.expected, hurt)) {
        const bool has_run = next < ran.size() && ran[next] == expected;
        next += has_run ? 1U : 0U;
        verdict.disordered += has_run ? 0U : 1U;
    }
    verdict.disordered += ran.size() - next;
}

LatenessFigures calc_figures(std::vector<std::int64_t>& lateness) {
    LatenessFigures figures;
    std::sort(lateness.begin(), lateness.end());
    const auto quantile = [&lateness](std::size_t of_10000) {
        return lateness.empty() ? std::int64_t{0} : lateness[(lateness.size() - 1U) * of_10000 / 10000U];
    };
    figures.openings = lateness.size();
    figures.p50_ns = quantile(5000U);
    figures.p99_ns = quantile(9900U);
    figures.p9999_ns = quantile(9999U);
    figures.max_ns = quantile(10000U);
    return figures;
}

/// Whether the instant lies between a fault and the end of its partition.
bool is_faulty(const std::vector<Deed>& deeds, Instant at) {
    const auto deed = std::lower_bound(deeds.begin(), deeds.end(), at,
                                       [](const Deed& row, Instant instant) { return row.over < instant; });
    return deed != deeds.end() && deed->begin <= at;
}

void judge_lateness(const Course& course, Verdict& verdict) {
    std::vector<std::int64_t> quiet;
    std::vector<std::int64_t> faulty;
    for (const TimedOpening& timed : course.openings) {
        const Instant release = timed.opening.release;
        (is_faulty(course.deeds, release) ? faulty : quiet).push_back((timed.woke - release).ns);
    }
    verdict.quiet = calc_figures(quiet);
    verdict.faulty = calc_figures(faulty);
    for (const TimedOpening& timed : verdict.moved) {
        ++(is_faulty(course.deeds, timed.opening.release) ? verdict.faulty : verdict.quiet).moved;
    }
    for (const Stall& stall : course.stalls) {
        ++(is_faulty(course.deeds, stall.begin) ? verdict.faulty : verdict.quiet).stalls;
    }
    for (const Deed& deed : course.deeds) {
        verdict.faulty.time = verdict.faulty.time + (deed.over - deed.begin);
    }
    if (!course.openings.empty()) {
        const Duration all = course.openings.back().end - course.openings.front().opening.release;
        verdict.quiet.time = all - verdict.faulty.time;
    }
}

}  // namespace

const char* get_name(Kind kind) noexcept {
    switch (kind) {
        case Kind::kKill:
            return "kill";
        case Kind::kStop:
            return "stop";
        case Kind::kFlood:
            return "flood";
        case Kind::kCorrupt:
            return "corrupt";
    }
    return "invalid";
}

const char* get_name(Outcome outcome) noexcept {
    switch (outcome) {
        case Outcome::kInTime:
            return "in_time";
        case Outcome::kTardyByHost:
            return "tardy_by_host";
        case Outcome::kTardy:
            return "tardy";
        case Outcome::kUnseen:
            return "unseen";
        case Outcome::kMisnamed:
            return "misnamed";
        case Outcome::kNotDone:
            return "not_done";
    }
    return "invalid";
}

std::uint64_t Verdict::count(Outcome outcome) const noexcept {
    return static_cast<std::uint64_t>(std::count(outcomes.begin(), outcomes.end(), outcome));
}

bool Verdict::is_well() const noexcept {
    const std::uint64_t good = count(Outcome::kInTime) + count(Outcome::kTardyByHost);
    return has_run && good + count(Outcome::kNotDone) == requested && 20U * good >= 19U * requested &&
           disordered + moved.size() + moved_alone.size() + moved_suspected + invented.size() == 0U;
}

verification::RunEvidence Verdict::get_evidence() const noexcept {
    verification::RunEvidence evidence;
    evidence.violations = count(Outcome::kUnseen) + count(Outcome::kMisnamed) + invented.size() + disordered;
    evidence.violations += has_run || is_too_slow ? 0U : 1U;
    evidence.unexplained = count(Outcome::kTardy) + moved.size() + moved_alone.size();
    evidence.suspected = moved_suspected;
    evidence.set_aside = count(Outcome::kTardyByHost) + moved_by_host + by_machine;
    evidence.instances = quiet.openings + faulty.openings;
    evidence.shown = count(Outcome::kInTime) + count(Outcome::kTardyByHost) + count(Outcome::kTardy);
    evidence.requested = requested;
    evidence.host = host;
    return evidence;
}

Verdict judge(const Course& course) {
    Verdict verdict;
    verdict.knows_foreign = course.knows_foreign;
    verdict.reaction_ns.resize(kKindCount);
    judge_reactions(course, verdict);
    judge_order(course, verdict);
    judge_lateness(course, verdict);
    return verdict;
}

}  // namespace mamori::partition_faults
