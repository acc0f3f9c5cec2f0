// SPDX-License-Identifier: Apache-2.0
/// @file
/// Rules of windows: names, triggers, position in the major frame, execution times and rates of their
/// components. Not for users.
///
/// @satisfies SWR-KRN-018, SWR-KRN-025, SWR-KRN-081, SWR-KRN-094      Design:
/// docs/design/kernel.md#system-table
#ifndef MAMORI_KERNEL_WINDOW_CHECK_HPP
#define MAMORI_KERNEL_WINDOW_CHECK_HPP

#include <cstddef>

#include "mamori/kernel/base/text.hpp"
#include "mamori/kernel/base/time.hpp"
#include "mamori/kernel/table/detail/finding_list.hpp"
#include "mamori/kernel/table/detail/opening_distance.hpp"
#include "mamori/kernel/table/detail/response_time.hpp"
#include "mamori/kernel/table/system_table.hpp"

namespace mamori::detail {

constexpr void check_window_name(const SystemView& view, std::size_t i, FindingList& findings) noexcept {
    for (std::size_t j = 0U; j < i; ++j) {
        if (make_text(view.windows[j].name) == make_text(view.windows[i].name)) {
            findings.add(Rule::kWindowNamedTwice, i, j);
            break;
        }
    }
}

constexpr void check_window_trigger(const SystemView& view, std::size_t i, FindingList& findings) noexcept {
    for (std::size_t j = 0U; j < i && view.windows[i].trigger != nullptr; ++j) {
        if (view.windows[j].trigger == view.windows[i].trigger) {
            findings.add(Rule::kTriggerUsedTwice, i, j);
            break;
        }
    }
}

constexpr void check_window_times(const SystemView& view, std::size_t i, FindingList& findings) noexcept {
    const WindowRow& row = view.windows[i];
    if (view.frame.ns % row.period.ns != 0) {
        findings.add(Rule::kPeriodNotInFrame, i);
    }
    // Without sums, which could overflow.
    if (row.offset < Duration{0} || row.length <= Duration{0} || row.offset > row.period ||
        row.length > row.period - row.offset) {
        findings.add(Rule::kWindowOutsideFrame, i);
        return;
    }
    const Duration budget = get_declared_budget(row);
    if (budget <= Duration{0} || budget > row.length) {
        findings.add(Rule::kBudgetExceedsWindow, i);
    } else if (is_background(row) && !can_complete(view, row)) {
        findings.add(Rule::kBackgroundTooSlow, i);
    }
    for (std::size_t j = 0U; j < i; ++j) {
        const WindowRow& earlier = view.windows[j];
        if (earlier.core == row.core &&
            (calc_distance(earlier, row) < earlier.length || calc_distance(row, earlier) < row.length)) {
            findings.add(Rule::kWindowsOverlap, i, j);
        }
    }
}

/// Whether a rate [Hz] and a period [ns] agree within one part in 10^9.
constexpr bool is_rate_of(double rate_hz, Duration period) noexcept {
    const double cycles = rate_hz * static_cast<double>(period.ns) * 1.0e-9;
    return cycles > 1.0 - 1.0e-9 && cycles < 1.0 + 1.0e-9;
}

constexpr void check_window_load(const SystemView& view, std::size_t i, FindingList& findings) noexcept {
    const WindowRow& row = view.windows[i];
    if (row.stack_kib > kStackKibMax) {
        findings.add(Rule::kStackOutOfRange, i);
    }
    Duration left = get_declared_budget(row);
    for (std::size_t c = row.first_component; c < row.first_component + row.component_count; ++c) {
        const Duration worst_case = view.component_rows[c].worst_case;
        // Without a sum, which could overflow.
        if (worst_case > left) {
            findings.add(Rule::kWorstCasesExceedBudget, i);
            break;
        }
        left = left - worst_case;
    }
    if (row.has_rate && !is_rate_of(row.rate_hz, row.period)) {
        findings.add(Rule::kRateNotOccurrences, i);
    }
    for (std::size_t a = 0U; a < row.alternative_count; ++a) {
        if (row.alternative_periods[a] <= row.period || row.alternative_periods[a].ns % row.period.ns != 0) {
            findings.add(Rule::kRateNotReachable, i);
        }
    }
}

}  // namespace mamori::detail

#endif  // MAMORI_KERNEL_WINDOW_CHECK_HPP
