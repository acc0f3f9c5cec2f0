// SPDX-License-Identifier: Apache-2.0
/// @file
/// Detector of a deliberate push: a level counts in the cycle in which it rises, and a button that is held
/// down, or stuck, when the machine is switched on never counts.
///
/// @satisfies SWR-FSM-006      Design: docs/design/safe_state.md#restart
#ifndef MAMORI_SAFETY_RISING_EDGE_HPP
#define MAMORI_SAFETY_RISING_EDGE_HPP

namespace mamori::safety {

/// One input level. Thread safety: none. Time: O(1). Memory: one byte.
class RisingEdge final {
  public:
    /// @param[in] level the input in this cycle; call once per cycle.
    /// @return true when it was released in the cycle before.
    [[nodiscard]] constexpr bool step(bool level) noexcept {
        const bool has_risen = level && !was_high_;
        was_high_ = level;
        return has_risen;
    }

  private:
    bool was_high_{true};  // nobody knows how long it has been held before the first cycle
};

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_RISING_EDGE_HPP
