// SPDX-License-Identifier: Apache-2.0
/// @file
/// Visitor for decoding; checks every byte that it reads. Not for users.
///
/// @satisfies SWR-CDR-010, SWR-CDR-013      Design: docs/design/data_flow.md#cdr
#ifndef MAMORI_KERNEL_CDR_READER_HPP
#define MAMORI_KERNEL_CDR_READER_HPP

#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/status.hpp"
#include "mamori/kernel/payload/cdr_scalar.hpp"
#include "mamori/kernel/payload/fields.hpp"

namespace mamori::detail {

/// Number from its bytes, expanded instead of a loop, as in store().
template <bool kIsBig, typename Bits, std::size_t... kIndex>
constexpr Bits load(const std::byte* source, std::index_sequence<kIndex...> /*bytes*/) noexcept {
    constexpr std::size_t kLast = sizeof(Bits) - 1U;
    return static_cast<Bits>(
        ((std::to_integer<std::uint64_t>(source[kIsBig ? kLast - kIndex : kIndex]) << (8U * kIndex)) | ...));
}

/// Reads from an untrusted buffer and checks every byte: true means complete and valid. With kStores = false,
/// it only checks, and uses the payload only for the types of the expected data.
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
        const std::byte* source = buffer_.data() + start;
        position_ = start + count * kSize;
        if constexpr (kStores && kIsEncodedAsStored<kIsBig, T>) {
            if (!__builtin_is_constant_evaluated()) {
                __builtin_memcpy(first, source, count * kSize);
                return true;
            }
        }
        bool is_valid = true;
        if constexpr (kStores || std::is_same_v<T, bool> || std::is_enum_v<T>) {
            for (std::size_t i = 0U; i < count; ++i) {
                const auto bits =
                    load<kIsBig, WireBits<T>>(source + i * kSize, std::make_index_sequence<kSize>{});
                is_valid = is_valid && is_value<T>(bits);
                if constexpr (kStores) {
                    // A value is invalid here only if another context changes the buffer during the call.
                    first[i] = from_bits<T>(is_valid ? bits : WireBits<T>{0});
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
    /// The length is required even when nothing is stored.
    constexpr bool read_length(std::uint32_t& length) noexcept {
        CdrReader<kIsBig, true> reader(buffer_, position_);
        const bool is_there = reader.run(&length, 1U);
        position_ = reader.get_position();
        return is_there;
    }

    Span<const std::byte> buffer_;
    std::size_t position_;  ///< never after the end of the buffer
};

/// Checks before it stores, so that `value` is unchanged after a rejection, without a copy of `value`.
template <bool kIsBig, typename T>
constexpr bool read_cdr(Span<const std::byte> buffer, T& value) noexcept {
    CdrReader<kIsBig, false> look(buffer);
    CdrReader<kIsBig, true> take(buffer);
    return walk(value, look) && look.get_position() == buffer.size() && walk(value, take);
}

}  // namespace mamori::detail

#endif  // MAMORI_KERNEL_CDR_READER_HPP
