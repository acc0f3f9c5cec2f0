// SPDX-License-Identifier: Apache-2.0
// Goal: across cores a FIFO tears, reorders and loses nothing that its policy does not name.
// Method: every interleaving of three writes with one to three reads of the real code, from an empty and
//         from a full buffer; seeded defects must be found by the same search.
#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include "mamori/kernel/dataflow/fifo_buffer.hpp"
#include "mamori/trace/verifies.hpp"
#include "support/interleaving.hpp"

namespace mamori {
namespace {

using namespace testing_support;
using namespace verification;

struct Pair {
    std::uint32_t first;
    std::uint32_t second;
};

/// What is explored: capacity, entries before both sides begin, reads.
template <std::size_t kCapacityValue, std::uint32_t kFilledValue, std::uint32_t kReadsValue,
          FullPolicy kFullValue>
struct Shape {
    static constexpr std::size_t kCapacity = kCapacityValue;
    static constexpr std::uint32_t kFilled = kFilledValue;
    static constexpr std::uint32_t kReads = kReadsValue;
    static constexpr FullPolicy kFull = kFullValue;
};

template <typename Shape, typename Word>
class Crossing {
  public:
    Crossing() {
        for (std::uint32_t i = 0U; i < Shape::kFilled; ++i) {
            write();
        }
    }
    void write_side() {
        for (std::uint32_t i = 0U; i < 3U; ++i) {
            write();
        }
    }
    void read_side() {
        for (std::uint32_t i = 0U; i < Shape::kReads; ++i) {
            read();
        }
    }
    void finish() {
        for (std::size_t i = 0U; i < Shape::kCapacity; ++i) {
            read();
        }
        if (last_ != completed_) {
            note("an entry is left behind");
        }
        if (read_count_ + sut_.get_overwritten_count() != completed_) {
            note("an entry is read or lost twice, or neither");
        }
    }
    std::string violation;

  private:
    static constexpr std::uint32_t kCapacity = Shape::kCapacity;

    void write() {
        const std::uint32_t number = completed_ + 1U;
        const std::uint32_t read_before = read_count_;
        started_ = number;
        sut_.get_write_slot().first = number;
        step();
        sut_.get_write_slot().second = number;
        if (sut_.publish() == Status::kOk) {
            completed_ = number;
        } else if (completed_ - read_before < kCapacity) {
            note("an entry is refused although there was room");
        }
    }
    void read() {
        const std::uint32_t completed_before = completed_;
        const Status status = sut_.peek();
        if (status == Status::kPreconditionNotMet && completed_before > last_) {
            note("a completed entry is not seen");
        }
        outrun_count_ += status == Status::kOutOfResources ? 1U : 0U;
        // The first attempt needs no publication meanwhile: it may find an entry of a later lap.
        if (status == Status::kOutOfResources &&
            started_ < completed_before + detail::SlotRing<1U, std::atomic<std::uint32_t>>::kTries - 2U) {
            note("the reader gave up before the writer had outrun it");
        }
        if (status == Status::kOk) {
            const std::uint32_t first = sut_.get_front().first;
            step();
            judge({first, sut_.get_front().second});
            sut_.drop();
        }
    }
    void judge(const Pair& value) {
        if (value.first != value.second) {
            note("a torn entry");
        }
        if (value.first <= last_) {
            note("an entry is read twice or out of order");
        }
        if (value.first > last_ + 1U && value.first - 1U + kCapacity > started_) {
            note("an entry is skipped although it had room");
        }
        last_ = value.first;
        ++read_count_;
    }
    void note(const char* what) {
        if (violation.empty()) {
            violation = what;
        }
    }

    FifoBuffer<Pair, Shape::kCapacity, Shape::kFull, EmptyPolicy::kDoNothing, Word> sut_;
    std::uint32_t started_{0U};
    std::uint32_t completed_{0U};
    std::uint32_t read_count_{0U};
    std::uint32_t last_{0U};

