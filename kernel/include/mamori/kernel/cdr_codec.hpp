// SPDX-License-Identifier: Apache-2.0
/// @file
/// The visitors behind cdr.hpp: measuring, writing and reading of one payload. Not for users.
///
/// @satisfies SWR-CDR-010, SWR-CDR-013      Design: docs/design/payloads.md#cdr
#ifndef MAMORI_KERNEL_CDR_CODEC_HPP
#define MAMORI_KERNEL_CDR_CODEC_HPP

#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include "mamori/kernel/assert.hpp"
#include "mamori/kernel/cdr_size.hpp"
#include "mamori/kernel/span.hpp"

namespace mamori::detail {

/// Unsigned number with as many bits as T has on the wire.
template <typename T>
using WireBits = std::conditional_t<
    calc_wire_size<T>() == 8U, std::uint64_t,
    std::conditional_t<calc_wire_size<T>() == 4U, std::uint32_t,
                       std::conditional_t<calc_wire_size<T>() == 2U, std::uint16_t, std::uint8_t>>>;

template <typename T>
constexpr WireBits<T> to_bits(T value) noexcept {
    if constexpr (std::is_floating_point_v<T>) {
        return __builtin_bit_cast(WireBits<T>, value);
    } else {
        return static_cast<WireBits<T>>(value);
    }
}
template <typename T>
constexpr T from_bits(WireBits<T> bits) noexcept {
    if constexpr (std::is_floating_point_v<T>) {
        return __builtin_bit_cast(T, bits);
    } else {
        return static_cast<T>(bits);
    }
}
/// Is this a value of T? Every pattern of a number is; of booleans and enumerations only the declared ones.
template <typename T>
constexpr bool is_value(WireBits<T> bits) noexcept {
    if constexpr (std::is_same_v<T, bool>) {
        return bits <= 1U;
    } else if constexpr (std::is_enum_v<T>) {
        return bits < Enumerators<T>::kCount;
    } else {
        return true;
    }
}

/// Bytes of a number, spelled out rather than looped over, so that compilers make one load or store of them.
template <bool kIsBig, typename Bits, std::size_t... kIndex>
constexpr void store(std::byte* target, Bits bits, std::index_sequence<kIndex...> /*bytes*/) noexcept {
    constexpr std::size_t kLast = sizeof(Bits) - 1U;
    ((target[kIsBig ? kLast - kIndex : kIndex] =
          static_cast<std::byte>(static_cast<std::uint64_t>(bits) >> (8U * kIndex))),
     ...);
}
template <bool kIsBig, typename Bits, std::size_t... kIndex>
constexpr Bits load(const std::byte* source, std::index_sequence<kIndex...> /*bytes*/) noexcept {
    constexpr std::size_t kLast = sizeof(Bits) - 1U;
    return static_cast<Bits>(
        ((std::to_integer<std::uint64_t>(source[kIsBig ? kLast - kIndex : kIndex]) << (8U * kIndex)) | ...));
}

/// Counts the bytes that the writer will write. False when a value has no encoding: no reader would take it.
class CdrMeter final {
  public:
    template <typename T>
    constexpr bool run([[maybe_unused]] const T* first, std::size_t count) noexcept {
        bool is_valid = true;
        if constexpr (std::is_enum_v<T>) {
            for (std::size_t i = 0U; is_valid && i < count; ++i) {
                is_valid = is_value<T>(to_bits(first[i]));
            }
        }
        count_bytes(calc_wire_size<T>(), count);
        return is_valid;
    }
    template <typename Sequence>
    constexpr bool open(const Sequence& sequence, std::size_t& count) noexcept {
        count = sequence.size();
        count_bytes(sizeof(std::uint32_t), 1U);
        return true;
    }
    template <std::size_t N>
    constexpr bool text(const BoundedString<N>& string) noexcept {
        count_bytes(sizeof(std::uint32_t), 1U);
        count_bytes(sizeof(char), string.size() + 1U);
        return true;
    }
    constexpr std::size_t get_position() const noexcept { return position_; }

