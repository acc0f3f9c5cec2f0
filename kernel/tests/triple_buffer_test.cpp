// SPDX-License-Identifier: Apache-2.0
// Goal: the reader always gets the newest published value, whole and in order, and no side waits.
// Method: single-threaded use, then every interleaving of three writes with three reads of the real code.
#include "mamori/kernel/dataflow/triple_buffer.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <set>
#include <string>

#include "mamori/trace/verifies.hpp"
#include "mamori/verification/failed_check.hpp"
#include "support/interleaving.hpp"

namespace mamori {
namespace {

using namespace testing_support;
using namespace verification;

struct Pair {
    std::uint32_t first;
    std::uint32_t second;
};

class TripleBufferTest : public ::testing::Test {
  protected:
    TripleBuffer<Pair> sut_;
};

TEST_F(TripleBufferTest, TheReaderGetsWhatWasWrittenOnce) {
    verifies("SWR-BUF-001");
    Pair value{};

    sut_.write({1U, 2U});

    ASSERT_TRUE(sut_.take(value));
    EXPECT_EQ(value.first, 1U);
    EXPECT_EQ(value.second, 2U);
    EXPECT_FALSE(sut_.take(value)) << "it is not new a second time";
    EXPECT_EQ(value.first, 1U) << "and the reader's variable is left alone";
}

TEST_F(TripleBufferTest, NothingIsNewBeforeTheFirstWrite) {
    verifies("SWR-BUF-001", Technique::kBoundaryValues);
    Pair value{7U, 8U};

    EXPECT_FALSE(sut_.take(value));
    EXPECT_EQ(value.first, 7U);
    EXPECT_EQ(sut_.get_read_slot().first, 0U) << "value-initialised";
}

TEST_F(TripleBufferTest, OfSeveralWritesTheLastIsTaken) {
    verifies("SWR-BUF-001", Technique::kEquivalenceClasses);
    Pair value{};

    for (std::uint32_t number = 1U; number <= 7U; ++number) {
        sut_.write({number, number});
    }

    ASSERT_TRUE(sut_.take(value));
    EXPECT_EQ(value.first, 7U);
}

TEST_F(TripleBufferTest, WhatIsDroppedIsNotRead) {
    verifies("SWR-KRN-039", Technique::kStateTransition, Polarity::kViolation);
    sut_.write({1U, 1U});
    ASSERT_TRUE(sut_.update());
    sut_.write({2U, 2U});

    sut_.drop();
    EXPECT_FALSE(sut_.update());
    EXPECT_EQ(sut_.get_read_slot().first, 0U);
    sut_.write({3U, 3U});
    ASSERT_TRUE(sut_.update());
    EXPECT_EQ(sut_.get_read_slot().first, 3U);
}

TEST_F(TripleBufferTest, ASlotInPlaceIsSeenWhenItIsPublishedAndNotBefore) {
    verifies("SWR-BUF-001", Technique::kInterface, Polarity::kViolation);
    sut_.get_write_slot() = {1U, 1U};
    EXPECT_FALSE(sut_.update());
    sut_.publish();
    ASSERT_TRUE(sut_.update());
    const Pair& held = sut_.get_read_slot();

    sut_.get_write_slot() = {2U, 2U};
    sut_.publish();
    sut_.get_write_slot() = {3U, 3U};

    EXPECT_EQ(held.first, 1U) << "the reader's slot is left alone until it asks";
    ASSERT_TRUE(sut_.update());
    EXPECT_EQ(sut_.get_read_slot().first, 2U);
    EXPECT_FALSE(sut_.update());
    EXPECT_EQ(sut_.get_read_slot().first, 2U);
}

TEST_F(TripleBufferTest, APublicationExchangesOnlyToReplaceAValueThatWasNotTaken) {
    verifies("SWR-BUF-022", Technique::kInterface);
    using Word = CountedAtomic<std::uint8_t>;
    TripleBuffer<Pair, Word> sut;
    Word::exchange_count = 0U;

    sut.publish();
    EXPECT_EQ(Word::exchange_count, 0U) << "nothing waited";
    sut.publish();
    EXPECT_EQ(Word::exchange_count, 1U) << "a value waited";
    ASSERT_TRUE(sut.update());
    EXPECT_EQ(Word::exchange_count, 2U) << "the reader takes a value";
    sut.publish();
    EXPECT_EQ(Word::exchange_count, 2U) << "the last value was taken";
}

TEST_F(TripleBufferTest, IsConstantInitialised) {
    verifies("SWR-BUF-001", Technique::kInterface);
    static constexpr TripleBuffer<Pair> kBuffer;

    EXPECT_EQ(kBuffer.get_read_slot().first, 0U);
}

/// Two halves of a value are two steps, so a slot with two owners shows as a value of unequal halves.
template <typename Word>
class Crossing {
  public:
    void write_side() {
        for (std::uint32_t number = 1U; number <= kWrites; ++number) {
            Pair& slot = sut_.get_write_slot();
            slot.first = number;
            step();
            slot.second = number;
            sut_.publish();
            completed_ = number;
        }
    }
    void read_side() {
        for (std::uint32_t number = 0U; number < kReads; ++number) {
            const std::uint32_t completed_before = completed_;
            const bool is_new = sut_.update();
            const Pair& slot = sut_.get_read_slot();
            const std::uint32_t first = slot.first;
            step();
            judge({first, slot.second}, is_new, completed_before);
        }
    }
    void finish() {
        std::set<const Pair*> slots{&sut_.get_read_slot(), &sut_.get_write_slot()};
        const bool was_new = sut_.update();
        slots.insert(&sut_.get_read_slot());
        judge(sut_.get_read_slot(), was_new, kWrites);
        sut_.publish();
        slots.insert(&sut_.get_write_slot());
        if (slots.size() != 3U) {
            note("a slot is lost");
        }
    }
    std::string violation;

