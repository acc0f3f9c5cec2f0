// SPDX-License-Identifier: Apache-2.0
/// @file
/// What every port promises of its window timer: each window opens at its place on the fixed grid of the
/// frame, not before it, in order, and however late an earlier one was.
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

/// A port that drives one executive with kWindowCount windows, each with the component of the same number.
class TimerRig {
  public:
    static constexpr std::size_t kWindowCount = 2U;

    /// Openings so far that ran no component, or cut one off.
    struct Counts {
        std::uint64_t missed{0U};
        std::uint64_t overran{0U};
    };

    TimerRig() = default;
    virtual ~TimerRig() = default;
    TimerRig(const TimerRig&) = delete;
    TimerRig& operator=(const TimerRig&) = delete;

    /// Opens every window of the next `frame_count` frames, from the first frame on that can be kept, and
    /// returns after the last of them.
    virtual void run(std::uint64_t frame_count) = 0;
    virtual Counts get_counts() const = 0;
    virtual WindowHost& get_host() = 0;
    /// Lets time pass until `instant`; does nothing when it has passed.
    virtual void wait_until(Instant instant) = 0;
    /// As ClockRig::is_exact(); the first frame then begins at instant 0, and each where the last one ended.
    virtual bool is_exact() const = 0;

    /// What a component takes from now on; for a host that models execution times.
    virtual void plan(std::size_t component, Duration time) = 0;
    /// Called in a component's action, on whatever thread runs it, with the same time; for a host that
    /// measures execution times.
    virtual void spend(Duration time) noexcept = 0;
};

/// Makes a new port around an executive that was initialised and started, and that outlives it.
using TimerRigFactory = std::function<std::unique_ptr<TimerRig>(Executive&)>;

/// @param[in] make_rig a new port each time; its frames last 8 ms. @return the trials, for the runners of
///            rule_runner.hpp.
TrialFactory make_timer_trials(TimerRigFactory make_rig);

}  // namespace mamori::ports::conformance

#endif  // MAMORI_PORTS_CONFORMANCE_TIMER_CONTRACT_HPP
