// SPDX-License-Identifier: Apache-2.0
/// @file
/// The index that denotes no row of a table.
///
/// @satisfies SWR-KRN-017      Design: docs/design/kernel.md#system-table
#ifndef MAMORI_KERNEL_TABLE_INDEX_HPP
#define MAMORI_KERNEL_TABLE_INDEX_HPP

#include <cstddef>
#include <limits>

namespace mamori {

/// No row, or a row that is not known yet.
inline constexpr std::size_t kNoIndex = std::numeric_limits<std::size_t>::max();

}  // namespace mamori

#endif  // MAMORI_KERNEL_TABLE_INDEX_HPP
