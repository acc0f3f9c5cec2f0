// SPDX-License-Identifier: Apache-2.0
/// @file
/// Checks the ports and parameters of a component type on a constant of this type, since the compiler cannot
/// read the objects that a table refers to. Not for users.
///
/// @satisfies SWR-KRN-045, SWR-KRN-046, SWR-PAR-020, SWR-PAR-021
/// Design:   docs/design/kernel.md#system-table
#ifndef MAMORI_KERNEL_COMPONENT_CONSTANT_HPP
#define MAMORI_KERNEL_COMPONENT_CONSTANT_HPP

#include <array>
#include <cstddef>
#include <type_traits>
#include <utility>

#include "mamori/kernel/base/type_list.hpp"
#include "mamori/kernel/component/member.hpp"
#include "mamori/kernel/system/component_part.hpp"
#include "mamori/kernel/table/system_check.hpp"
#include "mamori/kernel/table/system_finding.hpp"

namespace mamori::detail {

/// No component takes it as an argument. A type that is constructible from it has a constructor for any type;
/// only the compilation of its body would tell whether it takes a name.
struct Unrelated {};

// How a constant of a component type is constructed, if the type allows it: without arguments, or with a
// name.
struct WithoutName {
    template <typename C>
    static constexpr bool kIsPossible =
        std::is_default_constructible_v<C> && !std::is_constructible_v<C, Unrelated>;
    template <typename C, typename Use>
    static constexpr auto apply(const Use& use) noexcept {
        const C constant{};
        return use(constant);
    }
};
struct WithName {
    template <typename C>
    static constexpr bool kIsPossible =
        std::is_constructible_v<C, const char*> && !std::is_constructible_v<C, Unrelated>;
    template <typename C, typename Use>
    static constexpr auto apply(const Use& use) noexcept {
        constexpr const char* kAnyName = "name";  // a literal that becomes a bool is a warning
        const C constant(kAnyName);
        return use(constant);
    }
};
struct NotConstructible {
    template <typename C, typename Use>
    static constexpr auto apply(const Use& use) noexcept {
        return decltype(use(std::declval<const C&>())){};
    }
};

struct AcceptAny {
    template <typename C>
    constexpr bool operator()(const C&) const noexcept {
        return true;
    }
};
template <typename Way, typename C, std::enable_if_t<Way::template kIsPossible<C>, int> = 0,
          bool = Way::template apply<C>(AcceptAny{})>
std::true_type try_constant(int) noexcept;
template <typename Way, typename C>
std::false_type try_constant(...) noexcept;
template <typename Way, typename C>
inline constexpr bool kMakesConstant = decltype(try_constant<Way, C>(0))::value;

/// A type that the compiler cannot construct is checked by Executive::initialize().
template <typename C>
using WayOf = std::conditional_t<kMakesConstant<WithoutName, C>, WithoutName,
                                 std::conditional_t<kMakesConstant<WithName, C>, WithName, NotConstructible>>;

/// First finding of check_registration() for each object of a component type.
template <typename List>
struct FirstFindingOf;
template <typename... Members>
struct FirstFindingOf<TypeList<Members...>> {
    const MemberRules& rules;
    template <typename C>
    constexpr Finding operator()(const C& component) const noexcept {
        const std::array<const Member*, sizeof...(Members)> listed{&(component.*Members::kPointer)...};
        Finding first{};
        check_registration(
            component, rules, listed.size(), [&listed](std::size_t p) noexcept { return listed[p]; },
            [&first](Rule rule, std::size_t element, std::size_t other) noexcept {
                first = first.rule == Rule::kNone ? Finding{rule, element, other} : first;
            });
        return first;
    }
};
template <typename C, typename Members>
constexpr Finding find_faulty_member(const MemberRules& rules) noexcept {
    return WayOf<C>::template apply<C>(FirstFindingOf<Members>{rules});
}

/// Name of the member of type C after which `later` others are constructed.
template <typename C, MemberKind kKind>
struct OfUnlistedMember {
    template <typename Table>
    static constexpr const char* get(const Table&, std::size_t later) noexcept {
        return WayOf<C>::template apply<C>([later](const C& component) noexcept {
            const Member* member = component.get_first(kKind);
            for (std::size_t i = 0U; i < later; ++i) {
                member = member->get_next();
            }
            return member->get_name();
        });
    }
};

/// First faulty member of one kind of a list of components; the elements as in table_rules.hpp.
/// @param[in] found first finding of each component type. @param[in] counts listed members of each.
template <std::size_t kCount>
constexpr Finding find_first(const std::array<Finding, kCount>& found,
                             const std::array<std::size_t, kCount>& counts,
                             const MemberRules& rules) noexcept {
    std::size_t first = 0U;
    for (std::size_t i = 0U; i < kCount; ++i) {
        if (found[i].rule == rules.not_listed) {
            return {found[i].rule, i, found[i].element};
        }
        if (found[i].rule != Rule::kNone) {
            return {found[i].rule, first + found[i].element, first + found[i].other};
        }
        first += counts[i];
    }
    return {};
}

/// First faulty port or parameter of the components of a table. A wrong list has its own message.
template <typename... Cs>
constexpr Finding find_faulty_member(TypeList<Cs...>) noexcept {
    if constexpr (((PortsOf<Cs>::kIsValid && ParametersOf<Cs>::kIsValid) && ...)) {
        const Finding port = find_first<sizeof...(Cs)>(
            {find_faulty_member<Cs, typename ComponentTypes<Cs>::PortList>(kPortRules)...},
            {ComponentTypes<Cs>::PortList::kSize...}, kPortRules);
        const Finding parameter = find_first<sizeof...(Cs)>(
            {find_faulty_member<Cs, typename ComponentTypes<Cs>::ParameterList>(kParameterRules)...},
            {ComponentTypes<Cs>::ParameterList::kSize...}, kParameterRules);
        return port.rule != Rule::kNone ? port : parameter;
    }
    return {};
}

}  // namespace mamori::detail

#endif  // MAMORI_KERNEL_COMPONENT_CONSTANT_HPP
