// SPDX-License-Identifier: Apache-2.0
/// @file
/// LCM encoding of payloads, from the field list: fingerprint, then the fields, most significant byte first,
/// without padding. The bytes equal the output of the code that lcm-gen generates from the `.lcm` text of the
/// type.
///
/// @satisfies SWR-LCM-003, SWR-LCM-004      Design: docs/design/lcm.md#types
/// Source:   LCM Type Specification Language, "Encoding"
#ifndef MAMORI_PORTS_LCM_CODEC_HPP
#define MAMORI_PORTS_LCM_CODEC_HPP

#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/status.hpp"
#include "mamori/kernel/payload/cdr.hpp"
#include "mamori/ports/lcm/fingerprint.hpp"

namespace mamori::ports::lcm {

inline constexpr std::size_t kFingerprintSize = sizeof(std::uint64_t);

namespace detail {

/// Octets of one T. @tparam kLongest of the longest encoding, else of the shortest.
template <typename T, bool kLongest>
constexpr std::size_t calc_body_size() noexcept;

template <bool kLongest, typename... T>
constexpr std::size_t calc_fields_size(mamori::detail::TypeList<T...> /*types*/) noexcept {
    return (calc_body_size<T, kLongest>() + ... + 0U);
}

template <typename T, bool kLongest>
constexpr std::size_t calc_body_size() noexcept {
    using Shape = mamori::detail::Shape<T>;
    if constexpr (Shape::kIsString) {
        return sizeof(std::int32_t) + 1U + (kLongest ? Shape::kCapacity : 0U);
    } else if constexpr (Shape::kIsSequence) {
        return sizeof(std::int32_t) +
               (kLongest ? Shape::kCapacity * calc_body_size<typename Shape::Element, kLongest>() : 0U);
    } else if constexpr (Shape::kIsArray) {
        return Shape::kCapacity * calc_body_size<typename Shape::Element, kLongest>();
    } else if constexpr (mamori::detail::kIsScalar<T>) {
        return mamori::detail::calc_wire_size<T>();
    } else {
        return calc_fields_size<kLongest>(mamori::detail::FieldTypes<T>{});
    }
}

/// Counts octets; false when an enumeration has a value that is not an enumerator.
class LcmMeter final {
  public:
    template <typename T>
    constexpr bool run([[maybe_unused]] const T* first, std::size_t count) noexcept {
        bool is_valid = true;
        if constexpr (std::is_enum_v<T>) {
            for (std::size_t i = 0U; is_valid && i < count; ++i) {
                is_valid = mamori::detail::is_value<T>(mamori::detail::to_bits(first[i]));
            }
        }
        position_ += mamori::detail::calc_wire_size<T>() * count;
        return is_valid;
    }
    template <typename Sequence>
    constexpr bool open(const Sequence& sequence, std::size_t& count) noexcept {
        count = sequence.size();
        position_ += sizeof(std::int32_t);
        return true;
    }
    template <std::size_t N>
    constexpr bool text(const BoundedString<N>& string) noexcept {
        position_ += sizeof(std::int32_t) + string.size() + 1U;
        return true;
    }
    constexpr std::size_t get_position() const noexcept { return position_; }

  private:
    std::size_t position_{0U};
};

/// Writes into a buffer of the size counted before.
class LcmWriter final {
  public:
    constexpr explicit LcmWriter(Span<std::byte> buffer) noexcept : buffer_(buffer) {}

    template <typename T>
    constexpr bool run(const T* first, std::size_t count) noexcept {
        constexpr std::size_t kSize = mamori::detail::calc_wire_size<T>();
        MAMORI_REQUIRE(1, count <= (buffer_.size() - position_) / kSize);
        mamori::detail::store_block<true>(buffer_.data() + position_, first, count);
        position_ += count * kSize;
        return true;
    }
    template <typename Sequence>
    constexpr bool open(const Sequence& sequence, std::size_t& count) noexcept {
        count = sequence.size();
        const auto length = static_cast<std::int32_t>(count);
        return run(&length, 1U);
    }
    template <std::size_t N>
    constexpr bool text(const BoundedString<N>& string) noexcept {
        const auto length = static_cast<std::int32_t>(string.size() + 1U);
        return run(&length, 1U) && run(string.c_str(), string.size() + 1U);
    }
    constexpr std::size_t get_position() const noexcept { return position_; }

  private:
    Span<std::byte> buffer_;
    std::size_t position_{0U};
};

/// Reads an untrusted buffer and checks every octet. With kStores = false, it only checks.
template <bool kStores>
class LcmReader final {
  public:
    constexpr explicit LcmReader(Span<const std::byte> buffer, std::size_t position = 0U) noexcept
        : buffer_(buffer), position_(position) {}