  private:
    /// Nothing is aligned where nothing follows: an empty sequence ends behind its length.
    constexpr void count_bytes(std::size_t size, std::size_t count) noexcept {
        if (count > 0U) {
            position_ = align_up(position_, size) + count * size;
        }
    }

    std::size_t position_{0U};
};

/// Writes into a buffer that was measured before; padding is zero.
template <bool kIsBig>
class CdrWriter final {
  public:
    constexpr explicit CdrWriter(Span<std::byte> buffer) noexcept : buffer_(buffer) {}

    template <typename T>
    constexpr bool run(const T* first, std::size_t count) noexcept {
        constexpr std::size_t kSize = calc_wire_size<T>();
        if (count > 0U) {
            const std::size_t start = align_up(position_, kSize);
            MAMORI_REQUIRE(1, start <= buffer_.size() && count <= (buffer_.size() - start) / kSize);
            for (std::size_t i = position_; i < start; ++i) {
                buffer_.data()[i] = std::byte{0};
            }
            for (std::size_t i = 0U; i < count; ++i) {
                store<kIsBig>(buffer_.data() + start + i * kSize, to_bits(first[i]),
                              std::make_index_sequence<kSize>{});
            }
            position_ = start + count * kSize;
        }
        return true;
    }
    template <typename Sequence>
    constexpr bool open(const Sequence& sequence, std::size_t& count) noexcept {
        count = sequence.size();
        const std::uint32_t length = static_cast<std::uint32_t>(count);
        return run(&length, 1U);
    }
    template <std::size_t N>
    constexpr bool text(const BoundedString<N>& string) noexcept {
        const std::uint32_t length = static_cast<std::uint32_t>(string.size() + 1U);
        return run(&length, 1U) && run(string.c_str(), string.size() + 1U);
    }
    constexpr std::size_t get_position() const noexcept { return position_; }

  private:
    Span<std::byte> buffer_;
    std::size_t position_{0U};
};

/// Reads from a buffer of foreign origin and trusts no byte of it: true means that everything was there and
/// allowed. kStores = false only looks, and uses the payload as a pattern of the types to come.
template <bool kIsBig, bool kStores>
class CdrReader final {
  public:
    constexpr explicit CdrReader(Span<const std::byte> buffer, std::size_t position = 0U) noexcept
        : buffer_(buffer), position_(position) {}

    template <typename T>
    constexpr bool run(T* first, std::size_t count) noexcept {
        constexpr std::size_t kSize = calc_wire_size<T>();
        if (count == 0U) {
            return true;
        }
        const std::size_t start = align_up(position_, kSize);
        if (start > buffer_.size() || count > (buffer_.size() - start) / kSize) {
            return false;
        }
        bool is_valid = true;
        if constexpr (kStores || std::is_same_v<T, bool> || std::is_enum_v<T>) {
            for (std::size_t i = 0U; i < count; ++i) {
                const auto bits = load<kIsBig, WireBits<T>>(buffer_.data() + start + i * kSize,
                                                            std::make_index_sequence<kSize>{});
                is_valid = is_valid && is_value<T>(bits);
                if constexpr (kStores) {
                    // A wrong value can come here only when somebody changes the buffer meanwhile.
                    first[i] = from_bits<T>(is_valid ? bits : WireBits<T>{0});
                }
            }
        }
        position_ = start + count * kSize;
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
    /// The length counts the closing NUL, which must be there, and there alone.
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
    /// A length is needed even where nothing is stored.
    constexpr bool read_length(std::uint32_t& length) noexcept {
        CdrReader<kIsBig, true> reader(buffer_, position_);
        const bool is_there = reader.run(&length, 1U);
        position_ = reader.get_position();
        return is_there;
    }

    Span<const std::byte> buffer_;
    std::size_t position_;  ///< never beyond the end of the buffer
};

}  // namespace mamori::detail

#endif  // MAMORI_KERNEL_CDR_CODEC_HPP
