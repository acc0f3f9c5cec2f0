// SPDX-License-Identifier: Apache-2.0
/// @file
/// A protected message: a payload type, a profile and a channel, which both ends must agree on and therefore
/// name as one type. Behind the header lies the encoding of the value, as the kernel's CDR writer writes it.
///
/// @satisfies SWR-E2E-030, SWR-E2E-037      Design: docs/design/e2e.md#ports
#ifndef MAMORI_SAFETY_E2E_MESSAGE_HPP
#define MAMORI_SAFETY_E2E_MESSAGE_HPP

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "mamori/kernel/base/type_list.hpp"
#include "mamori/kernel/payload/cdr.hpp"
#include "mamori/safety/e2e/channel.hpp"
#include "mamori/safety/e2e/frame.hpp"
#include "mamori/safety/e2e/frame_cause.hpp"
#include "mamori/safety/e2e/profile_01.hpp"

namespace mamori::safety {

namespace detail {

template <typename T>
constexpr std::size_t calc_least_end(std::size_t position) noexcept;

template <typename... T>
constexpr std::size_t calc_least_end_of_fields(std::size_t position,
                                               mamori::detail::TypeList<T...> /*types*/) noexcept {
    ((position = calc_least_end<T>(position)), ...);
    return position;
}

/// Where the shortest encoding of T ends that begins at `position` [bytes]. A shorter part never ends later,
/// so the shortest whole has the shortest parts.
template <typename T>
constexpr std::size_t calc_least_end(std::size_t position) noexcept {
    using Shape = mamori::detail::Shape<T>;
    if constexpr (mamori::detail::kIsScalar<T>) {
        constexpr std::size_t kSize = mamori::detail::calc_wire_size<T>();
        return mamori::detail::align_up(position, kSize) + kSize;
    } else if constexpr (Shape::kIsArray) {
        for (std::size_t i = 0U; i < Shape::kCapacity; ++i) {
            position = calc_least_end<typename Shape::Element>(position);
        }
        return position;
    } else if constexpr (Shape::kIsSequence) {
        return calc_least_end<std::uint32_t>(position);
    } else if constexpr (Shape::kIsString) {
        return calc_least_end<std::uint32_t>(position) + 1U;
    } else {
        return calc_least_end_of_fields(position, mamori::detail::FieldTypes<T>{});
    }
}

/// Where the payload begins: behind the last byte that the profile writes [bytes].
template <typename Profile>
constexpr std::size_t calc_payload_begin(const typename Profile::Channel& channel) noexcept {
    if constexpr (std::is_same_v<typename Profile::Channel, NibbleCounterChannel>) {
        std::size_t last_bit =
            channel.crc_offset > channel.counter_offset ? channel.crc_offset : channel.counter_offset;
        if (channel.mode == DataIdMode::kNibble && channel.nibble_offset > last_bit) {
            last_bit = channel.nibble_offset;
        }
        return last_bit / 8U + 1U;
    } else {
        return channel.offset + Profile::kHeaderSize;
    }
}

/// True when the channel takes frames of shortest .. longest [bytes] and no others.
template <typename Profile>
constexpr bool takes_exactly(const typename Profile::Channel& channel, std::size_t shortest,
                             std::size_t longest) noexcept {
    return Profile::judge_length(channel, shortest - 1U) == FrameCause::kTooShort &&
           Profile::judge_length(channel, shortest) == FrameCause::kGood &&
           Profile::judge_length(channel, longest) == FrameCause::kGood &&
           Profile::judge_length(channel, longest + 1U) == FrameCause::kTooLong;
}

}  // namespace detail

/// Fails to compile for a channel of other lengths; the compiler prints those that it must have [bytes].
template <bool kIsTaken, std::size_t kShortest, std::size_t kLongest>
struct ChannelTakesFramesOf : std::true_type {
    static_assert(kIsTaken,
                  "lengths of the channel are not those of the message; a profile without length field "
                  "needs a payload of one size");
};

/// One message, for both ends. An unsound channel does not compile.
/// @tparam T        payload with a field list; Stamped<...> where delays on the whole way are to be seen.
/// @tparam P        E2eProfile01<> .. E2eProfile44<>.
/// @tparam kTheChannel constexpr channel of the profile, of static storage duration. Its lengths are those of
///                  the frames of T: kPayloadAt and the shortest and longest encoding of T together.
/// @tparam kOrder   byte order of the payload; that of the header is the profile's.
template <typename T, typename P, const auto& kTheChannel, ByteOrder kOrder = ByteOrder::kLittle>
struct E2eMessage {
    static_assert(is_sound<P, kTheChannel>());

    using Value = T;
    using Profile = P;
    static constexpr const typename P::Channel& kChannel = kTheChannel;
    static constexpr ByteOrder kByteOrder = kOrder;
    /// First byte of the payload. Bytes before it that are not the profile's are sent as 0 and not looked at.
    static constexpr std::size_t kPayloadAt = detail::calc_payload_begin<P>(kTheChannel);
    /// Shortest and longest frame, header included [bytes].
    static constexpr std::size_t kLengthMin = kPayloadAt + detail::calc_least_end<T>(0U);
    static constexpr std::size_t kLengthMax = kPayloadAt + max_encoded_size<T>();
    static_assert(ChannelTakesFramesOf<detail::takes_exactly<P>(kTheChannel, kLengthMin, kLengthMax),
                                       kLengthMin, kLengthMax>::value);

    /// Payload type of the ports that carry the message.
    using Frame = E2eFrame<kLengthMax>;
};

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_E2E_MESSAGE_HPP
