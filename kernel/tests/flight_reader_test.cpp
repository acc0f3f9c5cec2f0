// SPDX-License-Identifier: Apache-2.0
// Goal: the reader gives back what was written and believes nothing else. Method: regions made by the
// recorder, cut, changed and replaced; random bytes from a seeded generator; a region of another version made
// by hand.
#include "mamori/kernel/record/flight_reader.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "mamori/kernel/record/flight_recorder.hpp"
#include "mamori/trace/verifies.hpp"
#include "mamori/verification/failed_check.hpp"

namespace mamori {
namespace {

using namespace verification;

using Region = std::vector<std::byte>;

Span<std::byte> view(Region& region) {
    return {region.data(), region.size()};
}
Span<const std::byte> view_const(const Region& region) {
    return {region.data(), region.size()};
}

Region make_region(std::size_t capacity, int record_count) {
    Region region(flight::calc_region_size(capacity));
    FlightRecorder recorder;
    EXPECT_EQ(recorder.open(view(region)), Status::kOk);
    for (int i = 1; i <= record_count; ++i) {
        recorder.write(Instant{i * 10}, Severity::kWarning, 2U, 3U, i);
    }
    return region;
}

TEST(FlightReaderTest, GivesBackWhatWasWritten) {
    verifies("SWR-REC-004");
    const Region region = make_region(4U, 2);
    FlightReader sut;
    ASSERT_EQ(sut.open(view_const(region)), Status::kOk);

    FlightRecord record{};
    EXPECT_EQ(sut.get_capacity(), 4U);
    EXPECT_EQ(sut.calc_newest_sequence(), 2U);
    EXPECT_EQ(sut.calc_session().number, 1U);
    EXPECT_EQ(sut.calc_session().next_sequence, 1U);
    ASSERT_EQ(sut.read(1U, record), SlotState::kWhole);
    EXPECT_EQ(record.sequence, 2U);
    EXPECT_EQ(record.session, 1U);
    EXPECT_EQ(record.time, Instant{20});
    EXPECT_EQ(record.severity, Severity::kWarning);
    EXPECT_EQ(record.source, 2U);
    EXPECT_EQ(record.code, 3U);
    EXPECT_EQ(record.argument, 2);
    EXPECT_EQ(sut.read(2U, record), SlotState::kEmpty);
}

TEST(FlightReaderTest, BeforeOpenThereIsNothing) {
    verifies("SWR-REC-005", Technique::kBoundaryValues);
    const FlightReader sut;
    FlightRecord record{};

    EXPECT_EQ(sut.get_capacity(), 0U);
    EXPECT_EQ(sut.calc_newest_sequence(), 0U);
    EXPECT_EQ(sut.calc_session().number, 0U);
    EXPECT_CHECK_FAILS(static_cast<void>(sut.read(0U, record)), "flight_reader.cpp", 1);
}

TEST(FlightReaderTest, SlotBeyondTheRingEndsInTheAssertion) {
    verifies("SWR-REC-005", Technique::kBoundaryValues, Polarity::kViolation);
    const Region region = make_region(2U, 1);
    FlightReader sut;
    ASSERT_EQ(sut.open(view_const(region)), Status::kOk);
    FlightRecord record{};

    EXPECT_EQ(sut.read(1U, record), SlotState::kEmpty);
    EXPECT_CHECK_FAILS(static_cast<void>(sut.read(2U, record)), "flight_reader.cpp", 1);
}

TEST(FlightReaderTest, RegionOfEachOtherLengthIsRefused) {
    verifies("SWR-REC-005", Technique::kBoundaryValues, Polarity::kViolation);
    const Region region = make_region(3U, 3);
    FlightReader sut;

    for (std::size_t size = 0U; size < region.size(); ++size) {
        const Status wanted = size < flight::calc_region_size(1U) ? Status::kBadParameter : Status::kError;
        EXPECT_EQ(sut.open({region.data(), size}), wanted) << size;
    }
    EXPECT_EQ(sut.get_capacity(), 0U);
    EXPECT_EQ(sut.open(view_const(region)), Status::kOk);
}

TEST(FlightReaderTest, EachChangedBitOfTheFixedHeaderIsRefused) {
    verifies("SWR-REC-005", Technique::kFaultInjection, Polarity::kViolation);
    const Region whole = make_region(3U, 3);
    FlightReader sut;

    for (std::size_t bit = 0U; bit < 8U * flight::kSessionOffsets[0]; ++bit) {
        Region region = whole;
        region[bit / 8U] ^= std::byte{1U} << (bit % 8U);
        const bool is_version = bit / 8U == flight::kVersionOffset || bit / 8U == flight::kVersionOffset + 1U;
        EXPECT_EQ(sut.open(view_const(region)), is_version ? Status::kUnsupported : Status::kError) << bit;
    }
}

TEST(FlightReaderTest, ARefusedRegionLeavesTheReaderWithItsOwn) {
    verifies("SWR-REC-005", Technique::kErrorGuessing, Polarity::kViolation);
    const Region region = make_region(2U, 1);
    const Region foreign(flight::calc_region_size(9U), std::byte{'x'});
    FlightReader sut;
    ASSERT_EQ(sut.open(view_const(region)), Status::kOk);

    EXPECT_EQ(sut.open(view_const(foreign)), Status::kError);
    EXPECT_EQ(sut.get_capacity(), 2U);
    EXPECT_EQ(sut.calc_newest_sequence(), 1U);
}

TEST(FlightReaderTest, RandomBytesBehindTheHeaderGiveNoRecord) {
    verifies("SWR-REC-004", Technique::kFaultInjection, Polarity::kViolation);
    constexpr unsigned kSeed = 20261U;
    std::mt19937 generator{kSeed};
    std::uniform_int_distribution<int> byte{0, 255};
    Region region = make_region(500U, 0);
    for (std::size_t i = flight::kHeaderSize; i < region.size(); ++i) {
        region[i] = static_cast<std::byte>(byte(generator));
    }
    FlightReader sut;
    ASSERT_EQ(sut.open(view_const(region)), Status::kOk);

    EXPECT_EQ(sut.calc_newest_sequence(), 0U) << "seed " << kSeed;
}

TEST(FlightReaderTest, SessionIsTheNewerOfTwoOrTheOneThatIsLeft) {
    verifies("SWR-REC-006", Technique::kFaultInjection);
    Region region = make_region(2U, 1);
    FlightRecorder second;
    ASSERT_EQ(second.open(view(region)), Status::kOk);
    FlightReader sut;
    ASSERT_EQ(sut.open(view_const(region)), Status::kOk);
    EXPECT_EQ(sut.calc_session().number, 2U);
    EXPECT_EQ(sut.calc_session().next_sequence, 2U);

    EXPECT_EQ(sut.calc_session_place(), 0U);

    region[flight::kSessionOffsets[0]] ^= std::byte{1U};
    EXPECT_EQ(sut.calc_session().number, 1U);
    EXPECT_EQ(sut.calc_session_place(), 1U);
    region[flight::kSessionOffsets[1]] ^= std::byte{1U};
    EXPECT_EQ(sut.calc_session().number, 0U);
    EXPECT_EQ(sut.calc_session_place(), 0U);
}

TEST(FlightReaderTest, OfTwoNotesOfOneSessionTheOneThatCameFurtherCounts) {
    verifies("SWR-REC-006", Technique::kBoundaryValues);
    for (const std::size_t newer : {0U, 1U}) {
        Region region = make_region(2U, 0);
        for (const std::size_t place : {0U, 1U}) {
            const flight::SessionBytes bytes = flight::encode_session({1U, place == newer ? 4U : 3U});
            for (std::size_t i = 0U; i < bytes.size(); ++i) {
                region[flight::kSessionOffsets[place] + i] = std::byte{bytes[i]};
            }
        }
        FlightReader sut;
        ASSERT_EQ(sut.open(view_const(region)), Status::kOk);

        EXPECT_EQ(sut.calc_session_place(), newer);
        EXPECT_EQ(sut.calc_session().next_sequence, 4U);
    }
}

}  // namespace
}  // namespace mamori
