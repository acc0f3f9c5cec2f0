// SPDX-License-Identifier: Apache-2.0
/// @file
/// Checks a constant list of limits of components: static_assert(is_watch_list_of<kSystem, kLimits>()).
///
/// @satisfies SWR-SUP-041      Design: docs/design/supervision.md#local-and-global-status
#ifndef MAMORI_SAFETY_SUPERVISION_WATCH_CHECK_HPP
#define MAMORI_SAFETY_SUPERVISION_WATCH_CHECK_HPP

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/table/index_of.hpp"
#include "mamori/safety/supervision/execution_supervisor.hpp"

namespace mamori::safety {

/// What is wrong with a row.
enum class WatchFault : std::uint8_t {
    kNone,
    kComponentNotInTable,
    kComponentTwice,
    kAliveLimits,
    kDeadlineLimits,
};

/// The first fault of a list; kNone when it has none.
struct WatchFinding {
    WatchFault fault{WatchFault::kNone};
    std::size_t row{0U};
};

/// First fault of `rows` for the components of a table. O(rows * components).
constexpr WatchFinding find_watch_fault(Span<const WatchRow> rows,
                                        Span<Component* const> components) noexcept {
    for (std::size_t i = 0U; i < rows.size(); ++i) {
        const WatchRow& row = rows[i];
        if (find_component(components, row.component) == kNoIndex) {
            return {WatchFault::kComponentNotInTable, i};
        }
        for (std::size_t earlier = 0U; earlier < i; ++earlier) {
            if (rows[earlier].component == row.component) {
                return {WatchFault::kComponentTwice, i};
            }
        }
        if (!is_valid(row.limits.alive)) {
            return {WatchFault::kAliveLimits, i};
        }
        if (!is_valid(row.limits.deadline)) {
            return {WatchFault::kDeadlineLimits, i};
        }
    }
    return {};
}

/// Does not compile for a fault; the compiler prints it with the number of the row, 0 is the first.
template <WatchFault kFault, std::size_t kRow>
struct WatchListIsSound : std::true_type {
    static_assert(kFault != WatchFault::kComponentNotInTable,
                  "limits of a component that no window of the table runs; remove the row");
    static_assert(kFault != WatchFault::kComponentTwice, "component with two rows of limits; keep one");
    static_assert(kFault != WatchFault::kAliveLimits,
                  "alive limits out of range; 1 <= late_cycles <= expired_cycles");
    static_assert(kFault != WatchFault::kDeadlineLimits,
                  "deadline limits out of range; 0 <= shortest <= longest and longest > 0");
};

/// @tparam kTable system table. @tparam kRows std::array of WatchRow. Both constexpr, of static storage.
/// @return true; every other outcome does not compile.
template <const auto& kTable, const auto& kRows>
constexpr bool is_watch_list_of() noexcept {
    constexpr WatchFinding kFinding = find_watch_fault(kRows, kTable.components);
    return WatchListIsSound<kFinding.fault, kFinding.row>::value;
}

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_SUPERVISION_WATCH_CHECK_HPP