  protected:
    std::uint32_t outrun_count_{0U};
};

/// @return the number of interleavings; a violation fails the test.
template <std::size_t kCapacity, std::uint32_t kFilled, std::uint32_t kReads, FullPolicy kFull>
std::uint64_t count_clean() {
    const Exploration found =
        explore<Crossing<Shape<kCapacity, kFilled, kReads, kFull>, SteppedAtomic<std::uint32_t>>>();
    EXPECT_EQ(found.violation, "") << found.schedule;
    return found.interleaving_count;
}

TEST(FifoInterleavingTest, TheSearchVisitsEachInterleavingOnce) {
    verifies("SWR-BUF-003", Technique::kErrorGuessing);
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

TEST(FifoInterleavingTest, RefusingAcrossCoresTearsAndReordersNothing) {
    verifies("SWR-BUF-003", Technique::kStateTransition);

    EXPECT_EQ((count_clean<1U, 0U, 3U, FullPolicy::kDoNothing>()), 1493U);
    EXPECT_EQ((count_clean<1U, 1U, 3U, FullPolicy::kDoNothing>()), 4386U);
    EXPECT_EQ((count_clean<2U, 0U, 3U, FullPolicy::kDoNothing>()), 3608U);
    EXPECT_EQ((count_clean<2U, 2U, 3U, FullPolicy::kDoNothing>()), 9239U);
}

TEST(FifoInterleavingTest, OverwritingAcrossCoresLosesTheOldestOnly) {
    verifies("SWR-BUF-004", Technique::kStateTransition);

    EXPECT_EQ((count_clean<1U, 0U, 3U, FullPolicy::kOverwrite>()), 28461U);
    EXPECT_EQ((count_clean<1U, 1U, 2U, FullPolicy::kOverwrite>()), 123195U);
    EXPECT_EQ((count_clean<2U, 2U, 2U, FullPolicy::kOverwrite>()), 207878U);
    EXPECT_EQ((count_clean<2U, 5U, 1U, FullPolicy::kOverwrite>()), 85135U);
}

/// Looks for an interleaving in which the reader gives up.
struct Outrun : Crossing<Shape<2U, 5U, 1U, FullPolicy::kOverwrite>, SteppedAtomic<std::uint32_t>> {
    void finish() {
        Crossing::finish();
        if (violation.empty() && outrun_count_ > 0U) {
            violation = "outrun, and nothing lost that was left";
        }
    }
};

TEST(FifoInterleavingTest, AReaderThatIsOutrunGivesUpAndFindsTheRestLater) {
    verifies("SWR-BUF-004", Technique::kErrorGuessing, Polarity::kViolation);

    EXPECT_EQ(explore<Outrun>().violation, "outrun, and nothing lost that was left");
}

/// Seeded defect: the entry is taken with a load and a store in place of a compare-and-exchange.
struct SplitClaim : SteppedAtomic<std::uint32_t> {
    using SteppedAtomic::SteppedAtomic;
    bool compare_exchange_strong(std::uint32_t& expected, std::uint32_t value, std::memory_order order,
                                 std::memory_order) noexcept {
        if (load(order) != expected) {
            return false;
        }
        store(value, order);
        return true;
    }
};

TEST(FifoInterleavingTest, AClaimInTwoStepsIsFoundOut) {
    verifies("SWR-BUF-004", Technique::kFaultInjection, Polarity::kViolation);

    const Exploration found = explore<Crossing<Shape<2U, 2U, 2U, FullPolicy::kOverwrite>, SplitClaim>>();

    EXPECT_NE(found.violation, "");
    RecordProperty("violation", found.violation);
    RecordProperty("schedule", found.schedule);
}

/// Seeded defect: the claim takes what is there, although the writer may have replaced it meanwhile.
struct BlindClaim : SteppedAtomic<std::uint32_t> {
    using SteppedAtomic::SteppedAtomic;
    bool compare_exchange_strong(std::uint32_t& expected, std::uint32_t value, std::memory_order order,
                                 std::memory_order) noexcept {
        expected = exchange(value, order);
        return true;
    }
};

TEST(FifoInterleavingTest, AClaimOfWhateverIsThereIsFoundOut) {
    verifies("SWR-BUF-003", Technique::kFaultInjection, Polarity::kViolation);

    const Exploration found = explore<Crossing<Shape<2U, 2U, 2U, FullPolicy::kOverwrite>, BlindClaim>>();

    EXPECT_NE(found.violation, "");
    RecordProperty("violation", found.violation);
    RecordProperty("schedule", found.schedule);
}

}  // namespace
}  // namespace mamori