  private:
    static constexpr std::uint32_t kWrites = 3U;
    static constexpr std::uint32_t kReads = 3U;

    void judge(const Pair& value, bool is_new, std::uint32_t completed_before) {
        if (value.first != value.second) {
            note("a torn value");
        }
        if (value.first < last_) {
            note("a value older than the last");
        }
        if (is_new != (value.first > last_)) {
            note("new and newer are not the same");
        }
        if (value.first < completed_before) {
            note("a completed write is not seen");
        }
        last_ = value.first;
    }
    void note(const char* what) {
        if (violation.empty()) {
            violation = what;
        }
    }

    TripleBuffer<Pair, Word> sut_;
    std::uint32_t completed_{0U};
    std::uint32_t last_{0U};
};

TEST(TripleBufferInterleavingTest, TheSearchVisitsEachInterleavingOnce) {
    verifies("SWR-BUF-001", Technique::kErrorGuessing);
    struct Steps {
        void write_side() {
            for (int i = 0; i < 3; ++i) {
                step();
            }
        }
        void read_side() {
            for (int i = 0; i < 4; ++i) {
                step();
            }
        }
        void finish() {}
        std::string violation;
    };

    EXPECT_EQ(explore<Steps>().interleaving_count, 35U) << "7 steps, 3 of them the writer's: 7! / (3! 4!)";
}

TEST(TripleBufferInterleavingTest, EveryInterleavingOfThreeWritesAndThreeReadsIsWholeNewAndInOrder) {
    verifies("SWR-BUF-001", Technique::kStateTransition);

    const Exploration found = explore<Crossing<SteppedAtomic<std::uint8_t>>>();

    EXPECT_EQ(found.violation, "") << found.schedule;
    EXPECT_EQ(found.interleaving_count, 13648U);
}

/// Seeded defect: load and store in place of one exchange.
struct SplitExchange : SteppedAtomic<std::uint8_t> {
    using SteppedAtomic::SteppedAtomic;
    std::uint8_t exchange(std::uint8_t value, std::memory_order order) noexcept {
        const std::uint8_t before = load(order);
        store(value, order);
        return before;
    }
};

TEST(TripleBufferInterleavingTest, AnExchangeInTwoStepsIsFoundOut) {
    verifies("SWR-BUF-001", Technique::kFaultInjection, Polarity::kViolation);

    const Exploration found = explore<Crossing<SplitExchange>>();

    EXPECT_NE(found.violation, "");
    RecordProperty("schedule", found.schedule);
    RecordProperty("violation", found.violation);
}

/// Seeded defect: a publication loses the flag.
struct ForgetfulExchange : SteppedAtomic<std::uint8_t> {
    using SteppedAtomic::SteppedAtomic;
    std::uint8_t exchange(std::uint8_t value, std::memory_order order) noexcept {
        return SteppedAtomic::exchange(value & 3U, order);
    }
    void store(std::uint8_t value, std::memory_order order) noexcept {
        SteppedAtomic::store(value & 3U, order);
    }
};

TEST(TripleBufferInterleavingTest, APublicationWithoutItsFlagIsFoundOut) {
    verifies("SWR-BUF-001", Technique::kFaultInjection, Polarity::kViolation);

    EXPECT_EQ(explore<Crossing<ForgetfulExchange>>().violation, "a completed write is not seen");
}

TEST_F(TripleBufferTest, EachSlotIsUsedInTurnWithoutAFailedCheck) {
    verifies("SWR-BUF-002");
    std::set<const Pair*> slots;

    for (int cycle = 0; cycle < 6; ++cycle) {
        slots.insert(&sut_.get_write_slot());
        sut_.publish();
        ASSERT_TRUE(sut_.update());
        slots.insert(&sut_.get_read_slot());
    }

    EXPECT_EQ(slots.size(), 3U);
}

/// A word that names a fourth slot, as only corrupted memory does.
struct CorruptedWord : SteppedAtomic<std::uint8_t> {
    using SteppedAtomic::SteppedAtomic;
    std::uint8_t load(std::memory_order) const noexcept { return 7U; }
    std::uint8_t exchange(std::uint8_t, std::memory_order) noexcept { return 7U; }
};

TEST(TripleBufferDeathTest, ACorruptedWordHaltsTheWriter) {
    verifies("SWR-BUF-002", Technique::kFaultInjection, Polarity::kViolation);
    TripleBuffer<Pair, CorruptedWord> sut;

    EXPECT_CHECK_FAILS(sut.publish(), "triple_buffer.hpp", 1);
}

TEST(TripleBufferDeathTest, ACorruptedWordHaltsTheReader) {
    verifies("SWR-BUF-002", Technique::kFaultInjection, Polarity::kViolation);
    TripleBuffer<Pair, CorruptedWord> sut;

    EXPECT_CHECK_FAILS(static_cast<void>(sut.update()), "triple_buffer.hpp", 1);
}

}  // namespace
}  // namespace mamori
