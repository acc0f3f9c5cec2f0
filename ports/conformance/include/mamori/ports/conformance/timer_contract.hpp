// SPDX-License-Identifier: Apache-2.0
/// @file
/// Contract of each port for its window timer: each window starts in order and not before its planned instant
/// of the schedule, also after late windows.
///
/// @satisfies SWR-CNF-011      Design: docs/design/conformance.md#timer
#ifndef MAMORI_PORTS_CONFORMANCE_TIMER_CONTRACT_HPP
#define MAMORI_PORTS_CONFORMANCE_TIMER_CONTRACT_HPP

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>

#include "mamori/kernel/base/time.hpp"
#include "mamori/kernel/component/window_host.hpp"
#include "mamori/kernel/run/executive.hpp"
#include "mamori/ports/conformance/trial.hpp"

namespace mamori::ports::conformance {

/// Test adapter for a port that runs one executive with kWindowCount windows. Window i runs component i.
class TimerRig {
  public:
    static constexpr std::size_t kWindowCount = 2U;

    /// Counts of skipped and aborted window instances so far.
    struct Counts {
        std::uint64_t missed{0U};
        std::uint64_t overran{0U};
    };

    TimerRig() = default;
    virtual ~TimerRig() = default;
    TimerRig(const TimerRig&) = delete;
    TimerRig& operator=(const TimerRig&) = delete;

    /// Runs all windows of the next `frame_count` major frames, from the first major frame that can start in
    /// time. Returns after the last window.
    virtual void run(std::uint64_t frame_count) = 0;
    virtual Counts get_counts() const = 0;
    virtual WindowHost& get_host() = 0;
    /// Waits until `instant`. Returns immediately if it has passed.
    virtual void wait_until(Instant instant) = 0;
    /// As ClockRig::is_exact(). If true, the first major frame begins at instant 0, and each run begins at
    /// the end of the previous run.
    virtual bool is_exact() const = 0;

    /// Sets the execution time of a component, for a host that models execution times.
    virtual void plan(std::size_t component, Duration time) = 0;
    /// Called with the same time in the action of a component, on the thread that runs it, for a host that
    /// measures execution times.
    virtual void spend(Duration time) noexcept = 0;
};

/// Makes a new port for an initialised and started executive, which must outlive the port.
using TimerRigFactory = std::function<std::unique_ptr<TimerRig>(Executive&)>;

/// @param[in] make_rig returns a new port on each call; its major frames last 8 ms.
/// @return the trials for the runners of rule_runner.hpp.
TrialFactory make_timer_trials(TimerRigFactory make_rig);

}  // namespace mamori::ports::conformance

#endif  // MAMORI_PORTS_CONFORMANCE_TIMER_CONTRACT_HPP