    template <typename T>
    constexpr bool run([[maybe_unused]] T* first, std::size_t count) noexcept {
        constexpr std::size_t kSize = mamori::detail::calc_wire_size<T>();
        if (count > (buffer_.size() - position_) / kSize) {
            return false;
        }
        const std::byte* source = buffer_.data() + position_;
        position_ += count * kSize;
        bool is_valid = true;
        if constexpr (kStores || std::is_same_v<T, bool> || std::is_enum_v<T>) {
            for (std::size_t i = 0U; i < count; ++i) {
                const auto bits = mamori::detail::load<true, mamori::detail::WireBits<T>>(
                    source + i * kSize, std::make_index_sequence<kSize>{});
                is_valid = is_valid && mamori::detail::is_value<T>(bits);
                if constexpr (kStores) {
                    // A value is invalid here only if another context changes the buffer during the call.
                    first[i] = mamori::detail::from_bits<T>(is_valid ? bits : mamori::detail::WireBits<T>{0});
                }
            }
        }
        return is_valid;
    }
    template <typename Sequence>
    constexpr bool open(Sequence& sequence, std::size_t& count) noexcept {
        std::uint32_t length = 0U;
        if (!read_length(length) || length > Sequence::capacity()) {
            return false;
        }
        count = length;
        if constexpr (kStores) {
            return sequence.resize(count) == Status::kOk;
        }
        return true;
    }
    /// The length includes the terminating NUL, which must be the last and only NUL.
    template <typename String>
    constexpr bool text(String& string) noexcept {
        std::uint32_t length = 0U;
        if (!read_length(length) || length == 0U || length > String::capacity() + 1U ||
            length > buffer_.size() - position_ || buffer_.data()[position_ + length - 1U] != std::byte{0}) {
            return false;
        }
        bool is_valid = true;
        if constexpr (kStores) {
            string.clear();
        }
        for (std::size_t i = 0U; is_valid && i + 1U < length; ++i) {
            const std::byte character = buffer_.data()[position_ + i];
            is_valid = character != std::byte{0};
            if constexpr (kStores) {
                is_valid = string.push_back(static_cast<char>(character)) == Status::kOk;
            }
        }
        position_ += length;
        return is_valid;
    }
    constexpr std::size_t get_position() const noexcept { return position_; }

  private:
    /// A negative length is a large unsigned one, which no capacity allows.
    constexpr bool read_length(std::uint32_t& length) noexcept {
        LcmReader<true> reader(buffer_, position_);
        const bool is_there = reader.run(&length, 1U);
        position_ = reader.get_position();
        return is_there;
    }

    Span<const std::byte> buffer_;
    std::size_t position_;  ///< never after the end of the buffer
};

/// Checks before it stores, so that `value` is unchanged after a rejection.
template <typename T>
constexpr bool read_body(Span<const std::byte> body, T& value) noexcept {
    LcmReader<false> look(body);
    LcmReader<true> take(body);
    return mamori::detail::walk(value, look) && look.get_position() == body.size() &&
           mamori::detail::walk(value, take);
}

/// Writes fingerprint and fields of `value`, with `gap` octets between them that do not change.
template <typename T>
constexpr Result<std::size_t> write_message(const T& value, std::uint64_t fingerprint, std::size_t gap,
                                            Span<std::byte> buffer) noexcept {
    LcmMeter meter;
    if (!mamori::detail::walk(value, meter)) {
        return Status::kBadParameter;
    }
    const std::size_t begin = kFingerprintSize + gap;
    if (buffer.size() < begin || buffer.size() - begin < meter.get_position()) {
        return Status::kOutOfResources;
    }
    LcmWriter head(buffer);
    static_cast<void>(head.run(&fingerprint, 1U));
    LcmWriter writer(buffer.subspan(begin, meter.get_position()));
    static_cast<void>(mamori::detail::walk(value, writer));
    return begin + meter.get_position();
}

/// @return the fingerprint at the begin of `message`, which has at least kFingerprintSize octets.
constexpr std::uint64_t read_fingerprint(Span<const std::byte> message) noexcept {
    return mamori::detail::load<true, std::uint64_t>(message.subspan(0U, kFingerprintSize).data(),
                                                     std::make_index_sequence<kFingerprintSize>{});
}

}  // namespace detail

/// Shortest and longest LCM message of T, fingerprint included [byte].
template <typename T>
inline constexpr std::size_t kLcmSizeMin = kFingerprintSize + detail::calc_body_size<T, false>();
template <typename T>
inline constexpr std::size_t kLcmSizeMax = kFingerprintSize + detail::calc_body_size<T, true>();

/// Encodes `value` into the first octets of `buffer`; octets after the message do not change. Thread safe on
/// separate objects, O(size of the message), no memory.
/// @param[out] buffer kLcmSizeMax<T> octets are always sufficient; must not overlap `value`.
/// @return octets written; kOutOfResources (buffer too small) and kBadParameter (an enumeration has a value
///         that is not an enumerator), both with the buffer unchanged.
template <typename T>
constexpr Result<std::size_t> encode_lcm(const T& value, Span<std::byte> buffer) noexcept {
    return detail::write_message(value, kLcmFingerprint<T>, 0U, buffer);
}

/// Decodes all octets of `message`, which may have any content: no octet outside of it is read. Thread safe
/// on separate objects, O(size of the message), no memory.
/// @param[in] message must not change during the call; must not overlap `value`.
/// @param[in,out] value unchanged on any code except kOk.
/// @return kOk; kUnsupported: another fingerprint, so a message of another type; kBadParameter: truncated or
///         too long, a sequence or string beyond its bound, a string without its only NUL at its end, a
///         boolean that is neither 0 nor 1, or the value of an enumeration that is not an enumerator.
template <typename T>
constexpr Status decode_lcm(Span<const std::byte> message, T& value) noexcept {
    if (message.size() < kFingerprintSize) {
        return Status::kBadParameter;
    }
    if (detail::read_fingerprint(message) != kLcmFingerprint<T>) {
        return Status::kUnsupported;
    }
    const bool is_read =
        detail::read_body(message.subspan(kFingerprintSize, message.size() - kFingerprintSize), value);
    return is_read ? Status::kOk : Status::kBadParameter;
}

}  // namespace mamori::ports::lcm

#endif  // MAMORI_PORTS_LCM_CODEC_HPP
