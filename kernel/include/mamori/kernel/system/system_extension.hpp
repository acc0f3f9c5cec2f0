// SPDX-License-Identifier: Apache-2.0
/// @file
/// For a layer above the kernel that adds rows of its own to the system table, as mamori::safety::system()
/// does. Not for users.
///
/// Such a layer derives a table from DescribedSystem, gives each of its parts the Types
/// ExtensionTypes<Part>, and an add_part(TableBuilder<Table<Types>>&, const Part&) in the namespace of the
/// part. Types::Extensions lists its parts.
///
/// @satisfies SWR-KRN-095      Design: docs/design/kernel.md#system-table
#ifndef MAMORI_KERNEL_SYSTEM_EXTENSION_HPP
#define MAMORI_KERNEL_SYSTEM_EXTENSION_HPP

#include <cstddef>
#include <type_traits>

#include "mamori/kernel/base/type_list.hpp"
#include "mamori/kernel/system/detail/option_words.hpp"
#include "mamori/kernel/system/detail/part_types.hpp"
#include "mamori/kernel/system/detail/system_builder.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/kernel/system/system_rules.hpp"

namespace mamori::extension {

/// Contribution of a part of a layer above. @tparam Tag identifies the kind of part. @tparam FaultEnums
/// enumerations of the faults that it names: all faults of a system are of one enumeration.
template <typename Tag, typename... FaultEnums>
struct ExtensionTypes : mamori::detail::NoTypes {
    using Extensions = mamori::detail::TypeList<Tag>;
    using FaultTypes = mamori::detail::TypeList<FaultEnums...>;
};

template <typename T, typename List>
struct IsListOf;
template <typename T, typename... Ts>
struct IsListOf<T, mamori::detail::TypeList<Ts...>> : std::bool_constant<(std::is_same_v<T, Ts> && ...)> {};
/// Whether each reaction of a table is an enumerator of `Reaction`. @tparam Types of the table.
template <typename Reaction, typename Types>
inline constexpr bool kHasReactionsOf = IsListOf<Reaction, typename Types::ReactionTypes>::value;

template <typename Part, typename List>
struct PartCounter;
template <typename Part, typename... Parts>
struct PartCounter<Part, mamori::detail::TypeList<Parts...>> {
    static constexpr std::size_t kCount = (std::size_t{std::is_same_v<Part, Parts>} + ... + 0U);
};
/// Number of parts of one kind in a description. @tparam Types of the table.
template <typename Part, typename Types>
inline constexpr std::size_t kPartCount = PartCounter<Part, typename Types::Extensions>::kCount;

/// Whether an option is specified exactly once.
template <typename Option, typename... Options>
inline constexpr bool kIsSaidOnce = mamori::detail::kTimesSaid<Option, Options...> == 1U;

/// Under construction: its member `table`.
template <typename Table>
using TableBuilder = mamori::detail::TableBuilder<Table>;

/// @tparam Table of the layer, for the types of its parts. @return the table, as mamori::system() builds it.
template <template <typename> class Table, typename... Parts>
constexpr auto build(Frame frame_part, const Parts&... parts) noexcept {
    return mamori::detail::build_system<Table>(frame_part, parts...);
}

/// Type of a component, and FaultName of a fault, as compiler messages show them. @tparam kIndex its number.
template <const auto& kTable, std::size_t kIndex>
using ComponentAt = mamori::detail::At<typename mamori::detail::TypesOf<kTable>::Components, kIndex>;
template <const auto& kTable, std::size_t kIndex>
using FaultAt = mamori::detail::At<typename mamori::detail::TypesOf<kTable>::Faults, kIndex>;

/// @return true; a violated rule of the kernel does not compile.
template <const auto& kTable>
constexpr bool keeps_rules() noexcept {
    return mamori::detail::keeps_rules<kTable>();
}

}  // namespace mamori::extension

#endif  // MAMORI_KERNEL_SYSTEM_EXTENSION_HPP
