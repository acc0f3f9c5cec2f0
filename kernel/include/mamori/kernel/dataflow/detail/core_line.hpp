// SPDX-License-Identifier: Apache-2.0
/// @file
/// Alignment that keeps the data of different cores on different cache lines.
///
/// @satisfies SWR-BUF-021      Design: docs/design/data_flow.md#cache-lines
#ifndef MAMORI_KERNEL_CORE_LINE_HPP
#define MAMORI_KERNEL_CORE_LINE_HPP

#include <cstddef>
#include <cstdint>

namespace mamori::detail {

/// Data aligned to this size never share a cache line with the data of another core [byte]. On the Arm M
/// profile, buffers between cores must be in memory that is not cached: natural alignment, no padding.
#if defined(__ARM_ARCH_PROFILE) && __ARM_ARCH_PROFILE == 'M'
inline constexpr std::size_t kCoreLineSize = alignof(std::uint32_t);
#else
inline constexpr std::size_t kCoreLineSize = 64U;
#endif

}  // namespace mamori::detail

#endif  // MAMORI_KERNEL_CORE_LINE_HPP
