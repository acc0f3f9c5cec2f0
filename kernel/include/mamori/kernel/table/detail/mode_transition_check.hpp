// SPDX-License-Identifier: Apache-2.0
/// @file
/// Rules of mode switches: transitions, reachable modes, and the safe mode, in which a failed switch ends.
/// Not for users.
///
/// @satisfies SWR-MOD-003      Design: docs/design/modes.md#what-the-compiler-refuses
#ifndef MAMORI_KERNEL_MODE_TRANSITION_CHECK_HPP
#define MAMORI_KERNEL_MODE_TRANSITION_CHECK_HPP

#include <cstddef>

#include "mamori/kernel/table/detail/finding_list.hpp"
#include "mamori/kernel/table/mode_table.hpp"
#include "mamori/kernel/table/system_table.hpp"
#include "mamori/kernel/table/table_index.hpp"

namespace mamori::detail {

constexpr void check_transitions(const SystemView& view, FindingList& findings) noexcept {
    const Span<const ModeTransitionRow> rows = view.modes.transitions;
    for (std::size_t i = 0U; i < rows.size(); ++i) {
        if (rows[i].source >= view.modes.modes.size() || rows[i].target >= view.modes.modes.size()) {
            findings.add(Rule::kTransitionOfUnknownMode, i);
            continue;
        }
        if (view.modes.modes[rows[i].source].is_safe) {
            findings.add(Rule::kSafeModeIsLeft, i);
        }
        for (std::size_t j = 0U; j < i; ++j) {
            if (rows[j].source == rows[i].source && rows[j].event == rows[i].event) {
                findings.add(Rule::kTransitionAmbiguous, i, j);
            }
        }
    }
}

/// The safe mode needs no transition: a failed mode switch leads to it.
constexpr void check_reachability(const SystemView& view, FindingList& findings) noexcept {
    const std::size_t mode_count = view.modes.modes.size();
    ModeMask reached = 1U;
    for (std::size_t round = 0U; round < mode_count; ++round) {
        for (const ModeTransitionRow& row : view.modes.transitions) {
            if (row.source < mode_count && row.target < mode_count && (reached & to_mask(row.source)) != 0U) {
                reached |= to_mask(row.target);
            }
        }
    }
    for (std::size_t m = 0U; m < mode_count; ++m) {
        if ((reached & to_mask(m)) == 0U && !view.modes.modes[m].is_safe) {
            findings.add(Rule::kModeUnreachable, m);
        }
    }
}

constexpr void check_safe_mode(const SystemView& view, FindingList& findings) noexcept {
    const std::size_t safe = find_safe_mode(view.modes);
    if (safe == kNoIndex) {
        findings.add(Rule::kNoSafeMode, 0U);
        return;
    }
    for (std::size_t i = 0U; i < view.components.size(); ++i) {
        const ModeMask modes = view.component_rows[i].modes;
        for (std::size_t m = 0U; m < view.modes.modes.size(); ++m) {
            if ((modes & to_mask(safe)) != 0U && (modes & to_mask(m)) == 0U) {
                findings.add(Rule::kSafeModeActivates, i, m);
                break;
            }
        }
    }
}

}  // namespace mamori::detail

#endif  // MAMORI_KERNEL_MODE_TRANSITION_CHECK_HPP
