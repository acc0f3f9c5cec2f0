// SPDX-License-Identifier: Apache-2.0
/// @file
/// Profiles 1 and 11: an 8-bit checksum and a 4-bit counter, for frames of at most 30 bytes. The identifier
/// goes into the checksum, in one of four ways.
///
/// @satisfies SWR-E2E-003, SWR-E2E-004, SWR-E2E-009      Design: docs/design/e2e.md#profiles
/// Source:   AUTOSAR PRS E2E Protocol, profiles 1 and 11
#ifndef MAMORI_SAFETY_E2E_PROFILE_01_HPP
#define MAMORI_SAFETY_E2E_PROFILE_01_HPP

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "mamori/kernel/base/span.hpp"
#include "mamori/safety/e2e/channel.hpp"
#include "mamori/safety/e2e/crc_catalogue.hpp"
#include "mamori/safety/e2e/frame_cause.hpp"
#include "mamori/safety/e2e/sequence.hpp"
#include "mamori/safety/e2e/wire.hpp"

namespace mamori::safety {

/// How the two bytes of the identifier are protected.
enum class DataIdMode : std::uint8_t {
    kBoth,         ///< both bytes in each checksum, low byte first
    kAlternating,  ///< low byte with even counters, high byte with odd ones; profile 1 only
    kLow,          ///< low byte only, the high one must be 0; profile 1 only
    kNibble,       ///< low byte in the checksum, bits 8 .. 11 sent, bits 12 .. 15 must be 0
};

/// Channel of profile 1 or 11. Offsets are in bits, as AUTOSAR writes them: byte * 8, + 4 for its high
/// nibble.
struct NibbleCounterChannel {
    std::uint16_t data_id{0U};  ///< of this channel alone, in the whole system
    DataIdMode mode{DataIdMode::kBoth};
    std::size_t length{0U};          ///< of every frame with its header [bytes], 2 .. 30
    std::size_t crc_offset{0U};      ///< [bits], a whole byte
    std::size_t counter_offset{8U};  ///< [bits], a nibble outside the checksum
    std::size_t nibble_offset{12U};  ///< [bits], another such nibble; used with kNibble only
};

/// One profile of the family; use the names below.
/// @tparam Order how the profile judges counters, which is all in which the two differ on good channels.
template <std::uint8_t kProfile, typename Order, std::size_t kSlices>
class NibbleCounterProfile final {
    using Checksum = Crc<kCrc8E2e, kSlices>;

  public:
    using Channel = NibbleCounterChannel;
    using Sequence = Order;
    static constexpr std::uint8_t kNumber = kProfile;
    static constexpr std::uint32_t kCounterMax = 14U;  ///< 15 is never sent
    static constexpr std::uint32_t kFirstCounter = 0U;
    static constexpr std::size_t kHeaderSize = 2U;
    static constexpr std::size_t kLengthMax = 30U;

    /// A frame of ones has counter 15, so only one of zeros could pass.
    static constexpr ChannelFault find_fault(const Channel& channel) noexcept {
        if (channel.length < kHeaderSize || channel.length > kLengthMax) {
            return ChannelFault::kLength;
        }
        if (!is_layout_sound(channel)) {
            return ChannelFault::kOffset;
        }
        if (!is_id_sound(channel)) {
            return ChannelFault::kDataId;
        }
        Checksum crc = begin(channel, 0U);
        crc.add_repeated(std::byte{0U}, channel.length - 1U);
        const bool is_zero_good =
            crc.get_value() == 0U && (channel.data_id >> 8U == 0U || !sends_nibble(channel));
        return is_zero_good ? ChannelFault::kStuckFrame : ChannelFault::kNone;
    }

    /// @param[in] length of a frame [bytes]. @return kGood, kTooShort or kTooLong.
    static constexpr FrameCause judge_length(const Channel& channel, std::size_t length) noexcept {
        return detail::judge_length(channel.length, channel.length, length);
    }

    /// Writes the header. @pre the channel has no fault and takes the length.
    static constexpr void write(const Channel& channel, std::uint32_t counter,
                                Span<std::byte> frame) noexcept {
        store_nibble(frame.data(), channel.counter_offset, counter);
        if (sends_nibble(channel)) {
            store_nibble(frame.data(), channel.nibble_offset, get_nibble(channel));
        }
        frame.data()[channel.crc_offset / 8U] =
            std::byte{calc_checksum(channel, counter, {frame.data(), frame.size()})};
    }

