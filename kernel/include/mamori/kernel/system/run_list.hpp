// SPDX-License-Identifier: Apache-2.0
/// @file
/// Function run(...): the components of one window in execution order.
///
/// @satisfies SWR-KRN-017      Design: docs/design/kernel.md#system-table
#ifndef MAMORI_KERNEL_RUN_LIST_HPP
#define MAMORI_KERNEL_RUN_LIST_HPP

#include <array>
#include <cstddef>
#include <type_traits>

#include "mamori/kernel/base/time.hpp"
#include "mamori/kernel/base/type_list.hpp"
#include "mamori/kernel/component/component.hpp"
#include "mamori/kernel/parameter/parameter_list.hpp"
#include "mamori/kernel/system/component_part.hpp"
#include "mamori/kernel/system/port_list.hpp"
#include "mamori/kernel/table/connection_row.hpp"

namespace mamori {

/// Components of one window in execution order; they form one execution context. Made by run().
template <typename... Cs>
struct RunList {
    static constexpr std::size_t kPortCount = (detail::ComponentTypes<Cs>::kPortCount + ... + 0U);
    using Parameters = typename detail::Concat<typename detail::ComponentTypes<Cs>::ParameterList...>::Type;

    std::array<Component*, sizeof...(Cs)> components{};
    std::array<Duration, sizeof...(Cs)> worst_cases{};
    std::array<std::size_t, sizeof...(Cs)> port_counts{};
    std::array<PortRow, kPortCount> ports{};
    ParameterList<Parameters> parameters{};
};

namespace detail {

/// Fills a RunList component by component.
template <typename List>
struct RunListBuilder {
    List list{};
    std::size_t component_count{0U};
    std::size_t port_count{0U};
    std::size_t parameter_count{0U};

    template <typename C>
    constexpr void add(const TimedComponent<C>& part) noexcept {
        list.components[component_count] = &part.component;
        list.worst_cases[component_count] = part.worst_case;
        list.port_counts[component_count] = ComponentTypes<C>::kPortCount;
        ++component_count;
        add_ports(part.component, typename PortsOf<C>::Type{});
        append_parameters(part.component, list.parameters, parameter_count, typename ParametersOf<C>::Type{});
    }
    template <typename C, auto... kMembers>
    constexpr void add_ports(C& component, Ports<kMembers...>) noexcept {
        static_cast<void>(component);
        ((list.ports[port_count++] = make_port_row(component, component.*kMembers)), ...);
    }
};

}  // namespace detail

/// Components in execution order, each with or without worst_case(). They must outlive the table.
template <typename... Cs>
constexpr RunList<std::remove_const_t<std::remove_reference_t<Cs>>...> run(Cs&&... components) noexcept {
    static_assert(sizeof...(Cs) > 0U, "a window runs at least one component");
    detail::RunListBuilder<RunList<std::remove_const_t<std::remove_reference_t<Cs>>...>> builder{};
    (builder.add(detail::as_timed(components)), ...);
    return builder.list;
}

}  // namespace mamori

#endif  // MAMORI_KERNEL_RUN_LIST_HPP
