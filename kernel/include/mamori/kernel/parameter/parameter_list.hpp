// SPDX-License-Identifier: Apache-2.0
/// @file
/// Lists the parameters of components, like ports, and provides the compile-time check of a value.
///
/// @satisfies SWR-PAR-006      Design: docs/design/parameters.md#configuration-sets
#ifndef MAMORI_KERNEL_PARAMETER_LIST_HPP
#define MAMORI_KERNEL_PARAMETER_LIST_HPP

#include <array>
#include <cstddef>
#include <type_traits>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/parameter/configuration_table.hpp"
#include "mamori/kernel/parameter/parameter.hpp"
#include "mamori/kernel/parameter/parameter_base.hpp"
#include "mamori/kernel/parameter/scalar.hpp"

namespace mamori {

/// One parameter of a listed component, used while the table is built.
struct ParameterDeclaration {
    ParameterRow row{};
    /// Checks the values with a temporary component; returns true if its type has no default constructor.
    bool (*admits)(Span<const Scalar> values) noexcept {nullptr};
};

/// Parameters of a list of components, in component order.
template <std::size_t kCount>
struct ParameterList {
    std::array<ParameterDeclaration, kCount> declarations{};
};

namespace detail {

template <typename C, typename = void>
struct ParameterCount {
    static constexpr std::size_t kValue = 0U;
};
template <typename C>
struct ParameterCount<C, std::void_t<typename C::Parameters>> {
    static constexpr std::size_t kValue = C::Parameters::kCount;
};

/// Constraint check with a local object: the compiler can read its parameters, but not those of a static
/// object. Both have the same constraint.
template <typename C, auto kMember>
constexpr bool admits_in_default(Span<const Scalar> values) noexcept {
    if constexpr (std::is_default_constructible_v<C>) {
        const C component{};
        return (component.*kMember).admits_scalars(values);
    } else {
        static_cast<void>(values);
        return true;
    }
}

template <typename C, auto kMember>
constexpr ParameterDeclaration declare_parameter(C& component) noexcept {
    using Member = std::remove_reference_t<decltype(component.*kMember)>;
    static_assert(std::is_base_of_v<ParameterBase, Member>,
                  "Parameters<...> names members that are parameters");
    return {{&component, &(component.*kMember)}, &admits_in_default<C, kMember>};
}

template <typename C, std::size_t N, auto... kMembers>
constexpr void append_parameters(C& component, ParameterList<N>& list, std::size_t& next,
                                 Parameters<kMembers...>) noexcept {
    ((list.declarations[next++] = declare_parameter<C, kMembers>(component)), ...);
}

template <typename C, std::size_t N>
constexpr void append_parameters_of(C& component, ParameterList<N>& list, std::size_t& next) noexcept {
    if constexpr (ParameterCount<C>::kValue > 0U) {
        append_parameters(component, list, next, typename C::Parameters{});
    } else {
        static_cast<void>(component);
        static_cast<void>(list);
        static_cast<void>(next);
    }
}

}  // namespace detail

/// Number of parameters that component type C declares.
template <typename C>
constexpr std::size_t parameter_count() noexcept {
    return detail::ParameterCount<C>::kValue;
}

/// All parameters of these components, which must outlive the list. Components without parameters are
/// allowed.
template <typename... Cs>
constexpr ParameterList<(parameter_count<Cs>() + ... + 0U)> parameters_of(Cs&... components) noexcept {
    ParameterList<(parameter_count<Cs>() + ... + 0U)> list{};
    std::size_t next = 0U;
    (detail::append_parameters_of(components, list, next), ...);
    return list;
}

}  // namespace mamori

#endif  // MAMORI_KERNEL_PARAMETER_LIST_HPP
