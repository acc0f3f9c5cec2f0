// SPDX-License-Identifier: Apache-2.0
// Goal: a reader gets a whole value that was current during the call, or is told that it got none.
// Method: one thread, then every interleaving of two writes with one read of the real code; seeded defects.
#include "mamori/kernel/dataflow/snapshot_cell.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <string>

#include "mamori/trace/verifies.hpp"
#include "support/interleaving.hpp"

namespace mamori {
namespace {

using namespace testing_support;
using namespace verification;

TEST(SnapshotCellTest, EveryReaderGetsWhatWasWrittenLast) {
    verifies("SWR-BUF-007");
    SnapshotCell<std::array<std::uint8_t, 13U>> sut;  // no whole number of words
    std::array<std::uint8_t, 13U> value{};
    std::array<std::uint8_t, 13U> written{1U, 2U, 3U, 4U, 5U, 6U, 7U, 8U, 9U, 10U, 11U, 12U, 13U};

    sut.write({});
    sut.write(written);

    ASSERT_EQ(sut.try_read(value), Status::kOk);
    EXPECT_EQ(value, written);
    value = {};
    ASSERT_EQ(sut.try_read(value), Status::kOk) << "reading takes nothing away";
    EXPECT_EQ(value, written);
}

TEST(SnapshotCellTest, NothingCanBeReadBeforeTheFirstWrite) {
    verifies("SWR-BUF-007", Technique::kBoundaryValues, Polarity::kViolation);
    static SnapshotCell<std::int16_t> sut;
    std::int16_t value = 7;

    EXPECT_EQ(sut.try_read(value), Status::kPreconditionNotMet);
    EXPECT_EQ(value, 7);
}

TEST(SnapshotCellTest, EachWriteCanBeReadAlsoWhereTheSequenceNumberWraps) {
    verifies("SWR-BUF-007", Technique::kBoundaryValues, Polarity::kViolation);
    SnapshotCell<std::int16_t, std::atomic<std::uint8_t>> sut;
    for (std::int16_t written = 1; written <= 600; ++written) {
        std::int16_t value = 0;
        sut.write(written);

        ASSERT_EQ(sut.try_read(value), Status::kOk) << written;
        EXPECT_EQ(value, written);
    }
}

struct Pair {
    std::uint32_t first;
    std::uint32_t second;
};

template <typename Word, std::uint32_t kWrites>
class Looking {
  public:
    void write_side() {
        for (std::uint32_t number = 1U; number <= kWrites; ++number) {
            started_ = number;
            sut_.write({number, number});
            completed_ = number;
        }
    }
    void read_side() { read(); }
    void finish() {
        read();
        if (last_ != kWrites) {
            note("the last value cannot be read at rest");
        }
    }
    std::string violation;
    bool was_outrun{false};

  private:
    void read() {
        const std::uint32_t completed_before = completed_;
        const std::uint32_t started_before = started_;
        Pair value{};
        const Status status = sut_.try_read(value);
        if (status == Status::kPreconditionNotMet && completed_before > 0U) {
            note("a completed write is not seen");
        }
        if (status == Status::kOutOfResources && started_ == started_before && started_ == completed_before) {
            note("the reader gave up although nobody wrote");
        }
        was_outrun = was_outrun || status == Status::kOutOfResources;
        if (status == Status::kOk) {
            if (value.first != value.second) {
                note("a torn value");
            }
            if (value.first < completed_before || value.first > started_) {
                note("a value that was not current during the call");
            }
            last_ = value.first;
        }
    }
    void note(const char* what) {
        if (violation.empty()) {
            violation = what;
        }
    }

    SnapshotCell<Pair, Word> sut_;
    std::uint32_t started_{0U};
    std::uint32_t completed_{0U};
    std::uint32_t last_{0U};
};
using SteppedWord = SteppedAtomic<std::uint32_t>;

TEST(SnapshotCellInterleavingTest, NoInterleavingGivesATornOrOldValue) {
    verifies("SWR-BUF-007", Technique::kStateTransition);

    const Exploration found = explore<Looking<SteppedWord, 2U>>();

    EXPECT_EQ(found.violation, "") << found.schedule;
    EXPECT_EQ(found.interleaving_count, 47549U);
}

/// Looks for an interleaving in which the reader gives up.
struct Outrun : Looking<SteppedWord, 3U> {
    void finish() {
        Looking::finish();
        if (violation.empty() && was_outrun) {
            violation = "outrun";
        }
    }
};

TEST(SnapshotCellInterleavingTest, AReaderThatIsOvertakenEachTimeIsTold) {
    verifies("SWR-BUF-007", Technique::kErrorGuessing, Polarity::kViolation);

    EXPECT_EQ(explore<Outrun>().violation, "outrun");
}

/// Seeded defect: the number is never odd (its odd store is the only relaxed one).
struct NeverOdd : SteppedWord {
    using SteppedWord::SteppedWord;
    void store(std::uint32_t value, std::memory_order order) noexcept {
        if (order != std::memory_order_relaxed) {
            SteppedWord::store(value, order);
        }
    }
};

TEST(SnapshotCellInterleavingTest, ANumberThatIsNeverOddIsFoundOut) {
    verifies("SWR-BUF-007", Technique::kFaultInjection, Polarity::kViolation);

    EXPECT_EQ((explore<Looking<NeverOdd, 2U>>().violation), "a torn value");
}

TEST(SnapshotCellTest, AWriterThatIsCutOffLeavesNothingToBeSeenUntilTheNextWrite) {
    verifies("SWR-BUF-007", Technique::kFaultInjection, Polarity::kViolation);
    constexpr int kStores = 4;
    for (int stores = 1; stores < kStores; ++stores) {
        SnapshotCell<Pair, SteppedWord> sut;
        Pair value{};
        sut.write({1U, 1U});
        testing_support::Side cut_off;
        cut_off.begin([&sut] { sut.write({2U, 2U}); });
        for (int i = 0; i < stores; ++i) {
            cut_off.resume();
        }

        EXPECT_EQ(sut.try_read(value), Status::kOutOfResources) << stores;
        sut.write({3U, 3U});

        ASSERT_EQ(sut.try_read(value), Status::kOk) << stores;
        EXPECT_EQ(value.first, 3U);
        EXPECT_EQ(value.second, 3U);
    }
}

}  // namespace
}  // namespace mamori
