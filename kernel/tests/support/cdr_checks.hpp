// SPDX-License-Identifier: Apache-2.0
/// @file
/// Checks of CDR that several tests apply to vectors of different origin. Buffers are on the heap and of
/// exact size, so that the address sanitizer sees each access outside of them.
#ifndef MAMORI_KERNEL_TESTS_SUPPORT_CDR_CHECKS_HPP
#define MAMORI_KERNEL_TESTS_SUPPORT_CDR_CHECKS_HPP

#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <vector>

#include "mamori/kernel/payload/cdr.hpp"

namespace mamori::cdr_checks {

using Bytes = std::vector<std::byte>;

/// "01 02" -> two bytes; blanks are for the reader.
inline Bytes from_hex(const std::string& text) {
    Bytes bytes;
    std::string digits;
    for (const char digit : text) {
        if (digit != ' ') {
            digits += digit;
        }
        if (digits.size() == 2U) {
            bytes.push_back(static_cast<std::byte>(std::stoi(digits, nullptr, 16)));
            digits.clear();
        }
    }
    EXPECT_TRUE(digits.empty()) << "half a byte: " << text;
    return bytes;
}
inline std::string to_hex(const Bytes& bytes) {
    std::string text;
    for (const std::byte byte : bytes) {
        const auto value = std::to_integer<unsigned>(byte);
        text += "0123456789abcdef"[value / 16U];
        text += "0123456789abcdef"[value % 16U];
    }
    return text;
}
inline Span<const std::byte> view(const Bytes& bytes) {
    return {bytes.data(), bytes.size()};
}

/// The encoding of `value`, which must be possible and exactly as long as it was said to be.
template <typename T>
Bytes encode_exactly(const T& value, ByteOrder order) {
    const Result<std::size_t> size = calc_encoded_size(value);
    EXPECT_TRUE(size.has_value());
    Bytes bytes(size.get_value(), std::byte{0xEE});
    const Result<std::size_t> written = encode(value, Span<std::byte>(bytes.data(), bytes.size()), order);
    EXPECT_TRUE(written.has_value());
    EXPECT_EQ(written.get_value(), bytes.size());
    EXPECT_LE(bytes.size(), max_encoded_size<T>());
    return bytes;
}

/// `bytes` are decoded, and what they gave is encoded to `expected` again.
template <typename T>
void expect_decodes(const Bytes& bytes, ByteOrder order, const Bytes& expected) {
    T decoded{};
    ASSERT_EQ(decode(view(bytes), order, decoded), Status::kOk) << to_hex(bytes);
    EXPECT_EQ(to_hex(encode_exactly(decoded, order)), to_hex(expected));
}

/// `bytes` are refused and `witness` is as it was, to the last byte.
template <typename T>
void expect_refused(const Bytes& bytes, ByteOrder order, const T& witness) {
    T object;
    std::memcpy(&object, &witness, sizeof object);
    EXPECT_EQ(decode(view(bytes), order, object), Status::kBadParameter) << to_hex(bytes);
    EXPECT_EQ(std::memcmp(&object, &witness, sizeof object), 0) << to_hex(bytes);
}

/// Each beginning of `bytes`, and `bytes` with one more byte, is refused.
template <typename T>
void expect_only_whole_is_taken(const Bytes& bytes, ByteOrder order, const T& witness) {
    for (std::size_t size = 0U; size < bytes.size(); ++size) {
        expect_refused(Bytes(bytes.data(), bytes.data() + size), order, witness);
    }
    Bytes longer = bytes;
    longer.push_back(std::byte{0});
    longer.shrink_to_fit();
    expect_refused(longer, order, witness);
}

/// With any one bit turned over `bytes` are either refused without a change or give a value that has an
/// encoding.
/// @return how many of the changed encodings were taken.
template <typename T>
std::size_t count_taken_with_one_bit_turned(const Bytes& bytes, ByteOrder order, const T& witness) {
    std::size_t taken = 0U;
    for (std::size_t bit = 0U; bit < bytes.size() * 8U; ++bit) {
        Bytes changed = bytes;
        changed[bit / 8U] ^= static_cast<std::byte>(1U << (bit % 8U));
        T object;
        std::memcpy(&object, &witness, sizeof object);
        if (decode(view(changed), order, object) == Status::kOk) {
            EXPECT_EQ(encode_exactly(object, order).size(), changed.size());
            ++taken;
        } else {
            EXPECT_EQ(std::memcmp(&object, &witness, sizeof object), 0) << to_hex(changed);
        }
    }
    return taken;
}

}  // namespace mamori::cdr_checks

#endif  // MAMORI_KERNEL_TESTS_SUPPORT_CDR_CHECKS_HPP
