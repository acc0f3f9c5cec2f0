// SPDX-License-Identifier: Apache-2.0
/// @file
/// Names of the faults of a table, read from its enumeration: `kOverspeed` is "Overspeed". An application
/// does not state them a second time.
///
/// @satisfies SWR-CYC-032      Design: docs/design/cost.md#library
#ifndef MAMORI_TABLE_DUMP_FAULT_NAMES_HPP
#define MAMORI_TABLE_DUMP_FAULT_NAMES_HPP

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "mamori/kernel/base/type_list.hpp"
#include "mamori/kernel/system/reaction_part.hpp"

namespace mamori::table_dump {

namespace detail {

/// The compiler writes the enumerator into the name of the function.
template <auto kEnumerator>
const char* spell() noexcept {
    return static_cast<const char*>(__PRETTY_FUNCTION__);
}
/// @param[in] spelling result of spell(): the name is its enumerator without scope and leading `k`.
void add_name(std::vector<std::string>& names, std::uint64_t number, const std::string& spelling);

template <auto... kFaults>
std::vector<std::string> list_names(mamori::detail::TypeList<FaultName<kFaults>...> /*faults*/) {
    std::vector<std::string> names;
    (add_name(names, static_cast<std::uint64_t>(kFaults), spell<kFaults>()), ...);
    return names;
}

}  // namespace detail

/// @param[in] source system table, or a part that declares faults.
/// @return names by the number of the fault, for Names::faults. A fault that is not declared has its number,
/// and a number above 65535 has no name.
template <typename Source>
std::vector<std::string> list_fault_names(const Source& /*source*/) {
    return detail::list_names(typename Source::Types::Faults{});
}

}  // namespace mamori::table_dump

#endif  // MAMORI_TABLE_DUMP_FAULT_NAMES_HPP
