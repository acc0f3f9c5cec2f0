// SPDX-License-Identifier: Apache-2.0
// Goal: the recorder keeps the newest records, goes on where an earlier session ended, and changes nothing
// that it refuses. Method: below, at and above the capacity; several sessions over one region; damage between
// two sessions.
#include "mamori/kernel/record/flight_recorder.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "mamori/kernel/record/flight_reader.hpp"
#include "mamori/trace/verifies.hpp"
#include "mamori/verification/failed_check.hpp"

namespace mamori {
namespace {

using namespace verification;

class FlightRecorderTest : public ::testing::Test {
  protected:
    static constexpr std::size_t kCapacity = 4U;

    Span<std::byte> region() { return {memory_.data(), memory_.size()}; }
    static void write(FlightRecorder& recorder, int count) {
        for (int i = 0; i < count; ++i) {
            recorder.write(Instant{i}, Severity::kInfo, 1U, 2U, i);
        }
    }
    /// Numbers of the records that can be read, slot by slot; 0 for every other slot.
    std::vector<std::uint64_t> read_sequences() const {
        FlightReader reader;
        EXPECT_EQ(reader.open({memory_.data(), memory_.size()}), Status::kOk);
        std::vector<std::uint64_t> sequences;
        for (std::size_t slot = 0U; slot < reader.get_capacity(); ++slot) {
            FlightRecord record{};
            sequences.push_back(reader.read(slot, record) == SlotState::kWhole ? record.sequence : 0U);
        }
        return sequences;
    }
    std::byte& byte_of_slot(std::size_t slot, std::size_t offset) {
        return memory_[flight::calc_region_size(slot) + offset];
    }
    /// Puts a whole record into its slot, as no session of this test would write it.
    void plant(const FlightRecord& record) {
        flight::RecordBytes bytes = flight::encode_record(record);
        bytes[flight::kCommitOffset] = flight::kCommitted;
        for (std::size_t i = 0U; i < bytes.size(); ++i) {
            byte_of_slot(flight::calc_slot(record.sequence, kCapacity), i) = std::byte{bytes[i]};
        }
    }

