// SPDX-License-Identifier: Apache-2.0
/// @file
/// Rules of faults and reactions: each fault is declared once and has one reaction, with a positive time. Not
/// for users.
///
/// @satisfies SWR-KRN-018, SWR-KRN-025      Design: docs/design/kernel.md#system-table
#ifndef MAMORI_KERNEL_REACTION_CHECK_HPP
#define MAMORI_KERNEL_REACTION_CHECK_HPP

#include <cstddef>

#include "mamori/kernel/base/time.hpp"
#include "mamori/kernel/table/detail/finding_list.hpp"
#include "mamori/kernel/table/system_table.hpp"

namespace mamori::detail {

constexpr void check_reactions(const SystemView& view, FindingList& findings) noexcept {
    for (std::size_t i = 0U; i < view.faults.size(); ++i) {
        std::size_t count = 0U;
        for (const ReactionRow& reaction : view.reactions) {
            count += reaction.fault == view.faults[i].fault ? 1U : 0U;
        }
        for (std::size_t j = 0U; j < i; ++j) {
            if (view.faults[j].fault == view.faults[i].fault) {
                findings.add(Rule::kFaultDeclaredTwice, i, j);
                break;
            }
        }
        if (count == 0U) {
            findings.add(Rule::kFaultWithoutReaction, i);
        }
        if (count > 1U) {
            findings.add(Rule::kFaultWithTwoReactions, i);
        }
    }
    for (std::size_t i = 0U; i < view.reactions.size(); ++i) {
        if (view.reactions[i].within <= Duration{0}) {
            findings.add(Rule::kReactionWithoutTime, i);
        }
        bool is_declared = false;
        for (const FaultRow& row : view.faults) {
            is_declared = is_declared || row.fault == view.reactions[i].fault;
        }
        if (!is_declared) {
            findings.add(Rule::kReactionToUnknownFault, i);
        }
    }
}

}  // namespace mamori::detail

#endif  // MAMORI_KERNEL_REACTION_CHECK_HPP
