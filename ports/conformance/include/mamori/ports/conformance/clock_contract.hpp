// SPDX-License-Identifier: Apache-2.0
/// @file
/// Contract of each port for its clock and for waits.
///
/// @satisfies SWR-CNF-001      Design: docs/design/conformance.md#clock
#ifndef MAMORI_PORTS_CONFORMANCE_CLOCK_CONTRACT_HPP
#define MAMORI_PORTS_CONFORMANCE_CLOCK_CONTRACT_HPP

#include "mamori/kernel/base/time.hpp"
#include "mamori/ports/conformance/trial.hpp"

namespace mamori::ports::conformance {

/// Test adapter for the time line of a port.
class ClockRig {
  public:
    ClockRig() = default;
    virtual ~ClockRig() = default;
    ClockRig(const ClockRig&) = delete;
    ClockRig& operator=(const ClockRig&) = delete;

    virtual Instant get_now() const = 0;
    /// Waits until `instant`. Returns immediately if it has passed.
    virtual void wait_until(Instant instant) = 0;
    /// Time unit of the rules, > 0: much longer than a reading of the clock, and short enough for a test with
    /// many units.
    virtual Duration get_tick() const = 0;
    /// True if time is simulated and passes only during waits, by exactly the requested amount. Then the
    /// rules check exact instants. For other ports, they check only properties that hold on a busy host, too.
    virtual bool is_exact() const = 0;
};

/// @param[in] make_rig returns a new port on each call.
/// @return the trials for the runners of rule_runner.hpp.
TrialFactory make_clock_trials(RigFactory<ClockRig> make_rig);

}  // namespace mamori::ports::conformance

#endif  // MAMORI_PORTS_CONFORMANCE_CLOCK_CONTRACT_HPP
