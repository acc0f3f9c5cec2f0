// SPDX-License-Identifier: Apache-2.0
/// @file
/// Rules of the modes of a system: their names, sets and members. Sources of mandatory inputs in each mode:
/// input_check.hpp. Not for users.
///
/// @satisfies SWR-MOD-003      Design: docs/design/modes.md#what-the-compiler-refuses
#ifndef MAMORI_KERNEL_MODE_CHECK_HPP
#define MAMORI_KERNEL_MODE_CHECK_HPP

#include <cstddef>

#include "mamori/kernel/table/detail/finding_list.hpp"
#include "mamori/kernel/table/detail/mode_transition_check.hpp"
#include "mamori/kernel/table/index_of.hpp"
#include "mamori/kernel/table/mode_table.hpp"
#include "mamori/kernel/table/system_table.hpp"

namespace mamori::detail {

constexpr void check_mode(const SystemView& view, std::size_t m, FindingList& findings) noexcept {
    const SystemModeRow& row = view.modes.modes[m];
    if (find_named(view.modes.modes, row.name) < m) {
        findings.add(Rule::kModeNamedTwice, m);
    }
    const bool has_set = row.set_name != nullptr || row.set != kNoIndex;
    if (has_set && row.set >= view.configuration.sets.size()) {
        findings.add(Rule::kModeOfUnknownSet, m);
    }
    if (row.is_safe && find_safe_mode(view.modes) < m) {
        findings.add(Rule::kTwoSafeModes, m);
    }
}

constexpr bool is_member_known(const SystemView& view, const ModeMemberRow& row) noexcept {
    return row.mode < view.modes.modes.size() && row.index < view.components.size() &&
           view.components[row.index] == row.component;
}

constexpr void check_members(const SystemView& view, FindingList& findings) noexcept {
    for (std::size_t i = 0U; i < view.modes.members.size(); ++i) {
        if (!is_member_known(view, view.modes.members[i])) {
            findings.add(Rule::kModeOfUnknownComponent, i);
        }
    }
    for (std::size_t i = 0U; i < view.components.size() && !view.modes.modes.empty(); ++i) {
        if (view.component_rows[i].modes == 0U) {
            findings.add(Rule::kComponentInNoMode, i);
        }
    }
    for (std::size_t i = 0U; i < view.modes.connection_modes.size(); ++i) {
        const ConnectionModeRow& row = view.modes.connection_modes[i];
        if (row.mode >= view.modes.modes.size() || row.connection >= view.connections.size()) {
            findings.add(Rule::kConnectionOfUnknownMode, i);
        }
    }
}

/// Precondition: each row of the table is valid.
constexpr void check_modes(const SystemView& view, FindingList& findings) noexcept {
    for (std::size_t m = 0U; m < view.modes.modes.size(); ++m) {
        check_mode(view, m, findings);
    }
    check_members(view, findings);
    if (!view.modes.modes.empty()) {
        check_safe_mode(view, findings);
    }
    check_transitions(view, findings);
    if (!view.modes.modes.empty()) {
        check_reachability(view, findings);
    }
}

}  // namespace mamori::detail

#endif  // MAMORI_KERNEL_MODE_CHECK_HPP
