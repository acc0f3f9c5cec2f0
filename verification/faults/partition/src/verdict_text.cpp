// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>

#include "campaign.hpp"

namespace mamori::partition_faults {
namespace {

std::string quote(const std::string& text) {
    return '"' + text + '"';
}

std::string write(const char* key, std::int64_t value) {
    return ",\n " + quote(key) + ": " + std::to_string(value);
}

std::string write(const char* key, bool value) {
    return ",\n " + quote(key) + (value ? ": true" : ": false");
}

std::string write_count(const char* key, std::uint64_t value) {
    return write(key, static_cast<std::int64_t>(value));
}

std::string write_configuration() {
    return ",\n \"configuration\": {\"frame_ns\": " + std::to_string(kFrame.ns) +
           ", \"silent_frames\": " + std::to_string(kSilentFrames) +
           ", \"skipped_max\": " + std::to_string(kSkippedMax) +
           ", \"reaction_time_ns\": " + std::to_string(kReactionTime.ns) +
           ", \"bound_ns\": " + std::to_string(kBound.ns) + "}";
}

/// Times from a fault to its reaction, kind by kind.
std::string write_reactions(const Verdict& verdict) {
    std::string text;
    for (std::size_t i = 0U; i < verdict.reaction_ns.size(); ++i) {
        const std::vector<std::int64_t>& times = verdict.reaction_ns[i];
        const auto quantile = [&times](std::size_t percent) {
            return std::to_string(times.empty() ? 0 : times[(times.size() - 1U) * percent / 100U]);
        };
        text += (i == 0U ? "\n  " : ",\n  ") + quote(get_name(static_cast<Kind>(i))) +
                ": {\"count\": " + std::to_string(times.size()) + ", \"p50_ns\": " + quantile(50U) +
                ", \"p99_ns\": " + quantile(99U) + ", \"max_ns\": " + quantile(100U) + "}";
    }
    return ",\n \"reactions\": {" + text + "}";
}

std::string write_lateness(const char* key, const LatenessFigures& figures) {
    return ",\n " + quote(key) + ": {\"openings\": " + std::to_string(figures.openings) +
           ", \"p50_ns\": " + std::to_string(figures.p50_ns) +
           ", \"p99_ns\": " + std::to_string(figures.p99_ns) +
           ", \"p9999_ns\": " + std::to_string(figures.p9999_ns) +
           ", \"max_ns\": " + std::to_string(figures.max_ns) +
           ", \"moved\": " + std::to_string(figures.moved) +
           ", \"stalls\": " + std::to_string(figures.stalls) +
           ", \"time_ns\": " + std::to_string(figures.time.ns) + "}";
}

std::string write_opening(const TimedOpening& timed) {
    return "{\"window\": " + std::to_string(timed.opening.window) +
           ", \"release_ns\": " + std::to_string(timed.opening.release.ns) +
           ", \"woke_ns\": " + std::to_string(timed.woke.ns) +
           ", \"end_ns\": " + std::to_string(timed.end.ns) +
           ", \"is_missed\": " + (timed.is_missed ? "true" : "false") + "}";
}

std::string write_alone(const Verdict& verdict) {
    std::string text;
    for (const TimedOpening& timed : verdict.moved_alone) {
        text += (text.empty() ? "\n  " : ",\n  ") + write_opening(timed);
    }
    return ",\n \"alone\": [" + text + "]";
}

std::string write_unexplained(const Verdict& verdict) {
    std::string text;
    for (const ReactionBegin& reaction : verdict.invented) {
        text += (text.empty() ? "\n  " : ",\n  ") + ("{\"at_ns\": " + std::to_string(reaction.at.ns)) +
                ", \"fault\": " + std::to_string(static_cast<int>(reaction.fault)) + "}";
    }
    for (const TimedOpening& timed : verdict.moved) {
        text += (text.empty() ? "\n  " : ",\n  ") + write_opening(timed);
    }
    return ",\n \"unexplained\": [" + text + "]";
}

std::string write_plan(const CampaignRequest& request, const Verdict& verdict) {
    std::string text;
    const std::vector<Fault> plan = make_plan(request);
    for (std::size_t i = 0U; i < plan.size(); ++i) {
        const char* const outcome =
            i < verdict.outcomes.size() ? get_name(verdict.outcomes[i]) : "not_reached";
        text += (i == 0U ? "\n  " : ",\n  ") + ("{\"kind\": " + quote(get_name(plan[i].kind))) +
                ", \"wait_ns\": " + std::to_string(plan[i].wait.ns) +
                ", \"hold_ns\": " + std::to_string(plan[i].hold.ns) + ", \"outcome\": " + quote(outcome) +
                "}";
    }
    return ",\n \"plan\": [" + text + "]";
}

}  // namespace

std::string to_json(const CampaignRequest& request, const Verdict& verdict) {
    const char* const commit = std::getenv("MAMORI_COMMIT");
    std::string text = "{\"schema\": \"mamori.partition_faults/2\",\n \"commit\": " +
                       quote(commit == nullptr ? "unknown" : commit) + write_configuration() +
                       write_count("seed", request.seed) + write_count("requested", verdict.requested) +
                       write_count("frames", verdict.frames);
    for (std::size_t i = 0U; i < kOutcomeCount; ++i) {
        const auto outcome = static_cast<Outcome>(i);
        text += write_count(get_name(outcome), verdict.count(outcome));
    }
    const verification::RunFinding finding = verification::assess_run(verdict.get_evidence());
    text += write_count("invented", verdict.invented.size()) + write_count("by_machine", verdict.by_machine) +
            write_count("disordered", verdict.disordered) + write_count("moved", verdict.moved.size()) +
            write_count("moved_by_host", verdict.moved_by_host) +
            write_count("moved_suspected", verdict.moved_suspected) +
            write_count("moved_alone", verdict.moved_alone.size()) +
            write("knows_foreign", verdict.knows_foreign) + write_reactions(verdict) +
            write_lateness("quiet", verdict.quiet) + write_lateness("faulty", verdict.faulty) +
            write("has_priority", verdict.has_priority) + ",\n \"trouble\": " + quote(verdict.trouble) +
            ",\n \"defect\": " + quote(verification::get_name(request.defect)) +
            ",\n \"verdict\": " + quote(get_name(finding.verdict)) +
            ",\n \"reason\": " + quote(finding.reason.c_str());
    return text +
           (verdict.is_well()
                ? ""
                : write_alone(verdict) + write_unexplained(verdict) + write_plan(request, verdict)) +
           "\n}\n";
}

}  // namespace mamori::partition_faults
