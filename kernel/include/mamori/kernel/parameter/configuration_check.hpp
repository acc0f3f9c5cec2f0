// SPDX-License-Identifier: Apache-2.0
/// @file
/// Rules that a configuration must keep. They are constant expressions: MAMORI_CHECK_CONFIGURATION makes the
/// compiler refuse a table that breaks one, and a tool gets all findings at once.
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

/// Calls `visitor(finding)` for each broken rule that the rows alone show, in their order. For a
/// configuration whose rows are valid in themselves.
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
    detail::visit_invalid_rows(view, first);
    if (first.finding.rule == ConfigurationRule::kNone) {
        detail::visit_findings(view, first);
    }
    return first.finding;
}

/// Every broken rule at once, each value judged by the constraint of the parameter itself. Rows that are
/// invalid in themselves hide the rest, here and in check(). O(rows squared), from any thread.
/// @param[out] findings as many as have room. @return how many there are.
std::size_t collect_findings(const ConfigurationView& view, Span<ConfigurationFinding> findings) noexcept;

}  // namespace mamori

/// Refuses the constexpr configuration `table` at compile time when it breaks a rule.
#define MAMORI_CHECK_CONFIGURATION(table)                           \
    static_assert(::mamori::detail::ConfigurationKeeps<             \
                  ::mamori::check(::mamori::make_view(table)).rule, \
                  ::mamori::check(::mamori::make_view(table)).set,  \
                  ::mamori::check(::mamori::make_view(table)).assignment>::kValue)

#endif  // MAMORI_KERNEL_CONFIGURATION_CHECK_HPP
