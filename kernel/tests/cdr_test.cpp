// SPDX-License-Identifier: Apache-2.0
// Goal: payloads are written as CDR and read back, in both byte orders.
// Method: bytes worked out by hand from the rules of alignment, for each kind of field and each kind of
// nesting.
#include "mamori/kernel/payload/cdr.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "mamori/kernel/payload/timed_types.hpp"
#include "mamori/trace/verifies.hpp"
#include "support/cdr_checks.hpp"

namespace mamori {
namespace {

enum class Mode : std::uint8_t { kIdle, kRun, kStop };

/// Every width, so that padding of 1 to 7 bytes occurs.
struct Mixed {
    std::uint8_t octet{0U};
    std::int16_t whole{0};
    bool flag{false};
    std::uint64_t huge{0U};
    char letter{'\0'};
    float small{0.0F};
    std::int8_t tiny{0};
    double real{0.0};
};
struct Nested {
    char first{'\0'};
    std::array<BoundedSequence<std::int16_t, 2>, 2> rows{};
    BoundedSequence<BoundedString<3>, 2> names{};
    std::array<Mode, 2> modes{};
    BoundedSequence<Mixed, 2> parts{};
};
struct Plain {
    std::uint32_t number{0U};
    Mode mode{Mode::kIdle};
};

}  // namespace
}  // namespace mamori
MAMORI_LAST_ENUMERATOR(mamori::Mode, kStop)
MAMORI_FIELDS(mamori::Mixed, octet, whole, flag, huge, letter, small, tiny, real)
MAMORI_FIELDS(mamori::Nested, first, rows, names, modes, parts)
MAMORI_FIELDS(mamori::Plain, number, mode)

