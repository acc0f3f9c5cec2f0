// SPDX-License-Identifier: Apache-2.0
#include "mamori/verification/run_verdict.hpp"

namespace mamori::verification {
namespace {

std::string count(std::uint64_t number, const char* what) {
    return std::to_string(number) + " " + what;
}

RunFinding make(RunVerdict verdict, const std::string& what, const RunEvidence& evidence) {
    return {verdict, what + "; host: " + to_text(evidence.host)};
}

}  // namespace

const char* get_name(RunVerdict verdict) noexcept {
    switch (verdict) {
        case RunVerdict::kPassed:
            return "passed";
        case RunVerdict::kFailed:
            return "failed";
        case RunVerdict::kInconclusive:
            return "inconclusive";
    }
    return "invalid";
}

int get_exit_status(RunVerdict verdict) noexcept {
    constexpr int kInconclusiveStatus = 4;
    if (verdict == RunVerdict::kInconclusive) {
        return kInconclusiveStatus;
    }
    return verdict == RunVerdict::kPassed ? 0 : 1;
}

std::string to_text(const HostFigures& host) {
    return count(host.stalls, "stalls, longest ") + std::to_string(host.longest_stall.ns / 1000) +
           " us, lost " + std::to_string(host.lost.ns / 1000) + " us in " +
           count(host.late_polls, "late polls, run delay ") + std::to_string(host.run_delay.ns / 1000) +
           " us, steal " + std::to_string(host.steal_ms) + " ms, " +
           count(host.involuntary_switches, "involuntary switches");
}

RunFinding assess_run(const RunEvidence& evidence) {
    const bool is_disturbed = evidence.host.stalls != 0U;
    if (evidence.violations != 0U) {
        return make(RunVerdict::kFailed, count(evidence.violations, "violations"), evidence);
    }
    if (evidence.unexplained * kSeenPerUnseen > evidence.host.stalls) {
        return make(RunVerdict::kFailed,
                    count(evidence.unexplained, "deviations while nothing disturbed the host"), evidence);
    }
    const bool shows_too_little = 20U * evidence.shown < 19U * evidence.requested;
    if (shows_too_little) {
        return make(is_disturbed ? RunVerdict::kInconclusive : RunVerdict::kFailed,
                    count(evidence.shown, "of ") + count(evidence.requested, "faults took effect"), evidence);
    }
    if (evidence.unexplained != 0U) {
        return make(RunVerdict::kInconclusive,
                    count(evidence.unexplained, "deviations that unseen disturbances may have caused"),
                    evidence);
    }
    if (evidence.suspected != 0U) {
        return make(RunVerdict::kInconclusive,
                    count(evidence.suspected, "deviations that short losses of the host explain"), evidence);
    }
    if (evidence.set_aside * kInstancesPerSetAside > evidence.instances) {
        return make(RunVerdict::kInconclusive,
                    count(evidence.set_aside, "of ") + count(evidence.instances, "instances set aside"),
                    evidence);
    }
    return {RunVerdict::kPassed, ""};
}

}  // namespace mamori::verification
