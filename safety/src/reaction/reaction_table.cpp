// SPDX-License-Identifier: Apache-2.0
#include "mamori/safety/reaction/reaction_table.hpp"

#include <cstdint>

namespace mamori::safety {
namespace {

bool is_answer(const ReactionRow& row, FaultIndex fault, std::size_t mode) noexcept {
    return row.fault == fault && row.reaction <= static_cast<std::uint32_t>(Reaction::kSto) &&
           mode < kSystemModeMax && (row.modes & to_mask(mode)) != 0U;
}

}  // namespace

ReactionDemand find_demand(Span<const ReactionRow> rows, FaultIndex fault, std::size_t mode) noexcept {
    for (const ReactionRow& row : rows) {
        if (is_answer(row, fault, mode)) {
            return {static_cast<Reaction>(row.reaction), fault, row.within};
        }
    }
    return {Reaction::kSto, fault, Duration{0}};
}

ReactionDemand calc_reaction(Span<const ReactionRow> rows, FaultRegister& faults, std::size_t mode) noexcept {
    ReactionDemand worst{};
    for (std::size_t i = 0U; i < faults.get_capacity(); ++i) {
        const auto fault = static_cast<FaultIndex>(i);
        if (faults.is_latched(fault)) {
            const ReactionDemand& demand = faults.raise(find_demand(rows, fault, mode));
            if (is_worse(demand, worst)) {
                worst = demand;
            }
        }
    }
    return worst;
}

}  // namespace mamori::safety
