// SPDX-License-Identifier: Apache-2.0
// Goal: the channel passes messages on in order, and loses, delays and damages exactly those it is told to.
// Method: cycles of 10 ns by hand; both sides of a delay; the full queue; faults that come and go.
#include "mamori/ports/virtual_time/simulated_channel.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "mamori/ports/virtual_time/virtual_host.hpp"
#include "mamori/trace/verifies.hpp"

namespace mamori::ports::virtual_time {
namespace {

using namespace verification;

constexpr int kNothing = -1;

class SimulatedChannelTest : public ::testing::Test {
  protected:
    /// One cycle: `message` arrives unless it is kNothing. @return what leaves, kNothing when nothing does.
    int run_cycle(int message) {
        if (message != kNothing) {
            source_.write(message);
            EXPECT_TRUE(source_.publish(now_));
        }
        sut_.in.take(source_.get_published_sample());
        EXPECT_EQ(sut_.on_execute({0, now_}), Status::kOk);
        sut_.in.mark_read();
        now_ = now_ + 10_ns;
        return sut_.out.publish(now_) ? sut_.out.get_published() : kNothing;
    }
    std::vector<int> run_cycles(const std::vector<int>& messages) {
        std::vector<int> leaving;
        for (const int message : messages) {
            leaving.push_back(run_cycle(message));
        }
        return leaving;
    }

    SimulatedChannel<int, 3U> sut_{"channel"};
    OutPort<int> source_{kNoOwner, "source"};
    Instant now_{};
};

using Messages = std::vector<int>;

TEST_F(SimulatedChannelTest, WithoutAFaultEachMessageLeavesInItsCycleOnce) {
    verifies("SWR-VTM-004");

    EXPECT_EQ(run_cycles({1, 2, kNothing, 3}), (Messages{1, 2, kNothing, 3}));
    EXPECT_EQ(sut_.get_dropped_count(), 0U);
}

TEST_F(SimulatedChannelTest, WhileLosingNothingLeavesAndNothingComesLater) {
    verifies("SWR-VTM-004", Technique::kFaultInjection);
    EXPECT_EQ(run_cycle(1), 1);

    sut_.set_fault({true, 0_ns});
    EXPECT_EQ(run_cycles({2, 3}), (Messages{kNothing, kNothing}));
    sut_.set_fault({});

    EXPECT_EQ(run_cycles({kNothing, 4}), (Messages{kNothing, 4}));
}

TEST_F(SimulatedChannelTest, AnInvertedBitIsForBytesOnly) {
    verifies("SWR-VTM-004", Technique::kEquivalenceClasses);
    ChannelFault fault{};
    fault.inverted_bit = 1U;
    sut_.set_fault(fault);
    EXPECT_EQ(run_cycle(4), 4);
}

TEST(SimulatedChannelOfBytesTest, ADamagedMessageHasOneInvertedBit) {
    verifies("SWR-VTM-004", Technique::kFaultInjection);
    using Bytes = BoundedSequence<std::uint8_t, 4U>;
    SimulatedChannel<Bytes, 3U> sut{"channel"};
    OutPort<Bytes> source{kNoOwner, "source"};
    const auto send = [&](std::size_t size) {
        Bytes message{};
        EXPECT_EQ(message.resize(size), Status::kOk);
        source.write(message);
        EXPECT_TRUE(source.publish({}));
        sut.in.take(source.get_published_sample());
        EXPECT_EQ(sut.on_execute({}), Status::kOk);
        EXPECT_TRUE(sut.out.publish({}));
        return sut.out.get_published();
    };
    ChannelFault fault{};
    fault.inverted_bit = 19U;
    sut.set_fault(fault);
    const Bytes damaged = send(3U);
    EXPECT_EQ(damaged[0], 0U);
    EXPECT_EQ(damaged[2], 8U);
    EXPECT_EQ(send(2U)[0], 8U) << "from the front again";
    EXPECT_EQ(send(0U).size(), 0U);
    sut.set_fault({});
    EXPECT_EQ(send(3U)[2], 0U);
}

TEST_F(SimulatedChannelTest, ADelayedMessageLeavesInTheFirstCycleThatIsLateEnough) {
    verifies("SWR-VTM-004", Technique::kBoundaryValues);

    sut_.set_fault({false, 20_ns});
    EXPECT_EQ(run_cycles({1, kNothing, kNothing, kNothing}), (Messages{kNothing, kNothing, 1, kNothing}));
    sut_.set_fault({false, 21_ns});
    EXPECT_EQ(run_cycles({2, kNothing, kNothing, kNothing}), (Messages{kNothing, kNothing, kNothing, 2}));
    sut_.set_fault({false, 19_ns});
    EXPECT_EQ(run_cycles({3, kNothing, kNothing, kNothing}), (Messages{kNothing, kNothing, 3, kNothing}));
}

TEST_F(SimulatedChannelTest, AStreamUnderDelayKeepsItsOrderAndSpacing) {
    verifies("SWR-VTM-004", Technique::kFaultInjection);

    sut_.set_fault({false, 20_ns});

    EXPECT_EQ(run_cycles({1, 2, 3, 4, kNothing, kNothing}), (Messages{kNothing, kNothing, 1, 2, 3, 4}));
    EXPECT_EQ(sut_.get_dropped_count(), 0U);
}

TEST_F(SimulatedChannelTest, AMessageWithoutDelayDoesNotOvertakeADelayedOne) {
    verifies("SWR-VTM-004", Technique::kErrorGuessing);
    sut_.set_fault({false, 20_ns});
    EXPECT_EQ(run_cycle(1), kNothing);
    sut_.set_fault({});

    EXPECT_EQ(run_cycles({2, 3}), (Messages{kNothing, 3}))
        << "1, 2 and 3 are due together: the newest leaves";
}

TEST_F(SimulatedChannelTest, TheOldestGivesWayWhenTheQueueIsFull) {
    verifies("SWR-VTM-004", Technique::kBoundaryValues);
    sut_.set_fault({false, 40_ns});

    // The queue holds three: 1 has given way to 4, 2 to 5, when their time comes.
    EXPECT_EQ(run_cycles({1, 2, 3, 4, 5}), (Messages{kNothing, kNothing, kNothing, kNothing, kNothing}));
    EXPECT_EQ(sut_.get_dropped_count(), 2U);
    EXPECT_EQ(run_cycles({kNothing, kNothing, kNothing, kNothing, kNothing}),
              (Messages{kNothing, 3, 4, 5, kNothing}));
}

TEST_F(SimulatedChannelTest, AMessageUnderTwoFaultsIsLostAndNotDelayed) {
    verifies("SWR-VTM-004", Technique::kFaultInjection);

    sut_.set_fault({true, 10_ns});

    EXPECT_EQ(run_cycles({1, kNothing, kNothing}), (Messages{kNothing, kNothing, kNothing}));
}

TEST_F(SimulatedChannelTest, TheLongestDelayNeverEndsAndANegativeOneIsNone) {
    verifies("SWR-VTM-004", Technique::kBoundaryValues);
    EXPECT_EQ(run_cycle(kNothing), kNothing);

    sut_.set_fault({false, Duration{-5}});
    EXPECT_EQ(run_cycle(1), 1);
    sut_.set_fault({false, kNever});
    EXPECT_EQ(run_cycles({2, kNothing, kNothing}), (Messages{kNothing, kNothing, kNothing}));
}

}  // namespace
}  // namespace mamori::ports::virtual_time
