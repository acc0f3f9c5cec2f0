// SPDX-License-Identifier: Apache-2.0
/// @file
/// Delay of background windows by the ordinary windows that preempt them. Not for users.
///
/// @satisfies SWR-KRN-081, SWR-KRN-082      Design: docs/design/kernel.md#background-windows
/// Source:   M. Joseph, P. Pandya, "Finding response times in a real-time system", The Computer Journal
/// 29(5),
///           1986
#ifndef MAMORI_KERNEL_RESPONSE_TIME_HPP
#define MAMORI_KERNEL_RESPONSE_TIME_HPP

#include <cstddef>
#include <cstdint>
#include <limits>

#include "mamori/kernel/base/time.hpp"
#include "mamori/kernel/table/detail/opening_distance.hpp"
#include "mamori/kernel/table/system_table.hpp"

namespace mamori::detail {

/// A delay that exceeds its limit.
inline constexpr Duration kUnbounded{std::numeric_limits<std::int64_t>::max()};
/// Steps of the iteration. A delay that needs more counts as unbounded, so that the time to compile stays
/// short.
inline constexpr std::size_t kResponseStepMax = 256U;

/// Maximum processor time of the ordinary windows of a core that start within `span`.
/// @param[in] span > 0. @return at most `limit`; else kUnbounded.
constexpr Duration calc_demand(const SystemView& view, std::size_t core, Duration span,
                               Duration limit) noexcept {
    Duration left = limit;
    for (const WindowRow& row : view.windows) {
        if (row.core != core || row.budget <= Duration{0}) {
            continue;  // another rule rejects a window without a budget
        }
        const std::int64_t count = (span.ns - 1) / row.period.ns + 1;
        // Without the product, which could overflow.
        if (row.budget.ns > left.ns / count) {
            return kUnbounded;
        }
        left = left - row.budget * count;
    }
    return limit - left;
}

/// Maximum processor time that ordinary windows of a core take from work of lower priority before it has
/// executed for `own`.
/// @param[in] own > 0; with 1 ns, the result is the delay of its start. @param[in] limit >= 0; own + limit is
///                a Duration. @return at most `limit`; else kUnbounded.
constexpr Duration calc_interference(const SystemView& view, std::size_t core, Duration own,
                                     Duration limit) noexcept {
    Duration total{0};
    for (std::size_t step = 0U; step < kResponseStepMax; ++step) {
        const Duration next = calc_demand(view, core, own + total, limit);
        if (next == total || next == kUnbounded) {
            return next;
        }
        total = next;
    }
    return kUnbounded;
}

/// The margin that the rules below add; another rule rejects a negative one.
constexpr Duration get_margin(const SystemView& view) noexcept {
    return view.publication_margin < Duration{0} ? Duration{0} : view.publication_margin;
}

/// Whether the outputs of a background window are published by its end plus the publication margin, for each
/// execution time up to its budget. The margin is also the time that the publication takes.
/// Precondition: 0 < execution budget <= length.
constexpr bool can_complete(const SystemView& view, const WindowRow& row) noexcept {
    const Duration margin = get_margin(view);
    const Duration slack = row.length - row.execution_budget;
    return margin < kUnbounded - row.length &&
           calc_interference(view, row.background_of, row.execution_budget + margin, slack) <= slack;
}

/// Whether a reader on another executive receives the latest value of its planned start. The storage keeps
/// two values: the writer overwrites this value from its second window start after the publication on.
constexpr bool is_history_sufficient(const SystemView& view, const WindowRow& writer,
                                     const WindowRow& reader) noexcept {
    if (writer.length <= Duration{0} || writer.length > writer.period) {
        return true;  // another rule rejects this window
    }
    // From the latest start of the reader to that window start of the writer.
    const std::int64_t before =
        calc_gcd(writer.period.ns, reader.period.ns) - calc_age_min(writer, reader).ns;
    const Duration rest = writer.period - writer.length;
    const Duration room = rest.ns > kUnbounded.ns - before ? kUnbounded : rest + Duration{before};
    const Duration margin = get_margin(view);
    if (margin >= room) {
        return false;
    }
    const Duration left = room - margin - Duration{1};
    return !is_background(reader) ||
           calc_interference(view, reader.background_of, margin + Duration{1}, left) <= left;
}

}  // namespace mamori::detail

#endif  // MAMORI_KERNEL_RESPONSE_TIME_HPP
