// SPDX-License-Identifier: Apache-2.0
/// @file
/// The table of what a system takes for granted about its platform, with a check for each. A declared
/// assumption without a check does not compile.
///
/// @satisfies SWR-AOU-002      Design: docs/design/assumptions.md#table
#ifndef MAMORI_SAFETY_ASSUMPTIONS_ASSUMPTION_TABLE_HPP
#define MAMORI_SAFETY_ASSUMPTIONS_ASSUMPTION_TABLE_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include "mamori/kernel/base/time.hpp"
#include "mamori/kernel/system/system_extension.hpp"
#include "mamori/safety/base/self_test_status.hpp"

namespace mamori::safety {

/// Number of an assumption, 0 .. count - 1 of the application's enumeration.
using AssumptionIndex = std::uint16_t;

/// "No assumption".
inline constexpr AssumptionIndex kNoAssumption = 0xFFFFU;

/// Looks whether one assumption holds.
class AssumptionCheck {
  public:
    /// Called once per cycle, from one execution context, also after it held. Must not block.
    /// @return kRunning (not known yet); kPassed (it holds); kFailed (it does not).
    virtual SelfTestStatus check() noexcept = 0;

  protected:
    ~AssumptionCheck() = default;
};

/// Kind of part of safety::system(...).
struct AssumptionTag {};
/// One row: the assumption, its name for logs, its check, and the time in which it must be known to hold. A
/// part of safety::system(...), whose cycle checks it, or an element of an array for an AssumptionMonitor.
struct AssumptionRow {
    using Types = extension::ExtensionTypes<AssumptionTag>;
    AssumptionIndex assumption{kNoAssumption};
    const char* name{""};
    AssumptionCheck* check{nullptr};
    Duration within{0};
};

/// Writes a row as one reads it: assume(Assumption::kWatchdog, "watchdog", g_watchdog_check, 100_ms).
/// @param[in] assumption enumerator of the application's assumptions, 0 .. count - 1.
/// @param[in] name       static storage.
/// @param[in] check      of static storage duration.
/// @param[in] within     > 0.
template <typename Assumption>
constexpr AssumptionRow assume(Assumption assumption, const char* name, AssumptionCheck& check,
                               Duration within) noexcept {
    static_assert(std::is_enum_v<Assumption>, "assumptions are the enumerators of one enumeration");
    return {static_cast<AssumptionIndex>(assumption), name, &check, within};
}

/// @return number of rows of `table` for `assumption`.
template <std::size_t kRowCount>
constexpr std::size_t count_rows(const std::array<AssumptionRow, kRowCount>& table,
                                 AssumptionIndex assumption) noexcept {
    std::size_t count = 0U;
    for (const AssumptionRow& row : table) {
        count += row.assumption == assumption ? 1U : 0U;
    }
    return count;
}

/// True when every row names one of the assumptions 0 .. count - 1, has a check, and time for it.
template <std::size_t kRowCount>
constexpr bool are_rows_valid(const std::array<AssumptionRow, kRowCount>& table, std::size_t count) noexcept {
    for (const AssumptionRow& row : table) {
        if (row.assumption >= count || row.check == nullptr || row.within <= Duration{0}) {
            return false;
        }
    }
    return true;
}

/// Fails to compile for an assumption that has not exactly one row; the compiler prints the assumption.
template <auto kAssumption, std::size_t kRows>
struct AssumptionHasCheck : std::true_type {
    static_assert(kRows != 0U,
                  "declared assumption without a check; add assume(<assumption>, ...) to the table");
    static_assert(kRows <= 1U, "declared assumption with more than one check; keep one row");
};

namespace detail {

template <const auto& kTable, typename Assumption, std::size_t... kIndex>
constexpr bool has_checks(std::index_sequence<kIndex...> /*assumptions*/) noexcept {
    return (AssumptionHasCheck<static_cast<Assumption>(kIndex),
                               count_rows(kTable, static_cast<AssumptionIndex>(kIndex))>::value &&
            ...);
}

}  // namespace detail

/// Proves a table: static_assert(checks_all<kAssumptions, Assumption::kCount>());
/// @tparam kTable constexpr std::array<AssumptionRow, n> of static storage duration.
/// @tparam kCount enumerator behind the last assumption, its value is the number of assumptions.
/// @return true; every other outcome does not compile.
template <const auto& kTable, auto kCount>
constexpr bool checks_all() noexcept {
    using Assumption = decltype(kCount);
    static_assert(std::is_enum_v<Assumption>, "assumptions are the enumerators of one enumeration");
    constexpr auto kAssumptionCount = static_cast<std::size_t>(kCount);
    static_assert(kAssumptionCount >= 1U && kAssumptionCount <= kNoAssumption,
                  "number of assumptions is out of range");
    static_assert(are_rows_valid(kTable, kAssumptionCount),
                  "row with an unknown assumption, without a check, or with no time for it");
    return detail::has_checks<kTable, Assumption>(std::make_index_sequence<kAssumptionCount>{});
}

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_ASSUMPTIONS_ASSUMPTION_TABLE_HPP
