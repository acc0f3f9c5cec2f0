// SPDX-License-Identifier: Apache-2.0
/// @file
/// What became of a frame, by cause, and how often: what a diagnosis reads beside the status.
///
/// @satisfies SWR-E2E-004, SWR-E2E-005      Design: docs/design/e2e.md#causes
#ifndef MAMORI_SAFETY_E2E_FRAME_CAUSE_HPP
#define MAMORI_SAFETY_E2E_FRAME_CAUSE_HPP

#include <array>
#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/span.hpp"
#include "mamori/safety/base/saturating_increment.hpp"

namespace mamori::safety {

/// Why a call of a checker ended as it did. Exactly one per call.
enum class FrameCause : std::uint8_t {
    kGood,         ///< new and in order, losses within the limit included
    kSilence,      ///< no frame
    kTooShort,     ///< fewer bytes than the channel allows
    kTooLong,      ///< more bytes than the channel allows
    kAllZero,      ///< line stuck at 0
    kAllOnes,      ///< line stuck at 1
    kChecksum,     ///< damaged; or, where the identifier is not sent, from another channel
    kDataId,       ///< whole, but from another channel
    kLengthField,  ///< whole, but cut or lengthened with its checksum made anew
    kCounter,      ///< whole, but with a counter or an identifier nibble that no sender writes
    kRepeated,     ///< the counter of the last accepted frame
    kOutOfOrder,   ///< older than the last accepted frame, or after more losses than allowed
    kInitial,      ///< first frame, or one while order is being found again: not for use
    kNotReady,     ///< the channel or its limits were refused
};
inline constexpr std::size_t kFrameCauseCount = 14U;

/// True when every byte of `frame` is `value`; a frame without bytes is of no value.
constexpr bool consists_of(Span<const std::byte> frame, std::byte value) noexcept {
    std::size_t count = 0U;
    for (const std::byte byte : frame) {
        count += byte == value ? 1U : 0U;
    }
    return count > 0U && count == frame.size();
}

/// A line that is stuck is named as such, whatever else is wrong with the frame.
/// @param[in] cause why `frame` was refused.
constexpr FrameCause refine(FrameCause cause, Span<const std::byte> frame) noexcept {
    if (consists_of(frame, std::byte{0U})) {
        return FrameCause::kAllZero;
    }
    return consists_of(frame, std::byte{0xFFU}) ? FrameCause::kAllOnes : cause;
}

/// How often each cause came since the start.
using FrameCounts = std::array<std::uint32_t, kFrameCauseCount>;

/// Spelling for logs and reports; "Invalid" for a corrupted value, never nullptr.
constexpr const char* get_name(FrameCause cause) noexcept {
    switch (cause) {
        case FrameCause::kGood:
            return "Good";
        case FrameCause::kSilence:
            return "Silence";
        case FrameCause::kTooShort:
            return "TooShort";
        case FrameCause::kTooLong:
            return "TooLong";
        case FrameCause::kAllZero:
            return "AllZero";
        case FrameCause::kAllOnes:
            return "AllOnes";
        case FrameCause::kChecksum:
            return "Checksum";
        case FrameCause::kDataId:
            return "DataId";
        case FrameCause::kLengthField:
            return "LengthField";
        case FrameCause::kCounter:
            return "Counter";
        case FrameCause::kRepeated:
            return "Repeated";
        case FrameCause::kOutOfOrder:
            return "OutOfOrder";
        case FrameCause::kInitial:
            return "Initial";
        case FrameCause::kNotReady:
            return "NotReady";
    }
    return "Invalid";
}

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_E2E_FRAME_CAUSE_HPP
