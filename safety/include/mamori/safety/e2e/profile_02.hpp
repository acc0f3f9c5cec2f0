// SPDX-License-Identifier: Apache-2.0
/// @file
/// Profiles 2 and 22: an 8-bit checksum, a 4-bit counter, and a list of sixteen identifiers of which the
/// counter picks the one that goes into the checksum.
///
/// @satisfies SWR-E2E-003, SWR-E2E-004, SWR-E2E-009      Design: docs/design/e2e.md#profiles
/// Source:   AUTOSAR PRS E2E Protocol, profiles 2 and 22
#ifndef MAMORI_SAFETY_E2E_PROFILE_02_HPP
#define MAMORI_SAFETY_E2E_PROFILE_02_HPP

#include <array>
#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/span.hpp"
#include "mamori/safety/e2e/channel.hpp"
#include "mamori/safety/e2e/crc_catalogue.hpp"
#include "mamori/safety/e2e/frame_cause.hpp"
#include "mamori/safety/e2e/sequence.hpp"

namespace mamori::safety {

/// Channel of profile 2 or 22.
struct IdListChannel {
    std::array<std::uint8_t, 16U> data_ids{};  ///< one per counter; the list is of this channel alone
    std::size_t length{0U};                    ///< of every frame with its header [bytes], 2 .. 256
    std::size_t offset{0U};                    ///< bytes in front of the header; 0 in profile 2
};

/// One profile of the family; use the names below.
/// @tparam Order how the profile judges counters.
template <std::uint8_t kProfile, typename Order, std::size_t kSlices>
class IdListProfile final {
    using Checksum = Crc<kCrc8H2f, kSlices>;

  public:
    using Channel = IdListChannel;
    using Sequence = Order;
    static constexpr std::uint8_t kNumber = kProfile;
    static constexpr std::uint32_t kCounterMax = 15U;
    static constexpr std::uint32_t kFirstCounter = 1U;  ///< counted up before use
    static constexpr std::size_t kHeaderSize = 2U;
    static constexpr std::size_t kLengthMax = 256U;

    static constexpr ChannelFault find_fault(const Channel& channel) noexcept {
        if (channel.length < kHeaderSize || channel.length > kLengthMax) {
            return ChannelFault::kLength;
        }
        if (channel.offset > channel.length - kHeaderSize) {
            return ChannelFault::kOffset;
        }
        if constexpr (kProfile == 2U) {
            if (channel.offset != 0U) {
                return ChannelFault::kOffset;
            }
        }
        const bool is_stuck_good = calc_stuck(channel, std::byte{0U}, 0U) == 0U ||
                                   calc_stuck(channel, std::byte{0xFFU}, kCounterMax) == 0xFFU;
        return is_stuck_good ? ChannelFault::kStuckFrame : ChannelFault::kNone;
    }

    /// @param[in] length of a frame [bytes]. @return kGood, kTooShort or kTooLong.
    static constexpr FrameCause judge_length(const Channel& channel, std::size_t length) noexcept {
        return detail::judge_length(channel.length, channel.length, length);
    }

    /// Writes the header. @pre the channel has no fault and takes the length.
    static constexpr void write(const Channel& channel, std::uint32_t counter,
                                Span<std::byte> frame) noexcept {
        std::byte* const header = frame.data() + channel.offset;
        header[1] = (header[1] & std::byte{0xF0U}) | (static_cast<std::byte>(counter) & kCounterBits);
        header[0] = std::byte{calc_checksum(channel, {frame.data(), frame.size()})};
    }

    /// Reads the header. @pre the channel has no fault and takes the length.
    /// @param[out] counter written for kGood only. @return kGood or kChecksum.
    static constexpr FrameCause read(const Channel& channel, Span<const std::byte> frame,
                                     std::uint32_t& counter) noexcept {
        const std::byte* const header = frame.data() + channel.offset;
        if (header[0] != std::byte{calc_checksum(channel, frame)}) {
            return FrameCause::kChecksum;
        }
        counter = std::to_integer<std::uint32_t>(header[1] & kCounterBits);
        return FrameCause::kGood;
    }

  private:
    static constexpr std::byte kCounterBits{0x0FU};

    static constexpr std::uint8_t calc_checksum(const Channel& channel,
                                                Span<const std::byte> frame) noexcept {
        const std::size_t place = channel.offset;
        const auto counter = std::to_integer<std::size_t>(frame.data()[place + 1U] & kCounterBits);
        Checksum crc;
        crc.add({frame.data(), place});
        crc.add({frame.data() + place + 1U, frame.size() - place - 1U});
        crc.add(std::byte{channel.data_ids[counter]});
        return crc.get_value();
    }
    /// Checksum that a frame of equal bytes would need.
    static constexpr std::uint8_t calc_stuck(const Channel& channel, std::byte value,
                                             std::size_t counter) noexcept {
        Checksum crc;
        crc.add_repeated(value, channel.length - 1U);
        crc.add(std::byte{channel.data_ids[counter]});
        return crc.get_value();
    }
};

/// CRC-8 (H2F), judged with profile 2's own rules of order.
template <std::size_t kSlices = 8U>
using E2eProfile02 = IdListProfile<2U, SynchronisingSequence, kSlices>;
/// The same with the header at any byte, judged as the newer profiles are.
template <std::size_t kSlices = 8U>
using E2eProfile22 = IdListProfile<22U, PlainSequence, kSlices>;

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_E2E_PROFILE_02_HPP
