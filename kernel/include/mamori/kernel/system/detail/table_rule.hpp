// SPDX-License-Identifier: Apache-2.0
/// @file
/// What the rules of a system table have in common. Each rule is a template that no table may instantiate:
/// the compiler names it with its arguments, the guilty element, and says what was broken. Not for users.
///
/// @satisfies SWR-KRN-018      Design: docs/design/kernel.md#system-table
#ifndef MAMORI_KERNEL_TABLE_RULE_HPP
#define MAMORI_KERNEL_TABLE_RULE_HPP

#include <cstddef>

namespace mamori {

namespace rules {

/// Never true, but only known when instantiated.
template <typename...>
inline constexpr bool kKept = false;
/// A row that has no better name than its number.
template <std::size_t kIndex>
struct Row {};

template <typename Element>
struct RowIsValid {
    static_assert(kKept<Element>, "a row of the table is invalid in itself; build it with mamori::system()");
};

}  // namespace rules

}  // namespace mamori

#endif  // MAMORI_KERNEL_TABLE_RULE_HPP
