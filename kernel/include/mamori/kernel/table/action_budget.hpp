// SPDX-License-Identifier: Apache-2.0
/// @file
/// Budget of an action outside windows, as a machine passes it to its ActionGuard.
///
/// @satisfies SWR-KRN-092      Design: docs/design/kernel.md#actions-outside-windows
#ifndef MAMORI_KERNEL_ACTION_BUDGET_HPP
#define MAMORI_KERNEL_ACTION_BUDGET_HPP

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/time.hpp"
#include "mamori/kernel/table/system_finding.hpp"

namespace mamori {

/// Budget of a table without action_budget(). An action may open files and devices.
inline constexpr Duration kActionBudget{1'000'000'000};
/// Maximum. Far below the range of Instant, so that no deadline overflows.
inline constexpr Duration kActionBudgetMax{3'600'000'000'000};

/// @param[in] stated the budget that the table states, or none.
constexpr Duration choose_action_budget(Span<const Duration> stated) noexcept {
    return stated.empty() ? kActionBudget : stated[0U];
}

/// Rule::kActionBudgetOutOfRange, or Rule::kNone. @param[in] stated as above.
constexpr Finding check_action_budget(Span<const Duration> stated) noexcept {
    const Duration budget = choose_action_budget(stated);
    const bool is_valid = budget > Duration{0} && budget <= kActionBudgetMax;
    return is_valid ? Finding{} : Finding{Rule::kActionBudgetOutOfRange};
}

}  // namespace mamori

#endif  // MAMORI_KERNEL_ACTION_BUDGET_HPP
