// SPDX-License-Identifier: Apache-2.0
/// @file
/// A list of types, for what the compiler alone computes: fields of a payload, components of a table.
///
/// @satisfies SWR-KRN-017      Design: docs/design/kernel.md#system-table
#ifndef MAMORI_KERNEL_TYPE_LIST_HPP
#define MAMORI_KERNEL_TYPE_LIST_HPP

#include <cstddef>

namespace mamori::detail {

template <typename... Ts>
struct TypeList {
    static constexpr std::size_t kSize = sizeof...(Ts);
};

}  // namespace mamori::detail

#endif  // MAMORI_KERNEL_TYPE_LIST_HPP
