// SPDX-License-Identifier: Apache-2.0
/// @file
/// Profiles 5 and 6: a 16-bit checksum, an 8-bit counter, and an identifier that is known to both ends and
/// goes into the checksum only.
///
/// @satisfies SWR-E2E-003, SWR-E2E-004, SWR-E2E-009      Design: docs/design/e2e.md#profiles
/// Source:   AUTOSAR PRS E2E Protocol, profiles 5 and 6
#ifndef MAMORI_SAFETY_E2E_PROFILE_05_HPP
#define MAMORI_SAFETY_E2E_PROFILE_05_HPP

#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/span.hpp"
#include "mamori/safety/e2e/channel.hpp"
#include "mamori/safety/e2e/crc_catalogue.hpp"
#include "mamori/safety/e2e/frame_cause.hpp"
#include "mamori/safety/e2e/sequence.hpp"
#include "mamori/safety/e2e/wire.hpp"

namespace mamori::safety {

/// Channel of a profile that knows its identifier without sending it.
struct KnownIdChannel {
    std::uint16_t data_id{0U};   ///< of this channel alone, in the whole system
    std::size_t length_min{0U};  ///< shortest frame with its header [bytes], from offset + header on
    std::size_t length_max{
        0U};                 ///< longest frame with its header [bytes], up to 4096; profile 5: as length_min
    std::size_t offset{0U};  ///< bytes in front of the header
};

/// One profile of the family; use the names below.
/// @tparam kSendsLength profile 6: length field, most significant byte first; profile 5: none, least
/// significant first.
template <bool kSendsLength, std::size_t kSlices>
class KnownIdProfile final {
    using Checksum = Crc<kCrc16, kSlices>;
    static constexpr std::size_t kLengthAt = 2U;
    static constexpr std::size_t kCounterAt = kSendsLength ? 4U : 2U;
    static constexpr unsigned kFirstByte = kSendsLength ? 1U : 0U;  ///< of checksum and identifier

  public:
    using Channel = KnownIdChannel;
    using Sequence = PlainSequence;
    static constexpr std::uint8_t kNumber = kSendsLength ? 6U : 5U;
    static constexpr std::uint32_t kCounterMax = 255U;
    static constexpr std::uint32_t kFirstCounter = 0U;
    static constexpr std::size_t kHeaderSize = kCounterAt + 1U;
    static constexpr std::size_t kLengthMax = 4096U;

    /// A stuck line carries a wrong length in profile 6; profile 5 depends on length and identifier.
    static constexpr ChannelFault find_fault(const Channel& channel) noexcept {
        const ChannelFault fault = detail::find_range_fault(channel, kHeaderSize, kLengthMax);
        if (fault != ChannelFault::kNone) {
            return fault;
        }
        if constexpr (!kSendsLength) {
            if (channel.length_min != channel.length_max) {
                return ChannelFault::kLength;  // nothing in the frame would tell of a cut
            }
            if (is_stuck_good(channel, std::byte{0U}) || is_stuck_good(channel, std::byte{0xFFU})) {
                return ChannelFault::kStuckFrame;
            }
        }
        return ChannelFault::kNone;
    }

    /// @param[in] length of a frame [bytes]. @return kGood, kTooShort or kTooLong.
    static constexpr FrameCause judge_length(const Channel& channel, std::size_t length) noexcept {
        return detail::judge_length(channel.length_min, channel.length_max, length);
    }

    /// Writes the header. @pre the channel has no fault and takes the length.
    static constexpr void write(const Channel& channel, std::uint32_t counter,
                                Span<std::byte> frame) noexcept {
        std::byte* const header = frame.data() + channel.offset;
        if constexpr (kSendsLength) {
            detail::store_big(header + kLengthAt, static_cast<std::uint16_t>(frame.size()));
        }
        header[kCounterAt] = static_cast<std::byte>(counter);
        const std::uint16_t checksum = calc_checksum(channel, {frame.data(), frame.size()});
        header[0] = detail::get_byte(checksum, kFirstByte);
        header[1] = detail::get_byte(checksum, 1U - kFirstByte);
    }

    /// Reads the header. @pre the channel has no fault and takes the length.
    /// @param[out] counter written for kGood only. @return kGood, kChecksum or kLengthField.
    static constexpr FrameCause read(const Channel& channel, Span<const std::byte> frame,
                                     std::uint32_t& counter) noexcept {
        const std::byte* const header = frame.data() + channel.offset;
        const auto sent =
            static_cast<std::uint16_t>(std::to_integer<unsigned>(header[kFirstByte]) |
                                       std::to_integer<unsigned>(header[1U - kFirstByte]) << 8U);
        if (sent != calc_checksum(channel, frame)) {
            return FrameCause::kChecksum;
        }
        if constexpr (kSendsLength) {
            if (detail::load_big<std::uint16_t>(header + kLengthAt) != frame.size()) {
                return FrameCause::kLengthField;
            }
        }
        counter = std::to_integer<std::uint32_t>(header[kCounterAt]);
        return FrameCause::kGood;
    }

  private:
    static constexpr std::uint16_t finish(const Channel& channel, Checksum crc) noexcept {
        crc.add(detail::get_byte(channel.data_id, kFirstByte));
        crc.add(detail::get_byte(channel.data_id, 1U - kFirstByte));
        return crc.get_value();
    }
    static constexpr std::uint16_t calc_checksum(const Channel& channel,
                                                 Span<const std::byte> frame) noexcept {
        const std::size_t end = channel.offset + sizeof(std::uint16_t);
        Checksum crc;
        crc.add({frame.data(), channel.offset});
        crc.add({frame.data() + end, frame.size() - end});
        return finish(channel, crc);
    }
    static constexpr bool is_stuck_good(const Channel& channel, std::byte value) noexcept {
        Checksum crc;
        crc.add_repeated(value, channel.length_max - sizeof(std::uint16_t));
        const std::uint16_t checksum = finish(channel, crc);
        return detail::get_byte(checksum, 0U) == value && detail::get_byte(checksum, 1U) == value;
    }
};

/// CRC-16, 8-bit counter, fixed length up to 4096 bytes.
template <std::size_t kSlices = 8U>
using E2eProfile05 = KnownIdProfile<false, kSlices>;
/// CRC-16, 8-bit counter, length up to 4096 bytes sent along.
template <std::size_t kSlices = 8U>
using E2eProfile06 = KnownIdProfile<true, kSlices>;

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_E2E_PROFILE_05_HPP