    std::vector<std::byte> memory_ = std::vector<std::byte>(flight::calc_region_size(kCapacity));
    FlightRecorder sut_;
};

using Sequences = std::vector<std::uint64_t>;

TEST_F(FlightRecorderTest, MemoryOfZerosBecomesTheFirstSession) {
    verifies("SWR-REC-006");
    ASSERT_EQ(sut_.open(region()), Status::kOk);

    EXPECT_TRUE(sut_.is_open());
    EXPECT_EQ(sut_.get_session(), 1U);
    EXPECT_EQ(sut_.get_next_sequence(), 1U);
    EXPECT_EQ(read_sequences(), (Sequences{0U, 0U, 0U, 0U}));
}

TEST_F(FlightRecorderTest, EachOpeningIsASessionThatGoesOnWithTheNumbers) {
    verifies("SWR-REC-006", Technique::kStateTransition);
    ASSERT_EQ(sut_.open(region()), Status::kOk);
    write(sut_, 2);

    FlightRecorder second;
    ASSERT_EQ(second.open(region()), Status::kOk);
    EXPECT_EQ(second.get_session(), 2U);
    EXPECT_EQ(second.get_next_sequence(), 3U);
    FlightRecorder third;
    ASSERT_EQ(third.open(region()), Status::kOk);
    EXPECT_EQ(third.get_session(), 3U) << "a session without a record counts";
    write(third, 1);
    EXPECT_EQ(read_sequences(), (Sequences{1U, 2U, 3U, 0U}));
}

TEST_F(FlightRecorderTest, FullRingGivesUpTheOldestAndCounts) {
    verifies("SWR-REC-008", Technique::kBoundaryValues, Polarity::kViolation);
    ASSERT_EQ(sut_.open(region()), Status::kOk);

    write(sut_, 4);
    EXPECT_EQ(read_sequences(), (Sequences{1U, 2U, 3U, 4U}));
    EXPECT_EQ(sut_.get_overwritten_count(), 0U);
    write(sut_, 1);
    EXPECT_EQ(read_sequences(), (Sequences{5U, 2U, 3U, 4U}));
    EXPECT_EQ(sut_.get_overwritten_count(), 1U);
    write(sut_, 1000);
    EXPECT_EQ(read_sequences(), (Sequences{1005U, 1002U, 1003U, 1004U}));
    EXPECT_EQ(sut_.get_overwritten_count(), 1001U);
}

TEST_F(FlightRecorderTest, NothingIsGivenUpBelowTheCapacity) {
    verifies("SWR-REC-008");
    ASSERT_EQ(sut_.open(region()), Status::kOk);
    write(sut_, 3);

    EXPECT_EQ(read_sequences(), (Sequences{1U, 2U, 3U, 0U}));
    EXPECT_EQ(sut_.get_overwritten_count(), 0U);
}

TEST_F(FlightRecorderTest, RoomForOneRecordHoldsTheNewest) {
    verifies("SWR-REC-008", Technique::kBoundaryValues);
    memory_.resize(flight::calc_region_size(1U));
    ASSERT_EQ(sut_.open(region()), Status::kOk);
    write(sut_, 3);

    EXPECT_EQ(read_sequences(), (Sequences{3U}));
    EXPECT_EQ(sut_.get_overwritten_count(), 2U);
}

TEST_F(FlightRecorderTest, RecordsOfAnEarlierSessionGiveWayToo) {
    verifies("SWR-REC-006", Technique::kStateTransition);
    ASSERT_EQ(sut_.open(region()), Status::kOk);
    write(sut_, 4);
    FlightRecorder second;
    ASSERT_EQ(second.open(region()), Status::kOk);
    write(second, 1);

    EXPECT_EQ(read_sequences(), (Sequences{5U, 2U, 3U, 4U}));
    EXPECT_EQ(second.get_overwritten_count(), 1U);
}

TEST_F(FlightRecorderTest, NumbersBehindTheNewestThatCannotBeReadAreNotGivenAgain) {
    verifies("SWR-REC-006", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_EQ(sut_.open(region()), Status::kOk);
    write(sut_, 3);
    byte_of_slot(1U, 0U) ^= std::byte{1U};                    // corrupt
    byte_of_slot(2U, flight::kCommitOffset) = std::byte{0U};  // torn

    FlightRecorder second;
    ASSERT_EQ(second.open(region()), Status::kOk);
    EXPECT_EQ(second.get_next_sequence(), 4U);
    write(second, 1);
    EXPECT_EQ(read_sequences(), (Sequences{1U, 0U, 0U, 4U}));
}

TEST_F(FlightRecorderTest, RingWithoutAnyReadableRecordGoesOnBehindItsSession) {
    verifies("SWR-REC-006", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_EQ(sut_.open(region()), Status::kOk);
    write(sut_, 9);
    FlightRecorder second;
    ASSERT_EQ(second.open(region()), Status::kOk);
    for (std::size_t slot = 0U; slot < kCapacity; ++slot) {
        byte_of_slot(slot, 0U) ^= std::byte{0x80U};
    }

    FlightRecorder third;
    ASSERT_EQ(third.open(region()), Status::kOk);
    EXPECT_EQ(third.get_session(), 3U);
    EXPECT_EQ(third.get_next_sequence(), 10U + kCapacity);
}

TEST_F(FlightRecorderTest, NoNumberIsGivenAgainWhateverSlotsAreSpoiledOrWipedHowManyWereGiven) {
    verifies("SWR-REC-006", Technique::kFaultInjection, Polarity::kViolation);
    for (int count = 1; count <= 14; ++count) {
        for (unsigned spoiled = 0U; spoiled < 1U << kCapacity; ++spoiled) {
            // Empty slots of the first turn were never written, for all that anybody can tell.
            for (const bool is_wiped : {false, true}) {
                if (is_wiped && count <= static_cast<int>(kCapacity)) {
                    continue;
                }
                memory_.assign(memory_.size(), std::byte{0U});
                FlightRecorder first;
                ASSERT_EQ(first.open(region()), Status::kOk);
                write(first, count);
                const std::uint64_t next = first.get_next_sequence();
                for (std::size_t slot = 0U; slot < kCapacity; ++slot) {
                    for (std::size_t i = 0U; i < flight::kRecordSize && (spoiled >> slot) % 2U == 1U; ++i) {
                        std::byte& byte = byte_of_slot(slot, i);
                        byte = is_wiped ? std::byte{0U} : byte ^ std::byte{0x21U};
                    }
                }

                FlightRecorder second;
                ASSERT_EQ(second.open(region()), Status::kOk);
                EXPECT_GE(second.get_next_sequence(), next) << count << " records, spoiled " << spoiled;
                EXPECT_LE(second.get_next_sequence(), next + kCapacity);
                EXPECT_EQ(second.get_session(), 2U);
            }
        }
    }
}

TEST_F(FlightRecorderTest, NumbersThatNobodyKnowsAnyMoreAreRefused) {
    verifies("SWR-REC-006", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_EQ(sut_.open(region()), Status::kOk);
    write(sut_, 9);
    for (const std::size_t offset : flight::kSessionOffsets) {
        memory_[offset] ^= std::byte{1U};
    }
    for (std::size_t slot = 1U; slot < kCapacity; ++slot) {
        byte_of_slot(slot, 0U) ^= std::byte{0x80U};
    }
    std::vector<std::byte> one_left = memory_;
    byte_of_slot(0U, 0U) ^= std::byte{0x80U};
    const std::vector<std::byte> before = memory_;

    FlightRecorder second;
    EXPECT_EQ(second.open(region()), Status::kError);
    EXPECT_FALSE(second.is_open());
    EXPECT_EQ(memory_, before);
    EXPECT_EQ(second.open({one_left.data(), one_left.size()}), Status::kOk) << "one record tells";
    EXPECT_EQ(second.get_next_sequence(), 9U + kCapacity);
}

TEST_F(FlightRecorderTest, HeaderThatForgotItsSessionOpensWhenNothingWasEverWritten) {
    verifies("SWR-REC-006", Technique::kBoundaryValues);
    ASSERT_EQ(sut_.open(region()), Status::kOk);
    for (const std::size_t offset : flight::kSessionOffsets) {
        memory_[offset] ^= std::byte{1U};
    }

    FlightRecorder second;
    ASSERT_EQ(second.open(region()), Status::kOk);
    EXPECT_EQ(second.get_session(), 1U);
    EXPECT_EQ(second.get_next_sequence(), 1U);
}

TEST_F(FlightRecorderTest, SessionIsKnownFromTheRecordsWhenTheHeaderForgotIt) {
    verifies("SWR-REC-006", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_EQ(sut_.open(region()), Status::kOk);
    FlightRecorder second;
    ASSERT_EQ(second.open(region()), Status::kOk);
    write(second, 1);
    for (const std::size_t offset : flight::kSessionOffsets) {
        memory_[offset] ^= std::byte{1U};
    }

    FlightRecorder third;
    ASSERT_EQ(third.open(region()), Status::kOk);
    EXPECT_EQ(third.get_session(), 3U);
    EXPECT_EQ(third.get_next_sequence(), 2U);
}

TEST_F(FlightRecorderTest, SessionIsKnownFromARecordInWhateverSlotItLies) {
    verifies("SWR-REC-006", Technique::kFaultInjection, Polarity::kViolation);
    for (int first_count = 0; first_count < 4; ++first_count) {
        memory_.assign(memory_.size(), std::byte{0U});
        FlightRecorder first;
        ASSERT_EQ(first.open(region()), Status::kOk);
        write(first, 3);
        FlightRecorder second;
        ASSERT_EQ(second.open(region()), Status::kOk);
        write(second, 1 + first_count);
        FlightRecorder third;
        ASSERT_EQ(third.open(region()), Status::kOk);
        write(third, 1);
        for (const std::size_t offset : flight::kSessionOffsets) {
            memory_[offset] ^= std::byte{1U};
        }

        FlightRecorder fourth;
        ASSERT_EQ(fourth.open(region()), Status::kOk);
        EXPECT_EQ(fourth.get_session(), 4U) << "the only record of session 3 lies in slot " << first_count;
        EXPECT_EQ(fourth.get_next_sequence(), 6U + static_cast<std::uint64_t>(first_count));
    }
}

TEST_F(FlightRecorderTest, UsedUpRecordNumbersAreRefused) {
    verifies("SWR-REC-007", Technique::kBoundaryValues, Polarity::kViolation);
    ASSERT_EQ(FlightRecorder::format(region()), Status::kOk);
    for (std::uint64_t i = kCapacity; i > 0U; --i) {
        plant({flight::kSequenceMax - i, {}, 0, 1U, 0U, 0U, Severity::kInfo});
    }
    EXPECT_EQ(sut_.open(region()), Status::kOk);
    EXPECT_EQ(sut_.get_next_sequence(), flight::kSequenceMax);

    plant({flight::kSequenceMax, {}, 0, 1U, 0U, 0U, Severity::kInfo});
    const std::vector<std::byte> before = memory_;
    FlightRecorder next;
    EXPECT_EQ(next.open(region()), Status::kOutOfResources);
    EXPECT_FALSE(next.is_open());
    EXPECT_EQ(memory_, before);
}

TEST_F(FlightRecorderTest, UsedUpSessionNumbersAreRefused) {
    verifies("SWR-REC-007", Technique::kBoundaryValues, Polarity::kViolation);
    constexpr std::uint32_t kMax = std::numeric_limits<std::uint32_t>::max();
    ASSERT_EQ(FlightRecorder::format(region()), Status::kOk);
    plant({1U, {}, 0, kMax - 1U, 0U, 0U, Severity::kInfo});
    EXPECT_EQ(sut_.open(region()), Status::kOk);
    EXPECT_EQ(sut_.get_session(), kMax);

    FlightRecorder next;
    EXPECT_EQ(next.open(region()), Status::kOutOfResources);
    EXPECT_FALSE(next.is_open());
}

TEST_F(FlightRecorderTest, ForeignRegionIsRefusedAndLeftAsItWas) {
    verifies("SWR-REC-007", Technique::kFaultInjection, Polarity::kViolation);
    for (std::byte& byte : memory_) {
        byte = std::byte{'m'};
    }
    const std::vector<std::byte> before = memory_;

    EXPECT_EQ(sut_.open(region()), Status::kError);
    EXPECT_FALSE(sut_.is_open());
    EXPECT_EQ(memory_, before);
}

TEST_F(FlightRecorderTest, RegionOfANewerVersionIsRefusedAndLeftAsItWas) {
    verifies("SWR-REC-007", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_EQ(FlightRecorder::format(region()), Status::kOk);
    memory_[flight::kVersionOffset] = std::byte{flight::kVersion + 1U};
    const std::vector<std::byte> before = memory_;

    EXPECT_EQ(sut_.open(region()), Status::kUnsupported);
    EXPECT_EQ(memory_, before);
}

TEST_F(FlightRecorderTest, RecorderWithoutItsHeaderIsRefusedAndLeftAsItWas) {
    verifies("SWR-REC-007", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_EQ(sut_.open(region()), Status::kOk);
    write(sut_, 1);
    for (std::size_t i = 0U; i < flight::kHeaderSize; ++i) {
        memory_[i] = std::byte{0U};
    }
    const std::vector<std::byte> before = memory_;

    FlightRecorder second;
    EXPECT_EQ(second.open(region()), Status::kError) << "its records are still there";
    EXPECT_EQ(memory_, before);
}

TEST_F(FlightRecorderTest, PartOfAHeaderIsFormattedAgainOnlyWhenNothingElseIsThere) {
    verifies("SWR-REC-015", Technique::kBoundaryValues, Polarity::kViolation);
    const flight::HeaderBytes header = flight::encode_header(kCapacity);
    for (std::size_t missing = 0U; missing <= flight::kHeaderSize; ++missing) {
        for (const std::size_t changed :
             {std::size_t{0U}, flight::kHeaderSize - 1U, flight::kHeaderSize, memory_.size() - 1U}) {
            for (const bool is_changed : {false, true}) {
                for (std::size_t i = 0U; i < memory_.size(); ++i) {
                    memory_[i] = std::byte{i >= missing && i < header.size() ? header[i] : std::uint8_t{0U}};
                }
                if (is_changed) {
                    memory_[changed] = static_cast<std::byte>(memory_[changed] ^ std::byte{0x40U});
                }
                const std::vector<std::byte> before = memory_;
                FlightRecorder recorder;
                if (!is_changed) {
                    EXPECT_EQ(recorder.open(region()), Status::kOk) << missing;
                    EXPECT_EQ(recorder.get_session(), 1U) << missing;
                } else if (missing > 0U || changed < flight::kSessionOffsets[0]) {
                    EXPECT_EQ(recorder.open(region()), Status::kError) << missing << " " << changed;
                    EXPECT_EQ(memory_, before);
                }
            }
        }
    }
}

TEST_F(FlightRecorderTest, AnIntactRecorderWithoutItsFirstByteIsRefused) {
    verifies("SWR-REC-007", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_EQ(sut_.open(region()), Status::kOk);
    memory_[0] = std::byte{0U};
    const std::vector<std::byte> before = memory_;

    FlightRecorder second;
    EXPECT_EQ(second.open(region()), Status::kError) << "its session is still there";
    EXPECT_EQ(memory_, before);
}

TEST_F(FlightRecorderTest, RegionOfAnotherSizeIsRefused) {
    verifies("SWR-REC-007", Technique::kBoundaryValues, Polarity::kViolation);
    ASSERT_EQ(FlightRecorder::format(region()), Status::kOk);
    ASSERT_EQ(sut_.open(region()), Status::kOk) << "the whole is right";

    FlightRecorder second;
    EXPECT_EQ(second.open(region().subspan(0U, flight::calc_region_size(kCapacity) - 1U)), Status::kError);
    EXPECT_EQ(second.open(region().subspan(0U, flight::calc_region_size(1U) - 1U)), Status::kBadParameter);
    EXPECT_EQ(second.open({}), Status::kBadParameter);
    EXPECT_EQ(FlightRecorder::format(region().subspan(0U, flight::calc_region_size(1U) - 1U)),
              Status::kBadParameter);
}

TEST_F(FlightRecorderTest, FormatMakesAnEmptyRecorderOfWhateverWasThere) {
    verifies("SWR-REC-007");
    for (std::byte& byte : memory_) {
        byte = std::byte{0xFFU};
    }
    ASSERT_EQ(FlightRecorder::format(region()), Status::kOk);

    ASSERT_EQ(sut_.open(region()), Status::kOk);
    EXPECT_EQ(sut_.get_session(), 1U);
    EXPECT_EQ(read_sequences(), (Sequences{0U, 0U, 0U, 0U}));
}

TEST_F(FlightRecorderTest, FormatLeavesNothingOfTheRecordsThatWereThere) {
    verifies("SWR-REC-007", Technique::kBackToBack);
    const std::vector<std::byte> old(memory_.size(), std::byte{0xFFU});
    ASSERT_EQ(FlightRecorder::format(region()), Status::kOk);
    const std::vector<std::byte> fresh = memory_;
    ASSERT_EQ(sut_.open(region()), Status::kOk);
    write(sut_, 7);
    ASSERT_NE(memory_, fresh);

    ASSERT_EQ(FlightRecorder::format(region()), Status::kOk);
    EXPECT_EQ(memory_, fresh);
    memory_ = old;
    ASSERT_EQ(FlightRecorder::format(region()), Status::kOk);
    EXPECT_EQ(memory_, fresh);
    FlightReader reader;
    ASSERT_EQ(reader.open({memory_.data(), memory_.size()}), Status::kOk);
    FlightRecord record{};
    for (std::size_t slot = 0U; slot < kCapacity; ++slot) {
        EXPECT_EQ(reader.read(slot, record), SlotState::kEmpty) << slot;
    }
}

TEST_F(FlightRecorderTest, OpenRecorderRefusesASecondRegion) {
    verifies("SWR-REC-007", Technique::kStateTransition, Polarity::kViolation);
    ASSERT_EQ(sut_.open(region()), Status::kOk);
    EXPECT_EQ(sut_.open(region()), Status::kPreconditionNotMet);
    EXPECT_EQ(sut_.get_session(), 1U);

    sut_.close();
    EXPECT_FALSE(sut_.is_open());
    EXPECT_EQ(sut_.open(region()), Status::kOk);
    EXPECT_EQ(sut_.get_session(), 2U);
}

TEST_F(FlightRecorderTest, WriteWithoutARegionEndsInTheAssertion) {
    verifies("SWR-REC-008", Technique::kErrorGuessing, Polarity::kViolation);
    EXPECT_CHECK_FAILS(write(sut_, 1), "flight_recorder.cpp", 1);
}

TEST_F(FlightRecorderTest, EventsOfALogGoOnToTheRecorder) {
    verifies("SWR-REC-009");
    std::array<Event, 2U> storage{};
    EventLog log{storage};
    log.write(Instant{1}, Severity::kInfo, 5U, 6U, 7);
    ASSERT_EQ(sut_.open(region()), Status::kOk);
    ASSERT_EQ(log.attach(sut_), Status::kOk);

    log.write(Instant{2}, Severity::kFault, 15U, 16U, -17);

    EXPECT_EQ(log.size(), 2U);
    EXPECT_EQ(read_sequences(), (Sequences{1U, 0U, 0U, 0U}));
    FlightReader reader;
    ASSERT_EQ(reader.open({memory_.data(), memory_.size()}), Status::kOk);
    FlightRecord record{};
    ASSERT_EQ(reader.read(0U, record), SlotState::kWhole);
    EXPECT_EQ(record.time, Instant{2});
    EXPECT_EQ(record.severity, Severity::kFault);
    EXPECT_EQ(record.source, 15U);
    EXPECT_EQ(record.code, 16U);
    EXPECT_EQ(record.argument, -17);
}

TEST_F(FlightRecorderTest, LogTakesOneRecorderThatIsOpen) {
    verifies("SWR-REC-009", Technique::kStateTransition, Polarity::kViolation);
    std::array<Event, 2U> storage{};
    EventLog log{storage};
    EXPECT_EQ(log.attach(sut_), Status::kPreconditionNotMet);
    log.write(Instant{1}, Severity::kInfo, 0U, 0U, 0);
    ASSERT_EQ(sut_.open(region()), Status::kOk);

    EXPECT_EQ(log.attach(sut_), Status::kOk);
    EXPECT_EQ(log.attach(sut_), Status::kPreconditionNotMet);
    log.write(Instant{2}, Severity::kInfo, 0U, 0U, 0);
    EXPECT_EQ(sut_.get_next_sequence(), 2U);
}

}  // namespace
}  // namespace mamori
