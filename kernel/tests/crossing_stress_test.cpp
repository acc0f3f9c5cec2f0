// SPDX-License-Identifier: Apache-2.0
// Goal: two real threads exchange values as the interleavings promise, on this machine's memory order.
// Method: a fixed number of writes at full speed while another thread reads; run under the thread sanitizer
//         too, which reports each pair of accesses that nothing orders. The numbers are checked, never times.
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <thread>

#include "mamori/kernel/dataflow/connection.hpp"
#include "mamori/kernel/dataflow/fifo_buffer.hpp"
#include "mamori/kernel/dataflow/snapshot_cell.hpp"
#include "mamori/trace/verifies.hpp"

namespace mamori {
namespace {

using namespace verification;

constexpr std::uint32_t kWrites = 500'000U;

/// Larger than a cache line, so that a torn copy has room to happen.
using Block = std::array<std::uint32_t, 32U>;

Block make_block(std::uint32_t number) {
    Block block{};
    block.fill(number);
    return block;
}

/// Counts what must not be; gtest's own checks are too slow for the inner loop.
struct Judge {
    void see(const Block& block) {
        for (const std::uint32_t word : block) {
            torn += word != block[0] ? 1U : 0U;
        }
        backward += block[0] < last ? 1U : 0U;
        repeated += block[0] == last ? 1U : 0U;
        skipped += block[0] > last + 1U ? block[0] - last - 1U : 0U;
        last = block[0];
        ++seen;
    }
    std::uint64_t torn{0U};
    std::uint64_t backward{0U};
    std::uint64_t repeated{0U};
    std::uint64_t skipped{0U};
    std::uint64_t seen{0U};
    std::uint32_t last{0U};
};

/// Runs `write(number)` for 1 .. kWrites on a thread of its own, and `read()` here until all of them are
/// written, and once more.
template <typename Write, typename Read>
void run_both(Write write, Read read) {
    std::atomic<bool> is_done{false};
    std::thread writer([&] {
        for (std::uint32_t number = 1U; number <= kWrites; ++number) {
            write(number);
        }
        is_done.store(true, std::memory_order_release);
    });
    while (!is_done.load(std::memory_order_acquire)) {
        read();
    }
    writer.join();
    read();
}

TEST(CrossingStressTest, ACrossingGivesWholeValuesInOrderAndTheLastOne) {
    verifies("SWR-KRN-026", Technique::kErrorGuessing);
    static Crossing<Block> sut;
    static OutPort<Block> source{kNoOwner, "source"};
    static InPort<Block> sink{kNoOwner, "sink"};
    Judge judge;

    run_both(
        [](std::uint32_t number) {
            source.write(make_block(number));
            ASSERT_TRUE(source.publish(Instant{number}));
            sut.deliver(source);
        },
        [&] {
            sut.latch(sink, Instant{kWrites});
            if (sink.is_new()) {
                judge.see(sink.read());
                sink.mark_read();
            }
        });

    EXPECT_EQ(judge.torn, 0U);
    EXPECT_EQ(judge.backward + judge.repeated, 0U);
    EXPECT_EQ(judge.last, kWrites);
    EXPECT_EQ(judge.seen + judge.skipped, kWrites);
}

TEST(CrossingStressTest, ARefusingFifoLosesNothingThatItAccepted) {
    verifies("SWR-BUF-003", Technique::kErrorGuessing);
    static FifoBuffer<Block, 4U, FullPolicy::kDoNothing, EmptyPolicy::kDoNothing> sut;
    Judge judge;
    Block block{};
    std::uint32_t accepted = 0U;

    run_both([&accepted](
                 std::uint32_t) { accepted += sut.push(make_block(accepted + 1U)) == Status::kOk ? 1U : 0U; },
             [&] {
                 for (int i = 0; i < 4 && sut.pop(block) == Status::kOk; ++i) {
                     judge.see(block);
                 }
             });

    EXPECT_EQ(judge.torn, 0U);
    EXPECT_EQ(judge.backward + judge.repeated + judge.skipped, 0U);
    EXPECT_EQ(judge.seen, accepted);
    EXPECT_EQ(accepted + sut.get_rejected_count(), kWrites);
}

TEST(CrossingStressTest, AnOverwritingFifoLosesExactlyWhatItCounts) {
    verifies("SWR-BUF-004", Technique::kErrorGuessing);
    static FifoBuffer<Block, 4U, FullPolicy::kOverwrite, EmptyPolicy::kDoNothing> sut;
    Judge judge;
    Block block{};

    run_both([](std::uint32_t number) { EXPECT_EQ(sut.push(make_block(number)), Status::kOk); },
             [&] {
                 for (int i = 0; i < 4 && sut.pop(block) == Status::kOk; ++i) {
                     judge.see(block);
                 }
             });

    EXPECT_EQ(judge.torn, 0U);
    EXPECT_EQ(judge.backward + judge.repeated, 0U);
    EXPECT_EQ(judge.skipped, sut.get_overwritten_count());
    EXPECT_EQ(judge.seen + judge.skipped, kWrites);
}

TEST(CrossingStressTest, ASnapshotIsWholeAndNeverGoesBack) {
    verifies("SWR-BUF-007", Technique::kErrorGuessing);
    static SnapshotCell<Block> sut;
    Judge judge;
    Block block{};

    run_both([](std::uint32_t number) { sut.write(make_block(number)); },
             [&] {
                 if (sut.try_read(block) == Status::kOk) {
                     judge.see(block);
                 }
             });

    EXPECT_EQ(judge.torn, 0U);
    EXPECT_EQ(judge.backward, 0U);
    EXPECT_EQ(judge.last, kWrites);
}

}  // namespace
}  // namespace mamori
