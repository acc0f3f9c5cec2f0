// SPDX-License-Identifier: Apache-2.0
/// @file
/// Profiles 4, 7, 44 and, provisional, 8: length, counter and identifier are sent with the frame, and the
/// checksum covers everything but itself.
///
/// @satisfies SWR-E2E-003, SWR-E2E-004, SWR-E2E-009      Design: docs/design/e2e.md#profiles
/// Source:   AUTOSAR PRS E2E Protocol, profiles 4, 7, 8 and 44. Profile 8 was built from public descriptions
/// and has
///           no second implementation to compare with: provisional.
#ifndef MAMORI_SAFETY_E2E_PROFILE_04_HPP
#define MAMORI_SAFETY_E2E_PROFILE_04_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "mamori/kernel/base/span.hpp"
#include "mamori/safety/e2e/channel.hpp"
#include "mamori/safety/e2e/crc_catalogue.hpp"
#include "mamori/safety/e2e/frame_cause.hpp"
#include "mamori/safety/e2e/sequence.hpp"
#include "mamori/safety/e2e/wire.hpp"

namespace mamori::safety {

/// Channel of a profile that sends its identifier.
struct SentIdChannel {
    std::uint32_t data_id{0U};   ///< of this channel alone, in the whole system
    std::size_t length_min{0U};  ///< shortest frame with its header [bytes], from offset + header on
    std::size_t length_max{0U};  ///< longest frame with its header [bytes], up to the profile's limit
    std::size_t offset{0U};      ///< bytes in front of the header
};

/// One profile of the family; use the names below.
/// @tparam Layout where the fields lie, of which type they are, and the longest frame.
template <typename Layout, std::size_t kSlices>
class SentIdProfile final {
    using Counter = typename Layout::Counter;
    using Length = typename Layout::Length;
    using Checksum = Crc<Layout::kCrc, kSlices>;
    using Word = typename Checksum::Word;

  public:
    using Channel = SentIdChannel;
    using Sequence = PlainSequence;
    static constexpr std::uint8_t kNumber = Layout::kNumber;
    static constexpr std::uint32_t kCounterMax = std::numeric_limits<Counter>::max();
    static constexpr std::uint32_t kFirstCounter = 0U;
    static constexpr std::size_t kHeaderSize = Layout::kHeaderSize;
    static constexpr std::size_t kLengthMax = Layout::kLengthMax;

    /// No stuck line can pass: zeros carry length 0, and ones a length above the limit (profile 44 by its
    /// checksum).
    static constexpr ChannelFault find_fault(const Channel& channel) noexcept {
        return detail::find_range_fault(channel, kHeaderSize, kLengthMax);
    }

    /// @param[in] length of a frame [bytes]. @return kGood, kTooShort or kTooLong.
    static constexpr FrameCause judge_length(const Channel& channel, std::size_t length) noexcept {
        return detail::judge_length(channel.length_min, channel.length_max, length);
    }

    /// Writes the header. @param[in] source a Channel or a ConstantChannel. @pre the channel has no fault and
    /// takes the length.
    template <typename Source>
    static constexpr void write(const Source& source, std::uint32_t counter, Span<std::byte> frame) noexcept {
        const Channel& channel = source;
        std::byte* const header = frame.data() + channel.offset;
        const auto length = static_cast<Length>(frame.size());
        const auto sent_counter = static_cast<Counter>(counter);
        detail::store_big(header + Layout::kLengthAt, length);
        detail::store_big(header + Layout::kCounterAt, sent_counter);
        detail::store_big(header + Layout::kIdAt, channel.data_id);
        const std::uint64_t first = Layout::join(length, sent_counter, channel.data_id);
        detail::store_big(header + Layout::kCrcAt,
                          calc_checksum(channel, {frame.data(), frame.size()}, first));
    }

    /// Reads the header. @pre the channel has no fault and takes the length.
    /// @param[out] counter written for kGood only. @return kGood, kChecksum, kDataId or kLengthField.
    template <typename Source>
    static constexpr FrameCause read(const Source& source, Span<const std::byte> frame,
                                     std::uint32_t& counter) noexcept {
        const Channel& channel = source;
        const std::byte* const header = frame.data() + channel.offset;
        const auto first = detail::load_big<std::uint64_t>(header + Layout::kLengthAt);
        if (detail::load_big<Word>(header + Layout::kCrcAt) != calc_checksum(channel, frame, first)) {
            return FrameCause::kChecksum;
        }
        if (detail::load_big<std::uint32_t>(header + Layout::kIdAt) != channel.data_id) {
            return FrameCause::kDataId;
        }
        if (detail::load_big<Length>(header + Layout::kLengthAt) != frame.size()) {
            return FrameCause::kLengthField;
        }
        counter = detail::load_big<Counter>(header + Layout::kCounterAt);
        return FrameCause::kGood;
    }

