// SPDX-License-Identifier: Apache-2.0
/// @file
/// Evaluates the controls of the operator: switches with two channels, and buttons that count only when they
/// are pushed and released on purpose.
///
/// @satisfies SWR-SAF-030, SWR-SAF-031, SWR-SAF-032, SWR-SAF-035, SWR-SAF-036     Design:
/// docs/design/safe_arm.md#operator-panel Source:    ISO 13849-1:2015, 5.2.2 (manual reset: at the release of
/// the button); ISO 13850 (emergency stop)
#ifndef EXAMPLES_SAFE_ARM_OPERATOR_PANEL_HPP
#define EXAMPLES_SAFE_ARM_OPERATOR_PANEL_HPP

#include <array>
#include <cstdint>

#include "arm_limits.hpp"
#include "mamori/safety/arm/arm_device.hpp"
#include "mamori/safety/redundancy/discrepancy.hpp"
#include "messages.hpp"

namespace safe_arm {

/// Switch with two channels, whose closed circuits permit. Thread safety: none. Time: O(1).
class TwoChannelSwitch final {
  public:
    /// One frame. @return true if both circuits are closed. One open circuit demands the function at once.
    bool step(const std::array<bool, 2U>& is_closed, mamori::Instant now) noexcept;

    /// The channels differed for longer than kSwitchDiscrepancyTime, and are not acknowledged.
    bool has_failed() const noexcept { return timer_.get() == mamori::safety::Discrepancy::kLatched; }

    /// For a deliberate act of a person. A failed switch must have opened both circuits since then: a welded
    /// contact cannot do so.
    void acknowledge() noexcept;

  private:
    mamori::safety::DiscrepancyTimer timer_{kSwitchDiscrepancyTime};
    bool has_opened_{true};  ///< both circuits together since the failure
};

/// Button that counts in the frame of its release, if it was pushed for kPushMin to kPushMax. One that is
/// stuck never counts, whenever it sticks. Thread safety: none. Time: O(1).
class PushButton final {
  public:
    /// One frame. @return true if a deliberate push ends.
    bool step(bool is_pushed, mamori::Instant now) noexcept;

  private:
    mamori::Instant pushed_at_{};
    bool was_pushed_{true};  ///< unknown for how long, until it is released
    bool has_begun_{false};  ///< the begin of this push was seen
};

/// What the operator demands in one frame.
struct PanelState {
    OperatingMode selected{OperatingMode::kHoldToRun};
    std::uint32_t faults{0U};  ///< in any mode; bit n = ArmFault n
    bool start{false};         ///< a push of the start button ends
    bool reset{false};         ///< a push of the reset button ends
};

/// Selector with one contact per mode. Thread safety: none. Time: O(modes).
class ModeSelector final {
  public:
    /// One frame. @param[in] mode in effect. @return the mode that is shown; `mode` if none is: between two
    /// modes, no contact is closed.
    OperatingMode step(const std::array<bool, 3U>& is_selected, OperatingMode mode,
                       mamori::Instant now) noexcept;
    /// No mode was shown for longer than kSwitchDiscrepancyTime, and this is not acknowledged.
    bool has_failed() const noexcept { return timer_.get() == mamori::safety::Discrepancy::kLatched; }
    void acknowledge() noexcept { static_cast<void>(timer_.acknowledge()); }

  private:
    mamori::safety::DiscrepancyTimer timer_{kSwitchDiscrepancyTime};
};

class OperatorPanel final {
  public:
    /// One frame. @param[in] mode in effect.
    PanelState step(const mamori::safety::ArmInputs& inputs, OperatingMode mode,
                    mamori::Instant now) noexcept;

  private:
    TwoChannelSwitch emergency_stop_{};
    TwoChannelSwitch protective_stop_{};
    TwoChannelSwitch enabling_{};
    ModeSelector selector_{};
    PushButton start_{};
    PushButton reset_{};
};

}  // namespace safe_arm

#endif  // EXAMPLES_SAFE_ARM_OPERATOR_PANEL_HPP
