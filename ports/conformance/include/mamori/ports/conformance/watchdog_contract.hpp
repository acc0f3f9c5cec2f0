// SPDX-License-Identifier: Apache-2.0
/// @file
/// Contract of each port for its hardware watchdog: it is inactive before its first service. If it is not
/// serviced in time, it opens its relay permanently.
///
/// @satisfies SWR-CNF-006      Design: docs/design/conformance.md#watchdog
#ifndef MAMORI_PORTS_CONFORMANCE_WATCHDOG_CONTRACT_HPP
#define MAMORI_PORTS_CONFORMANCE_WATCHDOG_CONTRACT_HPP

#include "mamori/kernel/base/time.hpp"
#include "mamori/ports/conformance/trial.hpp"
#include "mamori/safety/supervision/watchdog_gate.hpp"

namespace mamori::ports::conformance {

/// Test adapter for a watchdog that was not serviced yet.
class WatchdogRig {
  public:
    WatchdogRig() = default;
    virtual ~WatchdogRig() = default;
    WatchdogRig(const WatchdogRig&) = delete;
    WatchdogRig& operator=(const WatchdogRig&) = delete;

    virtual safety::Watchdog& get_watchdog() = 0;
    /// Maximum time between two services, > 1 ns.
    virtual Duration get_timeout() const = 0;
    /// Current time of the clock of the watchdog.
    virtual Instant get_now() const = 0;
    /// Waits at least this time, measured with the clock of the watchdog.
    virtual void let_pass(Duration time) = 0;
    /// True if the relay is open. A simulated watchdog must read its clock here and in its service, not in
    /// let_pass(). Otherwise, the rules cannot check that a late service is rejected.
    virtual bool has_expired() = 0;
};

/// @param[in] make_rig returns a new port on each call.
/// @return the trials for the runners of rule_runner.hpp.
TrialFactory make_watchdog_trials(RigFactory<WatchdogRig> make_rig);

}  // namespace mamori::ports::conformance

#endif  // MAMORI_PORTS_CONFORMANCE_WATCHDOG_CONTRACT_HPP
