// SPDX-License-Identifier: Apache-2.0
/// @file
/// Lists the parameters of components, like ports, and provides the compile-time check of a value.
///
/// @satisfies SWR-PAR-006, SWR-KRN-062      Design: docs/design/parameters.md#configuration-sets
#ifndef MAMORI_KERNEL_PARAMETER_LIST_HPP
#define MAMORI_KERNEL_PARAMETER_LIST_HPP

#include <array>
#include <cstddef>
#include <type_traits>

#include "mamori/kernel/base/compiler_message.hpp"
#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/type_list.hpp"
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

/// One parameter of a component type, as a compiler message shows it.
template <typename C, auto kMember>
struct ParameterMember {
    static constexpr auto kPointer = kMember;
    using Owner = C;
};

/// Parameters of a list of components, in component order. @tparam Members TypeList of ParameterMember.
template <typename Members>
struct ParameterList {
    std::array<ParameterDeclaration, Members::kSize> declarations{};
};

namespace detail {

/// Whether a pointer refers to a parameter that is a member of C.
template <typename C, typename Pointer>
inline constexpr bool kIsParameterOf = false;
template <typename C, typename Value, typename Owner>
inline constexpr bool kIsParameterOf<C, Value Owner::*> =
    std::is_base_of_v<Owner, C> && std::is_base_of_v<ParameterBase, Value>;

/// An empty list instead of a wrong one, so that the compiler reports one error.
template <typename C, auto... kMembers>
constexpr auto require_parameters(Parameters<kMembers...> list) noexcept {
    if constexpr ((kIsParameterOf<C, decltype(kMembers)> && ...)) {
        return list;
    } else {
        static_cast<void>(list);
        static_cast<void>((sizeof(std::conditional_t<kIsParameterOf<C, decltype(kMembers)>, C,
                                                     rules::ListNamesMembersOfItsComponent<C, kMembers>>) +
                           ...));
        return Parameters<>{};
    }
}

template <typename C, typename = void>
struct ParametersOf {
    using Type = Parameters<>;
    static constexpr bool kIsValid = true;
};
template <typename C>
struct ParametersOf<C, std::void_t<typename C::Parameters>> {
    using Type = decltype(require_parameters<C>(typename C::Parameters{}));
    static constexpr bool kIsValid = std::is_same_v<Type, typename C::Parameters>;
};
template <typename C, typename List>
struct ParameterMembers;
template <typename C, auto... kMembers>
struct ParameterMembers<C, Parameters<kMembers...>> {
    using Type = TypeList<ParameterMember<C, kMembers>...>;
};
/// Members of several component types, in their order.
template <typename... Cs>
using JoinedParameters =
    typename Concat<typename ParameterMembers<Cs, typename ParametersOf<Cs>::Type>::Type...>::Type;

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
    return {{&component, &(component.*kMember)}, &admits_in_default<C, kMember>};
}

template <typename C, typename Members, auto... kMembers>
constexpr void append_parameters(C& component, ParameterList<Members>& list, std::size_t& next,
                                 Parameters<kMembers...>) noexcept {
    static_cast<void>(component);
    static_cast<void>(list);
    static_cast<void>(next);
    ((list.declarations[next++] = declare_parameter<C, kMembers>(component)), ...);
}

}  // namespace detail

/// Number of parameters that component type C declares.
template <typename C>
constexpr std::size_t parameter_count() noexcept {
    return detail::JoinedParameters<C>::kSize;
}

/// All parameters of these components, which must outlive the list. Components without parameters are
/// allowed.
template <typename... Cs>
constexpr ParameterList<detail::JoinedParameters<Cs...>> parameters_of(Cs&... components) noexcept {
    ParameterList<detail::JoinedParameters<Cs...>> list{};
    std::size_t next = 0U;
    (detail::append_parameters(components, list, next, typename detail::ParametersOf<Cs>::Type{}), ...);
    return list;
}

}  // namespace mamori

#endif  // MAMORI_KERNEL_PARAMETER_LIST_HPP
