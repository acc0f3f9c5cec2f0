// SPDX-License-Identifier: Apache-2.0
/// @file
/// Contract of each port for the execution of work within a budget: the contract of WindowHost.
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

/// Behaviour of a step of work.
struct StepPlan {
    Duration time{0};     ///< execution time; longer on a busy host
    bool is_hang{false};  ///< the step returns only after HostRig::release()
};

/// Test adapter for a platform host with windows 0 .. kWindowCount - 1 and components 0 .. kComponentCount -
/// 1.
///
/// The rules release a hanging step before they destroy the adapter.
class HostRig : public ClockRig {
  public:
    static constexpr std::size_t kWindowCount = 3U;
    static constexpr std::size_t kStepsMax = 4U;  ///< maximum number of steps of one piece of work
    static constexpr std::size_t kComponentCount = kWindowCount * kStepsMax;

    virtual WindowHost& get_host() = 0;
    Instant get_now() const override = 0;

    /// Called before the host gets work, so that a host that models execution times knows them.
    /// @param[in] work its step i is component `work.component` + i.
    /// @param[in] steps behaviour of each step.
    virtual void plan(const WindowHost::Work& work, const std::vector<StepPlan>& steps) = 0;
    /// Called within a step, on the thread that runs it. A host that does not model execution times consumes
    /// the time here, and returns from a hang only after release().
    virtual void spend(std::size_t window, const StepPlan& step) noexcept = 0;
    /// Ends the hang of the work of a window. A hang that has not begun yet ends as soon as it begins. The
    /// next plan() of the window permits a new hang.
    virtual void release(std::size_t window) noexcept = 0;
};

/// @param[in] make_rig returns a new port on each call.
/// @return the trials for the runners of rule_runner.hpp.
TrialFactory make_host_trials(RigFactory<HostRig> make_rig);

}  // namespace mamori::ports::conformance

#endif  // MAMORI_PORTS_CONFORMANCE_HOST_CONTRACT_HPP
