// SPDX-License-Identifier: Apache-2.0
/// @file
/// What each row of a system table must keep by itself, before a rule may follow its indices and pointers.
/// Not for users.
///
/// @satisfies SWR-KRN-018, SWR-KRN-025      Design: docs/design/kernel.md#system-table
#ifndef MAMORI_KERNEL_ROW_CHECK_HPP
#define MAMORI_KERNEL_ROW_CHECK_HPP

#include <cstddef>

#include "mamori/kernel/finding_list.hpp"
#include "mamori/kernel/system_table.hpp"
#include "mamori/kernel/table_index.hpp"
#include "mamori/kernel/time.hpp"

namespace mamori::detail {

constexpr bool is_range_in(std::size_t first, std::size_t count, std::size_t size) noexcept {
    return count <= size && first <= size - count;
}

constexpr bool is_window_valid(const SystemView& view, const WindowRow& row) noexcept {
    return row.name != nullptr && row.partition != nullptr && row.period > Duration{0} &&
           is_range_in(row.first_component, row.component_count, view.components.size()) &&
           is_range_in(row.first_port, row.port_count, view.ports.size()) &&
           is_range_in(row.first_latch, row.latch_count, view.latch_order.size()) &&
           is_range_in(row.first_parameter, row.parameter_count, view.configuration.parameters.size()) &&
           row.alternative_count <= kAlternativeRateMax;
}

constexpr bool is_component_valid(const SystemView& view, std::size_t i) noexcept {
    return i < view.component_rows.size() && view.components[i] != nullptr &&
           view.component_rows[i].window < view.windows.size() &&
           is_range_in(view.component_rows[i].first_port, view.component_rows[i].port_count,
                       view.ports.size()) &&
           is_range_in(view.component_rows[i].first_outgoing, view.component_rows[i].outgoing_count,
                       view.outgoing_order.size());
}

constexpr bool is_connection_valid(const SystemView& view, const ConnectionRow& row) noexcept {
    return row.source != nullptr && row.sink != nullptr && row.operations.is_set &&
           (row.source_window == kNoIndex || row.source_window < view.windows.size()) &&
           (row.sink_window == kNoIndex || row.sink_window < view.windows.size());
}

/// What a later rule relies on when it follows an index or a pointer.
constexpr bool are_rows_valid(const SystemView& view, FindingList& findings) noexcept {
    const std::size_t before = findings.get_count();
    if (view.frame <= Duration{0}) {
        findings.add(Rule::kFrameNotPositive, 0U);
    }
    for (std::size_t i = 0U; i < view.windows.size(); ++i) {
        if (!is_window_valid(view, view.windows[i])) {
            findings.add(Rule::kWindowRowInvalid, i);
        }
    }
    for (std::size_t i = 0U; i < view.components.size(); ++i) {
        if (!is_component_valid(view, i)) {
            findings.add(Rule::kComponentRowInvalid, i);
        }
    }
    for (std::size_t i = 0U; i < view.ports.size(); ++i) {
        if ((view.ports[i].input == nullptr) == (view.ports[i].output == nullptr)) {
            findings.add(Rule::kPortRowInvalid, i);
        }
    }
    for (std::size_t i = 0U; i < view.connections.size(); ++i) {
        if (!is_connection_valid(view, view.connections[i])) {
            findings.add(Rule::kConnectionRowInvalid, i);
        }
    }
    return findings.get_count() == before;
}

}  // namespace mamori::detail

#endif  // MAMORI_KERNEL_ROW_CHECK_HPP
