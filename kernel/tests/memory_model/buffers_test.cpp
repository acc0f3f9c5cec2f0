// SPDX-License-Identifier: Apache-2.0
// Goal: the memory orders of the kernel's buffers are strong enough on every machine, not only on this one.
// Method: Relacy runs the real code through all interleavings with all values that the C++ memory model
//         allows a load to give, and watches the payloads for data races. Each order that is weakened on
//         purpose must be found out.
#include <gtest/gtest.h>

#include <cstdint>
#include <ostream>
#include <string>

#include "mamori/kernel/dataflow/fifo_buffer.hpp"
#include "mamori/kernel/dataflow/snapshot_cell.hpp"
#include "mamori/trace/verifies.hpp"
#include "relaxed_word.hpp"

namespace mamori::verification {
namespace {

constexpr auto kRelaxed = std::memory_order_relaxed;
constexpr auto kAcquire = std::memory_order_acquire;
constexpr auto kRelease = std::memory_order_release;
constexpr auto kAcqRel = std::memory_order_acq_rel;

struct Found {
    std::string result;
    std::uint64_t execution_count;
};

/// Searches all executions, or up to the first that is wrong.
template <typename Suite>
Found search() {
    std::ostream silent{nullptr};
    rl::test_params parameters;
    parameters.search_type = rl::fair_full_search_scheduler_type;
    parameters.output_stream = &silent;
    parameters.progress_stream = &silent;
    rl::simulate<Suite>(parameters);
    return {rl::test_result_str(parameters.test_result), parameters.stop_iteration + 1U};
}

/// All executions are right. Their number is pinned, so that a search that became smaller is noticed.
template <typename Suite>
void expect_clean(std::uint64_t execution_count) {
    const Found found = search<Suite>();
    EXPECT_EQ(found.result, rl::test_result_str(rl::test_result_success));
    EXPECT_EQ(found.execution_count, execution_count);
}

template <typename Suite>
std::string find_defect() {
    return search<Suite>().result;
}
constexpr const char* kRace = "DATA RACE";
constexpr const char* kWrong = "USER ASSERT FAILED";

/// What is searched: the buffer, how often it is written and read, and whether the writer also tells by
/// another word what it has written, so that the reader may rely on it.
template <std::size_t kCapacityValue, FullPolicy kFullValue, int kWritesValue, int kReadsValue,
          bool kIsSignalledValue>
struct Shape {
    static constexpr std::size_t kCapacity = kCapacityValue;
    static constexpr FullPolicy kFull = kFullValue;
    static constexpr int kWrites = kWritesValue;
    static constexpr int kReads = kReadsValue;
    static constexpr bool kIsSignalled = kIsSignalledValue;
};

template <typename Shape, typename Orders>
struct FifoSuite : rl::test_suite<FifoSuite<Shape, Orders>, 2U> {
    using Fifo = FifoBuffer<unsigned, Shape::kCapacity, Shape::kFull, EmptyPolicy::kDoNothing,
                            RelaxedWord<std::uint32_t, Orders>>;
    Fifo sut;
    Payloads<unsigned, sizeof(Fifo)> payloads;
    RelaxedWord<unsigned> signal;
    unsigned accepted{0U};
    unsigned last{0U};
    unsigned read_count{0U};

