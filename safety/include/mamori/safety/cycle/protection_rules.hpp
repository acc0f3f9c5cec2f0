// SPDX-License-Identifier: Apache-2.0
/// @file
/// Rules of a safety table for its protected connections. Not for users.
///
/// @satisfies SWR-CYC-035      Design: docs/design/safety_cycle.md#protected-connections
#ifndef MAMORI_SAFETY_PROTECTION_RULES_HPP
#define MAMORI_SAFETY_PROTECTION_RULES_HPP

#include <cstddef>
#include <cstdint>

#include "mamori/kernel/component/component.hpp"
#include "mamori/kernel/system/system_extension.hpp"
#include "mamori/safety/cycle/safety_finding.hpp"
#include "mamori/safety/cycle/safety_part.hpp"

namespace mamori::safety::detail {

/// @param[in] period of the window of the receiver, > 0.
constexpr SafetyRule check_protection(const ProtectRow& row, Duration period) noexcept {
    if (row.limit.age_max < period || row.limit.lead_max < Duration{0}) {
        return SafetyRule::kProtectedReachable;
    }
    const auto steps = static_cast<std::uint64_t>(row.limit.age_max.ns / period.ns);
    return row.max_delta > steps ? SafetyRule::kProtectedLossesInTime : SafetyRule::kNone;
}

template <typename Table>
constexpr SafetyFinding check_protections(const Table& table) noexcept {
    for (std::size_t i = 0U; i < table.protections.size(); ++i) {
        const ProtectRow& row = table.protections[i];
        const std::size_t index = find_component(table.components, row.component);
        if (index == kNoIndex) {
            return {SafetyRule::kProtectedInTable, i};
        }
        for (std::size_t earlier = 0U; earlier < i; ++earlier) {
            if (table.protections[earlier].component == row.component) {
                return {SafetyRule::kProtectedOnce, i};
            }
        }
        if (row.fault >= table.faults.size()) {
            return {SafetyRule::kProtectedFaultDeclared, i};
        }
        const SafetyRule rule =
            check_protection(row, table.windows[table.component_rows[index].window].period);
        if (rule != SafetyRule::kNone) {
            return {rule, i};
        }
    }
    return {};
}

}  // namespace mamori::safety::detail

#endif  // MAMORI_SAFETY_PROTECTION_RULES_HPP
