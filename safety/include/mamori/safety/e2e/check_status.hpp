// SPDX-License-Identifier: Apache-2.0
/// @file
/// Status of one check, as AUTOSAR names it, and the status that its state machine understands.
///
/// @satisfies SWR-E2E-006, SWR-E2E-010      Design: docs/design/e2e.md#order-of-messages
/// Source:   AUTOSAR SWS E2E Library (names and numbers of the profiles' status types)
#ifndef MAMORI_SAFETY_E2E_CHECK_STATUS_HPP
#define MAMORI_SAFETY_E2E_CHECK_STATUS_HPP

#include <cstdint>

namespace mamori::safety {

/// Verdict of a checker on one frame, or on the lack of one. Numbers as AUTOSAR's.
enum class CheckStatus : std::uint8_t {
    kOk = 0x00U,         ///< new, whole, next in order
    kNoNewData = 0x01U,  ///< no frame since the last check
    kError = 0x02U,     ///< damaged, foreign, or not of the channel's length; "wrong CRC" in profiles 1 and 2
    kSync = 0x03U,      ///< whole, order not proven yet; profiles 1 and 2
    kInitial = 0x04U,   ///< first whole frame; profiles 1 and 2
    kRepeated = 0x08U,  ///< whole, with the counter of the frame before
    kOkSomeLost = 0x20U,     ///< new, whole, some lost before it, within the limit
    kWrongSequence = 0x40U,  ///< whole, but more lost than the limit allows, or old
};

/// True for a frame whose content may be used.
constexpr bool is_usable(CheckStatus status) noexcept {
    return status == CheckStatus::kOk || status == CheckStatus::kOkSomeLost;
}

/// What the state machine counts.
enum class ProfileStatus : std::uint8_t { kOk, kRepeated, kWrongSequence, kError, kNotAvailable, kNoNewData };

/// Which statuses of profiles 1 and 2 count as ok in the state machine; the other profiles never give these
/// two.
enum class MappingRule : std::uint8_t {
    kSyncIsOk,     ///< "new" behaviour: kSync is ok, kInitial a wrong sequence
    kInitialIsOk,  ///< "old" behaviour: kInitial is ok, kSync a wrong sequence
};

/// @return what the state machine counts for `status`; kError for a corrupted value.
constexpr ProfileStatus to_profile_status(CheckStatus status, MappingRule rule) noexcept {
    const bool is_sync_ok = rule == MappingRule::kSyncIsOk;
    switch (status) {
        case CheckStatus::kOk:
        case CheckStatus::kOkSomeLost:
            return ProfileStatus::kOk;
        case CheckStatus::kSync:
            return is_sync_ok ? ProfileStatus::kOk : ProfileStatus::kWrongSequence;
        case CheckStatus::kInitial:
            return is_sync_ok ? ProfileStatus::kWrongSequence : ProfileStatus::kOk;
        case CheckStatus::kWrongSequence:
            return ProfileStatus::kWrongSequence;
        case CheckStatus::kRepeated:
            return ProfileStatus::kRepeated;
        case CheckStatus::kNoNewData:
            return ProfileStatus::kNoNewData;
        case CheckStatus::kError:
            return ProfileStatus::kError;
    }
    return ProfileStatus::kError;
}

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_E2E_CHECK_STATUS_HPP
