// SPDX-License-Identifier: Apache-2.0
// Goal: the bytes are those of docs/design/recorder.md on each machine, and no small damage passes for a
// record. Method: bytes that a script computed apart from this code; every change of up to four bits, by the
// linearity of the checksum; every single byte with every value.
#include "mamori/kernel/record/flight_format.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "mamori/kernel/base/crc32.hpp"
#include "mamori/trace/verifies.hpp"
#include "mamori/verification/failed_check.hpp"

namespace mamori::flight {
namespace {

using namespace verification;

constexpr FlightRecord kRecord{
    0x0102030405060708U, Instant{-2}, 0x1122334455667788, 0xA1A2A3A4U, 0xB1B2U, 0xC1C2U, Severity::kFault};
constexpr std::size_t kCapacity = 1000U;

RecordBytes encode_committed(const FlightRecord& record) {
    RecordBytes bytes = encode_record(record);
    bytes[kCommitOffset] = kCommitted;
    return bytes;
}

TEST(FlightFormatTest, ChecksumHasTheCheckValueOfItsCatalogue) {
    verifies("SWR-REC-001");
    Crc32 crc;
    EXPECT_EQ(crc.get_value(), 0U);

    for (const char character : std::string_view{"123456789"}) {
        crc.add(static_cast<std::uint8_t>(character));
    }
    EXPECT_EQ(crc.get_value(), 0xCBF43926U);
}

TEST(FlightFormatTest, BytesOfARecordAreThoseOfTheDesign) {
    verifies("SWR-REC-001", Technique::kBackToBack);
    const RecordBytes wanted{0x08U, 0x07U, 0x06U, 0x05U, 0x04U, 0x03U, 0x02U, 0x01U, 0xFEU, 0xFFU,
                             0xFFU, 0xFFU, 0xFFU, 0xFFU, 0xFFU, 0xFFU, 0x88U, 0x77U, 0x66U, 0x55U,
                             0x44U, 0x33U, 0x22U, 0x11U, 0xA4U, 0xA3U, 0xA2U, 0xA1U, 0xB2U, 0xB1U,
                             0xC2U, 0xC1U, 0x02U, 0x00U, 0x00U, 0xC3U, 0xFBU, 0x5BU, 0xB5U, 0x2DU};

    EXPECT_EQ(encode_committed(kRecord), wanted);
    FlightRecord read{};
    ASSERT_EQ(decode_record(wanted, calc_slot(kRecord.sequence, kCapacity), kCapacity, read),
              SlotState::kWhole);
    EXPECT_EQ(read.sequence, kRecord.sequence);
    EXPECT_EQ(read.time, kRecord.time);
    EXPECT_EQ(read.argument, kRecord.argument);
    EXPECT_EQ(read.session, kRecord.session);
    EXPECT_EQ(read.source, kRecord.source);
    EXPECT_EQ(read.code, kRecord.code);
    EXPECT_EQ(read.severity, kRecord.severity);
}

TEST(FlightFormatTest, BytesOfTheHeaderAreThoseOfTheDesign) {
    verifies("SWR-REC-001", Technique::kBackToBack);
    const std::array<std::uint8_t, 24U> fixed{0x89U, 0x4DU, 0x52U, 0x45U, 0x43U, 0x0DU, 0x0AU, 0x1AU,
                                              0x02U, 0x00U, 0x40U, 0x00U, 0x28U, 0x00U, 0x00U, 0x00U,
                                              0x03U, 0x00U, 0x00U, 0x00U, 0x90U, 0xE1U, 0xD9U, 0x33U};
    const SessionBytes session{0x05U, 0x00U, 0x00U, 0x00U, 0x00U, 0x00U, 0x00U, 0x00U,
                               0x02U, 0x00U, 0x00U, 0x00U, 0xF4U, 0x79U, 0x7FU, 0x49U};

    const HeaderBytes header = encode_header(3U);
    EXPECT_TRUE(std::equal(fixed.begin(), fixed.end(), header.begin()));
    EXPECT_TRUE(std::all_of(header.begin() + 24, header.end(), [](std::uint8_t byte) { return byte == 0U; }));
    EXPECT_EQ(encode_session({2U, 5U}), session);
    EXPECT_EQ(decode_session(session).number, 2U);
    EXPECT_EQ(decode_session(session).next_sequence, 5U);
}

TEST(FlightFormatTest, WhatDoesNotBeginLikeARecorderIsForeignWhateverVersionItShows) {
    verifies("SWR-REC-005", Technique::kFaultInjection, Polarity::kViolation);
    HeaderBytes newer = encode_header(3U);
    newer[kVersionOffset] = kVersion + 1U;
    ASSERT_EQ(check_header(newer, 3U), Status::kUnsupported);

    for (std::size_t i = 0U; i < kMagic.size(); ++i) {
        HeaderBytes bytes = newer;
        bytes[i] ^= 1U;
        EXPECT_EQ(check_header(bytes, 3U), Status::kError) << i;
    }
}

TEST(FlightFormatTest, SizesFollowTheCapacity) {
    verifies("SWR-REC-001", Technique::kBoundaryValues);
    EXPECT_EQ(calc_region_size(1U), 104U);
    EXPECT_EQ(calc_capacity(0U), 0U);
    EXPECT_EQ(calc_capacity(103U), 0U);
    EXPECT_EQ(calc_capacity(104U), 1U);
    EXPECT_EQ(calc_capacity(143U), 1U);
    EXPECT_EQ(calc_capacity(144U), 2U);
    EXPECT_EQ(calc_slot(1U, 3U), 0U);
    EXPECT_EQ(calc_slot(3U, 3U), 2U);
    EXPECT_EQ(calc_slot(4U, 3U), 0U);
}

TEST(FlightFormatTest, PlaceOfNoRecordOrInNoRingEndsInTheAssertion) {
    verifies("SWR-REC-005", Technique::kBoundaryValues, Polarity::kViolation);
    EXPECT_CHECK_FAILS(static_cast<void>(calc_slot(0U, 1U)), "flight_format.hpp", 1);
    EXPECT_CHECK_FAILS(static_cast<void>(calc_slot(1U, 0U)), "flight_format.hpp", 1);
    EXPECT_EQ(calc_slot(1U, 1U), 0U);
}

// A checksum is linear: a change of bits passes when the remainders of its bits cancel. No two pairs of bits
// have the same remainder, and no pair has that of a single bit or none, so no change of one to four bits
// passes.
TEST(FlightFormatTest, NoChangeOfUpToFourBitsOfARecordPasses) {
    verifies("SWR-REC-004", Technique::kFaultInjection, Polarity::kViolation);
    const auto calc_remainder = [](std::size_t bit) {
        if (bit >= 8U * kCommitOffset) {
            return std::uint32_t{1U} << (bit - 8U * kCommitOffset);  // a bit of the stored checksum itself
        }
        Crc32 zeros;
        Crc32 changed;
        for (std::size_t i = 0U; i < kCommitOffset; ++i) {
            zeros.add(0U);
            changed.add(i == bit / 8U ? static_cast<std::uint8_t>(1U << (bit % 8U)) : std::uint8_t{0U});
        }
        return zeros.get_value() ^ changed.get_value();
    };
    constexpr std::size_t kBits = 8U * (kRecordSize - 1U);
    std::vector<std::uint32_t> singles;
    for (std::size_t bit = 0U; bit < kBits; ++bit) {
        singles.push_back(calc_remainder(bit));
    }
    std::vector<std::uint32_t> sums{0U};
    sums.insert(sums.end(), singles.begin(), singles.end());
    for (std::size_t i = 0U; i < kBits; ++i) {
        for (std::size_t j = i + 1U; j < kBits; ++j) {
            sums.push_back(singles[i] ^ singles[j]);
        }
    }

    std::sort(sums.begin(), sums.end());
    EXPECT_EQ(std::adjacent_find(sums.begin(), sums.end()), sums.end());
}

TEST(FlightFormatTest, NoByteOfARecordCanTakeAnotherValueUnseen) {
    verifies("SWR-REC-004", Technique::kFaultInjection, Polarity::kViolation);
    const RecordBytes whole = encode_committed(kRecord);
    const std::size_t slot = calc_slot(kRecord.sequence, kCapacity);
    FlightRecord read{};

    for (std::size_t i = 0U; i < whole.size(); ++i) {
        for (unsigned change = 1U; change < 256U; ++change) {
            RecordBytes bytes = whole;
            bytes[i] = static_cast<std::uint8_t>(bytes[i] ^ change);
            const SlotState wanted =
                i == kCommitOffset && bytes[i] == 0U ? SlotState::kTorn : SlotState::kCorrupt;
            ASSERT_EQ(decode_record(bytes, slot, kCapacity, read), wanted) << i << " ^ " << change;
        }
    }
}

TEST(FlightFormatTest, WholeBytesInTheWrongPlaceAreNoRecord) {
    verifies("SWR-REC-004", Technique::kFaultInjection, Polarity::kViolation);
    const RecordBytes bytes = encode_committed(kRecord);
    const std::size_t slot = calc_slot(kRecord.sequence, kCapacity);
    FlightRecord read{};

    EXPECT_EQ(decode_record(bytes, slot, kCapacity, read), SlotState::kWhole);
    EXPECT_EQ(decode_record(bytes, slot + 1U, kCapacity, read), SlotState::kCorrupt);
}

TEST(FlightFormatTest, NumbersAndSeveritiesThatNobodyWritesAreNoRecord) {
    verifies("SWR-REC-004", Technique::kBoundaryValues, Polarity::kViolation);
    const auto decode = [](std::uint64_t sequence, std::uint8_t severity) {
        FlightRecord record = kRecord;
        record.sequence = sequence;
        record.severity = static_cast<Severity>(severity);
        FlightRecord read{};
        const std::size_t slot = sequence == 0U ? 0U : calc_slot(sequence, kCapacity);
        return decode_record(encode_committed(record), slot, kCapacity, read);
    };

    EXPECT_EQ(decode(1U, 0U), SlotState::kWhole);
    EXPECT_EQ(decode(kSequenceMax, 2U), SlotState::kWhole);
    EXPECT_EQ(decode(0U, 2U), SlotState::kCorrupt);
    EXPECT_EQ(decode(kSequenceMax + 1U, 2U), SlotState::kCorrupt);
    EXPECT_EQ(decode(1U, 3U), SlotState::kCorrupt);
}

TEST(FlightFormatTest, SessionThatIsDamagedOrImpossibleIsNone) {
    verifies("SWR-REC-004", Technique::kFaultInjection, Polarity::kViolation);
    const SessionBytes whole = encode_session({7U, 9U});
    ASSERT_EQ(decode_session(whole).number, 7U);

    for (std::size_t bit = 0U; bit < 8U * whole.size(); ++bit) {
        SessionBytes bytes = whole;
        bytes[bit / 8U] = static_cast<std::uint8_t>(bytes[bit / 8U] ^ (1U << (bit % 8U)));
        EXPECT_EQ(decode_session(bytes).number, 0U) << bit;
    }
    EXPECT_EQ(decode_session(SessionBytes{}).number, 0U);
    EXPECT_EQ(decode_session(encode_session({7U, 0U})).number, 0U);
    EXPECT_EQ(decode_session(encode_session({7U, kSequenceMax})).number, 7U);
    EXPECT_EQ(decode_session(encode_session({7U, kSequenceMax + 1U})).number, 0U);
}

}  // namespace
}  // namespace mamori::flight
