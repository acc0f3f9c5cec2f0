// SPDX-License-Identifier: Apache-2.0
/// @file
/// What every port promises of its hardware watchdog: silent before its first service, and once it was not
/// serviced in time it has opened its relay for good.
///
/// @satisfies SWR-CNF-006      Design: docs/design/conformance.md#watchdog
#ifndef MAMORI_PORTS_CONFORMANCE_WATCHDOG_CONTRACT_HPP
#define MAMORI_PORTS_CONFORMANCE_WATCHDOG_CONTRACT_HPP

#include "mamori/kernel/base/time.hpp"
#include "mamori/ports/conformance/trial.hpp"
#include "mamori/safety/supervision/watchdog_gate.hpp"

namespace mamori::ports::conformance {

/// A watchdog that was not serviced yet.
class WatchdogRig {
  public:
    WatchdogRig() = default;
    virtual ~WatchdogRig() = default;
    WatchdogRig(const WatchdogRig&) = delete;
    WatchdogRig& operator=(const WatchdogRig&) = delete;

    virtual safety::Watchdog& get_watchdog() = 0;
    /// Longest time between two services that the watchdog accepts, > 1 ns.
    virtual Duration get_timeout() const = 0;
    /// On the time line of the watchdog's own clock.
    virtual Instant get_now() const = 0;
    /// At least this much time passes, also for the watchdog.
    virtual void let_pass(Duration time) = 0;
    /// Whether the relay is open now. A watchdog that is simulated looks at its clock here and in its
    /// service, not in let_pass(): else the rules cannot see that a late service is refused.
    virtual bool has_expired() = 0;
};

/// @param[in] make_rig a new port each time. @return the trials, for the runners of rule_runner.hpp.
TrialFactory make_watchdog_trials(RigFactory<WatchdogRig> make_rig);

}  // namespace mamori::ports::conformance

#endif  // MAMORI_PORTS_CONFORMANCE_WATCHDOG_CONTRACT_HPP
