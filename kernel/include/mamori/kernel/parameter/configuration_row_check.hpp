// SPDX-License-Identifier: Apache-2.0
/// @file
/// Checks each row of a configuration on its own, before a rule uses its ranges and pointers. Not for users.
///
/// @satisfies SWR-KRN-025, SWR-PAR-006      Design: docs/design/parameters.md#configuration-sets
#ifndef MAMORI_KERNEL_CONFIGURATION_ROW_CHECK_HPP
#define MAMORI_KERNEL_CONFIGURATION_ROW_CHECK_HPP

#include <cstddef>

#include "mamori/kernel/base/text.hpp"
#include "mamori/kernel/parameter/configuration_finding.hpp"
#include "mamori/kernel/parameter/configuration_table.hpp"

namespace mamori::detail {

/// Whether the range first .. first + count - 1 is within `size` rows.
constexpr bool is_range_in(std::size_t first, std::size_t count, std::size_t size) noexcept {
    return count <= size && first <= size - count;
}

/// Whether there is one value per element. In a constant expression this is assumed, because the parameter
/// object cannot be read there; is_refused then reports the check against its declaration.
constexpr bool has_value_of_each_element(const AssignmentRow& row) noexcept {
    return __builtin_is_constant_evaluated() || row.parameter->get_element_count() == row.value_count;
}

/// Calls `visitor(finding)` for each row whose pointers or ranges are invalid.
template <typename Visitor>
constexpr void visit_invalid_rows(const ConfigurationView& view, Visitor& visitor) noexcept {
    for (std::size_t p = 0U; p < view.parameters.size(); ++p) {
        if (view.parameters[p].owner == nullptr || view.parameters[p].parameter == nullptr) {
            visitor(ConfigurationFinding{ConfigurationRule::kParameterRowInvalid, p, 0U});
        }
    }
    for (std::size_t s = 0U; s < view.sets.size(); ++s) {
        const ConfigurationSetRow& set = view.sets[s];
        if (!is_name(set.name) ||
            !is_range_in(set.first_assignment, set.assignment_count, view.assignments.size())) {
            visitor(ConfigurationFinding{ConfigurationRule::kSetRowInvalid, s, 0U});
            continue;
        }
        for (std::size_t a = 0U; a < set.assignment_count; ++a) {
            const AssignmentRow& row = view.assignments[set.first_assignment + a];
            if (row.parameter == nullptr ||
                !is_range_in(row.first_value, row.value_count, view.values.size()) ||
                !has_value_of_each_element(row)) {
                visitor(ConfigurationFinding{ConfigurationRule::kSetRowInvalid, s, a});
            }
        }
    }
}

}  // namespace mamori::detail

#endif  // MAMORI_KERNEL_CONFIGURATION_ROW_CHECK_HPP
