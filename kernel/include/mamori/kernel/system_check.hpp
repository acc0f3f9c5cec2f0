// SPDX-License-Identifier: Apache-2.0
/// @file
/// Rules that a system table must keep. They are constant expressions: MAMORI_CHECK (system_rules.hpp) makes
/// the compiler refuse a table that breaks one, and a tool gets all findings of a table made at run time.
///
/// @satisfies SWR-KRN-018, SWR-KRN-025      Design: docs/design/kernel.md#system-table
#ifndef MAMORI_KERNEL_SYSTEM_CHECK_HPP
#define MAMORI_KERNEL_SYSTEM_CHECK_HPP

#include <array>
#include <cstddef>
#include <cstdint>

#include "mamori/kernel/mode_check.hpp"
#include "mamori/kernel/system_finding.hpp"
#include "mamori/kernel/system_table.hpp"

namespace mamori {

namespace detail {

constexpr std::int64_t calc_gcd(std::int64_t a, std::int64_t b) noexcept {
    while (b != 0) {  // at most 92 steps: the numbers fall at least as fast as Fibonacci's
        const std::int64_t rest = a % b;
        a = b;
        b = rest;
    }
    return a;
}

/// Smallest time from an opening of `from` to an opening of `to` that is not before it. Two strictly periodic
/// openings meet at every distance that is equal to their first one modulo the greatest common divisor of
/// their periods.
constexpr Duration calc_distance(const WindowRow& from, const WindowRow& to) noexcept {
    const std::int64_t divisor = calc_gcd(from.period.ns, to.period.ns);
    const std::int64_t rest = (to.offset.ns - from.offset.ns) % divisor;
    return {rest < 0 ? rest + divisor : rest};
}

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

constexpr void check_window_times(const SystemView& view, std::size_t i, FindingList& findings) noexcept {
    const WindowRow& row = view.windows[i];
    if (view.frame.ns % row.period.ns != 0) {
        findings.add(Rule::kPeriodNotInFrame, i);
    }
    // Written without sums, which could overflow.
    if (row.offset < Duration{0} || row.length <= Duration{0} || row.offset > row.period ||
        row.length > row.period - row.offset) {
        findings.add(Rule::kWindowOutsideFrame, i);
        return;
    }
    if (row.budget <= Duration{0} || row.budget > row.length) {
        findings.add(Rule::kBudgetExceedsWindow, i);
    }
    for (std::size_t j = 0U; j < i; ++j) {
        const WindowRow& earlier = view.windows[j];
        if (earlier.core == row.core &&
            (calc_distance(earlier, row) < earlier.length || calc_distance(row, earlier) < row.length)) {
            findings.add(Rule::kWindowsOverlap, i, j);
        }
    }
}

/// Rates are given in Hz, periods in ns; equal within one part in 10^9.
constexpr bool is_rate_of(double rate_hz, Duration period) noexcept {
    const double cycles = rate_hz * static_cast<double>(period.ns) * 1.0e-9;
    return cycles > 1.0 - 1.0e-9 && cycles < 1.0 + 1.0e-9;
}

constexpr void check_window_load(const SystemView& view, std::size_t i, FindingList& findings) noexcept {
    const WindowRow& row = view.windows[i];
    Duration sum{0};
    for (std::size_t c = row.first_component; c < row.first_component + row.component_count; ++c) {
        const Duration worst_case = view.component_rows[c].worst_case;
        // A single one beyond the budget is enough, and keeps the sum from overflowing.
        sum = worst_case > row.budget - sum ? row.budget + Duration{1} : sum + worst_case;
        if (sum > row.budget) {
            findings.add(Rule::kWorstCasesExceedBudget, i);
            break;
        }
    }
    if (row.rate_hz != 0.0 && !is_rate_of(row.rate_hz, row.period)) {
        findings.add(Rule::kRateNotOccurrences, i);
    }
    for (std::size_t a = 0U; a < row.alternative_count; ++a) {
        if (row.alternative_periods[a] <= row.period || row.alternative_periods[a].ns % row.period.ns != 0) {
            findings.add(Rule::kRateNotReachable, i);
        }
    }
}

constexpr void check_components(const SystemView& view, FindingList& findings) noexcept {
    for (std::size_t i = 0U; i < view.components.size(); ++i) {
        for (std::size_t j = 0U; j < i; ++j) {
            if (view.components[i] == view.components[j]) {
                findings.add(Rule::kComponentInTwoPlaces, i, j);
                break;
            }
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

constexpr bool are_equal(const char* a, const char* b) noexcept {
    while (*a != '\0' && *a == *b) {  // ends with the shorter name
        ++a;
        ++b;
    }
    return *a == *b;
}

constexpr void check_crossing(const SystemView& view, std::size_t i, FindingList& findings) noexcept {
    const ConnectionRow& row = view.connections[i];
    const WindowRow& writer = view.windows[row.source_window];
    const WindowRow& reader = view.windows[row.sink_window];
    const bool leaves_core = writer.core != reader.core;
    if ((leaves_core || !are_equal(writer.partition, reader.partition)) && !row.operations.may_leave_core) {
        findings.add(Rule::kCrossingWithoutBuffer, i);
    }
    if (leaves_core && row.operations.is_latest && calc_distance(writer, reader) < writer.length) {
        findings.add(Rule::kCrossingNotOrdered, i);
    }
    for (std::size_t j = 0U; j < i && row.crossing != nullptr; ++j) {
        if (view.connections[j].crossing == row.crossing) {
            findings.add(Rule::kCrossingUsedTwice, i, j);
        }
    }
}

constexpr void check_connections(const SystemView& view, FindingList& findings) noexcept {
    for (std::size_t i = 0U; i < view.connections.size(); ++i) {
        const ConnectionRow& row = view.connections[i];
        if (row.source_window == kNoIndex || row.sink_window == kNoIndex) {
            findings.add(Rule::kPortOfUnknownComponent, i);
        } else {
            check_crossing(view, i, findings);
        }
    }
}

constexpr void check_reactions(const SystemView& view, FindingList& findings) noexcept {
    for (std::size_t i = 0U; i < view.faults.size(); ++i) {
        std::size_t count = 0U;
        for (const ReactionRow& reaction : view.reactions) {
            count += reaction.fault == view.faults[i].fault ? 1U : 0U;
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

}  // namespace detail

/// Finds every rule that a table breaks, in the order of `Rule` groups: windows, components, modes,
/// inputs, connections, reactions, configuration. Rows that are invalid in themselves hide the rest: nothing
/// else can be judged then. Constant expression for a constexpr table; O(rows squared).
/// @param[out] storage the first findings; may be shorter than their number.
/// @return number of findings; 0: the table keeps every rule.
constexpr std::size_t check_all(const SystemView& view, Span<Finding> storage) noexcept {
    detail::FindingList findings{storage};
    if (!detail::are_rows_valid(view, findings)) {
        return findings.get_count();
    }
    for (std::size_t i = 0U; i < view.windows.size(); ++i) {
        detail::check_window_times(view, i, findings);
        detail::check_window_load(view, i, findings);
    }
    detail::check_components(view, findings);
    detail::check_modes(view, findings);
    detail::check_inputs(view, findings);
    detail::check_connections(view, findings);
    detail::check_reactions(view, findings);
    const ConfigurationFinding configuration = check(view.configuration);
    if (configuration.rule != ConfigurationRule::kNone) {
        findings.add(Rule::kConfigurationRefused, configuration.set, configuration.assignment);
    }
    return findings.get_count();
}

/// First finding of the table, or one with Rule::kNone.
constexpr Finding check(const SystemView& view) noexcept {
    std::array<Finding, 1U> first{};
    static_cast<void>(check_all(view, first));
    return first[0];
}

}  // namespace mamori

#endif  // MAMORI_KERNEL_SYSTEM_CHECK_HPP
