// SPDX-License-Identifier: Apache-2.0
// Goal: the log keeps the newest records in order and counts every one that it could not keep.
// Method: below, at and above its capacity; several turns of the ring; capacities 1 and 0.
#include "mamori/kernel/record/event_log.hpp"

#include <gtest/gtest.h>

#include "mamori/trace/verifies.hpp"
#include "mamori/verification/failed_check.hpp"

namespace mamori {
namespace {

using namespace verification;

class EventLogTest : public ::testing::Test {
  protected:
    void write(std::int64_t argument) {
        sut_.write(Instant{argument * 10}, Severity::kWarning, 2U, 3U, argument);
    }

    std::array<Event, 3> storage_{};
    EventLog sut_{storage_};
};

TEST_F(EventLogTest, ARecordIsKeptAsItWasWritten) {
    verifies("SWR-KRN-019");

    sut_.write(Instant{123}, Severity::kFault, 7U, 65535U, -9);

    ASSERT_EQ(sut_.size(), 1U);
    const Event& event = sut_.get(0U);
    EXPECT_EQ(event.sequence, 0U);
    EXPECT_EQ(event.time, Instant{123});
    EXPECT_EQ(event.severity, Severity::kFault);
    EXPECT_EQ(event.source, 7U);
    EXPECT_EQ(event.code, 65535U);
    EXPECT_EQ(event.argument, -9);
}

TEST(EventTest, IsAllZeroUntilItIsWritten) {
    verifies("SWR-KRN-019", Technique::kInterface);
    const Event event{};

    EXPECT_EQ(event.sequence, 0U);
    EXPECT_EQ(event.time, Instant{});
    EXPECT_EQ(event.severity, Severity::kInfo);
    EXPECT_EQ(event.source, 0U);
    EXPECT_EQ(event.code, 0U);
    EXPECT_EQ(event.argument, 0);
}

TEST_F(EventLogTest, NothingIsLostUpToTheCapacity) {
    verifies("SWR-KRN-019", Technique::kBoundaryValues);
    EXPECT_EQ(sut_.size(), 0U);

    for (std::int64_t i = 0; i < 3; ++i) {
        write(i);
    }

    EXPECT_EQ(sut_.size(), 3U);
    EXPECT_EQ(sut_.get_lost_count(), 0U);
    EXPECT_EQ(sut_.get(0U).argument, 0);
    EXPECT_EQ(sut_.get(2U).argument, 2);
}

TEST_F(EventLogTest, BeyondTheCapacityTheOldestGivesWayAndIsCounted) {
    verifies("SWR-KRN-019", Technique::kBoundaryValues, Polarity::kViolation);

    for (std::int64_t i = 0; i < 4; ++i) {
        write(i);
    }

    EXPECT_EQ(sut_.size(), 3U);
    EXPECT_EQ(sut_.get_lost_count(), 1U);
    EXPECT_EQ(sut_.get(0U).argument, 1);
    EXPECT_EQ(sut_.get(2U).argument, 3);
}

TEST_F(EventLogTest, AfterManyTurnsTheNewestAreInOrderWithoutAGapInTheirNumbers) {
    verifies("SWR-KRN-019", Technique::kErrorGuessing, Polarity::kViolation);

    for (std::int64_t i = 0; i < 1000; ++i) {
        write(i);
        for (std::size_t kept = 0U; kept < sut_.size(); ++kept) {
            const auto expected =
                static_cast<std::uint32_t>(i + 1) - static_cast<std::uint32_t>(sut_.size() - kept);
            ASSERT_EQ(sut_.get(kept).sequence, expected);
            ASSERT_EQ(sut_.get(kept).argument, static_cast<std::int64_t>(expected));
        }
    }
    EXPECT_EQ(sut_.get_lost_count(), 997U);
}

TEST(SmallEventLogTest, OneRecordOfRoomHoldsTheNewest) {
    verifies("SWR-KRN-019", Technique::kBoundaryValues);
    std::array<Event, 1> storage{};
    EventLog sut{storage};

    sut.write(Instant{}, Severity::kInfo, 0U, 0U, 1);
    sut.write(Instant{}, Severity::kInfo, 0U, 0U, 2);

    ASSERT_EQ(sut.size(), 1U);
    EXPECT_EQ(sut.get(0U).argument, 2);
    EXPECT_EQ(sut.get_lost_count(), 1U);
}

TEST(SmallEventLogTest, WithoutRoomEveryRecordIsCountedAsLost) {
    verifies("SWR-KRN-019", Technique::kBoundaryValues, Polarity::kViolation);
    std::array<Event, 0> storage{};
    EventLog sut{storage};

    sut.write(Instant{}, Severity::kInfo, 0U, 0U, 1);
    sut.write(Instant{}, Severity::kInfo, 0U, 0U, 2);

    EXPECT_EQ(sut.size(), 0U);
    EXPECT_EQ(sut.get_lost_count(), 2U);
}

TEST_F(EventLogTest, ReadingBeyondTheKeptRecordsEndsInTheAssertion) {
    verifies("SWR-KRN-019", Technique::kBoundaryValues, Polarity::kViolation);
    write(1);

    EXPECT_EQ(sut_.get(0U).argument, 1);
    EXPECT_CHECK_FAILS(static_cast<void>(sut_.get(1U)), "event_log.cpp", 1);
}

}  // namespace
}  // namespace mamori
