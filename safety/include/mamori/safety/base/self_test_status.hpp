// SPDX-License-Identifier: Apache-2.0
/// @file
/// Result of a self test, as those who run tests give it and the safe-state machine takes it.
///
/// @satisfies SWR-FSM-008, SWR-AOU-001      Design: docs/design/safe_state.md#restart
#ifndef MAMORI_SAFETY_SELF_TEST_STATUS_HPP
#define MAMORI_SAFETY_SELF_TEST_STATUS_HPP

#include <cstdint>

namespace mamori::safety {

/// Result of the self test as a level. Whatever is above kFailed is corrupted, and failed.
enum class SelfTestStatus : std::uint8_t { kRunning, kPassed, kFailed };

/// @return kFailed when one of them failed, kPassed when both passed, kRunning else.
constexpr SelfTestStatus combine(SelfTestStatus a, SelfTestStatus b) noexcept {
    if (a >= SelfTestStatus::kFailed || b >= SelfTestStatus::kFailed) {
        return SelfTestStatus::kFailed;
    }
    return a == b ? a : SelfTestStatus::kRunning;
}

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_SELF_TEST_STATUS_HPP
