// SPDX-License-Identifier: Apache-2.0
/// @file
/// A set of axes, for example those that broke a limit. Small enough to travel in an event.
///
/// @satisfies SWR-ARM-002, SWR-ARM-009      Design: docs/design/supervision.md#guards
#ifndef MAMORI_SAFETY_AXIS_SET_HPP
#define MAMORI_SAFETY_AXIS_SET_HPP

#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/assert.hpp"

namespace mamori::safety {

/// Most axes that the guards of one machine compare.
inline constexpr std::size_t kAxisMax = 9U;

/// Subset of the axes 0 .. kAxisMax - 1. Thread safety: none. Time: O(1). Memory: two bytes.
class AxisSet final {
  public:
    /// @param[in] axis 0 .. kAxisMax - 1.
    constexpr void insert(std::size_t axis) noexcept {
        MAMORI_REQUIRE(1, axis < kAxisMax);
        bits_ = static_cast<std::uint16_t>(bits_ | (1U << axis));
    }
    /// @return false for an axis that does not exist.
    constexpr bool contains(std::size_t axis) const noexcept {
        return axis < kAxisMax && (bits_ & (1U << axis)) != 0U;
    }
    constexpr bool is_empty() const noexcept { return bits_ == 0U; }
    /// @return lowest axis of the set; kAxisMax when it is empty.
    constexpr std::size_t get_first() const noexcept {
        for (std::size_t axis = 0U; axis < kAxisMax; ++axis) {
            if (contains(axis)) {
                return axis;
            }
        }
        return kAxisMax;
    }
    /// @return bit n is set for axis n.
    constexpr std::uint16_t get_bits() const noexcept { return bits_; }
    /// @return the axes of both sets.
    friend constexpr AxisSet unite(AxisSet a, AxisSet b) noexcept {
        a.bits_ = static_cast<std::uint16_t>(a.bits_ | b.bits_);
        return a;
    }

  private:
    std::uint16_t bits_{0U};
};

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_AXIS_SET_HPP