  private:
    /// @param[in] first the first fields as a number: a processor that reads them from the message waits for
    ///                  the stores.
    [[gnu::always_inline]] static constexpr Word calc_checksum(const Channel& channel,
                                                               Span<const std::byte> frame,
                                                               std::uint64_t first) noexcept {
        const std::size_t rest = channel.offset + Layout::kRestAt;
        const Checksum before =
            channel.offset != 0U ? start_checksum({frame.data(), channel.offset}) : Checksum{};
        return finish_checksum(before, first, {frame.data() + rest, frame.size() - rest});
    }
    /// A function of its own, because most channels have no bytes before the header.
    [[gnu::noinline]] static constexpr Checksum start_checksum(Span<const std::byte> before) noexcept {
        Checksum crc;
        crc.add(before);
        return crc;
    }
    static constexpr Word finish_checksum(Checksum crc, std::uint64_t first,
                                          Span<const std::byte> rest) noexcept {
        std::array<std::byte, sizeof(first)> first_bytes{};
        detail::store_big(first_bytes.data(), first);
        crc.add(first_bytes);
        crc.add(rest);
        return crc.get_value();
    }
};

namespace detail {

/// Header of profiles 4 and 44, which differ in the longest frame.
struct Header04 {
    using Length = std::uint16_t;
    using Counter = std::uint16_t;
    static constexpr const auto& kCrc = kCrc32P4;
    static constexpr std::size_t kLengthAt = 0U;
    static constexpr std::size_t kCounterAt = 2U;
    static constexpr std::size_t kIdAt = 4U;
    static constexpr std::size_t kCrcAt = 8U;
    static constexpr std::size_t kRestAt = 12U;  ///< where the checksum continues after the first fields
    static constexpr std::size_t kHeaderSize = 12U;

    /// The first eight bytes of the fields, as a number.
    static constexpr std::uint64_t join(Length length, Counter counter, std::uint32_t data_id) noexcept {
        return std::uint64_t{length} << 48U | std::uint64_t{counter} << 32U | data_id;
    }
};

struct Layout04 : Header04 {
    static constexpr std::uint8_t kNumber = 4U;
    static constexpr std::size_t kLengthMax = 4096U;
};

struct Layout44 : Header04 {
    static constexpr std::uint8_t kNumber = 44U;
    static constexpr std::size_t kLengthMax = 65535U;
};

/// What profiles 7 and 8, with their two checksums, have in common.
struct Header07 {
    using Length = std::uint32_t;
    using Counter = std::uint32_t;
    static constexpr std::size_t kCrcAt = 0U;
    static constexpr std::size_t kLengthMax = 4194304U;

    static constexpr std::uint64_t join(Length length, Counter counter, std::uint32_t /*data_id*/) noexcept {
        return std::uint64_t{length} << 32U | counter;
    }
};

struct Layout07 : Header07 {
    static constexpr const auto& kCrc = kCrc64;
    static constexpr std::uint8_t kNumber = 7U;
    static constexpr std::size_t kLengthAt = 8U;
    static constexpr std::size_t kCounterAt = 12U;
    static constexpr std::size_t kIdAt = 16U;
    static constexpr std::size_t kRestAt = 16U;
    static constexpr std::size_t kHeaderSize = 20U;
};

struct Layout08 : Header07 {
    static constexpr const auto& kCrc = kCrc32P4;
    static constexpr std::uint8_t kNumber = 8U;
    static constexpr std::size_t kLengthAt = 4U;
    static constexpr std::size_t kCounterAt = 8U;
    static constexpr std::size_t kIdAt = 12U;
    static constexpr std::size_t kRestAt = 12U;
    static constexpr std::size_t kHeaderSize = 16U;
};

}  // namespace detail

/// CRC-32 (P4), 16-bit counter, up to 4096 bytes.
template <std::size_t kSlices = 8U>
using E2eProfile04 = SentIdProfile<detail::Layout04, kSlices>;
/// CRC-64, 32-bit counter, up to 4 MiB.
template <std::size_t kSlices = 8U>
using E2eProfile07 = SentIdProfile<detail::Layout07, kSlices>;
/// Provisional: CRC-32 (P4), 32-bit counter, up to 4 MiB.
template <std::size_t kSlices = 8U>
using E2eProfile08 = SentIdProfile<detail::Layout08, kSlices>;
/// CRC-32 (P4), 16-bit counter, up to 65535 bytes.
template <std::size_t kSlices = 8U>
using E2eProfile44 = SentIdProfile<detail::Layout44, kSlices>;

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_E2E_PROFILE_04_HPP
