// SPDX-License-Identifier: Apache-2.0
/// @file
/// Elements of a constexpr table as compiler messages show them: a component by its type, a port by its type
/// and member, and the instance number among components of the same type. Not for users.
///
/// @satisfies SWR-KRN-018      Design: docs/design/kernel.md#system-table
#ifndef MAMORI_KERNEL_TABLE_ELEMENT_HPP
#define MAMORI_KERNEL_TABLE_ELEMENT_HPP

#include <cstddef>
#include <type_traits>
#include <utility>

#include "mamori/kernel/base/type_list.hpp"
#include "mamori/kernel/dataflow/data_port.hpp"
#include "mamori/kernel/table/index_of.hpp"
#include "mamori/kernel/table/table_index.hpp"

namespace mamori::detail {

template <const auto& kTable, std::size_t kComponent>
constexpr std::size_t calc_instance() noexcept {
    using Components = typename std::remove_reference_t<decltype(kTable)>::Types::Components;
    return count_same_before<Components, kComponent>(std::make_index_sequence<kComponent>{});
}

template <typename Table>
constexpr std::size_t find_input(const Table& table, const InPortBase* input) noexcept {
    for (std::size_t i = 0U; i < table.ports.size(); ++i) {
        if (table.ports[i].input == input) {
            return i;
        }
    }
    return kNoIndex;
}

template <typename Table>
constexpr std::size_t find_output(const Table& table, const OutPortBase* output) noexcept {
    for (std::size_t i = 0U; i < table.ports.size(); ++i) {
        if (table.ports[i].output == output) {
            return i;
        }
    }
    return kNoIndex;
}

/// Component that has the parameter of row `parameter`.
template <typename Table>
constexpr std::size_t find_owner(const Table& table, std::size_t parameter) noexcept {
    return find_component(table.components, table.configuration.parameters[parameter].owner);
}

// Elements as the rules refer to them.
template <const auto& kTable>
using TypesOf = typename std::remove_reference_t<decltype(kTable)>::Types;
template <const auto& kTable, std::size_t kIndex>
using ComponentAt = At<typename TypesOf<kTable>::Components, kIndex>;
template <const auto& kTable, std::size_t kIndex>
using PortAt = At<typename TypesOf<kTable>::Ports, kIndex>;
template <const auto& kTable, std::size_t kIndex>
using ParameterAt = At<typename TypesOf<kTable>::Parameters, kIndex>;

template <template <typename, auto, std::size_t> class RuleOf, const auto& kTable, std::size_t kPort>
using OfPort = RuleOf<typename PortAt<kTable, kPort>::Owner, PortAt<kTable, kPort>::kPointer,
                      calc_instance<kTable, kTable.ports[kPort].component>()>;
template <template <typename, auto, std::size_t> class RuleOf, const auto& kTable, std::size_t kConnection>
using OfSink = OfPort<RuleOf, kTable, find_input(kTable, kTable.connections[kConnection].sink)>;

template <template <typename, auto, std::size_t> class RuleOf, const auto& kTable, std::size_t kParameter>
using OfParameter =
    RuleOf<typename ParameterAt<kTable, kParameter>::Owner, ParameterAt<kTable, kParameter>::kPointer,
           calc_instance<kTable, find_owner(kTable, kParameter)>()>;

/// One end of a connection, as far as the table has its component.
struct PortOfNoComponentOfTheTable {};
template <const auto& kTable, std::size_t kPort>
constexpr auto show_end() noexcept {
    if constexpr (kPort != kNoIndex) {
        return PortAt<kTable, kPort>{};
    } else {
        return PortOfNoComponentOfTheTable{};
    }
}

}  // namespace mamori::detail

#endif  // MAMORI_KERNEL_TABLE_ELEMENT_HPP
