// SPDX-License-Identifier: Apache-2.0
/// @file
/// What a check of a system table finds: the broken rule and the row that is guilty.
///
/// @satisfies SWR-KRN-018, SWR-KRN-025      Design: docs/design/kernel.md#system-table
#ifndef MAMORI_KERNEL_SYSTEM_FINDING_HPP
#define MAMORI_KERNEL_SYSTEM_FINDING_HPP

#include <cstddef>

namespace mamori {

/// Why a table is refused. `Finding::element` is the index of the row named here.
enum class Rule {
    kNone,                 ///< the table keeps every rule
    kFrameNotPositive,     ///< no row: element is 0
    kWindowRowInvalid,     ///< window without a name, a positive period or components, with a trigger, events
                           ///< or slower rates that do not fit its kind, or with rows that are not its own
    kComponentRowInvalid,  ///< component that is null, with a negative worst case, without a window that has
                           ///< it, or with rows that are not its own
    kPortRowInvalid,       ///< port row that names not exactly one port, or is no row of its owner and window
    kConnectionRowInvalid,    ///< connection with a null end, without operations or the Crossing that they
                              ///< need, or of windows, components or ports that it does not join
    kWindowNamedTwice,        ///< window; `other` is the earlier listed one of the same name
    kTriggerUsedTwice,        ///< window; `other` is the earlier listed one of the same trigger
    kPeriodNotInFrame,        ///< window whose period does not divide the frame
    kWindowOutsideFrame,      ///< window that does not lie inside its period
    kWindowsOverlap,          ///< window; `other` is the earlier listed one of the same core
    kBudgetExceedsWindow,     ///< window whose budget is not in 1 ns .. its length
    kWorstCasesExceedBudget,  ///< window whose declared worst cases are longer than its budget
    kRateNotOccurrences,      ///< window whose declared rate is not that of its openings
    kRateNotReachable,        ///< window with an alternative rate that does not divide its first
    kComponentInTwoPlaces,    ///< component, second place
    kPortOfUnknownComponent,  ///< connection that names a port of no component in the table
    kInputNotConnected,       ///< port row: mandatory input without a connection
    kInputHasTwoWriters,      ///< port row: input with more than one connection
    kAgeLimitNotPositive,     ///< connection whose value would never be fresh
    kCrossingWithoutBuffer,   ///< connection that leaves its core or partition without a Crossing
    kCrossingUsedTwice,       ///< connection; `other` is the earlier one through the same Crossing
    kCrossingNotOrdered,      ///< connection whose reader may open while its writer's window is open
    kFaultDeclaredTwice,      ///< fault; `other` is its earlier declaration
    kFaultWithoutReaction,    ///< fault that no reaction names
    kFaultWithTwoReactions,   ///< fault that more than one reaction names
    kReactionWithoutTime,     ///< reaction whose time is not positive
    kReactionToUnknownFault,  ///< reaction to a fault that is not declared
    kParameterRowInvalid,     ///< parameter row without a parameter, an owner or a window that has it
    kSetRowInvalid,           ///< set without a name; or its assignment `other` or the values of that are not
                              ///< in the table
    kConfigurationRefused,    ///< set; `other` is its guilty assignment, see check(ConfigurationView)
    kModeRowInvalid,          ///< mode without a name, or beyond the 32nd
    kModeNamedTwice,          ///< mode with the name of an earlier one
    kModeOfUnknownComponent,  ///< member row: its component is in no window, or its mode not in the table
    kModeOfUnknownSet,        ///< mode whose configuration set does not exist
    kComponentInNoMode,       ///< component that no mode runs
    kInputNotFedInMode,       ///< port row: mandatory input that nothing feeds in mode `other`
    kConnectionOfUnknownMode,  ///< mode row of a connection: one of the two does not exist
    kTransitionOfUnknownMode,  ///< transition from or to a mode that does not exist
    kTransitionAmbiguous,      ///< transition; `other` is the earlier one of the same mode and event
    kModeUnreachable,          ///< mode that no sequence of transitions from the first one leads to
    kNoSafeMode,               ///< no row: element is 0
    kTwoSafeModes,             ///< mode, second safe one
    kSafeModeIsLeft,           ///< transition out of the safe mode
    kSafeModeActivates,        ///< component of the safe mode that mode `other` does not run
};

/// A broken rule; the rule says what the numbers count.
struct Finding {
    Rule rule{Rule::kNone};
    std::size_t element{0U};
    std::size_t other{0U};
};

/// Spelling of a rule for tools; never nullptr.
const char* get_name(Rule rule) noexcept;

}  // namespace mamori

#endif  // MAMORI_KERNEL_SYSTEM_FINDING_HPP
