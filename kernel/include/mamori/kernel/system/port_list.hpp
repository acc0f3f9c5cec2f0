// SPDX-License-Identifier: Apache-2.0
/// @file
/// Lists the ports of a component, as pointers to its members, and creates their rows of the table.
///
/// @satisfies SWR-KRN-017, SWR-KRN-062, SWR-CIF-012      Design: docs/design/kernel.md#system-table
#ifndef MAMORI_KERNEL_PORT_LIST_HPP
#define MAMORI_KERNEL_PORT_LIST_HPP

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "mamori/kernel/base/compiler_message.hpp"
#include "mamori/kernel/base/type_list.hpp"
#include "mamori/kernel/table/connection_row.hpp"

namespace mamori {

/// Ports of a component, as pointers to its members. A component without this alias has no ports:
///     using Ports = mamori::Ports<&Monitor::joints, &Monitor::verdict>;
template <auto... kMembers>
struct Ports {
    static constexpr std::size_t kCount = sizeof...(kMembers);
};

/// One port of a component type, as a compiler message shows it.
template <typename C, auto kMember>
struct PortMember {
    static constexpr auto kPointer = kMember;
    using Owner = C;
};

namespace detail {

/// Whether a pointer refers to a port that is a member of C.
template <typename C, typename Pointer>
inline constexpr bool kIsPortOf = false;
template <typename C, typename Port, typename Owner>
inline constexpr bool kIsPortOf<C, Port Owner::*> =
    std::is_base_of_v<Owner, C> &&
    (std::is_base_of_v<InPortBase, Port> || std::is_base_of_v<OutPortBase, Port>);

/// An empty list instead of a wrong one, so that the compiler reports one error.
template <typename C, auto... kMembers>
constexpr auto require_ports(Ports<kMembers...> list) noexcept {
    if constexpr ((kIsPortOf<C, decltype(kMembers)> && ...)) {
        return list;
    } else {
        static_cast<void>(list);
        static_cast<void>((sizeof(std::conditional_t<kIsPortOf<C, decltype(kMembers)>, C,
                                                     rules::ListNamesMembersOfItsComponent<C, kMembers>>) +
                           ...));
        return Ports<>{};
    }
}

template <typename C, typename = void>
struct PortsOf {
    using Type = Ports<>;
    static constexpr bool kIsValid = true;
};
template <typename C>
struct PortsOf<C, std::void_t<typename C::Ports>> {
    using Type = decltype(require_ports<C>(typename C::Ports{}));
    static constexpr bool kIsValid = std::is_same_v<Type, typename C::Ports>;
};

template <typename C, typename List>
struct PortMembers;
template <typename C, auto... kMembers>
struct PortMembers<C, Ports<kMembers...>> {
    using Type = TypeList<PortMember<C, kMembers>...>;
};

template <typename C, typename Port>
constexpr PortRow make_port_row(C& component, Port& port) noexcept {
    PortRow row{};
    row.owner = &component;
    constexpr std::size_t kBytes = sizeof(typename Port::Payload);
    row.payload_bytes = kBytes <= 0xFFFFU ? static_cast<std::uint16_t>(kBytes) : std::uint16_t{0U};
    if constexpr (std::is_base_of_v<OutPortBase, Port>) {
        row.output = &port;
        row.hash_published = &Port::hash_published;
    } else {
        row.input = &port;
        row.is_mandatory = Port::kIsMandatory;
        if constexpr (Port::kIsQueue) {
            row.count = &Port::count;
        }
    }
    return row;
}

}  // namespace detail

}  // namespace mamori

#endif  // MAMORI_KERNEL_PORT_LIST_HPP
