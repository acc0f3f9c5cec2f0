// SPDX-License-Identifier: Apache-2.0
/// @file
/// Checks the ports of a component type on a constant of this type, since the compiler cannot read the
/// objects that a table refers to. Not for users.
///
/// @satisfies SWR-KRN-045, SWR-KRN-046      Design: docs/design/kernel.md#system-table
#ifndef MAMORI_KERNEL_COMPONENT_CONSTANT_HPP
#define MAMORI_KERNEL_COMPONENT_CONSTANT_HPP

#include <array>
#include <cstddef>
#include <type_traits>
#include <utility>

#include "mamori/kernel/base/type_list.hpp"
#include "mamori/kernel/dataflow/port_base.hpp"
#include "mamori/kernel/system/port_list.hpp"
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

/// First finding of check_ports() for each object of the type.
template <typename List>
struct FirstPortFinding;
template <auto... kMembers>
struct FirstPortFinding<Ports<kMembers...>> {
    template <typename C>
    constexpr Finding operator()(const C& component) const noexcept {
        const std::array<const PortBase*, sizeof...(kMembers)> listed{&(component.*kMembers)...};
        Finding first{};
        check_ports(
            component, listed.size(), [&listed](std::size_t p) noexcept { return listed[p]; },
            [&first](Rule rule, std::size_t element, std::size_t other) noexcept {
                first = first.rule == Rule::kNone ? Finding{rule, element, other} : first;
            });
        return first;
    }
};
template <typename C>
constexpr Finding find_faulty_port() noexcept {
    return WayOf<C>::template apply<C>(FirstPortFinding<typename PortsOf<C>::Type>{});
}

/// Name of the port of type C after which `later` others are constructed.
template <typename C>
struct OfUnlistedPort {
    template <typename Table>
    static constexpr const char* get(const Table&, std::size_t later) noexcept {
        return WayOf<C>::template apply<C>([later](const C& component) noexcept {
            const PortBase* port = component.get_first_port();
            for (std::size_t i = 0U; i < later; ++i) {
                port = port->get_next();
            }
            return port->get_name();
        });
    }
};

/// First faulty port of the components of a table; the elements as in table_rules.hpp.
template <typename Table, typename... Cs>
constexpr Finding find_faulty_port(const Table& table, TypeList<Cs...>) noexcept {
    const std::array<Finding, sizeof...(Cs)> found{find_faulty_port<Cs>()...};
    for (std::size_t i = 0U; i < found.size(); ++i) {
        if (found[i].rule == Rule::kPortNotListed) {
            return {found[i].rule, i, found[i].element};
        }
        if (found[i].rule != Rule::kNone) {
            const std::size_t first = table.component_rows[i].first_port;
            return {found[i].rule, first + found[i].element, first + found[i].other};
        }
    }
    return {};
}

}  // namespace mamori::detail

#endif  // MAMORI_KERNEL_COMPONENT_CONSTANT_HPP
