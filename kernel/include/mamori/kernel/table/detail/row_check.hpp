// SPDX-License-Identifier: Apache-2.0
/// @file
/// Checks each row of a system table on its own, before a rule uses its indices and pointers. Consistency
/// between rows: range_check.hpp. Not for users.
///
/// @satisfies SWR-KRN-018, SWR-KRN-025, SWR-KRN-080      Design: docs/design/kernel.md#system-table
#ifndef MAMORI_KERNEL_ROW_CHECK_HPP
#define MAMORI_KERNEL_ROW_CHECK_HPP

#include <cstddef>

#include "mamori/kernel/base/text.hpp"
#include "mamori/kernel/base/time.hpp"
#include "mamori/kernel/parameter/configuration_row_check.hpp"
#include "mamori/kernel/table/detail/finding_list.hpp"
#include "mamori/kernel/table/system_table.hpp"
#include "mamori/kernel/table/table_index.hpp"

namespace mamori::detail {

/// Whether a function is set. A constant expression assumes it, since g++ with -fsanitize=undefined cannot
/// evaluate the comparison there; the values of a constant cannot be corrupted.
template <typename Function>
constexpr bool is_function(Function* function) noexcept {
    return __builtin_is_constant_evaluated() || function != nullptr;
}

/// Whether the range is within `order` and each of its elements is the index of one of `row_count` rows.
constexpr bool is_order_in(Span<const std::size_t> order, std::size_t first, std::size_t count,
                           std::size_t row_count) noexcept {
    if (!is_range_in(first, count, order.size())) {
        return false;
    }
    for (std::size_t place = first; place < first + count; ++place) {
        if (order[place] >= row_count) {
            return false;
        }
    }
    return true;
}

/// Whether the plan that is built from the row satisfies the preconditions of ExecutionContext::attach().
constexpr bool is_plan_valid(const WindowRow& row) noexcept {
    return row.kind <= ExecutionKind::kOther &&
           (row.kind == ExecutionKind::kOther) == (row.trigger != nullptr) && row.events_per_cycle != 0U &&
           row.alternative_count <= kAlternativeRateMax &&
           (row.kind == ExecutionKind::kPeriodic || row.alternative_count == 0U);
}

/// Whether a background window has a core, a deadline at its end, and an executive that runs exactly the
/// background windows of this core.
constexpr bool is_class_valid(const SystemView& view, const WindowRow& row) noexcept {
    if (!is_background(row)) {
        return row.execution_budget == Duration{0};
    }
    for (const WindowRow& other : view.windows) {
        const bool is_same_executive = other.core == row.core;
        if (is_same_executive != (other.background_of == row.background_of) ||
            (other.core == row.background_of && is_background(other))) {
            return false;
        }
    }
    return row.budget == row.length;
}

constexpr bool is_window_valid(const SystemView& view, const WindowRow& row) noexcept {
    return is_name(row.name) && row.partition != nullptr && row.period > Duration{0} &&
           row.component_count != 0U &&
           is_range_in(row.first_component, row.component_count, view.components.size()) &&
           is_range_in(row.first_port, row.port_count, view.ports.size()) &&
           is_order_in(view.latch_order, row.first_latch, row.latch_count, view.connections.size()) &&
           is_range_in(row.first_parameter, row.parameter_count, view.configuration.parameters.size()) &&
           is_plan_valid(row) && is_class_valid(view, row);
}

constexpr bool is_component_valid(const SystemView& view, std::size_t i) noexcept {
    if (i >= view.component_rows.size() || view.components[i] == nullptr) {
        return false;
    }
    const ComponentRow& row = view.component_rows[i];
    return row.window < view.windows.size() && row.worst_case >= Duration{0} &&
           is_range_in(row.first_port, row.port_count, view.ports.size()) &&
           is_order_in(view.outgoing_order, row.first_outgoing, row.outgoing_count, view.connections.size());
}

constexpr bool is_port_valid(const SystemView& view, const PortRow& row) noexcept {
    return (row.input == nullptr) != (row.output == nullptr) && row.owner != nullptr &&
           row.window < view.windows.size() && row.component < view.components.size() &&
           is_function(row.count);
}

/// Whether an end of a connection is in the table, or marked as not in the table.
constexpr bool is_end_valid(const SystemView& view, std::size_t window, std::size_t component) noexcept {
    return window == kNoIndex ? component == kNoIndex
                              : window < view.windows.size() && component < view.components.size();
}

constexpr bool is_connection_valid(const SystemView& view, const ConnectionRow& row) noexcept {
    // A latest-value connection that may leave a core needs storage; a queue is its own storage.
    const bool needs_crossing = row.operations.may_leave_core && row.operations.is_latest;
    return row.source != nullptr && row.sink != nullptr && row.operations.is_set &&
           is_function(row.operations.latch) && is_function(row.operations.restart) &&
           (!needs_crossing || row.crossing != nullptr) &&
           is_end_valid(view, row.source_window, row.source_component) &&
           is_end_valid(view, row.sink_window, row.sink_component);
}

constexpr void check_parameter_rows(const SystemView& view, FindingList& findings) noexcept {
    const auto add = [&findings](const ConfigurationFinding& found) noexcept {
        findings.add(found.rule == ConfigurationRule::kSetRowInvalid ? Rule::kSetRowInvalid
                                                                     : Rule::kParameterRowInvalid,
                     found.set, found.assignment);
    };
    visit_invalid_rows(view.configuration, add);
}

constexpr void check_rows(const SystemView& view, FindingList& findings) noexcept {
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
        if (!is_port_valid(view, view.ports[i])) {
            findings.add(Rule::kPortRowInvalid, i);
        }
    }
    for (std::size_t i = 0U; i < view.connections.size(); ++i) {
        if (!is_connection_valid(view, view.connections[i])) {
            findings.add(Rule::kConnectionRowInvalid, i);
        }
    }
    for (std::size_t m = 0U; m < view.modes.modes.size(); ++m) {
        if (!is_name(view.modes.modes[m].name) || m >= kSystemModeMax) {
            findings.add(Rule::kModeRowInvalid, m);
        }
    }
    check_parameter_rows(view, findings);
}

}  // namespace mamori::detail

#endif  // MAMORI_KERNEL_ROW_CHECK_HPP
