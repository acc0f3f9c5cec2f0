// SPDX-License-Identifier: Apache-2.0
// Goal: the hash is FNV-1a over the values in little-endian order and over nothing else.
// Method: published FNV vectors; payloads that differ in padding only, in one bit, in order.
#include "mamori/kernel/payload/trace_hash.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <string>

#include "mamori/trace/verifies.hpp"

namespace mamori {
namespace {

struct Padded {
    std::uint8_t small;  // seven bytes of padding follow
    double large;
};
enum class Colour : std::uint16_t { kRed = 0x0201 };

}  // namespace
}  // namespace mamori
MAMORI_FIELDS(mamori::Padded, small, large)

namespace mamori {
namespace {

using namespace verification;

std::uint64_t hash_text(const std::string& text) {
    TraceHash hash;
    for (const char letter : text) {
        hash(letter);
    }
    return hash.get_value();
}

template <typename T>
std::uint64_t hash_of(const T& payload) {
    TraceHash hash;
    hash.add(payload);
    return hash.get_value();
}

TEST(TraceHashTest, KnownFnvVectorsAreMet) {
    verifies("SWR-KRN-006", Technique::kBackToBack);

    EXPECT_EQ(hash_text(""), 0xCBF29CE484222325U);
    EXPECT_EQ(hash_text("a"), 0xAF63DC4C8601EC8CU);
    EXPECT_EQ(hash_text("foobar"), 0x85944171F73967E8U);
}

TEST(TraceHashTest, NumbersAreTakenInLittleEndianOrderWithTheirOwnSize) {
    verifies("SWR-KRN-006");

    EXPECT_EQ(hash_of(std::uint32_t{0x64636261U}), hash_text("abcd"));
    EXPECT_EQ(hash_of(std::uint8_t{0x61U}), hash_text("a"));
    EXPECT_EQ(hash_of(std::int16_t{-1}), hash_text("\xFF\xFF"));
    EXPECT_EQ(hash_of(Colour::kRed), hash_text("\x01\x02"));
    EXPECT_EQ(hash_of(true), hash_text("\x01"));
    EXPECT_EQ(hash_of(1.0F), hash_text(std::string("\x00\x00\x80\x3F", 4)));
    EXPECT_EQ(hash_of(1.0), hash_text(std::string("\x00\x00\x00\x00\x00\x00\xF0\x3F", 8)));
}

TEST(TraceHashTest, PaddingBytesDoNotTakePart) {
    verifies("SWR-KRN-006", Technique::kErrorGuessing);
    Padded first;
    Padded second;
    std::memset(&first, 0x00, sizeof first);
    std::memset(&second, 0xFF, sizeof second);
    first.small = 1U;
    second.small = 1U;
    first.large = 2.0;
    second.large = 2.0;

    ASSERT_NE(std::memcmp(&first, &second, sizeof first), 0);
    EXPECT_EQ(hash_of(first), hash_of(second));
}

TEST(TraceHashTest, ElementsThatAreNotInUseDoNotTakePart) {
    verifies("SWR-CDR-004", Technique::kErrorGuessing, Polarity::kViolation);
    BoundedSequence<std::uint8_t, 4> shrunk = std::array<std::uint8_t, 3>{1U, 2U, 3U};
    BoundedString<4> cut = "abc";

    ASSERT_EQ(shrunk.resize(1U), Status::kOk);
    ASSERT_EQ(cut.assign(Span<const char>("abc", 1U)), Status::kOk);

    EXPECT_EQ(hash_of(shrunk), hash_of(BoundedSequence<std::uint8_t, 4>(std::array<std::uint8_t, 1>{1U})));
    EXPECT_EQ(hash_of(shrunk), hash_text(std::string("\x01\x00\x00\x00\x01", 5)));
    EXPECT_EQ(hash_of(cut), hash_of(BoundedString<4>("a")));
}

TEST(TraceHashTest, TheLengthOfASequenceCounts) {
    verifies("SWR-CDR-004", Technique::kErrorGuessing);
    using Two = std::array<BoundedSequence<std::uint8_t, 2>, 2>;
    const Two first{{std::array<std::uint8_t, 2>{1U, 2U}, {}}};
    const Two second{{std::array<std::uint8_t, 1>{1U}, std::array<std::uint8_t, 1>{2U}}};

    EXPECT_NE(hash_of(first), hash_of(second));
}

TEST(TraceHashTest, EveryBitOfAValueCounts) {
    verifies("SWR-KRN-006", Technique::kErrorGuessing);

    EXPECT_NE(hash_of(0.0), hash_of(-0.0));
    EXPECT_NE(hash_of(1.0), hash_of(1.0 + 2.3e-16));
    EXPECT_NE(hash_of(std::array<std::int32_t, 2>{1, 2}), hash_of(std::array<std::int32_t, 2>{2, 1}));
    EXPECT_NE(hash_of(std::int32_t{1}), hash_of(std::int64_t{1}));
    EXPECT_EQ(hash_of(std::array<std::int32_t, 0>{}), hash_text(""));
}

TEST(TraceHashTest, IsAConstantExpression) {
    verifies("SWR-KRN-006", Technique::kInterface);
    constexpr auto kHash = [] {
        TraceHash hash;
        hash.add(Padded{1U, 2.0});
        return hash.get_value();
    }();

    EXPECT_EQ(kHash, hash_of(Padded{1U, 2.0}));
}

}  // namespace
}  // namespace mamori
