// SPDX-License-Identifier: Apache-2.0
/// @file
/// Rules of inputs: each has one writer, and in each mode a mandatory input of a running component has a
/// source. Not for users.
///
/// @satisfies SWR-KRN-018, SWR-KRN-025, SWR-MOD-003      Design: docs/design/kernel.md#system-table
#ifndef MAMORI_KERNEL_INPUT_CHECK_HPP
#define MAMORI_KERNEL_INPUT_CHECK_HPP

#include <cstddef>

#include "mamori/kernel/table/detail/finding_list.hpp"
#include "mamori/kernel/table/mode_table.hpp"
#include "mamori/kernel/table/system_table.hpp"

namespace mamori::detail {

constexpr bool is_connected(const SystemView& view, const PortRow& input) noexcept {
    bool is_found = false;
    for (const ConnectionRow& connection : view.connections) {
        is_found = is_found || connection.sink == input.input;
    }
    return is_found;
}

/// Whether two connections conflict at an input. They may share it if no mode has both. A queue always has
/// only one writer, since writers on two cores could access it at the same time.
constexpr bool has_two_writers(const SystemView& view, const PortRow& input) noexcept {
    for (std::size_t i = 0U; i < view.connections.size(); ++i) {
        const ConnectionRow& later = view.connections[i];
        for (std::size_t j = 0U; j < i && later.sink == input.input; ++j) {
            const ConnectionRow& earlier = view.connections[j];
            const bool may_alternate =
                (earlier.get_modes() & later.get_modes()) == 0U && later.operations.is_latest;
            if (earlier.sink == input.input && !may_alternate) {
                return true;
            }
        }
    }
    return false;
}

/// Reports the first mode in which a connected mandatory input has no source.
constexpr void check_feeding(const SystemView& view, std::size_t port, FindingList& findings) noexcept {
    const PortRow& row = view.ports[port];
    ModeMask fed = 0U;
    for (const ConnectionRow& connection : view.connections) {
        fed |= connection.sink == row.input ? connection.get_modes() : 0U;
    }
    for (std::size_t m = 0U; m < view.modes.modes.size(); ++m) {
        if ((view.component_rows[row.component].modes & ~fed & to_mask(m)) != 0U) {
            findings.add(Rule::kInputNotFedInMode, port, m);
            return;
        }
    }
}

constexpr void check_inputs(const SystemView& view, FindingList& findings) noexcept {
    for (std::size_t i = 0U; i < view.ports.size(); ++i) {
        const PortRow& row = view.ports[i];
        if (row.input == nullptr) {
            continue;
        }
        if (has_two_writers(view, row)) {
            findings.add(Rule::kInputHasTwoWriters, i);
        }
        if (row.is_mandatory && !is_connected(view, row)) {
            findings.add(Rule::kInputNotConnected, i);
        } else if (row.is_mandatory) {
            check_feeding(view, i, findings);
        }
    }
}

}  // namespace mamori::detail

#endif  // MAMORI_KERNEL_INPUT_CHECK_HPP
