// SPDX-License-Identifier: Apache-2.0
/// @file
/// A constexpr system table that the compiler has checked, as a type. An executive of it does not link the
/// rules that the compiler has evaluated, nor passes that the table does not need:
///
///     static mamori::ExecutiveFor executive{mamori::kChecked<kSystem>};
///
/// @satisfies SWR-KRN-070      Design: docs/design/kernel.md#initial-check
#ifndef MAMORI_KERNEL_CHECKED_TABLE_HPP
#define MAMORI_KERNEL_CHECKED_TABLE_HPP

#include <type_traits>

#include "mamori/kernel/table/system_check.hpp"

namespace mamori {

/// @tparam kTable constexpr system table of static storage duration. One that violates a rule does not
///                compile; MAMORI_CHECK names rule and faulty element.
template <const auto& kTable>
struct CheckedTable {
    static_assert(check(make_view(kTable)).rule == Rule::kNone,
                  "the system table violates a rule, which MAMORI_CHECK names");
    using Table = std::remove_const_t<std::remove_reference_t<decltype(kTable)>>;
};

template <const auto& kTable>
inline constexpr CheckedTable<kTable> kChecked{};

}  // namespace mamori

#endif  // MAMORI_KERNEL_CHECKED_TABLE_HPP
