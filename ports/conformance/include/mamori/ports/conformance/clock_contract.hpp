// SPDX-License-Identifier: Apache-2.0
/// @file
/// What every port promises of its clock and of waiting for an instant.
///
/// @satisfies SWR-CNF-001      Design: docs/design/conformance.md#clock
#ifndef MAMORI_PORTS_CONFORMANCE_CLOCK_CONTRACT_HPP
#define MAMORI_PORTS_CONFORMANCE_CLOCK_CONTRACT_HPP

#include "mamori/kernel/base/time.hpp"
#include "mamori/ports/conformance/trial.hpp"

namespace mamori::ports::conformance {

/// A port's time line, as its author hands it to the rules.
class ClockRig {
  public:
    ClockRig() = default;
    virtual ~ClockRig() = default;
    ClockRig(const ClockRig&) = delete;
    ClockRig& operator=(const ClockRig&) = delete;

    virtual Instant get_now() const = 0;
    /// Lets time pass until `instant`; does nothing when it has passed.
    virtual void wait_until(Instant instant) = 0;
    /// Measure of the rules' times, > 0: long against a reading of the clock, short against the patience of
    /// whoever waits for the test.
    virtual Duration get_tick() const = 0;
    /// True where time is simulated: it passes only where it is told to, and by as much. The rules then
    /// demand exact instants; of other ports they demand what holds however busy the machine is.
    virtual bool is_exact() const = 0;
};

/// @param[in] make_rig a new port each time. @return the trials, for the runners of rule_runner.hpp.
TrialFactory make_clock_trials(RigFactory<ClockRig> make_rig);

}  // namespace mamori::ports::conformance

#endif  // MAMORI_PORTS_CONFORMANCE_CLOCK_CONTRACT_HPP
