// SPDX-License-Identifier: Apache-2.0
/// @file
/// Rows of a configuration: what the compiler checks and the configuration admin switches. Users write
/// `mamori::configuration(...)` (configuration_set.hpp) and never fill rows by hand.
///
/// @satisfies SWR-PAR-006, SWR-PAR-007      Design: docs/design/parameters.md#configuration-sets
#ifndef MAMORI_KERNEL_CONFIGURATION_TABLE_HPP
#define MAMORI_KERNEL_CONFIGURATION_TABLE_HPP

#include <array>
#include <cstddef>
#include <cstdint>

#include "mamori/kernel/component.hpp"
#include "mamori/kernel/parameter_base.hpp"
#include "mamori/kernel/span.hpp"
#include "mamori/kernel/text_cursor.hpp"

namespace mamori {

struct ParameterRow {
    Component* owner{nullptr};
    ParameterBase* parameter{nullptr};
};

struct ConfigurationSetRow {
    const char* name{nullptr};
    std::size_t first_assignment{0U};
    std::size_t assignment_count{0U};
};

struct AssignmentRow {
    ParameterBase* parameter{nullptr};
    std::size_t first_value{0U};
    std::size_t value_count{0U};
    bool is_known{false};    ///< the parameter belongs to a component of the table
    bool is_refused{false};  ///< the constraint refused the value while the table was made
};

template <std::size_t kParameters, std::size_t kSets, std::size_t kAssignments, std::size_t kValues>
struct ConfigurationTable {
    std::array<ParameterRow, kParameters> parameters{};
    std::array<ConfigurationSetRow, kSets> sets{};
    std::array<AssignmentRow, kAssignments> assignments{};
    std::array<Scalar, kValues> values{};
};

/// The same rows without their sizes in the type; refers to the table, which must outlive it.
struct ConfigurationView {
    Span<const ParameterRow> parameters{};
    Span<const ConfigurationSetRow> sets{};
    Span<const AssignmentRow> assignments{};
    Span<const Scalar> values{};

    constexpr Span<const AssignmentRow> get_assignments(const ConfigurationSetRow& set) const noexcept {
        return assignments.subspan(set.first_assignment, set.assignment_count);
    }
    constexpr Span<const Scalar> get_values(const AssignmentRow& assignment) const noexcept {
        return values.subspan(assignment.first_value, assignment.value_count);
    }
};

template <std::size_t kP, std::size_t kS, std::size_t kA, std::size_t kV>
constexpr ConfigurationView make_view(const ConfigurationTable<kP, kS, kA, kV>& table) noexcept {
    return {table.parameters, table.sets, table.assignments, table.values};
}

/// Why a configuration is refused.
enum class ConfigurationRule : std::uint8_t {
    kNone,                    ///< the configuration keeps every rule
    kSetNamedTwice,           ///< the set has the name of one before it
    kUnknownParameter,        ///< the parameter belongs to no component of the table
    kParameterAssignedTwice,  ///< the set gives it a value twice
    kValueOutsideConstraint,  ///< the parameter may not have this value
};

/// A broken rule and where: `assignment` counts within the set.
struct ConfigurationFinding {
    ConfigurationRule rule{ConfigurationRule::kNone};
    std::size_t set{0U};
    std::size_t assignment{0U};
};

namespace detail {

/// Calls `visitor(finding)` for each broken rule that the rows alone show, in their order.
template <typename Visitor>
constexpr void visit_findings(const ConfigurationView& view, Visitor& visitor) noexcept {
    for (std::size_t s = 0U; s < view.sets.size(); ++s) {
        for (std::size_t before = 0U; before < s; ++before) {
            if (make_text(view.sets[before].name) == make_text(view.sets[s].name)) {
                visitor(ConfigurationFinding{ConfigurationRule::kSetNamedTwice, s, 0U});
            }
        }
        const Span<const AssignmentRow> rows = view.get_assignments(view.sets[s]);
        for (std::size_t a = 0U; a < rows.size(); ++a) {
            for (std::size_t before = 0U; before < a; ++before) {
                if (rows[before].parameter == rows[a].parameter) {
                    visitor(ConfigurationFinding{ConfigurationRule::kParameterAssignedTwice, s, a});
                }
            }
            if (!rows[a].is_known) {
                visitor(ConfigurationFinding{ConfigurationRule::kUnknownParameter, s, a});
            }
            if (rows[a].is_refused) {
                visitor(ConfigurationFinding{ConfigurationRule::kValueOutsideConstraint, s, a});
            }
        }
    }
}

struct FirstFinding {
    ConfigurationFinding finding{};

    constexpr void operator()(const ConfigurationFinding& found) noexcept {
        if (finding.rule == ConfigurationRule::kNone) {
            finding = found;
        }
    }
};

/// Instantiated by MAMORI_CHECK_CONFIGURATION; a refused table shows its rule, set and assignment as the
/// arguments of this template.
template <ConfigurationRule kRule, std::size_t kSet, std::size_t kAssignment>
struct ConfigurationKeeps {
    static_assert(kRule == ConfigurationRule::kNone,
                  "the configuration breaks the rule named in the template arguments: rule, set, assignment");
    static constexpr bool kValue = kRule == ConfigurationRule::kNone;
};

}  // namespace detail

/// First broken rule, or kNone. Constant expression for a constexpr table; O(rows squared).
/// A value of a component without a default constructor is not judged here, but by collect_findings().
constexpr ConfigurationFinding check(const ConfigurationView& view) noexcept {
    detail::FirstFinding first{};
    detail::visit_findings(view, first);
    return first.finding;
}

/// Every broken rule at once, each value judged by the constraint of the parameter itself.
/// @param[out] findings as many as have room. @return how many there are.
std::size_t collect_findings(const ConfigurationView& view, Span<ConfigurationFinding> findings) noexcept;

}  // namespace mamori

/// Refuses the constexpr configuration `table` at compile time when it breaks a rule.
#define MAMORI_CHECK_CONFIGURATION(table)                           \
    static_assert(::mamori::detail::ConfigurationKeeps<             \
                  ::mamori::check(::mamori::make_view(table)).rule, \
                  ::mamori::check(::mamori::make_view(table)).set,  \
                  ::mamori::check(::mamori::make_view(table)).assignment>::kValue)

#endif  // MAMORI_KERNEL_CONFIGURATION_TABLE_HPP
