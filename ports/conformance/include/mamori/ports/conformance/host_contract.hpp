// SPDX-License-Identifier: Apache-2.0
/// @file
/// What every port promises of running work within a budget: the contract of WindowHost.
///
/// @satisfies SWR-CNF-002, SWR-CNF-003, SWR-CNF-004, SWR-CNF-005
/// Design: docs/design/conformance.md#windows
#ifndef MAMORI_PORTS_CONFORMANCE_HOST_CONTRACT_HPP
#define MAMORI_PORTS_CONFORMANCE_HOST_CONTRACT_HPP

#include <cstddef>
#include <vector>

#include "mamori/kernel/base/time.hpp"
#include "mamori/kernel/component/window_host.hpp"
#include "mamori/ports/conformance/clock_contract.hpp"
#include "mamori/ports/conformance/trial.hpp"

namespace mamori::ports::conformance {

/// What a step of work is to do.
struct StepPlan {
    Duration time{0};     ///< that it takes; longer where the machine is busy
    bool is_hang{false};  ///< it does not return before HostRig::release()
};

/// A port's host with windows 0 .. kWindowCount - 1, whose components are 0 .. kComponentCount - 1.
///
/// Where a rig is destroyed while a step hangs, the rules have released it before.
class HostRig : public ClockRig {
  public:
    static constexpr std::size_t kWindowCount = 3U;
    static constexpr std::size_t kStepsMax = 4U;  ///< of one piece of work
    static constexpr std::size_t kComponentCount = kWindowCount * kStepsMax;

    virtual WindowHost& get_host() = 0;
    Instant get_now() const override = 0;

    /// Called before the host is given work: a host that models execution times learns them here.
    /// @param[in] work  step i of it is component `work.component` + i.
    /// @param[in] steps what each step of it is to do.
    virtual void plan(const WindowHost::Work& work, const std::vector<StepPlan>& steps) = 0;
    /// Called within a step, on whatever thread runs it: a host that does not model execution times takes its
    /// time here, and returns from a hang after release() only.
    virtual void spend(std::size_t window, const StepPlan& step) noexcept = 0;
    /// Ends the hang of a window's work, now or, where it has not begun yet, as soon as it does. The next
    /// plan() of the window makes a new one possible.
    virtual void release(std::size_t window) noexcept = 0;
};

/// @param[in] make_rig a new port each time. @return the trials, for the runners of rule_runner.hpp.
TrialFactory make_host_trials(RigFactory<HostRig> make_rig);

}  // namespace mamori::ports::conformance

#endif  // MAMORI_PORTS_CONFORMANCE_HOST_CONTRACT_HPP
