// SPDX-License-Identifier: Apache-2.0
/// @file
/// Rules of faults and reactions: each fault is declared once and has one reaction in each mode, with a
/// positive time. Not for users.
///
/// @satisfies SWR-KRN-018, SWR-KRN-025, SWR-FLT-004, SWR-FLT-011      Design:
/// docs/design/kernel.md#system-table
#ifndef MAMORI_KERNEL_REACTION_CHECK_HPP
#define MAMORI_KERNEL_REACTION_CHECK_HPP

#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/time.hpp"
#include "mamori/kernel/table/detail/finding_list.hpp"
#include "mamori/kernel/table/system_table.hpp"

namespace mamori::detail {

constexpr std::size_t count_reactions(const SystemView& view, std::uint32_t fault,
                                      std::size_t mode) noexcept {
    std::size_t count = 0U;
    for (const ReactionRow& row : view.reactions) {
        count += row.fault == fault && (row.modes & to_mask(mode)) != 0U ? 1U : 0U;
    }
    return count;
}

/// Finds the first mode without exactly one reaction; a system without modes has mode 0 only. The check of
/// the rows rejects more than kSystemModeMax modes.
constexpr void check_reactions_of(const SystemView& view, std::size_t fault, FindingList& findings) noexcept {
    const std::size_t mode_count = view.modes.modes.empty() ? 1U : view.modes.modes.size();
    for (std::size_t mode = 0U; mode < mode_count; ++mode) {
        const std::size_t count = count_reactions(view, view.faults[fault].fault, mode);
        if (count != 1U) {
            findings.add(count == 0U ? Rule::kFaultWithoutReaction : Rule::kFaultWithTwoReactions, fault,
                         mode);
            return;
        }
    }
}

/// Whether a reaction names at least one mode, and only modes of the table.
constexpr bool has_known_modes(const SystemView& view, const ReactionRow& row) noexcept {
    const std::size_t mode_count = view.modes.modes.size();
    const ModeMask known = mode_count >= kSystemModeMax ? kEveryMode : to_mask(mode_count) - 1U;
    return row.modes == kEveryMode || (row.modes != 0U && (row.modes & ~known) == 0U);
}

constexpr void check_reactions(const SystemView& view, FindingList& findings) noexcept {
    for (std::size_t i = 0U; i < view.faults.size(); ++i) {
        for (std::size_t j = 0U; j < i; ++j) {
            if (view.faults[j].fault == view.faults[i].fault) {
                findings.add(Rule::kFaultDeclaredTwice, i, j);
                break;
            }
        }
        check_reactions_of(view, i, findings);
    }
    for (std::size_t i = 0U; i < view.reactions.size(); ++i) {
        if (view.reactions[i].within <= Duration{0}) {
            findings.add(Rule::kReactionWithoutTime, i);
        }
        if (!has_known_modes(view, view.reactions[i])) {
            findings.add(Rule::kReactionInUnknownMode, i);
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
