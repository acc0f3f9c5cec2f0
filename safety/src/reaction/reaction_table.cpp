// SPDX-License-Identifier: Apache-2.0
#include "mamori/safety/reaction/reaction_table.hpp"

namespace mamori::safety {
namespace {

/// The row of a fault in a mode. One that was never declared is answered with the severest reaction at once.
ReactionRow find_row(Span<const ReactionRow> table, FaultIndex fault, std::size_t mode) noexcept {
    for (const ReactionRow& row : table) {
        if (answers(row, fault, mode)) {
            return row;
        }
    }
    return {fault, Reaction::kSto, Duration{0}};
}

bool is_worse(const ReactionRow& row, const ReactionDemand& demand) noexcept {
    if (demand.fault == kNoFault || row.reaction > demand.reaction) {
        return true;
    }
    return row.reaction == demand.reaction && row.within < demand.within;
}

}  // namespace

ReactionDemand calc_reaction(Span<const ReactionRow> table, const FaultRegister& faults,
                             std::size_t mode) noexcept {
    ReactionDemand worst{};
    for (std::size_t i = 0U; i < faults.get_capacity(); ++i) {
        const auto fault = static_cast<FaultIndex>(i);
        if (faults.is_latched(fault)) {
            const ReactionRow row = find_row(table, fault, mode);
            if (is_worse(row, worst)) {
                worst = {row.reaction, fault, row.within};
            }
        }
    }
    return worst;
}

}  // namespace mamori::safety
