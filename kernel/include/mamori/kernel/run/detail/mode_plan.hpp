// SPDX-License-Identifier: Apache-2.0
/// @file
/// One step of a mode switch that all cores agreed on, in one shared word. Not for users.
///
/// @satisfies SWR-MOD-004, SWR-MOD-005      Design: docs/design/modes.md#the-switch
#ifndef MAMORI_KERNEL_MODE_PLAN_HPP
#define MAMORI_KERNEL_MODE_PLAN_HPP

#include <cstddef>
#include <cstdint>
#include <limits>

#include "mamori/kernel/run/mode_step.hpp"

namespace mamori {

/// A step that the cores agreed on, in one word: step, index and the last 16 bits of its major frame number.
///
/// Thread safety: a value. Time: O(1). Memory: one word.
class ModePlan final {
  public:
    /// Largest index that a plan can carry.
    static constexpr std::size_t kIndexMax = 0xFFFU;
    /// Maximum distance to a future plan [major frames]: one when it is agreed, and one more for a core that
    /// is late.
    static constexpr std::int32_t kAheadMax = 2;

    constexpr ModePlan() noexcept = default;
    /// @param[in] word from get_word() of this or another core.
    constexpr explicit ModePlan(std::uint32_t word) noexcept : word_(word) {}
    /// @param[in] index mode, or set of kSet; 0 .. kIndexMax. @param[in] frame major frame in which all cores
    ///                  execute it.
    constexpr ModePlan(ModeStep step, std::size_t index, std::int64_t frame) noexcept
        : word_(static_cast<std::uint32_t>(step) << 28U | static_cast<std::uint32_t>(index) << 16U |
                static_cast<std::uint32_t>(static_cast<std::uint16_t>(frame))) {}

    constexpr std::uint32_t get_word() const noexcept { return word_; }
    constexpr ModeStep get_step() const noexcept { return static_cast<ModeStep>(word_ >> 28U); }
    constexpr std::size_t get_index() const noexcept { return word_ >> 16U & 0xFFFU; }
    /// Major frames since the plan is due, -kAheadMax .. 32767; negative: not due yet. A plan that seems to
    /// be further ahead is older than 16 bits can represent; it gets the maximum age.
    constexpr std::int32_t calc_age(std::int64_t frame) const noexcept {
        const std::int32_t age =
            static_cast<std::int16_t>(static_cast<std::uint16_t>(frame - static_cast<std::int64_t>(word_)));
        return age < -kAheadMax ? std::numeric_limits<std::int16_t>::max() : age;
    }

  private:
    std::uint32_t word_{0U};
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_MODE_PLAN_HPP
