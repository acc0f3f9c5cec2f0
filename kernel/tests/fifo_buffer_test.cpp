// SPDX-License-Identifier: Apache-2.0
// Goal: entries come out in the order they went in, and each policy, status and count is as declared.
// Method: one thread; capacities 1 and 3; positions that wrap after 127 by means of a 16-bit word.
#include "mamori/kernel/dataflow/fifo_buffer.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <set>

#include "mamori/trace/verifies.hpp"
#include "mamori/verification/failed_check.hpp"
#include "support/interleaving.hpp"

namespace mamori {
namespace {

using testing_support::CountedAtomic;
using testing_support::SteppedAtomic;
using namespace verification;

template <FullPolicy kFull, EmptyPolicy kEmpty = EmptyPolicy::kDoNothing>
using Fifo3 = FifoBuffer<std::int32_t, 3U, kFull, kEmpty>;

/// Value of the next pop(), or -1 when it is refused.
template <typename Fifo>
std::int32_t pop(Fifo& fifo) {
    std::int32_t value = -1;
    const Status status = fifo.pop(value);
    EXPECT_EQ(value == -1, status != Status::kOk) << "a refused pop() leaves the variable alone";
    return value;
}

template <typename Fifo>
void push_range(Fifo& fifo, std::int32_t first, std::int32_t last) {
    for (std::int32_t value = first; value <= last; ++value) {
        static_cast<void>(fifo.push(value));
    }
}

TEST(FifoBufferTest, EntriesComeOutInTheOrderTheyWentIn) {
    verifies("SWR-BUF-003");
    Fifo3<FullPolicy::kDoNothing> sut;

    for (std::int32_t lap = 0; lap < 5; ++lap) {
        ASSERT_EQ(sut.push(2 * lap), Status::kOk);
        ASSERT_EQ(sut.push(2 * lap + 1), Status::kOk);
        EXPECT_EQ(pop(sut), 2 * lap);
        EXPECT_EQ(pop(sut), 2 * lap + 1);
    }
}

TEST(FifoBufferTest, APeekedEntryStaysTheFrontUntilItIsDropped) {
    verifies("SWR-BUF-003", Technique::kInterface);
    Fifo3<FullPolicy::kDoNothing> sut;
    push_range(sut, 1, 2);

    ASSERT_EQ(sut.peek(), Status::kOk);
    EXPECT_EQ(sut.get_front(), 1);
    ASSERT_EQ(sut.peek(), Status::kOk) << "a second look";
    EXPECT_EQ(sut.get_front(), 1);
    EXPECT_EQ(pop(sut), 1) << "popped as it was seen";
    ASSERT_EQ(sut.peek(), Status::kOk);
    EXPECT_EQ(sut.get_front(), 2);
    sut.drop();

    EXPECT_EQ(sut.peek(), Status::kPreconditionNotMet);
    EXPECT_EQ(sut.get_front(), 2) << "still there to be looked at";
    EXPECT_EQ(sut.get_empty_read_count(), 0U) << "a look is no read";
}

TEST(FifoBufferTest, AnEntryInPlaceIsSeenWhenItIsPublishedAndNotBefore) {
    verifies("SWR-BUF-003", Technique::kInterface, Polarity::kViolation);
    Fifo3<FullPolicy::kDoNothing> sut;
    sut.get_write_slot() = 5;

    EXPECT_EQ(sut.peek(), Status::kPreconditionNotMet);
    ASSERT_EQ(sut.publish(), Status::kOk);

    EXPECT_EQ(pop(sut), 5);
}

TEST(FifoBufferDeathTest, DroppingWhatIsNotHeldHalts) {
    verifies("SWR-BUF-003", Technique::kFaultInjection, Polarity::kViolation);
    Fifo3<FullPolicy::kDoNothing> sut;
    push_range(sut, 1, 1);

    EXPECT_CHECK_FAILS(sut.drop(), "fifo_buffer.hpp", 1);
}

TEST(FifoBufferTest, AFullBufferRefusesTheNewEntryAndKeepsTheOld) {
    verifies("SWR-BUF-004", Technique::kBoundaryValues, Polarity::kViolation);
    Fifo3<FullPolicy::kDoNothing> sut;
    push_range(sut, 1, 2);

    EXPECT_EQ(sut.push(3), Status::kOk) << "the last free place";
    EXPECT_EQ(sut.push(4), Status::kOutOfResources);
    EXPECT_EQ(sut.push(5), Status::kOutOfResources);

    EXPECT_EQ(sut.get_rejected_count(), 2U);
    EXPECT_EQ(sut.get_overwritten_count(), 0U);
    EXPECT_EQ(pop(sut), 1);
    EXPECT_EQ(sut.push(6), Status::kOk) << "one place is free again";
    EXPECT_EQ(pop(sut), 2);
    EXPECT_EQ(pop(sut), 3);
    EXPECT_EQ(pop(sut), 6);
    EXPECT_EQ(pop(sut), -1);
}

TEST(FifoBufferTest, ARejectedEntryIsNotCopied) {
    verifies("SWR-BUF-004", Technique::kInterface);
    Fifo3<FullPolicy::kDoNothing> sut;
    push_range(sut, 1, 3);
    sut.get_write_slot() = 9;

    EXPECT_EQ(sut.push(4), Status::kOutOfResources);

    EXPECT_EQ(sut.get_write_slot(), 9);
}

TEST(FifoBufferTest, InAFullBufferTheOldestEntryGivesWay) {
    verifies("SWR-BUF-004", Technique::kBoundaryValues);
    Fifo3<FullPolicy::kOverwrite> sut;

    push_range(sut, 1, 3);
    EXPECT_EQ(sut.get_overwritten_count(), 0U);
    EXPECT_EQ(sut.push(4), Status::kOk);

    EXPECT_EQ(sut.get_overwritten_count(), 1U);
    EXPECT_EQ(sut.get_rejected_count(), 0U);
    EXPECT_EQ(pop(sut), 2);
    EXPECT_EQ(pop(sut), 3);
    EXPECT_EQ(pop(sut), 4);
    EXPECT_EQ(pop(sut), -1);
}

TEST(FifoBufferTest, AReaderThatWasAwayForLapsFindsTheNewestEntriesInOrder) {
    verifies("SWR-BUF-004", Technique::kEquivalenceClasses);
    for (std::int32_t count = 4; count <= 40; ++count) {
        Fifo3<FullPolicy::kOverwrite> sut;

        push_range(sut, 1, count);

        EXPECT_EQ(pop(sut), count - 2) << count;
        EXPECT_EQ(pop(sut), count - 1) << count;
        EXPECT_EQ(pop(sut), count) << count;
        EXPECT_EQ(pop(sut), -1) << count;
        EXPECT_EQ(sut.get_overwritten_count(), static_cast<std::uint32_t>(count - 3));
    }
}

TEST(FifoBufferTest, AnEntryThatIsHeldIsNotOverwritten) {
    verifies("SWR-BUF-004", Technique::kErrorGuessing, Polarity::kViolation);
    Fifo3<FullPolicy::kOverwrite> sut;
    push_range(sut, 1, 3);
    ASSERT_EQ(sut.peek(), Status::kOk);

    push_range(sut, 4, 20);

    EXPECT_EQ(sut.get_front(), 1);
    EXPECT_EQ(pop(sut), 1);
    EXPECT_EQ(pop(sut), 18);
}

TEST(FifoBufferTest, ACapacityOfOneIsTheLatestValue) {
    verifies("SWR-BUF-004", Technique::kBoundaryValues);
    FifoBuffer<std::int32_t, 1U, FullPolicy::kOverwrite, EmptyPolicy::kDoNothing> sut;

    for (std::int32_t value = 1; value <= 9; ++value) {
        push_range(sut, 10 * value, 10 * value + value);
        EXPECT_EQ(pop(sut), 11 * value);
        EXPECT_EQ(pop(sut), -1);
    }
}

/// Positions wrap after 126 entries here, so an old position comes to look like a new one.
TEST(FifoBufferTest, TheReaderNeverGoesBackHoweverLongItWasAway) {
    verifies("SWR-BUF-004", Technique::kBoundaryValues, Polarity::kViolation);
    constexpr std::int32_t kPositionCount = 126;
    for (std::int32_t absence = 1; absence <= 3 * kPositionCount; ++absence) {
        FifoBuffer<std::int32_t, 3U, FullPolicy::kOverwrite, EmptyPolicy::kDoNothing,
                   std::atomic<std::uint16_t>>
            sut;
        std::int32_t newest = 0;
        for (int round = 0; round < 3; ++round) {
            push_range(sut, newest + 1, newest + absence);
            newest += absence;

            // Of a whole turn's absence the reader cannot know: these entries are lost to it.
            std::int32_t last = absence % kPositionCount == 0 ? newest : newest - absence;
            for (int i = 0; i < 3 && last < newest; ++i) {
                const std::int32_t value = pop(sut);
                EXPECT_TRUE(value > last && value > newest - 3) << absence << " entries, value " << value;
                last = value;
            }
            EXPECT_EQ(last, newest) << absence;
            EXPECT_EQ(pop(sut), -1) << absence;
        }
    }
}

TEST(FifoBufferTest, AnEmptyBufferRefusesAndCounts) {
    verifies("SWR-BUF-005", Technique::kBoundaryValues, Polarity::kViolation);
    Fifo3<FullPolicy::kDoNothing, EmptyPolicy::kDoNothing> sut;

    EXPECT_EQ(pop(sut), -1);
    push_range(sut, 1, 1);
    EXPECT_EQ(pop(sut), 1);
    std::int32_t value = 9;
    EXPECT_EQ(sut.pop(value), Status::kPreconditionNotMet);

    EXPECT_EQ(value, 9);
    EXPECT_EQ(sut.get_empty_read_count(), 2U);
}

TEST(FifoBufferTest, ReadbackGivesTheLastEntryAgain) {
    verifies("SWR-BUF-005");
    Fifo3<FullPolicy::kDoNothing, EmptyPolicy::kReadback> sut;
    push_range(sut, 1, 2);

    EXPECT_EQ(pop(sut), 1);
    EXPECT_EQ(pop(sut), 2);
    EXPECT_EQ(pop(sut), 2);
    sut.get_write_slot() = 7;
    EXPECT_EQ(pop(sut), 2) << "while the writer fills its slot";
    EXPECT_EQ(sut.get_empty_read_count(), 2U);
    EXPECT_EQ(sut.peek(), Status::kPreconditionNotMet) << "there is nothing to look forward to";

    ASSERT_EQ(sut.publish(), Status::kOk);
    EXPECT_EQ(pop(sut), 7);
}

TEST(FifoBufferTest, ReadbackOfADroppedEntryGivesThatEntry) {
    verifies("SWR-BUF-005", Technique::kErrorGuessing);
    Fifo3<FullPolicy::kDoNothing, EmptyPolicy::kReadback> sut;
    push_range(sut, 1, 1);
    ASSERT_EQ(sut.peek(), Status::kOk);
    sut.drop();

    EXPECT_EQ(pop(sut), 1);
}

TEST(FifoBufferTest, ReadbackHasNothingToGiveBeforeTheFirstEntry) {
    verifies("SWR-BUF-005", Technique::kBoundaryValues, Polarity::kViolation);
    Fifo3<FullPolicy::kDoNothing, EmptyPolicy::kReadback> sut;

    EXPECT_EQ(pop(sut), -1);
    EXPECT_EQ(sut.get_empty_read_count(), 1U);
}

TEST(FifoBufferTest, TheHighWaterMarkIsTheMostThatEverWaited) {
    verifies("SWR-BUF-006", Technique::kBoundaryValues);
    Fifo3<FullPolicy::kOverwrite> sut;

    EXPECT_EQ(sut.get_high_water_mark(), 0U);
    push_range(sut, 1, 1);
    EXPECT_EQ(pop(sut), 1);
    push_range(sut, 2, 2);
    EXPECT_EQ(sut.get_high_water_mark(), 1U);
    push_range(sut, 3, 3);
    EXPECT_EQ(sut.get_high_water_mark(), 2U);
    EXPECT_EQ(pop(sut), 2);
    EXPECT_EQ(sut.get_high_water_mark(), 2U) << "a read does not lower it";
    push_range(sut, 4, 9);
    EXPECT_EQ(sut.get_high_water_mark(), 3U) << "the capacity, whatever was overwritten";
}

TEST(FifoBufferTest, TheDefaultsAreThoseOfOpenRtm) {
    verifies("SWR-BUF-004", Technique::kInterface);
    static_assert(std::is_same_v<FifoBuffer<int, 8U>,
                                 FifoBuffer<int, 8U, FullPolicy::kOverwrite, EmptyPolicy::kReadback>>);
    static constexpr FifoBuffer<int, 8U> kBuffer;

    EXPECT_EQ(kBuffer.get_high_water_mark(), 0U) << "constant-initialised";
}

TEST(FifoBufferTest, TheLargestCapacityHoldsThatManyEntries) {
    verifies("SWR-BUF-008", Technique::kBoundaryValues);
    static FifoBuffer<std::int32_t, 254U, FullPolicy::kDoNothing, EmptyPolicy::kDoNothing> sut;

    push_range(sut, 1, 255);

    EXPECT_EQ(sut.get_rejected_count(), 1U);
    for (std::int32_t value = 1; value <= 254; ++value) {
        EXPECT_EQ(pop(sut), value);
    }
    EXPECT_EQ(pop(sut), -1);
}

using Counted = CountedAtomic<std::uint32_t>;

/// Distance between the words that a push() and a pop() have stored last [byte].
template <typename Fifo>
std::ptrdiff_t calc_distance_of_sides(Fifo& fifo) {
    static_cast<void>(fifo.push(1));
    const auto* const written = static_cast<const char*>(Counted::last_stored);
    EXPECT_EQ(pop(fifo), 1);
    return std::abs(static_cast<const char*>(Counted::last_stored) - written);
}

TEST(FifoBufferTest, WhatTheSidesStoreIsOnDifferentCacheLines) {
    verifies("SWR-BUF-021", Technique::kInterface);
    FifoBuffer<std::int32_t, 3U, FullPolicy::kDoNothing, EmptyPolicy::kDoNothing, Counted> sut;
    constexpr std::ptrdiff_t kLine = 64;

    EXPECT_GE(calc_distance_of_sides(sut), kLine);
    static_assert(alignof(Fifo3<FullPolicy::kDoNothing>) == kLine);
    static_assert(alignof(Fifo3<FullPolicy::kOverwrite>) == kLine);
}

TEST(FifoBufferTest, ARejectingBufferMakesNoAtomicExchange) {
    verifies("SWR-BUF-022", Technique::kInterface);
    FifoBuffer<std::int32_t, 3U, FullPolicy::kDoNothing, EmptyPolicy::kDoNothing, Counted> sut;
    Counted::exchange_count = 0U;

    push_range(sut, 1, 4);
    EXPECT_EQ(pop(sut), 1);
    push_range(sut, 5, 5);

    EXPECT_EQ(Counted::exchange_count, 0U);
}

TEST(FifoBufferTest, AnOverwritingBufferExchangesToOverwriteAndToRead) {
    verifies("SWR-BUF-022", Technique::kInterface);
    FifoBuffer<std::int32_t, 3U, FullPolicy::kOverwrite, EmptyPolicy::kDoNothing, Counted> sut;
    Counted::exchange_count = 0U;

    push_range(sut, 1, 3);
    EXPECT_EQ(Counted::exchange_count, 0U);
    push_range(sut, 4, 4);
    EXPECT_EQ(Counted::exchange_count, 1U) << "the oldest entry";
    EXPECT_EQ(pop(sut), 2);
    EXPECT_EQ(Counted::exchange_count, 2U);
}

TEST(FifoBufferSlotsTest, EachSlotIsUsedInTurnWithoutAFailedCheck) {
    verifies("SWR-BUF-002");
    FifoBuffer<std::int32_t, 2U, FullPolicy::kOverwrite, EmptyPolicy::kDoNothing> overwriting;
    FifoBuffer<std::int32_t, 2U, FullPolicy::kDoNothing, EmptyPolicy::kDoNothing> rejecting;
    std::set<const std::int32_t*> slots_of_overwriting;
    std::set<const std::int32_t*> slots_of_rejecting;
    const auto pass_one = [](auto& fifo, auto& slots) {
        slots.insert(&fifo.get_write_slot());
        ASSERT_EQ(fifo.publish(), Status::kOk);
        ASSERT_EQ(fifo.peek(), Status::kOk);
        slots.insert(&fifo.get_front());
        fifo.drop();
    };

    for (int cycle = 0; cycle < 12; ++cycle) {
        pass_one(overwriting, slots_of_overwriting);
        pass_one(rejecting, slots_of_rejecting);
    }

    EXPECT_EQ(slots_of_overwriting.size(), 4U);
    EXPECT_EQ(slots_of_rejecting.size(), 4U);
}

/// A word that names a slot beyond the last, as only corrupted memory does.
struct CorruptedEntry : SteppedAtomic<std::uint32_t> {
    using SteppedAtomic::SteppedAtomic;
    std::uint32_t load(std::memory_order) const noexcept { return 0x100U | 5U; }
    std::uint32_t exchange(std::uint32_t, std::memory_order) noexcept { return 5U; }
    bool compare_exchange_strong(std::uint32_t&, std::uint32_t, std::memory_order,
                                 std::memory_order) noexcept {
        return true;
    }
};
template <FullPolicy kFull>
using CorruptedFifo = FifoBuffer<std::int32_t, 3U, kFull, EmptyPolicy::kDoNothing, CorruptedEntry>;

TEST(FifoBufferDeathTest, ACorruptedWordHaltsTheWriter) {
    verifies("SWR-BUF-002", Technique::kFaultInjection, Polarity::kViolation);
    CorruptedFifo<FullPolicy::kOverwrite> overwriting;
    CorruptedFifo<FullPolicy::kDoNothing> rejecting;

    EXPECT_CHECK_FAILS(static_cast<void>(overwriting.publish()), "slot_ring.hpp", 1);
    EXPECT_CHECK_FAILS(static_cast<void>(rejecting.publish()), "index_ring.hpp", 1);
}

TEST(FifoBufferDeathTest, ACorruptedWordHaltsTheReader) {
    verifies("SWR-BUF-002", Technique::kFaultInjection, Polarity::kViolation);
    CorruptedFifo<FullPolicy::kOverwrite> overwriting;
    CorruptedFifo<FullPolicy::kDoNothing> rejecting;

    EXPECT_CHECK_FAILS(static_cast<void>(overwriting.peek()), "slot_ring.hpp", 1);
    EXPECT_CHECK_FAILS(static_cast<void>(rejecting.peek()), "index_ring.hpp", 1);
}

}  // namespace
}  // namespace mamori
