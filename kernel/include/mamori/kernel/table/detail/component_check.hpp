// SPDX-License-Identifier: Apache-2.0
/// @file
/// Rules of components: each runs in one window, once, and has its own name, ports and parameters. Not for
/// users.
///
/// @satisfies SWR-KRN-018, SWR-KRN-025, SWR-KRN-045, SWR-KRN-046, SWR-PAR-020, SWR-PAR-021
/// Design:   docs/design/kernel.md#system-table
#ifndef MAMORI_KERNEL_COMPONENT_CHECK_HPP
#define MAMORI_KERNEL_COMPONENT_CHECK_HPP

#include <cstddef>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/text.hpp"
#include "mamori/kernel/component/member.hpp"
#include "mamori/kernel/table/detail/finding_list.hpp"
#include "mamori/kernel/table/system_table.hpp"
#include "mamori/kernel/table/table_index.hpp"

namespace mamori::detail {

/// Rules of one kind of members.
struct MemberRules {
    MemberKind kind;
    Rule not_listed;
    Rule not_owned;
    Rule named_twice;
};
inline constexpr MemberRules kPortRules{MemberKind::kPort, Rule::kPortNotListed, Rule::kPortNotOwned,
                                        Rule::kPortNamedTwice};
inline constexpr MemberRules kParameterRules{MemberKind::kParameter, Rule::kParameterNotListed,
                                             Rule::kParameterNotOwned, Rule::kParameterNamedTwice};

constexpr bool is_registered(const Component& component, MemberKind kind, const Member* member) noexcept {
    bool is_found = false;
    for (const Member* one = component.get_first(kind); one != nullptr; one = one->get_next()) {
        is_found = is_found || one == member;
    }
    return is_found;
}

/// Earlier listed member with the name of member `p`; p itself if it has no name; kNoIndex: none.
template <typename GetListed>
constexpr std::size_t find_namesake(const GetListed& get_listed, std::size_t p) noexcept {
    const char* name = get_listed(p)->get_name();
    if (!is_name(name)) {
        return p;
    }
    for (std::size_t q = 0U; q < p; ++q) {
        const Member* earlier = get_listed(q);
        if (earlier != nullptr && is_same_name(earlier->get_name(), name)) {
            return q;
        }
    }
    return kNoIndex;
}

/// Checks the members of a component against its listed ones: `get_listed(p)` with p < `count`, which returns
/// nullptr for a member of another component.
/// @param[in] report receives the rule and its elements: for `not_listed` the number of members that were
///                   constructed after the faulty one, for the others positions in the list.
template <typename GetListed, typename Report>
constexpr void check_registration(const Component& component, const MemberRules& rules, std::size_t count,
                                  const GetListed& get_listed, const Report& report) noexcept {
    std::size_t later = 0U;
    for (const Member* one = component.get_first(rules.kind); one != nullptr; one = one->get_next()) {
        bool is_listed = false;
        for (std::size_t p = 0U; p < count; ++p) {
            is_listed = is_listed || get_listed(p) == one;
        }
        if (!is_listed) {
            report(rules.not_listed, later, std::size_t{0U});
        }
        ++later;
    }
    for (std::size_t p = 0U; p < count; ++p) {
        const Member* member = get_listed(p);
        if (member == nullptr) {
            continue;
        }
        if (!is_registered(component, rules.kind, member)) {
            report(rules.not_owned, p, p);
        }
        const std::size_t namesake = find_namesake(get_listed, p);
        if (namesake != kNoIndex) {
            report(rules.named_twice, p, namesake);
        }
    }
}

constexpr const Member* get_member(const PortRow& row) noexcept {
    return row.input != nullptr ? static_cast<const Member*>(row.input) : row.output;
}
constexpr const Member* get_member(const ParameterRow& row) noexcept {
    return row.parameter;
}

/// Checks the members of component `i` against those of the rows from `first` on that name it as owner.
template <typename Row>
constexpr void check_member_rows(const SystemView& view, std::size_t i, const MemberRules& rules,
                                 Span<const Row> rows, std::size_t first, FindingList& findings) noexcept {
    const auto get_listed = [&](std::size_t p) noexcept -> const Member* {
        return rows[p].owner == view.components[i] ? get_member(rows[p]) : nullptr;
    };
    const auto report = [&](Rule rule, std::size_t element, std::size_t other) noexcept {
        const bool is_row = rule != rules.not_listed;
        findings.add(rule, is_row ? first + element : i, is_row ? first + other : element);
    };
    check_registration(*view.components[i], rules, rows.size(), get_listed, report);
}

/// Checks that component `i` has a name and that no earlier one has it.
inline void check_component_name(const SystemView& view, std::size_t i, FindingList& findings) noexcept {
    const char* name = view.components[i]->get_name();
    if (!is_name(name)) {
        findings.add(Rule::kComponentNamedTwice, i, i);
    }
    for (std::size_t j = 0U; j < i; ++j) {
        if (is_same_name(view.components[j]->get_name(), name)) {
            findings.add(Rule::kComponentNamedTwice, i, j);
            break;
        }
    }
}

/// Checks that the list of ports of component `i` contains exactly its registered ones.
inline void check_ports_of(const SystemView& view, std::size_t i, FindingList& findings) noexcept {
    const ComponentRow& row = view.component_rows[i];
    check_member_rows(view, i, kPortRules, view.ports.subspan(row.first_port, row.port_count), row.first_port,
                      findings);
}

/// The same for its parameters.
inline void check_parameters_of(const SystemView& view, std::size_t i, FindingList& findings) noexcept {
    const WindowRow& window = view.windows[view.component_rows[i].window];
    check_member_rows(view, i, kParameterRules,
                      view.configuration.parameters.subspan(window.first_parameter, window.parameter_count),
                      window.first_parameter, findings);
}

constexpr void check_components(const SystemView& view, FindingList& findings) noexcept {
    bool is_any_twice = false;
    for (std::size_t i = 0U; i < view.components.size(); ++i) {
        for (std::size_t j = 0U; j < i; ++j) {
            if (view.components[i] == view.components[j]) {
                findings.add(Rule::kComponentInTwoPlaces, i, j);
                is_any_twice = true;
                break;
            }
        }
    }
    // A constant expression cannot read the objects. keeps_rules() then checks a constant of their type. The
    // rows of a component that runs twice would also look like members that are listed twice.
    for (std::size_t i = 0U; !is_any_twice && i < view.components.size(); ++i) {
        if (!__builtin_is_constant_evaluated()) {
            check_component_name(view, i, findings);
            check_ports_of(view, i, findings);
            check_parameters_of(view, i, findings);
        }
    }
}

}  // namespace mamori::detail

#endif  // MAMORI_KERNEL_COMPONENT_CHECK_HPP
