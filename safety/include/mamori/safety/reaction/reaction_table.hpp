// SPDX-License-Identifier: Apache-2.0
/// @file
/// From latched faults to one demand: the reactions of the system table (mamori::react()) for the mode of the
/// system, the worst of them first. The compiler rejects a table in which a declared fault has no reaction.
///
/// @satisfies SWR-FLT-005, SWR-FLT-006, SWR-FLT-010, SWR-FLT-012
/// Design: docs/design/supervision.md#reactions
#ifndef MAMORI_SAFETY_REACTION_TABLE_HPP
#define MAMORI_SAFETY_REACTION_TABLE_HPP

#include <cstddef>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/table/system_table.hpp"
#include "mamori/safety/reaction/fault_register.hpp"
#include "mamori/safety/reaction/reaction.hpp"

namespace mamori::safety {

/// Finds the demand of one fault. @param[in] rows, mode as below.
/// @return the reaction of the row of the fault in the mode; Reaction::kSto at once without such a row.
/// Time: O(rows).
ReactionDemand find_demand(Span<const ReactionRow> rows, FaultIndex fault, std::size_t mode) noexcept;

/// Finds the demand of all latched faults. Call it in each cycle: the register keeps the worst demand of each
/// latched fault until it is acknowledged, so no mode switch lowers it.
/// @param[in]     rows   SystemTable::reactions; their numbers are those of Reaction.
/// @param[in,out] faults keep their demands.
/// @param[in]     mode   in which the system is; 0 for one without modes.
/// @return the severest reaction over all latched faults and the modes since each was latched, among equals
///         the shortest time, then the lowest fault number; Reaction::kSto at once for a latched fault that
///         has no row for the mode, or a row with a number that is no Reaction, and for every latched fault
///         in an invalid mode, from kSystemModeMax on.
/// Time: O(faults * rows).
ReactionDemand calc_reaction(Span<const ReactionRow> rows, FaultRegister& faults,
                             std::size_t mode = 0U) noexcept;

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_REACTION_TABLE_HPP
