// SPDX-License-Identifier: Apache-2.0
/// @file
/// Rules of connections: both ends are in the table, a value can be fresh, and a connection that leaves a
/// core or a partition uses dedicated storage in a valid order. Not for users.
///
/// @satisfies SWR-KRN-018, SWR-KRN-025, SWR-KRN-047, SWR-KRN-048, SWR-KRN-051, SWR-KRN-061, SWR-KRN-082
/// Design:   docs/design/kernel.md#system-table
#ifndef MAMORI_KERNEL_CONNECTION_CHECK_HPP
#define MAMORI_KERNEL_CONNECTION_CHECK_HPP

#include <cstddef>

#include "mamori/kernel/base/text.hpp"
#include "mamori/kernel/base/time.hpp"
#include "mamori/kernel/table/detail/finding_list.hpp"
#include "mamori/kernel/table/detail/opening_distance.hpp"
#include "mamori/kernel/table/detail/response_time.hpp"
#include "mamori/kernel/table/system_table.hpp"
#include "mamori/kernel/table/table_index.hpp"

namespace mamori::detail {

constexpr void check_crossing(const SystemView& view, std::size_t i, FindingList& findings) noexcept {
    const ConnectionRow& row = view.connections[i];
    const WindowRow& writer = view.windows[row.source_window];
    const WindowRow& reader = view.windows[row.sink_window];
    const bool leaves_core = writer.core != reader.core;
    const bool leaves_partition = !(make_text(writer.partition) == make_text(reader.partition));
    if ((leaves_core || leaves_partition) && !row.operations.may_leave_core) {
        findings.add(Rule::kCrossingWithoutBuffer, i);
    }
    if (leaves_core && row.operations.is_latest && !is_history_sufficient(view, writer, reader)) {
        findings.add(Rule::kHistoryTooShort, i);
    }
    if (leaves_core &&
        (view.publication_margin < Duration{0} || calc_age_min(writer, reader) < view.publication_margin)) {
        findings.add(Rule::kMarginNotKept, i);
    }
    for (std::size_t j = 0U; j < i && row.crossing != nullptr; ++j) {
        if (view.connections[j].crossing == row.crossing) {
            findings.add(Rule::kCrossingUsedTwice, i, j);
        }
    }
}

/// The executive forwards a value within a window to later components only.
constexpr void check_delay(const ConnectionRow& row, std::size_t i, FindingList& findings) noexcept {
    const bool is_delayed =
        row.source_window == row.sink_window && row.source_component >= row.sink_component;
    if (is_delayed != row.is_delayed_by_a_frame) {
        findings.add(Rule::kDelayNotStated, i);
    }
}

/// A value that is forwarded within its window has the instant of the window start.
constexpr void check_age_limit(const SystemView& view, std::size_t i, FindingList& findings) noexcept {
    const ConnectionRow& row = view.connections[i];
    if (row.age_max <= Duration{0} || row.lead_max < Duration{0}) {
        findings.add(Rule::kAgeLimitNotPositive, i);
    } else if (row.source_window != row.sink_window || row.source_component >= row.sink_component) {
        const Duration age_min = calc_age_min(view.windows[row.source_window], view.windows[row.sink_window]);
        // The time bases of both ends may differ by the tolerance. Without a sum, which could overflow.
        if (age_min - row.age_max > row.lead_max) {
            findings.add(Rule::kAgeLimitCannotBeMet, i);
        }
    }
}

constexpr void check_connections(const SystemView& view, FindingList& findings) noexcept {
    for (std::size_t i = 0U; i < view.connections.size(); ++i) {
        const ConnectionRow& row = view.connections[i];
        if (row.source_window == kNoIndex || row.sink_window == kNoIndex) {
            findings.add(Rule::kPortOfUnknownComponent, i);
        } else {
            check_delay(row, i, findings);
            check_age_limit(view, i, findings);
            check_crossing(view, i, findings);
        }
    }
}

}  // namespace mamori::detail

#endif  // MAMORI_KERNEL_CONNECTION_CHECK_HPP
