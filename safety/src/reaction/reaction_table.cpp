// SPDX-License-Identifier: Apache-2.0
#include "mamori/safety/reaction/reaction_table.hpp"

namespace mamori::safety {
namespace {

/// The demand of a fault in a mode. A fault without a row gets the severest reaction immediately.
ReactionDemand find_demand(Span<const ReactionRow> table, FaultIndex fault, std::size_t mode) noexcept {
    for (const ReactionRow& row : table) {
        if (answers(row, fault, mode)) {
            return {row.reaction, fault, row.within};
        }
    }
    return {Reaction::kSto, fault, Duration{0}};
}

}  // namespace

ReactionDemand calc_reaction(Span<const ReactionRow> table, FaultRegister& faults,
                             std::size_t mode) noexcept {
    ReactionDemand worst{};
    for (std::size_t i = 0U; i < faults.get_capacity(); ++i) {
        const auto fault = static_cast<FaultIndex>(i);
        if (faults.is_latched(fault)) {
            const ReactionDemand& demand = faults.raise(find_demand(table, fault, mode));
            if (is_worse(demand, worst)) {
                worst = demand;
            }
        }
    }
    return worst;
}

}  // namespace mamori::safety
