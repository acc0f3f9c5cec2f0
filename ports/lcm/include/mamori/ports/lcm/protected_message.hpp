// SPDX-License-Identifier: Apache-2.0
/// @file
/// A protected LCM message: a byte array `e2e` with the header of an E2E profile, then the fields of a
/// payload type. What E2E protects is everything after the fingerprint, so the checksum covers the encoded
/// octets.
///
/// @satisfies SWR-LCM-005      Design: docs/design/lcm.md#protected-form
#ifndef MAMORI_PORTS_LCM_PROTECTED_MESSAGE_HPP
#define MAMORI_PORTS_LCM_PROTECTED_MESSAGE_HPP

#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/status.hpp"
#include "mamori/ports/lcm/codec.hpp"
#include "mamori/ports/lcm/type_text.hpp"
#include "mamori/safety/e2e/channel.hpp"
#include "mamori/safety/e2e/frame_cause.hpp"

namespace mamori::ports::lcm {

/// Octets of an E2E channel that carries T without its fingerprint, for length_min and length_max.
template <typename T, typename Profile>
inline constexpr std::size_t kChannelLengthMin = Profile::kHeaderSize + detail::calc_body_size<T, false>();
template <typename T, typename Profile>
inline constexpr std::size_t kChannelLengthMax = Profile::kHeaderSize + detail::calc_body_size<T, true>();

/// One protected message, for both ends. An invalid channel does not compile.
/// @tparam T           struct with MAMORI_LCM_FIELDS and no field `e2e`.
/// @tparam P           profile with a header of its own: E2eProfile04<> .. E2eProfile44<>.
/// @tparam kTheChannel constexpr channel of static storage duration; offset 0, lengths kChannelLengthMin and
///                     kChannelLengthMax.
template <typename T, typename P, const auto& kTheChannel>
struct LcmMessage {
    static_assert(safety::is_sound<P, kTheChannel>());
    static_assert(kTheChannel.offset == 0U, "the header is the first field of the message");
    static_assert(kTheChannel.length_min == kChannelLengthMin<T, P> &&
                      kTheChannel.length_max == kChannelLengthMax<T, P>,
                  "lengths of the channel are kChannelLengthMin<T, P> and kChannelLengthMax<T, P>");
    static_assert(!detail::has_name_clash<T>(detail::kHeaderName), "`e2e` is the name of the header");

    using Value = T;
    using Profile = P;
    static constexpr const typename P::Channel& kChannel = kTheChannel;
    static constexpr std::uint64_t kFingerprint = detail::calc_type_hash<T>(P::kHeaderSize);
    /// First octet of the fields.
    static constexpr std::size_t kBodyAt = kFingerprintSize + P::kHeaderSize;
    /// Shortest and longest message, fingerprint and header included [byte].
    static constexpr std::size_t kSizeMin = kFingerprintSize + kChannelLengthMin<T, P>;
    static constexpr std::size_t kSizeMax = kFingerprintSize + kChannelLengthMax<T, P>;
};

/// The part of a message that E2E protects. @param[in] message of at least kFingerprintSize octets.
template <typename Byte>
constexpr Span<Byte> get_protected_part(Span<Byte> message) noexcept {
    return message.subspan(kFingerprintSize, message.size() - kFingerprintSize);
}

/// Encodes and protects `value`. Octets after the message do not change. O(size of the message), no memory.
/// @param[in,out] protector safety::E2eProtector of the profile and channel of Message; counts with kOk only.
/// @param[out] buffer Message::kSizeMax octets are always sufficient.
/// @return octets written; kOutOfResources and kBadParameter as encode_lcm();
///         kPreconditionNotMet (protector).
template <typename Message, typename Protector>
constexpr Result<std::size_t> encode_protected(const typename Message::Value& value, Protector& protector,
                                               Span<std::byte> buffer) noexcept {
    const Result<std::size_t> size =
        detail::write_message(value, Message::kFingerprint, Message::Profile::kHeaderSize, buffer);
    if (!size.has_value()) {
        return size;
    }
    const Span<std::byte> message = buffer.subspan(0U, size.get_value());
    for (std::byte& byte : message.subspan(kFingerprintSize, Message::Profile::kHeaderSize)) {
        byte = std::byte{0U};
    }
    const Status status = protector.protect(get_protected_part(message));
    return status == Status::kOk ? size : Result<std::size_t>(status);
}

/// Decodes the fields of a message that an E2eChecker found usable. @param[in,out] value unchanged except on
/// kOk. @return kOk, kUnsupported and kBadParameter as decode_lcm().
template <typename Message>
constexpr Status decode_protected(Span<const std::byte> message, typename Message::Value& value) noexcept {
    if (message.size() < Message::kSizeMin) {
        return Status::kBadParameter;
    }
    if (detail::read_fingerprint(message) != Message::kFingerprint) {
        return Status::kUnsupported;
    }
    const bool is_read =
        detail::read_body(message.subspan(Message::kBodyAt, message.size() - Message::kBodyAt), value);
    return is_read ? Status::kOk : Status::kBadParameter;
}

/// Writes the `.lcm` text of the protected message; the name of its struct is that of the payload and `_e2e`.
/// @return as write_lcm_text().
template <typename Message>
constexpr Result<std::size_t> write_protected_text(Span<char> buffer) noexcept {
    return detail::write_struct<typename Message::Value>(Message::Profile::kHeaderSize, "_e2e", buffer);
}

}  // namespace mamori::ports::lcm

#endif  // MAMORI_PORTS_LCM_PROTECTED_MESSAGE_HPP
