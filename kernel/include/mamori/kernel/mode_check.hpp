// SPDX-License-Identifier: Apache-2.0
/// @file
/// Rules that the modes of a system must keep, among them that in each mode each mandatory input of a running
/// component is fed, and by one source.
///
/// @satisfies SWR-MOD-003      Design: docs/design/modes.md#what-the-compiler-refuses
#ifndef MAMORI_KERNEL_MODE_CHECK_HPP
#define MAMORI_KERNEL_MODE_CHECK_HPP

#include <cstddef>

#include "mamori/kernel/mode_builder.hpp"
#include "mamori/kernel/system_finding.hpp"
#include "mamori/kernel/system_table.hpp"

namespace mamori::detail {

constexpr bool is_connected(const SystemView& view, const PortRow& input) noexcept {
    bool is_found = false;
    for (const ConnectionRow& connection : view.connections) {
        is_found = is_found || connection.sink == input.input;
    }
    return is_found;
}

/// Two connections may share an input when no mode has both; a queue has one writer for ever, since writers
/// of two cores could meet in it.
constexpr bool has_two_writers(const SystemView& view, const PortRow& input) noexcept {
    for (std::size_t i = 0U; i < view.connections.size(); ++i) {
        const ConnectionRow& later = view.connections[i];
        for (std::size_t j = 0U; j < i && later.sink == input.input; ++j) {
            const ConnectionRow& earlier = view.connections[j];
            const bool may_alternate = (earlier.modes & later.modes) == 0U && later.operations.is_latest;
            if (earlier.sink == input.input && !may_alternate) {
                return true;
            }
        }
    }
    return false;
}

/// Names the first mode in which a mandatory input that is connected gets nothing.
constexpr void check_feeding(const SystemView& view, std::size_t port, FindingList& findings) noexcept {
    const PortRow& row = view.ports[port];
    if (row.component >= view.component_rows.size()) {
        return;
    }
    ModeMask fed = 0U;
    for (const ConnectionRow& connection : view.connections) {
        fed |= connection.sink == row.input ? connection.modes : 0U;
    }
    for (std::size_t m = 0U; m < view.modes.modes.size() && m < kSystemModeMax; ++m) {
        if ((view.component_rows[row.component].modes & ~fed & to_mask(m)) != 0U) {
            findings.add(Rule::kInputNotFedInMode, port, m);
            return;
        }
    }
}

constexpr bool are_mode_rows_valid(const SystemView& view, FindingList& findings) noexcept {
    const std::size_t before = findings.get_count();
    for (std::size_t m = 0U; m < view.modes.modes.size(); ++m) {
        if (view.modes.modes[m].name == nullptr || m >= kSystemModeMax) {
            findings.add(Rule::kModeRowInvalid, m);
        }
    }
    return findings.get_count() == before;
}

constexpr void check_mode(const SystemView& view, std::size_t m, FindingList& findings) noexcept {
    const SystemModeRow& row = view.modes.modes[m];
    if (find_named(view.modes.modes, row.name) < m) {
        findings.add(Rule::kModeNamedTwice, m);
    }
    if (row.set_name != nullptr && row.set >= view.configuration.sets.size()) {
        findings.add(Rule::kModeOfUnknownSet, m);
    }
    if (row.is_safe && find_safe_mode(view.modes) < m) {
        findings.add(Rule::kTwoSafeModes, m);
    }
}

constexpr void check_members(const SystemView& view, FindingList& findings) noexcept {
    for (std::size_t i = 0U; i < view.modes.members.size(); ++i) {
        if (view.modes.members[i].index >= view.components.size()) {
            findings.add(Rule::kModeOfUnknownComponent, i);
        }
    }
    for (std::size_t i = 0U; i < view.components.size() && !view.modes.modes.empty(); ++i) {
        if (view.component_rows[i].modes == 0U) {
            findings.add(Rule::kComponentInNoMode, i);
        }
    }
    for (std::size_t i = 0U; i < view.modes.connection_modes.size(); ++i) {
        if (view.modes.connection_modes[i].mode >= view.modes.modes.size()) {
            findings.add(Rule::kConnectionOfUnknownMode, i);
        }
    }
}

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

/// The safe mode needs no transition: a switch that fails leads there.
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

/// For a table whose rows are valid in themselves.
constexpr void check_modes(const SystemView& view, FindingList& findings) noexcept {
    if (!are_mode_rows_valid(view, findings)) {
        return;
    }
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
