// SPDX-License-Identifier: Apache-2.0
/// @file
/// Rules of components: each runs in one window, once, and has its own name and ports. Not for users.
///
/// @satisfies SWR-KRN-018, SWR-KRN-025, SWR-KRN-045, SWR-KRN-046      Design:
/// docs/design/kernel.md#system-table
#ifndef MAMORI_KERNEL_COMPONENT_CHECK_HPP
#define MAMORI_KERNEL_COMPONENT_CHECK_HPP

#include <cstddef>

#include "mamori/kernel/base/text.hpp"
#include "mamori/kernel/dataflow/port_base.hpp"
#include "mamori/kernel/table/detail/finding_list.hpp"
#include "mamori/kernel/table/system_table.hpp"

namespace mamori::detail {

constexpr const PortBase* get_port(const PortRow& row) noexcept {
    return row.input != nullptr ? static_cast<const PortBase*>(row.input) : row.output;
}

constexpr bool is_registered(const Component& component, const PortBase* port) noexcept {
    bool is_found = false;
    for (const PortBase* one = component.get_first_port(); one != nullptr; one = one->get_next()) {
        is_found = is_found || one == port;
    }
    return is_found;
}

/// Checks the ports of a component against `count` listed ports, which `get_listed(p)` returns.
/// @param[in] report receives the rule and its elements: for Rule::kPortNotListed the number of ports that
///                   were constructed after the faulty one, for the others positions in the list.
template <typename GetListed, typename Report>
constexpr void check_ports(const Component& component, std::size_t count, const GetListed& get_listed,
                           const Report& report) noexcept {
    std::size_t later = 0U;
    for (const PortBase* port = component.get_first_port(); port != nullptr; port = port->get_next()) {
        bool is_listed = false;
        for (std::size_t p = 0U; p < count; ++p) {
            is_listed = is_listed || get_listed(p) == port;
        }
        if (!is_listed) {
            report(Rule::kPortNotListed, later, std::size_t{0U});
        }
        ++later;
    }
    for (std::size_t p = 0U; p < count; ++p) {
        const PortBase& port = *get_listed(p);
        if (!is_registered(component, &port)) {
            report(Rule::kPortNotOwned, p, std::size_t{0U});
        }
        for (std::size_t q = 0U; q < p; ++q) {
            if (make_text(get_listed(q)->get_name()) == make_text(port.get_name())) {
                report(Rule::kPortNamedTwice, p, q);
                break;
            }
        }
    }
}

/// Checks that no earlier component has the name of component `i`, and that Ports<...> lists exactly its
/// registered ports.
inline void check_component_objects(const SystemView& view, std::size_t i, FindingList& findings) noexcept {
    const Component& component = *view.components[i];
    const ComponentRow& row = view.component_rows[i];
    for (std::size_t j = 0U; j < i; ++j) {
        const Component& earlier = *view.components[j];
        if (&earlier != &component && make_text(earlier.get_name()) == make_text(component.get_name())) {
            findings.add(Rule::kComponentNamedTwice, i, j);
            break;
        }
    }
    const auto get_listed = [&](std::size_t p) noexcept { return get_port(view.ports[row.first_port + p]); };
    const auto report = [&](Rule rule, std::size_t element, std::size_t other) noexcept {
        if (rule == Rule::kPortNotListed) {
            findings.add(rule, i, element);
        } else {
            findings.add(rule, row.first_port + element, row.first_port + other);
        }
    };
    check_ports(component, row.port_count, get_listed, report);
}

constexpr void check_components(const SystemView& view, FindingList& findings) noexcept {
    for (std::size_t i = 0U; i < view.components.size(); ++i) {
        for (std::size_t j = 0U; j < i; ++j) {
            if (view.components[i] == view.components[j]) {
                findings.add(Rule::kComponentInTwoPlaces, i, j);
                break;
            }
        }
        // A constant expression cannot read the objects. keeps_rules() then checks a constant of their type.
        if (!__builtin_is_constant_evaluated()) {
            check_component_objects(view, i, findings);
        }
    }
}

}  // namespace mamori::detail

#endif  // MAMORI_KERNEL_COMPONENT_CHECK_HPP