    /// Reads the header. @pre the channel has no fault and takes the length.
    /// @param[out] counter written for kGood only. @return kGood, kChecksum, kDataId or kCounter.
    static constexpr FrameCause read(const Channel& channel, Span<const std::byte> frame,
                                     std::uint32_t& counter) noexcept {
        const std::uint32_t sent = load_nibble(frame.data(), channel.counter_offset);
        if (frame.data()[channel.crc_offset / 8U] != std::byte{calc_checksum(channel, sent, frame)}) {
            return FrameCause::kChecksum;
        }
        if (sends_nibble(channel) &&
            load_nibble(frame.data(), channel.nibble_offset) != get_nibble(channel)) {
            return FrameCause::kDataId;
        }
        if (sent > kCounterMax) {
            return FrameCause::kCounter;
        }
        counter = sent;
        return FrameCause::kGood;
    }

  private:
    static constexpr bool sends_nibble(const Channel& channel) noexcept {
        return channel.mode == DataIdMode::kNibble;
    }
    static constexpr std::uint32_t get_nibble(const Channel& channel) noexcept {
        return channel.data_id >> 8U;
    }

    /// True for a nibble inside the frame and outside the checksum.
    static constexpr bool is_nibble_sound(const Channel& channel, std::size_t offset) noexcept {
        return offset % 4U == 0U && offset < channel.length * 8U && offset / 8U != channel.crc_offset / 8U;
    }
    static constexpr bool is_layout_sound(const Channel& channel) noexcept {
        if (channel.crc_offset % 8U != 0U || channel.crc_offset >= channel.length * 8U) {
            return false;
        }
        if (!is_nibble_sound(channel, channel.counter_offset)) {
            return false;
        }
        return !sends_nibble(channel) || (is_nibble_sound(channel, channel.nibble_offset) &&
                                          channel.nibble_offset != channel.counter_offset);
    }
    static constexpr bool is_id_sound(const Channel& channel) noexcept {
        switch (channel.mode) {
            case DataIdMode::kBoth:
                return true;
            case DataIdMode::kAlternating:
                return kProfile == 1U;
            case DataIdMode::kLow:
                return kProfile == 1U && channel.data_id <= 0xFFU;
            case DataIdMode::kNibble:
                return channel.data_id <= 0xFFFU;
        }
        return false;  // only a corrupted value comes here
    }
    /// Checksum of the bytes of the identifier that go with `counter`.
    static constexpr Checksum begin(const Channel& channel, std::uint32_t counter) noexcept {
        const bool takes_high = channel.mode == DataIdMode::kAlternating && counter % 2U == 1U;
        Checksum crc;
        crc.add(detail::get_byte(channel.data_id, takes_high ? 1U : 0U));
        if (channel.mode == DataIdMode::kBoth) {
            crc.add(detail::get_byte(channel.data_id, 1U));
        }
        if (sends_nibble(channel)) {
            crc.add(std::byte{0U});
        }
        return crc;
    }
    static constexpr std::uint8_t calc_checksum(const Channel& channel, std::uint32_t counter,
                                                Span<const std::byte> frame) noexcept {
        const std::size_t place = channel.crc_offset / 8U;
        Checksum crc = begin(channel, counter);
        crc.add({frame.data(), place});
        crc.add({frame.data() + place + 1U, frame.size() - place - 1U});
        return crc.get_value();
    }
    static constexpr std::uint32_t load_nibble(const std::byte* data, std::size_t offset) noexcept {
        return (std::to_integer<std::uint32_t>(data[offset / 8U]) >> (offset % 8U)) & 0x0FU;
    }
    static constexpr void store_nibble(std::byte* data, std::size_t offset, std::uint32_t value) noexcept {
        const std::byte mask = std::byte{0x0FU} << (offset % 8U);
        const std::byte shifted = static_cast<std::byte>(value << (offset % 8U));
        data[offset / 8U] = (data[offset / 8U] & ~mask) | (shifted & mask);
    }
};

/// CRC-8 (SAE J1850), judged with profile 1's own rules of order.
template <std::size_t kSlices = 8U>
using E2eProfile01 = NibbleCounterProfile<1U, SynchronisingSequence, kSlices>;
/// The same bytes, judged as the newer profiles are.
template <std::size_t kSlices = 8U>
using E2eProfile11 = NibbleCounterProfile<11U, PlainSequence, kSlices>;

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_E2E_PROFILE_01_HPP
