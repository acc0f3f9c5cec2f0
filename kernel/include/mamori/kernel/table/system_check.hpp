// SPDX-License-Identifier: Apache-2.0
/// @file
/// Rules of a system table as constant expressions. MAMORI_CHECK (system_rules.hpp) makes the compiler reject
/// a table that violates a rule. check_all() returns all findings for tools that build tables at run time.
///
/// @satisfies SWR-KRN-018, SWR-KRN-025      Design: docs/design/kernel.md#system-table
#ifndef MAMORI_KERNEL_SYSTEM_CHECK_HPP
#define MAMORI_KERNEL_SYSTEM_CHECK_HPP

#include <array>
#include <cstddef>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/parameter/configuration_check.hpp"
#include "mamori/kernel/parameter/configuration_finding.hpp"
#include "mamori/kernel/table/detail/component_check.hpp"
#include "mamori/kernel/table/detail/connection_check.hpp"
#include "mamori/kernel/table/detail/finding_list.hpp"
#include "mamori/kernel/table/detail/input_check.hpp"
#include "mamori/kernel/table/detail/mode_check.hpp"
#include "mamori/kernel/table/detail/range_check.hpp"
#include "mamori/kernel/table/detail/reaction_check.hpp"
#include "mamori/kernel/table/detail/row_check.hpp"
#include "mamori/kernel/table/detail/window_check.hpp"
#include "mamori/kernel/table/system_finding.hpp"
#include "mamori/kernel/table/system_table.hpp"

namespace mamori {

/// Finds all rule violations of a table, in this order: windows, components, modes, inputs, connections,
/// reactions, configuration. If a row is invalid or rows are inconsistent, only these findings are reported,
/// since nothing else can be checked. For any row content, pointers and indices are checked before use. It is
/// assumed that a span has the rows that it counts, that a pointer other than nullptr refers to a living
/// object, and that each name is terminated. Constant expression for a constexpr table; O(rows squared).
/// Names and ports of the component objects are checked at run time only; a constant initialiser skips them.
/// Executive::initialize() always checks them (initial_check.hpp).
/// @param[out] storage receives the first findings; may be shorter than their number.
/// @return number of findings; 0: the table violates no rule.
constexpr std::size_t check_all(const SystemView& view, Span<Finding> storage) noexcept {
    detail::FindingList findings{storage};
    detail::check_rows(view, findings);
    if (findings.get_count() == 0U) {
        detail::check_ranges(view, findings);
    }
    if (findings.get_count() != 0U) {
        return findings.get_count();
    }
    for (std::size_t i = 0U; i < view.windows.size(); ++i) {
        detail::check_window_name(view, i, findings);
        detail::check_window_trigger(view, i, findings);
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

/// First finding of the table, or one with Rule::kNone. As check_all(), with the same complexity.
constexpr Finding check(const SystemView& view) noexcept {
    std::array<Finding, 1U> first{};
    static_cast<void>(check_all(view, first));
    return first[0];
}

}  // namespace mamori

#endif  // MAMORI_KERNEL_SYSTEM_CHECK_HPP
