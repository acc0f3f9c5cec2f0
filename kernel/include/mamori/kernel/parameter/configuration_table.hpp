// SPDX-License-Identifier: Apache-2.0
/// @file
/// Rows of a configuration, which the compiler checks and the configuration admin switches. Users write
/// `mamori::configuration(...)` (configuration_set.hpp) and never fill rows directly. Findings of a check:
/// configuration_finding.hpp.
///
/// @satisfies SWR-PAR-006, SWR-PAR-007      Design: docs/design/parameters.md#configuration-sets
#ifndef MAMORI_KERNEL_CONFIGURATION_TABLE_HPP
#define MAMORI_KERNEL_CONFIGURATION_TABLE_HPP

#include <array>
#include <cstddef>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/component/component.hpp"
#include "mamori/kernel/parameter/configuration_finding.hpp"
#include "mamori/kernel/parameter/parameter_base.hpp"
#include "mamori/kernel/parameter/scalar.hpp"

namespace mamori {

/// A parameter and the component that contains it; both must outlive the table.
struct ParameterRow {
    Component* owner{nullptr};
    ParameterBase* parameter{nullptr};
};

/// One set. Its assignments are consecutive rows of the table.
struct ConfigurationSetRow {
    const char* name{nullptr};  ///< static storage; unique in the table
    std::size_t first_assignment{0U};
    std::size_t assignment_count{0U};
};

/// Assignment of a set to one parameter: consecutive values in the table, one per element.
struct AssignmentRow {
    ParameterBase* parameter{nullptr};
    std::size_t first_value{0U};
    std::size_t value_count{0U};
    bool is_known{false};    ///< the parameter belongs to a component of the table
    bool is_refused{false};  ///< the constraint rejected the value when the table was built
};

/// Rows with their number in the type.
template <std::size_t kParameters, std::size_t kSets, std::size_t kAssignments, std::size_t kValues>
struct ConfigurationTable {
    std::array<ParameterRow, kParameters> parameters{};
    std::array<ConfigurationSetRow, kSets> sets{};
    std::array<AssignmentRow, kAssignments> assignments{};
    std::array<Scalar, kValues> values{};
};

/// The same rows without their number in the type; refers to the table, which must outlive the view.
struct ConfigurationView {
    Span<const ParameterRow> parameters{};
    Span<const ConfigurationSetRow> sets{};
    Span<const AssignmentRow> assignments{};
    Span<const Scalar> values{};

    /// @param[in] set row of this view; a range outside the table is a contract violation.
    constexpr Span<const AssignmentRow> get_assignments(const ConfigurationSetRow& set) const noexcept {
        return assignments.subspan(set.first_assignment, set.assignment_count);
    }
    /// @param[in] assignment row of this view; a range outside the table is a contract violation.
    constexpr Span<const Scalar> get_values(const AssignmentRow& assignment) const noexcept {
        return values.subspan(assignment.first_value, assignment.value_count);
    }
};

/// @param[in] table must outlive the view.
template <std::size_t kP, std::size_t kS, std::size_t kA, std::size_t kV>
constexpr ConfigurationView make_view(const ConfigurationTable<kP, kS, kA, kV>& table) noexcept {
    return {table.parameters, table.sets, table.assignments, table.values};
}

}  // namespace mamori

#endif  // MAMORI_KERNEL_CONFIGURATION_TABLE_HPP
