// SPDX-License-Identifier: Apache-2.0
/// @file
/// Visitors for encoding: one computes the size of a payload, the other writes it. Not for users.
///
/// @satisfies SWR-CDR-010, SWR-CDR-013      Design: docs/design/data_flow.md#cdr
#ifndef MAMORI_KERNEL_CDR_WRITER_HPP
#define MAMORI_KERNEL_CDR_WRITER_HPP

#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include "mamori/kernel/base/assert.hpp"
#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/payload/bounded_string.hpp"
#include "mamori/kernel/payload/cdr_scalar.hpp"
#include "mamori/kernel/payload/fields.hpp"

namespace mamori::detail {

/// Bytes of a number, expanded instead of a loop, so that compilers generate one load or store.
template <bool kIsBig, typename Bits, std::size_t... kIndex>
constexpr void store(std::byte* target, Bits bits, std::index_sequence<kIndex...> /*bytes*/) noexcept {
    constexpr std::size_t kLast = sizeof(Bits) - 1U;
    ((target[kIsBig ? kLast - kIndex : kIndex] =
          static_cast<std::byte>(static_cast<std::uint64_t>(bits) >> (8U * kIndex))),
     ...);
}

/// Bytes of a block of numbers. Copied at once where memory equals the encoding, except in constant
/// expressions.
template <bool kIsBig, typename T>
constexpr void store_block(std::byte* target, const T* first, std::size_t count) noexcept {
    if constexpr (kIsEncodedAsStored<kIsBig, T>) {
        if (!__builtin_is_constant_evaluated()) {
            __builtin_memcpy(target, first, count * sizeof(T));
            return;
        }
    }
    constexpr std::size_t kSize = calc_wire_size<T>();
    for (std::size_t i = 0U; i < count; ++i) {
        store<kIsBig>(target + i * kSize, to_bits(first[i]), std::make_index_sequence<kSize>{});
    }
}

/// Counts the bytes that the writer will write. False when a value has no encoding, because every reader
/// would reject it.
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
    /// Alignment applies only before data: an empty sequence ends after its length.
    constexpr void count_bytes(std::size_t size, std::size_t count) noexcept {
        if (count > 0U) {
            position_ = align_up(position_, size) + count * size;
        }
    }

    std::size_t position_{0U};
};

/// Writes into a buffer of the size computed before; padding is zero.
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
            store_block<kIsBig>(buffer_.data() + start, first, count);
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

template <bool kIsBig, typename T>
constexpr std::size_t write_cdr(const T& value, Span<std::byte> buffer) noexcept {
    CdrWriter<kIsBig> writer(buffer);
    static_cast<void>(walk(value, writer));
    return writer.get_position();
}

}  // namespace mamori::detail

#endif  // MAMORI_KERNEL_CDR_WRITER_HPP
