// SPDX-License-Identifier: Apache-2.0
#include "operator_panel.hpp"

#include "arm_faults.hpp"

namespace safe_arm {
namespace {

constexpr std::array<OperatingMode, 3U> kModeOfContact{
    OperatingMode::kAutomatic, OperatingMode::kReducedSpeed, OperatingMode::kHoldToRun};

/// One frame of a switch. @return its faults.
std::uint32_t evaluate(TwoChannelSwitch& channels, const std::array<bool, 2U>& is_closed, ArmFault demand,
                       bool is_reset, mamori::Instant now) noexcept {
    const bool is_permitted = channels.step(is_closed, now);
    if (is_reset) {
        channels.acknowledge();
    }
    return (is_permitted ? 0U : to_bit(demand)) |
           (channels.has_failed() ? to_bit(ArmFault::kSwitchDiscrepancy) : 0U);
}

}  // namespace

using mamori::Duration;
using mamori::Instant;
using mamori::safety::ArmInputs;
using mamori::safety::Discrepancy;

bool TwoChannelSwitch::step(const std::array<bool, 2U>& is_closed, Instant now) noexcept {
    const bool has_opened_before = has_failed() && has_opened_;
    static_cast<void>(timer_.step(is_closed[0] != is_closed[1], now));
    has_opened_ = has_opened_before || (!is_closed[0] && !is_closed[1]);
    return is_closed[0] && is_closed[1];
}

void TwoChannelSwitch::acknowledge() noexcept {
    if (has_opened_) {
        static_cast<void>(timer_.acknowledge());  // channels that differ keep it
    }
}

bool PushButton::step(bool is_pushed, Instant now) noexcept {
    const Duration length = now - pushed_at_;
    const bool is_deliberate =
        was_pushed_ && !is_pushed && has_begun_ && length >= kPushMin && length <= kPushMax;
    if (is_pushed && !was_pushed_) {
        pushed_at_ = now;
        has_begun_ = true;
    }
    was_pushed_ = is_pushed;
    return is_deliberate;
}

OperatingMode ModeSelector::step(const std::array<bool, 3U>& is_selected, OperatingMode mode,
                                 Instant now) noexcept {
    std::size_t count = 0U;
    OperatingMode shown = mode;
    for (std::size_t i = 0U; i < is_selected.size(); ++i) {
        count += is_selected[i] ? 1U : 0U;
        shown = is_selected[i] ? kModeOfContact[i] : shown;
    }
    static_cast<void>(timer_.step(count != 1U, now));
    return count == 1U ? shown : mode;
}

PanelState OperatorPanel::step(const ArmInputs& inputs, OperatingMode mode, Instant now) noexcept {
    PanelState result{};
    result.start = start_.step(inputs.start_button, now);
    result.reset = reset_.step(inputs.reset_button, now);
    result.faults |=
        evaluate(emergency_stop_, inputs.emergency_stop_closed, ArmFault::kEmergencyStop, result.reset, now);
    result.faults |= evaluate(protective_stop_, inputs.protective_stop_closed, ArmFault::kProtectiveStop,
                              result.reset, now);
    result.faults |= evaluate(enabling_, inputs.enabling_closed, ArmFault::kEnableLost, result.reset, now);
    result.faults |= inputs.enabling_squeezed ? to_bit(ArmFault::kEnablingSqueezed) : 0U;
    result.faults |= inputs.run_button ? 0U : to_bit(ArmFault::kRunReleased);
    if (result.reset) {
        selector_.acknowledge();  // a mode that is still not shown is a fault again after its time
    }
    result.selected = selector_.step(inputs.mode_selected, mode, now);
    const bool is_mode_unknown = mode == OperatingMode::kSwitchFailed || selector_.has_failed();
    result.faults |= is_mode_unknown ? to_bit(ArmFault::kModeSelector) : 0U;
    return result;
}

}  // namespace safe_arm
