// SPDX-License-Identifier: Apache-2.0
/// @file
/// Rules of a configuration as constant expressions. MAMORI_CHECK_CONFIGURATION makes the compiler reject a
/// table that violates a rule. collect_findings() returns all findings for tools.
///
/// @satisfies SWR-PAR-006      Design: docs/design/parameters.md#configuration-sets
#ifndef MAMORI_KERNEL_CONFIGURATION_CHECK_HPP
#define MAMORI_KERNEL_CONFIGURATION_CHECK_HPP

#include <cstddef>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/text.hpp"
#include "mamori/kernel/parameter/configuration_finding.hpp"
#include "mamori/kernel/parameter/configuration_row_check.hpp"
#include "mamori/kernel/parameter/configuration_table.hpp"

namespace mamori {

namespace detail {

/// Calls `visitor(finding)` for each rule violation that the rows alone show, in row order. Precondition:
/// each row is valid (visit_invalid_rows()).
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

/// Instantiated by MAMORI_CHECK_CONFIGURATION. For a rejected table, the compiler message shows rule, set and
/// assignment as arguments of this template.
template <ConfigurationRule kRule, std::size_t kSet, std::size_t kAssignment>
struct ConfigurationKeeps {
    static_assert(kRule == ConfigurationRule::kNone,
                  "the configuration breaks the rule named in the template arguments: rule, set, assignment");
    static constexpr bool kValue = kRule == ConfigurationRule::kNone;
};

}  // namespace detail

/// First violated rule, or kNone. Constant expression for a constexpr table; O(rows squared).
/// Values of a component without a default constructor are checked by collect_findings() only.
constexpr ConfigurationFinding check(const ConfigurationView& view) noexcept {
    detail::FirstFinding first{};
    detail::visit_invalid_rows(view, first);
    if (first.finding.rule == ConfigurationRule::kNone) {
        detail::visit_findings(view, first);
    }
    return first.finding;
}

/// Collects all rule violations; the constraint of each parameter checks its values. If a row is invalid,
/// only the findings of invalid rows are reported, as in check(). O(rows squared); from any thread.
/// @param[out] findings receives the first findings, up to its size. @return total number of findings.
std::size_t collect_findings(const ConfigurationView& view, Span<ConfigurationFinding> findings) noexcept;

}  // namespace mamori

/// Rejects the constexpr configuration `table` at compile time if it violates a rule.
#define MAMORI_CHECK_CONFIGURATION(table)                           \
    static_assert(::mamori::detail::ConfigurationKeeps<             \
                  ::mamori::check(::mamori::make_view(table)).rule, \
                  ::mamori::check(::mamori::make_view(table)).set,  \
                  ::mamori::check(::mamori::make_view(table)).assignment>::kValue)

#endif  // MAMORI_KERNEL_CONFIGURATION_CHECK_HPP
