// SPDX-License-Identifier: Apache-2.0
/// @file
/// Rules of a configuration as constant expressions. MAMORI_CHECK_CONFIGURATION makes the compiler reject a
/// table that violates a rule. collect_findings() returns all findings for tools.
///
/// @satisfies SWR-PAR-006, SWR-PAR-022      Design: docs/design/parameters.md#configuration-sets
#ifndef MAMORI_KERNEL_CONFIGURATION_CHECK_HPP
#define MAMORI_KERNEL_CONFIGURATION_CHECK_HPP

#include <cstddef>
#include <type_traits>
#include <utility>

#include "mamori/kernel/base/compiler_message.hpp"
#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/text.hpp"
#include "mamori/kernel/base/type_list.hpp"
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

namespace rules {

/// A parameter. @tparam kInstance distinguishes components of one type; 0 is the first.
template <typename C, auto kMember, std::size_t kInstance>
struct ParameterOf {};
/// Assignment `kIndex` of a set, whose parameter belongs to no component of the table.
template <std::size_t kIndex>
struct Assignment {};

}  // namespace rules

namespace detail {

/// Instantiated for a rejected configuration, with its rule, set, and parameter or row of the set.
template <ConfigurationRule kRule, typename Set, typename Faulty>
struct ConfigurationKeeps {
    static_assert(
        rules::kKept<ConfigurationKeeps>,
        "a configuration set has a name of its own and gives each of its parameters one admitted value");
};

/// Row of the parameter that an assignment names; the number of rows: none, or the set has no such
/// assignment.
constexpr std::size_t find_assigned(const ConfigurationView& view, std::size_t set,
                                    std::size_t assignment) noexcept {
    const std::size_t row = view.sets[set].first_assignment + assignment;
    if (row >= view.assignments.size()) {
        return view.parameters.size();
    }
    for (std::size_t p = 0U; p < view.parameters.size(); ++p) {
        if (view.parameters[p].parameter == view.assignments[row].parameter) {
            return p;
        }
    }
    return view.parameters.size();
}

template <ConfigurationRule kRule, typename Parameters, std::size_t kSet, std::size_t kAssignment,
          std::size_t kParameter>
constexpr auto show_faulty() noexcept {
    if constexpr (kRule == ConfigurationRule::kSetNamedTwice || kRule == ConfigurationRule::kSetRowInvalid) {
        return rules::Row<kSet>{};
    } else if constexpr (kParameter < Parameters::kSize) {
        using Member = At<Parameters, kParameter>;
        return rules::ParameterOf<typename Member::Owner, Member::kPointer,
                                  count_same_before<Parameters, kParameter>(
                                      std::make_index_sequence<kParameter>{})>{};
    } else {
        return rules::Assignment<kAssignment>{};
    }
}
template <ConfigurationRule kRule, typename Set, typename Parameters, std::size_t kSet,
          std::size_t kAssignment, std::size_t kParameter>
using ConfigurationMessage =
    ConfigurationKeeps<kRule, Set, decltype(show_faulty<kRule, Parameters, kSet, kAssignment, kParameter>())>;

struct OfOwnSet {
    template <typename Table>
    static constexpr const char* get(const Table& table, std::size_t i) noexcept {
        return table.sets[i].name;
    }
};

/// Evaluating the size of the message of a violated rule stops the compilation.
template <const auto& kTable>
constexpr bool keeps_configuration_rules() noexcept {
    constexpr ConfigurationFinding kFinding = check(make_view(kTable));
    if constexpr (kFinding.rule != ConfigurationRule::kNone) {
        using Parameters = typename std::remove_reference_t<decltype(kTable)>::Members;
        return sizeof(ConfigurationMessage<kFinding.rule, NameOf<kTable, OfOwnSet, kFinding.set>, Parameters,
                                           kFinding.set, kFinding.assignment,
                                           find_assigned(make_view(kTable), kFinding.set,
                                                         kFinding.assignment)>) == 0U;
    }
    return true;
}

}  // namespace detail

}  // namespace mamori

/// Rejects the constexpr configuration `table`, made by mamori::configuration() with static storage, at
/// compile time if it violates a rule.
#define MAMORI_CHECK_CONFIGURATION(table)                               \
    static_assert(::mamori::detail::keeps_configuration_rules<table>(), \
                  "the configuration violates the rule named above")

#endif  // MAMORI_KERNEL_CONFIGURATION_CHECK_HPP
