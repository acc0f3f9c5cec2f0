// SPDX-License-Identifier: Apache-2.0
/// @file
/// Decides for every real-time run whether it passed, failed or is inconclusive. The counts come from the
/// oracle of the campaign, the figures of the host from a `StallWatch`.
///
/// @satisfies SWR-VER-022, SWR-VER-023      Design: docs/design/test_strength.md#real-time-verdicts
#ifndef MAMORI_VERIFICATION_RUN_VERDICT_HPP
#define MAMORI_VERIFICATION_RUN_VERDICT_HPP

#include <cstdint>
#include <string>

#include "mamori/kernel/base/time.hpp"

namespace mamori::verification {

enum class RunVerdict : std::uint8_t {
    kPassed,
    kFailed,        ///< exact evidence shows that the software is at fault
    kInconclusive,  ///< evidence shows that the host is at fault
};
const char* get_name(RunVerdict verdict) noexcept;
/// Exit status of a campaign program: 0 passed, 1 failed, 4 inconclusive.
int get_exit_status(RunVerdict verdict) noexcept;

/// What the host did during a run.
struct HostFigures {
    std::uint64_t stalls{0U};  ///< the watch was away for longer than two of its steps
    Duration longest_stall{};
    Duration lost{};  ///< sum of what the polls of the watch were late by
    std::uint64_t late_polls{0U};
    Duration run_delay{};        ///< the watch was ready and did not run (/proc/thread-self/schedstat)
    std::uint64_t steal_ms{0U};  ///< time that the hypervisor took (/proc/stat)
    std::uint64_t involuntary_switches{0U};  ///< of all threads of the process (getrusage)
};
std::string to_text(const HostFigures& host);

/// Seen disturbances, at least, for each deviation that an unseen one can explain. The design note has the
/// measurement.
inline constexpr std::uint64_t kSeenPerUnseen = 100U;
/// Window instances, at least, for each that is set aside: a run that sets aside more shows too little.
inline constexpr std::uint64_t kInstancesPerSetAside = 100U;

/// Counts of one run. A deviation is anything that differs from what was expected; it belongs to exactly one
/// of the first four.
struct RunEvidence {
    std::uint64_t violations{0U};   ///< deviations that no host causes, for example a wrong name
    std::uint64_t unexplained{0U};  ///< deviations while the watch saw the clock continuous
    std::uint64_t suspected{0U};    ///< deviations that the host explains in part: short losses, switches
    std::uint64_t set_aside{0U};    ///< deviations that one stall explains alone: not assessed
    std::uint64_t instances{0U};    ///< window instances or trials of the run
    std::uint64_t shown{0U};        ///< injected faults that took effect; each had its reaction or is above
    std::uint64_t requested{0U};    ///< faults of the plan
    HostFigures host{};
};

struct RunFinding {
    RunVerdict verdict{RunVerdict::kFailed};
    std::string reason{};  ///< one line, with the figures; empty when passed
};

/// Worst condition first: a violation is a failure whatever the host did.
RunFinding assess_run(const RunEvidence& evidence);

}  // namespace mamori::verification

#endif  // MAMORI_VERIFICATION_RUN_VERDICT_HPP
