// SPDX-License-Identifier: Apache-2.0
// Goal: a malformed encoding is refused, leaves the object as it was, and is never read past its end.
// Method: each rule is broken by itself, on both sides of its limit; all beginnings and all single-bit
// changes of whole encodings; random bytes. Under the address sanitizer an access outside the buffer ends the
// test.
#include <gtest/gtest.h>

#include <cstdint>
#include <random>

#include "mamori/kernel/payload/cdr.hpp"
#include "mamori/kernel/payload/extended_types_3d.hpp"
#include "mamori/kernel/payload/timed_types.hpp"
#include "mamori/trace/verifies.hpp"
#include "support/cdr_checks.hpp"

namespace mamori {
namespace {

using cdr_checks::Bytes;
using cdr_checks::expect_decodes;
using cdr_checks::expect_refused;
using cdr_checks::from_hex;
using rtc::TimedBoolean;
using rtc::TimedBooleanSeq;
using rtc::TimedDoubleSeq;
using rtc::TimedPose3D;
using rtc::TimedString;
using rtc::TimedStringSeq;
using namespace verification;

constexpr auto kBig = ByteOrder::kBig;
constexpr auto kLittle = ByteOrder::kLittle;
const std::string kTime = "00000001 00000002";

constexpr TimedStringSeq<2, 4> kNames{{3U, 4U}, std::array<BoundedString<4>, 2>{"a", "bcde"}};
constexpr TimedDoubleSeq<2> kNumbers{{3U, 4U}, std::array{1.5, -2.5}};
constexpr TimedBooleanSeq<4> kFlags{{3U, 4U}, std::array{true, false, true}};

TEST(CdrRefusalTest, WholeEncodingsAreTaken) {
    verifies("SWR-CDR-013");

    expect_decodes<TimedString<3>>(from_hex(kTime + "00000004 61626300"), kBig,
                                   from_hex(kTime + "00000004 61626300"));
    expect_decodes<TimedBoolean>(from_hex(kTime + "01"), kBig, from_hex(kTime + "01"));
    expect_decodes<TimedBooleanSeq<2>>(from_hex(kTime + "00000002 0001"), kBig,
                                       from_hex(kTime + "00000002 0001"));
}

TEST(CdrRefusalTest, ASequenceLongerThanItsBoundIsRefused) {
    verifies("SWR-CDR-013", Technique::kBoundaryValues, Polarity::kViolation);

    expect_refused(from_hex(kTime + "00000005 0000000000"), kBig, kFlags);
    expect_refused(from_hex(kTime + "ffffffff"), kBig, kFlags);
    expect_refused(from_hex(kTime + "80000000"), kBig, kNumbers);
    expect_refused(from_hex(kTime + "00000003 00000001 00 000000 00000001 00 000000 00000001 00"), kBig,
                   kNames);
}

TEST(CdrRefusalTest, ASequenceThatPromisesMoreThanThereIsIsRefused) {
    verifies("SWR-CDR-013", Technique::kBoundaryValues, Polarity::kViolation);

    expect_refused(from_hex(kTime + "00000004 000000"), kBig, kFlags);
    expect_refused(from_hex(kTime + "00000002 00000000 3ff0000000000000 3ff00000000000"), kBig, kNumbers);
    expect_refused(from_hex(kTime + "00000001"), kBig, kNumbers);
    expect_refused(from_hex(kTime + "00000001 000000"), kBig, kNumbers);
    expect_refused(from_hex(kTime + "00000001 00000000"), kBig, kNumbers);
}

TEST(CdrRefusalTest, AStringWithoutItsClosingNulIsRefused) {
    verifies("SWR-CDR-013", Technique::kErrorGuessing, Polarity::kViolation);
    const TimedString<3> witness{{3U, 4U}, "xyz"};

    expect_refused(from_hex(kTime + "00000003 616263"), kBig, witness);
    expect_refused(from_hex(kTime + "00000001 61"), kBig, witness);
    expect_refused(from_hex(kTime + "00000000"), kBig, witness);
}

TEST(CdrRefusalTest, AStringWithANulInsideIsRefused) {
    verifies("SWR-CDR-013", Technique::kErrorGuessing, Polarity::kViolation);
    const TimedString<3> witness{{3U, 4U}, "xyz"};

    expect_refused(from_hex(kTime + "00000004 00626300"), kBig, witness);
    expect_refused(from_hex(kTime + "00000004 61620000"), kBig, witness);
    expect_refused(from_hex(kTime + "00000002 0000"), kBig, witness);
}

TEST(CdrRefusalTest, AStringLongerThanItsBoundOrThanTheBufferIsRefused) {
    verifies("SWR-CDR-013", Technique::kBoundaryValues, Polarity::kViolation);
    const TimedString<3> witness{{3U, 4U}, "xyz"};

    expect_refused(from_hex(kTime + "00000005 6162636400"), kBig, witness);
    expect_refused(from_hex(kTime + "00000004 616200"), kBig, witness);
    expect_refused(from_hex(kTime + "00000004"), kBig, witness);
    expect_refused(from_hex(kTime + "ffffffff 616200"), kBig, witness);
}

TEST(CdrRefusalTest, ABooleanThatIsNeitherZeroNorOneIsRefused) {
    verifies("SWR-CDR-013", Technique::kBoundaryValues, Polarity::kViolation);
    const TimedBoolean witness{{3U, 4U}, true};

    expect_refused(from_hex(kTime + "02"), kBig, witness);
    expect_refused(from_hex(kTime + "ff"), kBig, witness);
    expect_refused(from_hex(kTime + "00000003 000102"), kBig, kFlags);
    expect_refused(from_hex(kTime + "00000003 020100"), kBig, kFlags);
}

TEST(CdrRefusalTest, OnlyAWholeEncodingWithNothingBehindItIsTaken) {
    verifies("SWR-CDR-013", Technique::kBoundaryValues, Polarity::kViolation);

    for (const ByteOrder order : {kLittle, kBig}) {
        cdr_checks::expect_only_whole_is_taken(cdr_checks::encode_exactly(kNames, order), order, kNames);
        cdr_checks::expect_only_whole_is_taken(cdr_checks::encode_exactly(kNumbers, order), order, kNumbers);
        cdr_checks::expect_only_whole_is_taken(cdr_checks::encode_exactly(kFlags, order), order, kFlags);
    }
    expect_refused(from_hex("00"), kBig, std::array<double, 0>{});
}

/// The first kSize bytes of an encoding, in an array of that size. A compiler refuses a constant expression
/// that reads outside.
template <std::size_t kSize>
constexpr bool is_cut_refused() {
    std::array<std::byte, 29U> whole{};
    std::array<std::byte, kSize> cut{};
    TimedStringSeq<2, 4> names = kNames;
    const bool is_whole = encode(kNames, whole, kBig).get_value() == whole.size();
    for (std::size_t i = 0U; i < kSize; ++i) {
        cut[i] = whole[i];
    }
    return is_whole && decode(Span<const std::byte>(cut.data(), kSize), kBig, names) == Status::kBadParameter;
}
template <std::size_t... kSize>
constexpr bool is_each_cut_refused(std::index_sequence<kSize...> /*sizes*/) {
    return (is_cut_refused<kSize>() && ...);
}

TEST(CdrRefusalTest, NothingOutsideIsReadInAConstantExpression) {
    verifies("SWR-CDR-013", Technique::kInterface, Polarity::kViolation);
    constexpr bool kIsEachRefused = is_each_cut_refused(std::make_index_sequence<29U>{});

    EXPECT_TRUE(kIsEachRefused);
}

TEST(CdrRefusalTest, TheOtherByteOrderIsRefusedWhereItCanBeSeen) {
    verifies("SWR-CDR-013", Technique::kErrorGuessing, Polarity::kViolation);

    expect_refused(cdr_checks::encode_exactly(kNumbers, kBig), kLittle, kNumbers);
    expect_refused(cdr_checks::encode_exactly(kNames, kLittle), kBig, kNames);
}

TEST(CdrRefusalTest, OneWrongBitIsRefusedOrGivesAnotherValue) {
    verifies("SWR-CDR-013", Technique::kFaultInjection, Polarity::kViolation);

    // Time, numbers and padding take every bit; each bit of a length and all but the last of a boolean are
    // seen.
    EXPECT_EQ(cdr_checks::count_taken_with_one_bit_turned(cdr_checks::encode_exactly(kNumbers, kBig), kBig,
                                                          kNumbers),
              (8U + 4U + 16U) * 8U);
    EXPECT_EQ(cdr_checks::count_taken_with_one_bit_turned(cdr_checks::encode_exactly(kFlags, kLittle),
                                                          kLittle, kFlags),
              8U * 8U + 3U);
    static_cast<void>(
        cdr_checks::count_taken_with_one_bit_turned(cdr_checks::encode_exactly(kNames, kBig), kBig, kNames));
}

TEST(CdrRefusalTest, RandomBytesAreRefusedOrGiveAValueThatCanBeEncoded) {
    verifies("SWR-CDR-013", Technique::kFaultInjection, Polarity::kViolation);
    std::mt19937 random(20261121U);

    for (int round = 0; round < 20'000; ++round) {
        Bytes bytes(random() % 40U);
        for (std::byte& byte : bytes) {
            // Small numbers are frequent, or no length would ever fit.
            byte = static_cast<std::byte>(random() % 4U == 0U ? random() % 256U : random() % 3U);
        }
        TimedStringSeq<2, 4> names = kNames;
        if (decode(cdr_checks::view(bytes), kBig, names) == Status::kOk) {
            EXPECT_EQ(cdr_checks::encode_exactly(names, kBig).size(), bytes.size());
        } else {
            EXPECT_TRUE(names.data == kNames.data);
        }
    }
}

}  // namespace
}  // namespace mamori
