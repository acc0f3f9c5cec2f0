// SPDX-License-Identifier: Apache-2.0
/// @file
/// Holds the reports of a run against the faults that were put into it: each fault must have its report, in
/// time and under its name, and each report its reason. Pure functions of what was written down.
#ifndef MAMORI_TIME_FAULTS_JUDGE_HPP
#define MAMORI_TIME_FAULTS_JUDGE_HPP

#include <cstdint>
#include <vector>

#include "mamori/kernel/base/time.hpp"
#include "mamori/kernel/table/system_table.hpp"
#include "mamori/verification/run_verdict.hpp"
#include "watch_judge.hpp"

namespace mamori::time_faults {

/// Frame of the system: what "within one tick" means.
inline constexpr Duration kTick{1'000'000};

/// Time that the host must have taken from a window to be the cause of what is reported about it: half of the
/// budget. At once it sets the report aside, in pieces it makes the run inconclusive.
inline constexpr Duration kLossMin{100'000};

/// Page faults that need no disk, of all threads of the windows together, in a run with locked memory: the
/// kernel moves a page now and then.
inline constexpr std::int64_t kMinorFaultsMax = 16;

/// A report of the executive.
struct Report {
    bool is_overrun{false};
    std::size_t window{0U};
    std::size_t component{kNoIndex};  ///< of an overrun
    Instant release{};                ///< of the opening
    Instant woke{};
    Instant at{};
    Duration lateness{};  ///< of a late release
    Duration kept_off{};  ///< time that the runner was ready and did not run, since the opening before
    Duration component_kept_off{};
};

/// The runner was ready and did not run for half of the time that it is late, and for kLossMin. The threads
/// that watch it take a little of its time themselves.
constexpr bool is_runner_kept_off(Duration kept_off, Duration lateness) noexcept {
    return kept_off >= kLossMin && kept_off + kept_off >= lateness;
}

/// Why a component took too long.
enum class Cause : std::uint8_t {
    kWork,        ///< it computed or waited
    kLock,        ///< it waited for a mutex that a thread without priority held
    kStuckGuard,  ///< it computed, and the guard did not come back in time either
};

/// A component that took too long.
struct Deed {
    std::size_t component{0U};
    Instant begin{};
    Instant end{};
    Cause cause{Cause::kWork};
};

/// When each cycle of each component ended, as the component itself read the clock, and for how long of it
/// the component was ready and did not run; 0 when it computed or waited too long itself.
class Ends final {
  public:
    static constexpr Instant kNone{-1};

    /// @param[in] frame_count those behind are not written down.
    Ends(std::size_t component_count, std::uint64_t frame_count)
        : frame_count_(frame_count),
          ends_(component_count * frame_count, kNone),
          kept_off_(component_count * frame_count) {}
    Ends() = default;

    /// Thread safety: each component from one thread at a time. @param[in] release of its window.
    void set(std::size_t component, Instant release, Instant end, Duration kept_off = Duration{0}) noexcept {
        if (covers(release)) {
            ends_[find(component, release)] = end;
            kept_off_[find(component, release)] = kept_off;
        }
    }
    /// Whether the frame of a window is written down.
    bool covers(Instant release) const noexcept { return calc_frame(release) < frame_count_; }
    /// @pre covers(release). @return kNone: it did not end.
    Instant get(std::size_t component, Instant release) const noexcept {
        return ends_[find(component, release)];
    }
    /// @pre covers(release).
    Duration get_kept_off(std::size_t component, Instant release) const noexcept {
        return kept_off_[find(component, release)];
    }

  private:
    static std::uint64_t calc_frame(Instant release) noexcept {
        return static_cast<std::uint64_t>(release.ns / kTick.ns);
    }
    std::size_t find(std::size_t component, Instant release) const noexcept {
        return component * frame_count_ + calc_frame(release);
    }

    std::uint64_t frame_count_{0U};
    std::vector<Instant> ends_{};
    std::vector<Duration> kept_off_{};
};

/// What became of a run. All is well when nearly all faults took effect, each was seen, and nothing was
/// misnamed, unseen, tardy, invented or suspected.
struct Verdict {
    std::uint64_t frames{0U};
    std::uint64_t requested{0U};      ///< faults
    std::uint64_t injected{0U};       ///< that took effect; one may not when the machine stood still
    std::uint64_t seen{0U};           ///< reported, under the right name
    std::uint64_t misnamed{0U};       ///< reported in its time, under another name only
    std::uint64_t unseen{0U};         ///< not reported at all
    std::uint64_t tardy{0U};          ///< reported more than a tick after its deadline, while the machine ran
    std::uint64_t tardy_by_host{0U};  ///< likewise, while the machine stood still
    std::uint64_t invented{0U};       ///< reported without a fault, though the machine took nothing away
    std::uint64_t times{0U};          ///< of those invented; one that delays several windows counts once
    std::uint64_t by_host{0U};        ///< reported without a fault; the host took kLossMin or more at once
    std::uint64_t suspected{0U};      ///< likewise, in pieces; or it kept a ready component from running
    verification::HostFigures host{};
    std::vector<std::int64_t> detection_ns{};  ///< from the deadline of each overrun to its report
    std::vector<Report> unexplained{};         ///< those that were invented
    std::vector<Deed> overlooked{};            ///< those that were misnamed or unseen
    std::uint64_t locked_out{0U};              ///< of those injected: components that waited for a held mutex
    std::uint64_t locked_out_seen{0U};         ///< reported, under the right name
    WatchVerdict watch{};                      ///< its wrong clocks are among those injected and seen
    std::uint64_t reads_under_way{0U};  ///< openings at which a reader stood still in the middle of a request
    std::uint64_t requests{0U};         ///< of introspection
    std::int64_t major_faults{0};       ///< page faults in the threads of the windows
    std::int64_t minor_faults{0};
    bool has_storm{false};  ///< a process faulted pages beside it, from begin to end
    bool has_locked_memory{false};
    bool has_priority{false};

    /// A fault may miss its place while the machine stands still; more than a few that do are no test.
    bool are_reports_well() const noexcept {
        return 20U * injected >= 19U * requested && seen == injected &&
               misnamed + unseen + tardy + invented + suspected == 0U;
    }
    /// Without locked memory nothing is asked.
    bool are_pages_well() const noexcept {
        return !has_locked_memory || (major_faults == 0 && minor_faults <= kMinorFaultsMax);
    }
    bool is_well() const noexcept { return are_reports_well() && watch.is_well() && are_pages_well(); }

    /// For `assess_run()`: of the reports, of the watch, of both and the page faults.
    verification::RunEvidence get_report_evidence() const noexcept;
    verification::RunEvidence get_watch_evidence() const noexcept;
    verification::RunEvidence get_evidence() const noexcept;
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
    WatchBounds watch{};
};

/// Everything that was written down of a run, each list in the order of its instants.
struct Course {
    std::vector<Report> reports{};
    std::vector<Deed> deeds{};
    std::vector<Delay> delays{};
    std::vector<Stall> stalls{};
    WatchCourse watch{};
    std::vector<Stall> late_looks{};  ///< of whoever tells of stalls
    Ends ends{};
    verification::HostFigures host{};
    /// The runner was ready and did not run, for kLossMin or more: from the planned opening to the wake-up.
    std::vector<Stall> runner_delays{};
};

/// @return the counts from `injected` to `host`, and all from `detection_ns` to `watch`; the rest is
/// the caller's.
Verdict judge(const Plan& plan, const Course& course);

}  // namespace mamori::time_faults

#endif  // MAMORI_TIME_FAULTS_JUDGE_HPP
