// SPDX-License-Identifier: Apache-2.0
/// @file
/// Rules of a safety table, and what is found against them. Not for users.
///
/// @satisfies SWR-CYC-002      Design: docs/design/safety_cycle.md#the-table
#ifndef MAMORI_SAFETY_SAFETY_FINDING_HPP
#define MAMORI_SAFETY_SAFETY_FINDING_HPP

#include <cstddef>
#include <cstdint>

namespace mamori::safety {

/// What is wrong with a table; the row counts what the rule names, in the order of the description.
enum class SafetyRule : std::uint8_t {
    kNone,
    kFaultsNumbered,          ///< fault
    kReactionKnown,           ///< reaction
    kSupervisedInTable,       ///< supervise
    kSupervisedOnce,          ///< supervise
    kAliveInRange,            ///< supervise
    kDeadlineInRange,         ///< supervise
    kRaisedFaultDeclared,     ///< supervise
    kSomethingProven,         ///< supervise
    kConfirmedFaultDeclared,  ///< confirm
    kConfirmedOnce,           ///< confirm
    kConfirmationInRange,     ///< confirm
    kCycleOnce,               ///< cycle
    kStopBoundsInRange,       ///< cycle
    kBrakesHaveTime,          ///< cycle
    kWatchdogInRange,         ///< cycle
    kTorqueFeedbackInRange,   ///< cycle
    kLatenessInRange,         ///< cycle
    kCycleFaultDeclared,      ///< cycle
    kCycleComponentOnce,      ///< cycle
    kWatchdogFitsPeriod,      ///< cycle
    kSupervisedOnCore,        ///< supervise
    kBrakesFirstDeclared,     ///< cycle
    kBrakesFirstHasContacts,  ///< cycle
    kBrakesFirstBySto,        ///< cycle
    kStopConfirmed,           ///< StopConfirmation
    kConfirmedByOnce,         ///< confirmed_by
    kSourceInTable,           ///< confirmed_by
    kSourceSupervised,        ///< confirmed_by
    kSourceConnected,         ///< confirmed_by
    kSourceBeforeCycle,       ///< confirmed_by
    kCheckpointsOfOneTable,   ///< supervise
    kEntityKnown,             ///< supervise
    kEntityOfOneComponent,    ///< supervise
    kEntityOfAComponent,      ///< entity
    kTestedFaultDeclared,     ///< self_test
    kTestedOnce,              ///< self_test
    kTestHasSteps,            ///< self_test
    kProtectedInTable,        ///< protect
    kProtectedOnce,           ///< protect
    kProtectedFaultDeclared,  ///< protect
    kProtectedReachable,      ///< protect
    kProtectedLossesInTime,   ///< protect
    kProtectedOnCore,         ///< protect
    kAssumptionsNumbered,     ///< assume
    kAssumptionHasTime,       ///< assume
};

/// The first violated rule; kNone when there is none.
struct SafetyFinding {
    SafetyRule rule{SafetyRule::kNone};
    std::size_t row{0U};
};

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_SAFETY_FINDING_HPP