namespace mamori {
namespace {

using cdr_checks::Bytes;
using cdr_checks::encode_exactly;
using cdr_checks::from_hex;
using cdr_checks::to_hex;
using cdr_checks::view;
using namespace verification;

const Mixed kMixed{0x12U, -2, true, 0x0102030405060708U, 'A', 1.5F, -1, -2.0};
const std::string kMixedLittle =
    "12 00 feff 01 000000 0807060504030201 41 000000 0000c03f ff 00000000000000 00000000000000c0";
const std::string kMixedBig =
    "12 00 fffe 01 000000 0102030405060708 41 000000 3fc00000 ff 00000000000000 c000000000000000";

Nested make_nested() {
    Nested nested;
    nested.first = 'N';
    nested.rows = {{std::array<std::int16_t, 1>{1}, {}}};
    nested.names = std::array<BoundedString<3>, 2>{"", "xyz"};
    nested.modes = {Mode::kStop, Mode::kIdle};
    nested.parts = std::array<Mixed, 1>{kMixed};
    return nested;
}
// The part starts at byte 48, a multiple of 8, so it lies as it does alone.
const std::string kNestedLittle =
    "4e 000000 01000000 0100 0000 00000000"  // rows
    "02000000 01000000 00 000000 04000000 78797a00"
    "02000000 00000000 01000000" +
    kMixedLittle;
const std::string kNestedBig =
    "4e 000000 00000001 0001 0000 00000000"
    "00000002 00000001 00 000000 00000004 78797a00"
    "00000002 00000000 00000001" +
    kMixedBig;

TEST(CdrTest, EveryWidthIsAlignedToItselfWithZeroesBetween) {
    verifies("SWR-CDR-010");

    EXPECT_EQ(to_hex(encode_exactly(kMixed, ByteOrder::kLittle)), to_hex(from_hex(kMixedLittle)));
    EXPECT_EQ(to_hex(encode_exactly(kMixed, ByteOrder::kBig)), to_hex(from_hex(kMixedBig)));
}

TEST(CdrTest, NestedPartsAreWrittenOneAfterTheOther) {
    verifies("SWR-CDR-010");

    EXPECT_EQ(to_hex(encode_exactly(make_nested(), ByteOrder::kLittle)), to_hex(from_hex(kNestedLittle)));
    EXPECT_EQ(to_hex(encode_exactly(make_nested(), ByteOrder::kBig)), to_hex(from_hex(kNestedBig)));
}

TEST(CdrTest, AnEmptySequenceEndsBehindItsLength) {
    verifies("SWR-CDR-010", Technique::kBoundaryValues);
    const rtc::TimedDoubleSeq<2> empty{{1U, 2U}, {}};

    EXPECT_EQ(to_hex(encode_exactly(empty, ByteOrder::kLittle)), "010000000200000000000000");
    EXPECT_EQ(to_hex(encode_exactly(rtc::TimedString<3>{{1U, 2U}, ""}, ByteOrder::kBig)),
              "00000001000000020000000100");
    EXPECT_EQ(encode_exactly(std::array<double, 0>{}, ByteOrder::kBig).size(), 0U);
}

TEST(CdrTest, ElementsThatAreNotInUseAreNotWritten) {
    verifies("SWR-CDR-004", Technique::kErrorGuessing);
    rtc::TimedOctetSeq<4> sample{{}, std::array<std::uint8_t, 3>{1U, 2U, 3U}};
    ASSERT_EQ(sample.data.resize(1U), Status::kOk);

    EXPECT_EQ(to_hex(encode_exactly(sample, ByteOrder::kLittle)), "00000000000000000100000001");
}

TEST(CdrTest, WhatWasWrittenIsReadBack) {
    verifies("SWR-CDR-012");

    cdr_checks::expect_decodes<Mixed>(from_hex(kMixedLittle), ByteOrder::kLittle, from_hex(kMixedLittle));
    cdr_checks::expect_decodes<Mixed>(from_hex(kMixedBig), ByteOrder::kBig, from_hex(kMixedBig));
    cdr_checks::expect_decodes<Nested>(from_hex(kNestedLittle), ByteOrder::kLittle, from_hex(kNestedLittle));
    cdr_checks::expect_decodes<Nested>(from_hex(kNestedBig), ByteOrder::kBig, from_hex(kNestedBig));
}

TEST(CdrTest, FieldsGetTheValuesOfTheirPlaces) {
    verifies("SWR-CDR-012");
    Nested nested;

    ASSERT_EQ(decode(view(from_hex(kNestedBig)), ByteOrder::kBig, nested), Status::kOk);

    EXPECT_EQ(nested.first, 'N');
    EXPECT_EQ(nested.rows[0].size(), 1U);
    EXPECT_EQ(nested.rows[0][0], 1);
    EXPECT_TRUE(nested.rows[1].empty());
    EXPECT_TRUE(nested.names[0] == "");
    EXPECT_TRUE(nested.names[1] == "xyz");
    EXPECT_EQ(nested.modes[0], Mode::kStop);
    EXPECT_EQ(nested.parts[0].octet, 0x12U);
    EXPECT_EQ(nested.parts[0].whole, -2);
    EXPECT_TRUE(nested.parts[0].flag);
    EXPECT_EQ(nested.parts[0].huge, 0x0102030405060708U);
    EXPECT_EQ(nested.parts[0].letter, 'A');
    EXPECT_EQ(nested.parts[0].small, 1.5F);
    EXPECT_EQ(nested.parts[0].tiny, -1);
    EXPECT_EQ(nested.parts[0].real, -2.0);
}

TEST(CdrTest, AValueReplacesALongerAndAShorterOne) {
    verifies("SWR-CDR-012", Technique::kErrorGuessing);
    rtc::TimedStringSeq<3, 4> sut;
    const rtc::TimedStringSeq<3, 4> longer{{1U, 2U}, std::array<BoundedString<4>, 3>{"abcd", "", "e"}};
    const rtc::TimedStringSeq<3, 4> shorter{{3U, 4U}, std::array<BoundedString<4>, 1>{"f"}};

    for (const auto& value : {longer, shorter, longer}) {
        ASSERT_EQ(decode(view(encode_exactly(value, ByteOrder::kBig)), ByteOrder::kBig, sut), Status::kOk);
        EXPECT_TRUE(sut.data == value.data);
    }
}

TEST(CdrTest, AnEmptySequenceIsReadBackWhereverItStands) {
    verifies("SWR-CDR-012", Technique::kBoundaryValues);
    using Rows = std::array<BoundedSequence<double, 1>, 3>;
    const Bytes rows = from_hex("00000000 00000001 3ff0000000000000 00000000");

    cdr_checks::expect_decodes<Rows>(rows, ByteOrder::kBig, rows);
    cdr_checks::expect_decodes<std::array<double, 0>>({}, ByteOrder::kBig, {});
}

TEST(CdrTest, PaddingIsIgnored) {
    verifies("SWR-CDR-012", Technique::kErrorGuessing);
    Bytes bytes = from_hex(kMixedBig);

    for (const std::size_t padding : {1U, 5U, 6U, 7U, 17U, 18U, 19U, 25U, 26U, 27U, 28U, 29U, 30U, 31U}) {
        bytes[padding] = std::byte{0xA5};
    }
    cdr_checks::expect_decodes<Mixed>(bytes, ByteOrder::kBig, from_hex(kMixedBig));
}

TEST(CdrTest, EveryBitOfANumberGoesThrough) {
    verifies("SWR-CDR-012", Technique::kBoundaryValues);
    const double not_a_number = __builtin_bit_cast(double, std::uint64_t{0x7FF4000000000001U});

    for (const double value : {0.0, -0.0, std::numeric_limits<double>::infinity(), 4.9e-324, not_a_number}) {
        for (const ByteOrder order : {ByteOrder::kLittle, ByteOrder::kBig}) {
            double decoded = 1.0;
            ASSERT_EQ(decode(view(encode_exactly(value, order)), order, decoded), Status::kOk);
            EXPECT_EQ(__builtin_bit_cast(std::uint64_t, decoded), __builtin_bit_cast(std::uint64_t, value));
        }
    }
}

TEST(CdrTest, IsAConstantExpression) {
    verifies("SWR-CDR-012", Technique::kInterface);
    constexpr bool kIsRoundTrip = [] {
        std::array<std::byte, max_encoded_size<Plain>()> buffer{};
        Plain decoded;
        const auto size = encode(Plain{7U, Mode::kRun}, buffer, ByteOrder::kBig);
        return size.get_value() == 8U && decode(buffer, ByteOrder::kBig, decoded) == Status::kOk &&
               decoded.number == 7U && decoded.mode == Mode::kRun;
    }();

    EXPECT_TRUE(kIsRoundTrip);
}

TEST(CdrTest, TheBufferMayHaveRoomToSpare) {
    verifies("SWR-CDR-011", Technique::kBoundaryValues);
    std::array<std::byte, 12> buffer{};
    buffer.fill(std::byte{0xEE});

    EXPECT_EQ(encode(Plain{1U, Mode::kRun}, buffer, ByteOrder::kBig).get_value(), 8U);
    EXPECT_EQ(to_hex(Bytes(buffer.begin(), buffer.end())), "0000000100000001eeeeeeee");
}

TEST(CdrTest, ABufferThatIsTooSmallIsNotTouched) {
    verifies("SWR-CDR-011", Technique::kBoundaryValues, Polarity::kViolation);
    const Bytes whole = encode_exactly(make_nested(), ByteOrder::kBig);

    for (std::size_t size = 0U; size < whole.size(); ++size) {
        Bytes buffer(size, std::byte{0xEE});
        const auto written =
            encode(make_nested(), Span<std::byte>(buffer.data(), buffer.size()), ByteOrder::kBig);
        EXPECT_EQ(written.get_status(), Status::kOutOfResources) << size;
        EXPECT_EQ(buffer, Bytes(size, std::byte{0xEE})) << size;
    }
}

TEST(CdrTest, AnEnumerationIsAnUnsignedLongWhateverItsOwnWidth) {
    verifies("SWR-CDR-015");

    EXPECT_EQ(to_hex(encode_exactly(Mode::kStop, ByteOrder::kBig)), "00000002");
    EXPECT_EQ(max_encoded_size<Plain>(), 8U);
}

TEST(CdrTest, AnEnumerationWithoutAnEnumeratorOfItsOwnIsRefusedBothWays) {
    verifies("SWR-CDR-015", Technique::kBoundaryValues, Polarity::kViolation);
    std::array<std::byte, 8> buffer{};
    const Plain witness{5U, Mode::kRun};

    EXPECT_EQ(encode(Plain{1U, static_cast<Mode>(3)}, buffer, ByteOrder::kBig).get_status(),
              Status::kBadParameter);
    EXPECT_EQ(calc_encoded_size(Plain{1U, static_cast<Mode>(255)}).get_status(), Status::kBadParameter);
    EXPECT_EQ(buffer, (std::array<std::byte, 8>{}));
    cdr_checks::expect_decodes<Plain>(from_hex("00000001 00000002"), ByteOrder::kBig,
                                      from_hex("0000000100000002"));
    for (const char* bytes : {"00000001 00000003", "00000001 00000102", "00000001 ffffffff"}) {
        cdr_checks::expect_refused(from_hex(bytes), ByteOrder::kBig, witness);
    }
}

TEST(CdrTest, TheLargestSizeIsThatOfTheLongestValue) {
    verifies("SWR-CDR-014", Technique::kBoundaryValues);
    Nested longest;
    longest.rows = {{std::array<std::int16_t, 2>{1, 2}, std::array<std::int16_t, 2>{3, 4}}};
    longest.names = std::array<BoundedString<3>, 2>{"abc", "def"};
    longest.parts = std::array<Mixed, 2>{kMixed, kMixed};

    EXPECT_EQ(max_encoded_size<Nested>(), encode_exactly(longest, ByteOrder::kBig).size());
    EXPECT_EQ(max_encoded_size<Mixed>(), from_hex(kMixedBig).size());
    EXPECT_EQ((max_encoded_size<std::array<Mixed, 3>>()),
              (encode_exactly(std::array<Mixed, 3>{}, ByteOrder::kBig).size()));
    EXPECT_EQ((max_encoded_size<std::array<double, 0>>()), 0U);
}

TEST(CdrTest, TheLargestSizeOfALongSequenceIsAConstant) {
    verifies("SWR-CDR-014", Technique::kErrorGuessing);
    constexpr std::size_t kCount = 3'000'001U;
    constexpr std::size_t kSize =
        max_encoded_size<BoundedSequence<std::array<BoundedString<4>, 1>, kCount>>();

    // A length and five bytes, and three bytes of padding before each but the first.
    EXPECT_EQ(kSize, 4U + 9U + (kCount - 1U) * 12U);
}

}  // namespace
}  // namespace mamori
