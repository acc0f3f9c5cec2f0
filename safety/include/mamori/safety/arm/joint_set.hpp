// SPDX-License-Identifier: Apache-2.0
/// @file
/// A set of joints, for example those that broke a limit. Small enough to travel in an event.
///
/// @satisfies SWR-ARM-002      Design: docs/design/supervision.md#guards
#ifndef MAMORI_SAFETY_ARM_JOINT_SET_HPP
#define MAMORI_SAFETY_ARM_JOINT_SET_HPP

#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/assert.hpp"
#include "mamori/safety/arm/arm_device.hpp"

namespace mamori::safety {

/// Subset of the joints 0 .. kArmJointCount - 1. Thread safety: none. Time: O(1). Memory: one byte.
class JointSet final {
  public:
    /// @param[in] joint 0 .. kArmJointCount - 1.
    constexpr void insert(std::size_t joint) noexcept {
        MAMORI_REQUIRE(1, joint < kArmJointCount);
        bits_ = static_cast<std::uint8_t>(bits_ | (1U << joint));
    }
    /// @return false for a joint that does not exist.
    constexpr bool contains(std::size_t joint) const noexcept {
        return joint < kArmJointCount && (bits_ & (1U << joint)) != 0U;
    }
    constexpr bool is_empty() const noexcept { return bits_ == 0U; }
    /// @return lowest joint of the set; kArmJointCount when it is empty.
    constexpr std::size_t get_first() const noexcept {
        std::size_t joint = 0U;
        while (joint < kArmJointCount && !contains(joint)) {
            ++joint;
        }
        return joint;
    }
    /// @return bit n is set for joint n.
    constexpr std::uint8_t get_bits() const noexcept { return bits_; }

  private:
    static_assert(kArmJointCount <= 8U, "one bit per joint");
    std::uint8_t bits_{0U};
};

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_ARM_JOINT_SET_HPP
