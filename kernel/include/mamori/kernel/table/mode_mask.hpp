// SPDX-License-Identifier: Apache-2.0
/// @file
/// Sets of modes as bits of one word, for the rows of components and connections.
///
/// @satisfies SWR-MOD-001      Design: docs/design/modes.md#the-table
#ifndef MAMORI_KERNEL_MODE_MASK_HPP
#define MAMORI_KERNEL_MODE_MASK_HPP

#include <cstddef>
#include <cstdint>

namespace mamori {

/// Set of modes: bit m stands for mode m.
using ModeMask = std::uint32_t;
/// Maximum number of modes of a system.
inline constexpr std::size_t kSystemModeMax = 32U;
/// Mask of each component and connection of a system without modes.
inline constexpr ModeMask kEveryMode = ~ModeMask{0U};

/// Mask of one mode. @param[in] mode 0 .. kSystemModeMax - 1.
constexpr ModeMask to_mask(std::size_t mode) noexcept {
    return ModeMask{1U} << mode;
}

}  // namespace mamori

#endif  // MAMORI_KERNEL_MODE_MASK_HPP
