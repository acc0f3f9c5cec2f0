// SPDX-License-Identifier: Apache-2.0
/// @file
/// What is common to the channels of every profile: why a channel is refused, and the proof that one is
/// sound.
///
/// @satisfies SWR-E2E-009      Design: docs/design/e2e.md#rejected-channels
#ifndef MAMORI_SAFETY_E2E_CHANNEL_HPP
#define MAMORI_SAFETY_E2E_CHANNEL_HPP

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "mamori/safety/e2e/frame_cause.hpp"

namespace mamori::safety {

/// Why a channel, or the limits of its counter, cannot be used.
enum class ChannelFault : std::uint8_t {
    kNone,
    kLength,      ///< shorter than the header needs, longer than the profile allows, or least above greatest
    kOffset,      ///< header not where the profile allows it, or its parts overlap
    kDataId,      ///< identifier that the profile has no room for, or an unknown way to use it
    kStuckFrame,  ///< a frame of zeros only, or of ones only, would be a good frame of this channel
    kLimits,      ///< limits of the counter outside their range
};

namespace detail {

/// For channels with a range of lengths and a header at any byte.
template <typename Channel>
constexpr ChannelFault find_range_fault(const Channel& channel, std::size_t header_size,
                                        std::size_t length_max) noexcept {
    if (channel.length_min > channel.length_max || channel.length_max > length_max ||
        channel.length_min < header_size) {
        return ChannelFault::kLength;
    }
    return channel.offset > channel.length_min - header_size ? ChannelFault::kOffset : ChannelFault::kNone;
}

/// @return kGood for length_min <= length <= length_max [bytes]; kTooShort; kTooLong.
constexpr FrameCause judge_length(std::size_t length_min, std::size_t length_max,
                                  std::size_t length) noexcept {
    if (length < length_min) {
        return FrameCause::kTooShort;
    }
    return length > length_max ? FrameCause::kTooLong : FrameCause::kGood;
}

}  // namespace detail

/// Fails to compile for a fault; the compiler prints it.
template <ChannelFault kFault>
struct ChannelIsSound : std::true_type {
    static_assert(kFault != ChannelFault::kLength, "length does not fit the profile");
    static_assert(kFault != ChannelFault::kOffset, "header does not lie where the profile allows it");
    static_assert(kFault != ChannelFault::kDataId, "data id has no place in the profile");
    static_assert(kFault != ChannelFault::kStuckFrame,
                  "line stuck at 0 or 1 would be a good frame; take another data id");
    static_assert(kFault != ChannelFault::kLimits, "limits of the counter are out of range");
};

/// A channel that both ends know at compile time: it takes no memory, so nothing can change it, and the
/// compiler uses its numbers as constants.
/// @tparam kChannel constexpr channel of a profile, of static storage duration.
template <const auto& kChannel>
struct ConstantChannel {
    constexpr operator decltype(kChannel)() const noexcept {
        return kChannel;
    }  // NOLINT: implicit on purpose
};

/// Proves a channel where a table is made: static_assert(is_sound<E2eProfile04<>, kChannel>());
/// @tparam kChannel constexpr channel of the profile, of static storage duration.
/// @return true; every other outcome does not compile.
template <typename Profile, const auto& kChannel>
constexpr bool is_sound() noexcept {
    return ChannelIsSound<Profile::find_fault(kChannel)>::value;
}

/// The same for the limits of the order of frames: static_assert(are_sound<E2eProfile04<>, PlainSequence,
/// kLimits>());
template <typename Profile, typename Sequence, const auto& kLimits>
constexpr bool are_sound() noexcept {
    return ChannelIsSound<Sequence::find_fault(kLimits, Profile::kCounterMax)>::value;
}

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_E2E_CHANNEL_HPP