    void thread(unsigned index) {
        if (index == 0U) {
            for (int i = 0; i < Shape::kWrites; ++i) {
                write();
            }
        } else {
            for (int i = 0; i < Shape::kReads; ++i) {
                read();
            }
        }
    }
    void after() {
        for (std::size_t i = 0U; i < Shape::kCapacity; ++i) {
            read();
        }
        RL_ASSERT(last == accepted);
        RL_ASSERT(read_count + sut.get_overwritten_count() == accepted);
    }
    void write() {
        payloads.write(&sut, sut.get_write_slot(), accepted + 1U);
        if (sut.publish() == Status::kOk) {
            ++accepted;
            if (Shape::kIsSignalled) {
                signal.store(accepted, kRelease);
            }
        }
    }
    void read() {
        const unsigned known = Shape::kIsSignalled ? signal.load(kAcquire) : 0U;
        const Status status = sut.peek();
        if (status == Status::kOk) {
            const unsigned number = payloads.read(&sut, sut.get_front());
            RL_ASSERT(number > last);
            last = number;
            ++read_count;
            sut.drop();
        } else {
            RL_ASSERT(status == Status::kOutOfResources || known <= last);
        }
    }
};

constexpr auto kRefuse = FullPolicy::kDoNothing;
constexpr auto kOverwrite = FullPolicy::kOverwrite;

TEST(MemoryModelTest, TheRefusingFifoHasNoRaceUnderAnyOrderThatTheLanguageAllows) {
    verifies("SWR-BUF-003", Technique::kStateTransition);

    expect_clean<FifoSuite<Shape<1U, kRefuse, 4, 3, false>, AsWritten>>(3256U);
    expect_clean<FifoSuite<Shape<1U, kRefuse, 3, 2, true>, AsWritten>>(11325U);
    expect_clean<FifoSuite<Shape<2U, kRefuse, 4, 2, false>, AsWritten>>(2516U);
    expect_clean<FifoSuite<Shape<2U, kRefuse, 3, 2, true>, AsWritten>>(70668U);
}

TEST(MemoryModelTest, TheOverwritingFifoHasNoRaceUnderAnyOrderThatTheLanguageAllows) {
    verifies("SWR-BUF-004", Technique::kStateTransition);

    expect_clean<FifoSuite<Shape<1U, kOverwrite, 3, 2, false>, AsWritten>>(31619U);
    expect_clean<FifoSuite<Shape<1U, kOverwrite, 3, 1, true>, AsWritten>>(388226U);
    expect_clean<FifoSuite<Shape<2U, kOverwrite, 4, 1, false>, AsWritten>>(10779U);
    expect_clean<FifoSuite<Shape<2U, kOverwrite, 3, 1, true>, AsWritten>>(13545U);
}

template <typename Orders>
using RefusingSuite = FifoSuite<Shape<1U, kRefuse, 4, 3, false>, Orders>;

TEST(MemoryModelTest, EachOrderOfTheRefusingFifoIsNeeded) {
    verifies("SWR-BUF-003", Technique::kFaultInjection, Polarity::kViolation);

    EXPECT_EQ((find_defect<RefusingSuite<Weakened<kRelease, kRelaxed, kWriter>>>()), kRace);
    EXPECT_EQ((find_defect<RefusingSuite<Weakened<kAcquire, kRelaxed, kWriter>>>()), kRace);
    EXPECT_EQ((find_defect<RefusingSuite<Weakened<kRelease, kRelaxed, kReader>>>()), kRace);
    EXPECT_EQ((find_defect<RefusingSuite<Weakened<kAcquire, kRelaxed, kReader>>>()), kRace);
}

template <typename Orders>
using OverwritingSuite = FifoSuite<Shape<1U, kOverwrite, 4, 3, false>, Orders>;

TEST(MemoryModelTest, EachOrderOfTheOverwritingFifoIsNeeded) {
    verifies("SWR-BUF-004", Technique::kFaultInjection, Polarity::kViolation);

    EXPECT_EQ((find_defect<OverwritingSuite<Weakened<kRelease, kRelaxed, kWriter>>>()), kRace);
    EXPECT_EQ((find_defect<OverwritingSuite<Weakened<kAcquire, kRelaxed, kWriter>>>()), kRace);
    EXPECT_EQ((find_defect<OverwritingSuite<Weakened<kAcqRel, kAcquire, kWriter>>>()), kRace);
    EXPECT_EQ((find_defect<OverwritingSuite<Weakened<kAcqRel, kRelease, kWriter>>>()), kRace);
    EXPECT_EQ((find_defect<OverwritingSuite<Weakened<kRelease, kRelaxed, kReader>>>()), kRace);
    EXPECT_EQ((find_defect<OverwritingSuite<Weakened<kAcquire, kRelaxed, kReader>>>()), kRace);
}

TEST(MemoryModelTest, ASearchForTheOldestEntryNeedsItsAnnouncement) {
    verifies("SWR-BUF-004", Technique::kFaultInjection, Polarity::kViolation);

    EXPECT_EQ((find_defect<FifoSuite<Shape<2U, kOverwrite, 6, 1, true>, WeakAnnouncement>>()), kWrong);
}

struct Pair {
    std::uint32_t first;
    std::uint32_t second;
};

template <typename Orders>
struct SnapshotSuite : rl::test_suite<SnapshotSuite<Orders>, 2U> {
    SnapshotCell<Pair, RelaxedWord<std::uint32_t, Orders>> sut;

    void before() { sut.write({1U, 1U}); }
    void thread(unsigned index) {
        if (index == 0U) {
            sut.write({2U, 2U});
        } else {
            static_cast<void>(read());
        }
    }
    void after() { RL_ASSERT(read() == 2U); }
    std::uint32_t read() {
        Pair value{};
        const Status status = sut.try_read(value);
        RL_ASSERT(value.first == value.second);
        RL_ASSERT((status == Status::kOk) == (value.first > 0U) && status != Status::kPreconditionNotMet);
        return value.first;
    }
};

TEST(MemoryModelTest, ASnapshotIsWholeUnderEveryOrderThatTheLanguageAllows) {
    verifies("SWR-BUF-007", Technique::kStateTransition);

    expect_clean<SnapshotSuite<AsWritten>>(99367U);
}

TEST(MemoryModelTest, ASnapshotNeedsItsReleasesAndAcquires) {
    verifies("SWR-BUF-007", Technique::kFaultInjection, Polarity::kViolation);

    EXPECT_EQ((find_defect<SnapshotSuite<Weakened<kRelease, kRelaxed, kWriter>>>()), kWrong);
    EXPECT_EQ((find_defect<SnapshotSuite<Weakened<kAcquire, kRelaxed, kReader>>>()), kWrong);
}

}  // namespace
}  // namespace mamori::verification
