// SPDX-License-Identifier: Apache-2.0
/// @file
/// All records of a run with faults of time: injections, reports and host causes.
/// `verification/faults/evaluation` evaluates them.
#ifndef MAMORI_TIME_FAULTS_COURSE_HPP
#define MAMORI_TIME_FAULTS_COURSE_HPP

#include <cstdint>
#include <vector>

#include "mamori/kernel/base/time.hpp"
#include "mamori/kernel/table/system_table.hpp"
#include "mamori/ports/posix_rt/grid_watch.hpp"
#include "mamori/verification/stall_watch.hpp"

namespace mamori::time_faults {

using verification::Stall;

/// Major frame of the system.
inline constexpr Duration kTick{1'000'000};

/// Time that the host must take from a window to count as the cause of a report: half of the budget.
inline constexpr Duration kLossMin{100'000};

/// A report of the executive.
struct Report {
    bool is_overrun{false};
    std::size_t window{0U};
    std::size_t component{kNoIndex};  ///< of an overrun
    Instant release{};                ///< planned window start
    Instant woke{};                   ///< actual window start
    Instant at{};
    Duration runner_delay{};     ///< the runner was ready but did not run, since the previous window
    Duration component_delay{};  ///< the component was ready but did not run in this window
};

/// The runner was ready but did not run for half of its lateness, and for kLossMin. The threads that monitor
/// the runner take some of its time themselves.
constexpr bool is_runner_delayed(Duration delay, Duration lateness) noexcept {
    return delay >= kLossMin && delay + delay >= lateness;
}

/// Why a component took too long.
enum class Cause : std::uint8_t {
    kWork,        ///< it computed or waited
    kLock,        ///< it waited for a mutex that a thread without priority held
    kStuckGuard,  ///< it computed, and the guard also did not return in time
};

/// An injection: a component that took too long.
struct Overrun {
    std::size_t component{0U};
    Instant begin{};
    Instant end{};
    Cause cause{Cause::kWork};
};

/// An injection: a delayed window.
struct Delay {
    std::size_t window{0U};
    Instant release{};
    Instant end{};
};

/// An injection: the runner did not do its due work.
struct Hold {
    Instant due{};
    Instant end{};
};

/// An injection: the clock ran at a wrong rate.
struct ClockFault {
    Instant begin{};
    Instant end{};
    std::int64_t ppm{0};
};

/// A finding of the monitor, latched until its reset.
struct Found {
    ports::posix_rt::GridFinding finding{};
    Instant cleared{ports::posix_rt::GridBeat::kNever};
};

/// How long each component was ready but did not run, in each of its cycles; 0 for a component that itself
/// computed or waited too long.
class ComponentDelays final {
  public:
    /// @param[in] frame_count later frames are not recorded.
    ComponentDelays(std::size_t component_count, std::uint64_t frame_count)
        : frame_count_(frame_count), delays_(component_count * frame_count) {}

    /// Thread safety: each component from one thread at a time. @param[in] release of its window.
    void set(std::size_t component, Instant release, Duration delay) noexcept {
        if (calc_frame(release) < frame_count_) {
            delays_[find(component, release)] = delay;
        }
    }
    /// @return 0 for a cycle that was not recorded.
    Duration get(std::size_t component, Instant release) const noexcept {
        return calc_frame(release) < frame_count_ ? delays_[find(component, release)] : Duration{0};
    }

  private:
    static std::uint64_t calc_frame(Instant release) noexcept {
        return static_cast<std::uint64_t>(release.ns / kTick.ns);
    }
    std::size_t find(std::size_t component, Instant release) const noexcept {
        return component * frame_count_ + calc_frame(release);
    }

    std::uint64_t frame_count_{0U};
    std::vector<Duration> delays_{};
};

/// Each list in the order of its instants.
struct Course {
    std::vector<Report> reports{};
    std::vector<Overrun> overruns{};
    std::vector<Delay> delays{};
    std::vector<Hold> holds{};
    std::vector<ClockFault> clock_faults{};
    std::vector<Found> found{};
    std::vector<Stall> stalls{};
    std::vector<Stall> late_polls{};
    /// The runner was ready but did not run for at least kLossMin: from the planned to the actual window
    /// start.
    std::vector<Stall> runner_delays{};
    verification::HostFigures host{};
    std::uint64_t reads_under_way{0U};  ///< window starts at which a reader was preempted during a request
    std::uint64_t requests{0U};         ///< of introspection
    std::int64_t major_faults{0};       ///< page faults in the threads of the windows
    std::int64_t minor_faults{0};
    bool has_storm{false};  ///< another process caused page faults during the complete run
    bool has_locked_memory{false};
    bool has_priority{false};
    bool has_run{false};
};

}  // namespace mamori::time_faults

#endif  // MAMORI_TIME_FAULTS_COURSE_HPP
