// SPDX-License-Identifier: Apache-2.0
/// @file
/// Holds the reports of a run against the faults that were put into it: each fault must have its report, in
/// time and under its name, and each report its reason. Pure functions of what was written down.
#ifndef MAMORI_TIME_FAULTS_JUDGE_HPP
#define MAMORI_TIME_FAULTS_JUDGE_HPP

#include <cstdint>
#include <vector>

#include "mamori/kernel/system_table.hpp"
#include "mamori/kernel/time.hpp"
#include "mamori/verification/stall_watch.hpp"

namespace mamori::time_faults {

using verification::Stall;

/// Frame of the system: what "within one tick" means.
inline constexpr Duration kTick{1'000'000};

/// A report of the executive.
struct Report {
    bool is_overrun{false};
    std::size_t window{0U};
    std::size_t component{kNoIndex};  ///< of an overrun
    Instant release{};                ///< of the opening
    Instant woke{};
    Instant at{};
    Duration lateness{};  ///< of a late release
};

/// What became of a run. All is well when nearly all faults took effect, each was seen, and nothing was
/// misnamed, unseen, tardy or invented.
struct Verdict {
    std::uint64_t frames{0U};
    std::uint64_t requested{0U};      ///< faults
    std::uint64_t injected{0U};       ///< that took effect; one may not when the machine stood still
    std::uint64_t seen{0U};           ///< reported, under the right name
    std::uint64_t misnamed{0U};       ///< reported in its time, under another name only
    std::uint64_t unseen{0U};         ///< not reported at all
    std::uint64_t tardy{0U};          ///< reported more than a tick after its deadline, while the machine ran
    std::uint64_t tardy_by_host{0U};  ///< likewise, while the machine stood still
    std::uint64_t invented{0U};       ///< reported without a fault, while the machine ran
    std::uint64_t by_host{0U};        ///< reported without a fault, while the machine stood still
    std::uint64_t stalls{0U};  ///< times at which the machine stood still for a tenth of a tick or more
    Duration longest_stall{};
    std::vector<std::int64_t> detection_ns{};  ///< from the deadline of each overrun to its report
    std::vector<Report> unexplained{};         ///< those that were invented
    bool has_priority{false};

    /// A fault may miss its place while the machine stands still; more than a few that do are no test.
    bool is_well() const noexcept {
        return 20U * injected >= 19U * requested && seen == injected &&
               misnamed + unseen + tardy + invented == 0U;
    }
};

/// A component that took too long.
struct Deed {
    std::size_t component{0U};
    Instant begin{};
    Instant end{};
};

/// A window that was held back.
struct Delay {
    std::size_t window{0U};
    Instant release{};
    Instant end{};
};

/// What of the system's table decides.
struct Plan {
    Duration budget{};                       ///< of every window
    std::vector<std::size_t> window_of{};    ///< of each component
    std::vector<Duration> window_lengths{};  ///< from opening to close
};

/// Everything that was written down of a run, each list in the order of its instants.
struct Course {
    std::vector<Report> reports{};
    std::vector<Deed> deeds{};
    std::vector<Delay> delays{};
    std::vector<Stall> stalls{};
};

/// @return the counts from `injected` to `longest_stall`, `detection_ns` and `unexplained`; the rest is the
/// caller's.
Verdict judge(const Plan& plan, const Course& course);

}  // namespace mamori::time_faults

#endif  // MAMORI_TIME_FAULTS_JUDGE_HPP
