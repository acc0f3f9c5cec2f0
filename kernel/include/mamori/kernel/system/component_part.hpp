// SPDX-License-Identifier: Apache-2.0
/// @file
/// A component as a part of a window: its contribution to the table, and its declared execution time.
///
/// @satisfies SWR-KRN-017      Design: docs/design/kernel.md#system-table
#ifndef MAMORI_KERNEL_COMPONENT_PART_HPP
#define MAMORI_KERNEL_COMPONENT_PART_HPP

#include <cstddef>
#include <type_traits>

#include "mamori/kernel/base/time.hpp"
#include "mamori/kernel/component/component.hpp"
#include "mamori/kernel/parameter/parameter_list.hpp"
#include "mamori/kernel/system/port_list.hpp"

namespace mamori {

/// A component with its declared execution time.
template <typename C>
struct TimedComponent {
    C& component;
    Duration worst_case;
};
/// Declares the maximum execution time of `component` in one cycle, both passes together. The table is
/// rejected if the sum over a window exceeds its budget. The value is a declaration, not a measurement.
/// @param[in] component must outlive the table. @param[in] duration >= 0; 0: not declared.
template <typename C>
constexpr TimedComponent<C> worst_case(C& component, Duration duration) noexcept {
    return {component, duration};
}

namespace detail {

/// Contribution of a component of type C to the table.
template <typename C>
struct ComponentTypes {
    using Type = C;
    using PortList = typename PortMembers<C, typename PortsOf<C>::Type>::Type;
    static constexpr std::size_t kPortCount = PortList::kSize;
    using ParameterList = JoinedParameters<C>;
    /// An inherited member pointer has the type of the base class: the component does not override the
    /// action. A class derived from a non-final type may override it.
    static constexpr bool kHasSecondPass =
        !std::is_final_v<C> ||
        !std::is_same_v<decltype(&C::on_state_update), decltype(&Component::on_state_update)>;
};
template <typename C>
struct ComponentTypes<TimedComponent<C>> : ComponentTypes<C> {};

template <typename C>
constexpr TimedComponent<C> as_timed(C& component) noexcept {
    return {component, Duration{0}};
}
template <typename C>
constexpr TimedComponent<C> as_timed(TimedComponent<C>& component) noexcept {
    return component;
}

}  // namespace detail

}  // namespace mamori

#endif  // MAMORI_KERNEL_COMPONENT_PART_HPP
