// SPDX-License-Identifier: Apache-2.0
// Goal: values arrive through any transport, every lost message is counted, and a damaged, repeated, old or
// unexpected message gives no value. Method: cycles of both components by hand; a transport that the test
// commands.
#include "mamori/ports/lcm/link_components.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "mamori/trace/verifies.hpp"
#include "support/sample_types.hpp"

namespace mamori::ports::lcm {
namespace {

using lcm_sample::Cloud;
using Message = lcm_sample::CloudMessage;
using Queue = MessageQueue<Message, 4U>;
using namespace verification;

constexpr safety::HardenedLimits kLimits{3U};

/// A transport whose messages go where the test sends them.
class FakeSink final : public MessageSink {
  public:
    Status send(Span<const std::byte> message) noexcept override {
        last.assign(message.begin(), message.end());
        return status;
    }
    std::vector<std::byte> last{};
    Status status{Status::kOk};
};

/// A queue whose writer is faster than its reader in the next `busy` calls.
class BusyQueue final {
  public:
    static constexpr std::size_t kCapacity = Queue::kCapacity;

    Status take(Span<const std::byte>& message) noexcept {
        if (busy > 0) {
            --busy;
            return Status::kOutOfResources;
        }
        return queue.take(message);
    }
    ReceptionCounts get_counts() const noexcept { return queue.get_counts(); }

    Queue queue{};
    int busy{0};
};

class LinkComponentsTest : public ::testing::Test {
  protected:
    void SetUp() override {
        for (int i = 0; i < 2; ++i) {
            send(0);
            deliver(sink_.last);
            ASSERT_FALSE(receive());
        }
        ASSERT_EQ(get_news().initial, 2U);  // with these two, the receiver found the order
    }
    /// Sends one message with `mark` as its content; it stays at the sink.
    void send(int mark) {
        Cloud value{};
        value.last.f = mark;
        source_.write(value);
        ++now_;
        ASSERT_TRUE(source_.publish(Instant{now_}));
        sender_.in.take(source_.get_published_sample());
        ASSERT_EQ(sender_.on_execute({0, Instant{now_}}), Status::kOk);
        sender_.in.mark_read();
    }
    void deliver(const std::vector<std::byte>& octets) { queue_.put({octets.data(), octets.size()}); }
    /// One cycle of the receiver. @return true when it gave a value.
    bool receive() {
        ++now_;
        EXPECT_EQ(receiver_.on_execute({0, Instant{now_}}), Status::kOk);
        EXPECT_TRUE(receiver_.news.publish(Instant{now_}));
        return receiver_.out.publish(Instant{now_});
    }
    const LinkNews& get_news() const { return receiver_.news.get_published(); }
    int get_mark() const { return receiver_.out.get_published().last.f; }

    OutPort<Cloud> source_{kNoOwner, "source"};
    FakeSink sink_{};
    Queue queue_;
    LinkSender<Message> sender_{"sender", sink_};
    LinkReceiver<Message, Queue> receiver_{"receiver", queue_, kLimits};
    std::int64_t now_{0};
};

TEST_F(LinkComponentsTest, PortsHaveTheirNamesAndNewsBeginWithZeros) {
    verifies("SWR-LCM-008", Technique::kInterface, Polarity::kNominal);
    EXPECT_STREQ(sender_.in.get_name(), "in");
    EXPECT_STREQ(receiver_.out.get_name(), "out");
    EXPECT_STREQ(receiver_.news.get_name(), "news");
    const LinkNews news{};
    for (const std::uint32_t count : {news.used, news.lost, news.damaged, news.unordered, news.initial,
                                      news.foreign, news.truncated, news.oversized, news.overwritten}) {
        EXPECT_EQ(count, 0U);
    }
    EXPECT_FALSE(news.is_closed);
}

TEST_F(LinkComponentsTest, AValueArrivesOnceAndTheNewestOfSeveralCounts) {
    verifies("SWR-LCM-008", Technique::kRequirementsBased, Polarity::kNominal);
    send(7);
    deliver(sink_.last);
    ASSERT_TRUE(receive());
    EXPECT_EQ(get_mark(), 7);
    EXPECT_FALSE(receive());

    for (int mark = 8; mark <= 10; ++mark) {
        send(mark);
        deliver(sink_.last);
    }
    ASSERT_TRUE(receive());
    EXPECT_EQ(get_mark(), 10);
    EXPECT_EQ(get_news().used, 4U);
    EXPECT_EQ(get_news().lost, 0U);
}

TEST_F(LinkComponentsTest, EachLostMessageIsCountedUpToTheLimit) {
    verifies("SWR-LCM-008", Technique::kBoundaryValues, Polarity::kViolation);
    send(1);
    send(2);
    send(3);
    deliver(sink_.last);
    EXPECT_TRUE(receive());
    EXPECT_EQ(get_news().lost, 2U);
    EXPECT_FALSE(get_news().is_closed);

    for (int i = 0; i < 4; ++i) {
        send(4);
    }
    deliver(sink_.last);
    EXPECT_FALSE(receive());
    EXPECT_TRUE(get_news().is_closed);
    send(5);
    deliver(sink_.last);
    EXPECT_FALSE(receive());
    EXPECT_EQ(get_news().unordered, 2U);
    EXPECT_EQ(get_news().lost, 2U);
}

TEST_F(LinkComponentsTest, AValueArrivesAlsoIfALaterMessageOfTheSameCycleIsRefused) {
    verifies("SWR-LCM-008", Technique::kEquivalenceClasses, Polarity::kNominal);
    send(7);
    deliver(sink_.last);
    deliver(sink_.last);

    EXPECT_TRUE(receive());
    EXPECT_EQ(get_mark(), 7);
    EXPECT_EQ(get_news().unordered, 1U);
}

TEST_F(LinkComponentsTest, AnOldMessageAfterALongSilenceClosesTheChannel) {
    verifies("SWR-LCM-008", Technique::kBoundaryValues, Polarity::kViolation);
    const std::vector<std::byte> old = sink_.last;
    send(1);
    deliver(sink_.last);
    ASSERT_TRUE(receive());
    deliver(old);
    EXPECT_FALSE(receive());
    EXPECT_FALSE(get_news().is_closed);

    for (int cycle = 0; cycle < 300; ++cycle) {
        ASSERT_FALSE(receive());
    }
    deliver(old);
    EXPECT_FALSE(receive());
    EXPECT_TRUE(get_news().is_closed);
}

TEST_F(LinkComponentsTest, ARestartFindsTheOrderAgain) {
    verifies("SWR-LCM-008", Technique::kStateTransition, Polarity::kNominal);
    for (int i = 0; i < 4; ++i) {
        send(4);
    }
    deliver(sink_.last);
    ASSERT_FALSE(receive());
    ASSERT_TRUE(get_news().is_closed);

    receiver_.restart();
    for (int mark = 0; mark < 3; ++mark) {
        send(mark);
        deliver(sink_.last);
    }
    EXPECT_TRUE(receive());
    EXPECT_EQ(get_mark(), 2);
    EXPECT_FALSE(get_news().is_closed);
}

TEST_F(LinkComponentsTest, AMessageOverwrittenInTheQueueIsAlsoCountedAsLost) {
    verifies("SWR-LCM-008", Technique::kBoundaryValues, Polarity::kViolation);
    for (int mark = 1; mark <= 6; ++mark) {
        send(mark);
        deliver(sink_.last);
    }

    ASSERT_TRUE(receive());
    EXPECT_EQ(get_mark(), 6);
    EXPECT_EQ(get_news().overwritten, 2U);
    EXPECT_EQ(get_news().lost, 2U);
    EXPECT_EQ(get_news().used, 4U);
}

TEST_F(LinkComponentsTest, ADamagedMessageGivesNoValue) {
    verifies("SWR-LCM-008", Technique::kFaultInjection, Polarity::kViolation);
    send(1);
    std::vector<std::byte> octets = sink_.last;
    octets.back() ^= std::byte{1};
    deliver(octets);
    queue_.put_damaged();

    EXPECT_FALSE(receive());
    EXPECT_EQ(get_news().damaged, 2U);
    EXPECT_EQ(get_news().used, 0U);
}

TEST_F(LinkComponentsTest, AMessageWithAGoodChecksumAndInvalidContentGivesNoValue) {
    verifies("SWR-LCM-008", Technique::kFaultInjection, Polarity::kViolation);
    std::vector<std::byte> octets(Message::kSizeMin);
    safety::E2eProtector<Message::Profile> protector(Message::kChannel, 2U);
    ASSERT_TRUE(encode_protected<Message>(Cloud{}, protector, {octets.data(), octets.size()}).has_value());
    octets[octets.size() - 5U] = std::byte{2};  // the boolean of the last field but one
    safety::E2eProtector<Message::Profile> again(Message::kChannel, 2U);
    ASSERT_EQ(again.protect(get_protected_part(Span<std::byte>(octets.data(), octets.size()))), Status::kOk);
    deliver(octets);

    EXPECT_FALSE(receive());
    EXPECT_EQ(get_news().damaged, 1U);
    EXPECT_EQ(get_news().used, 0U);
}

TEST_F(LinkComponentsTest, MessagesOfASecondSenderOnTheChannelAreCountedAndGiveNoValue) {
    verifies("SWR-LCM-008", Technique::kFaultInjection, Polarity::kViolation);
    FakeSink other_sink{};
    LinkSender<Message> other("other", other_sink);
    for (int i = 0; i < 20; ++i) {
        send(i);
        deliver(sink_.last);
        ASSERT_TRUE(receive());
        ASSERT_EQ(get_mark(), i);

        Cloud foreign{};
        foreign.last.f = -1;
        source_.write(foreign);
        ++now_;
        ASSERT_TRUE(source_.publish(Instant{now_}));
        other.in.take(source_.get_published_sample());
        ASSERT_EQ(other.on_execute({0, Instant{now_}}), Status::kOk);
        other.in.mark_read();
        deliver(other_sink.last);
        ASSERT_FALSE(receive()) << "cycle " << i;
    }

    EXPECT_EQ(get_news().unordered, 20U);
    EXPECT_EQ(get_news().used, 20U);
}

TEST_F(LinkComponentsTest, ForeignTruncatedAndOversizedMessagesAreReported) {
    verifies("SWR-LCM-008", Technique::kEquivalenceClasses, Polarity::kViolation);
    deliver(std::vector<std::byte>(Message::kSizeMin));
    deliver(std::vector<std::byte>(3U));
    send(1);
    std::vector<std::byte> octets = sink_.last;
    octets.resize(Message::kSizeMax + 1U);
    deliver(octets);

    EXPECT_FALSE(receive());
    EXPECT_EQ(get_news().foreign, 1U);
    EXPECT_EQ(get_news().truncated, 1U);
    EXPECT_EQ(get_news().oversized, 1U);
}

TEST_F(LinkComponentsTest, AMessageThatTheTransportDoesNotTakeIsCountedAndDetectedAsLost) {
    verifies("SWR-LCM-008", Technique::kFaultInjection, Polarity::kViolation);
    sink_.status = Status::kOutOfResources;
    send(1);
    sink_.status = Status::kOk;
    send(2);
    deliver(sink_.last);

    EXPECT_TRUE(receive());
    EXPECT_EQ(sender_.get_failed_count(), 1U);
    EXPECT_EQ(get_news().lost, 1U);
}

/// The receiver of a busy queue, which found the order.
class BusyQueueTest : public LinkComponentsTest {
  protected:
    void SetUp() override {
        for (int mark = 0; mark < 3; ++mark) {
            send(mark);
            deliver();
            execute();
        }
        ASSERT_EQ(busy_receiver_.get_news().used, 1U);
    }
    void deliver() { busy_queue_.queue.put({sink_.last.data(), sink_.last.size()}); }
    void execute() {
        ++now_;
        ASSERT_EQ(busy_receiver_.on_execute({0, Instant{now_}}), Status::kOk);
    }

    BusyQueue busy_queue_;
    LinkReceiver<Message, BusyQueue> busy_receiver_{"receiver", busy_queue_, kLimits};
};

TEST_F(BusyQueueTest, MessagesAreReadInTheSameCycleIfTheWriterWasFasterOnce) {
    verifies("SWR-LCM-008", Technique::kFaultInjection, Polarity::kNominal);
    for (int mark = 3; mark < 6; ++mark) {
        send(mark);
        deliver();
    }
    busy_queue_.busy = 1;

    execute();
    EXPECT_EQ(busy_receiver_.get_news().used, 4U);
}

TEST_F(BusyQueueTest, AWriterThatIsAlwaysFasterEndsNeitherTheCycleNorCountsAsSilence) {
    verifies("SWR-LCM-008", Technique::kFaultInjection, Polarity::kViolation);
    deliver();  // repeated
    busy_queue_.busy = 300 * static_cast<int>(BusyQueue::kCapacity);
    for (int cycle = 0; cycle < 300; ++cycle) {
        execute();
    }
    ASSERT_EQ(busy_queue_.busy, 0);
    ASSERT_EQ(busy_receiver_.get_news().unordered, 0U);

    execute();
    EXPECT_EQ(busy_receiver_.get_news().unordered, 1U);
    EXPECT_FALSE(busy_receiver_.get_news().is_closed);
}

TEST_F(BusyQueueTest, MessagesOfAnEarlierRunAreDroppedIfTheWriterWasFasterOnce) {
    verifies("SWR-LCM-008", Technique::kStateTransition, Polarity::kViolation);
    send(3);
    deliver();
    busy_queue_.busy = 1;

    EXPECT_EQ(busy_receiver_.on_startup({0, Instant{now_}}), Status::kOk);
    execute();
    EXPECT_EQ(busy_receiver_.get_news().used, 1U);
}

TEST_F(BusyQueueTest, AStartWithAWriterThatIsAlwaysFasterEnds) {
    verifies("SWR-LCM-008", Technique::kFaultInjection, Polarity::kViolation);
    busy_queue_.busy = 100;

    EXPECT_EQ(busy_receiver_.on_startup({0, Instant{now_}}), Status::kOk);
    EXPECT_EQ(busy_queue_.busy, 100 - static_cast<int>(BusyQueue::kCapacity));
}

TEST_F(LinkComponentsTest, WithoutANewValueNothingIsSent) {
    verifies("SWR-LCM-008", Technique::kRequirementsBased, Polarity::kNominal);
    sink_.last.clear();

    EXPECT_EQ(sender_.on_execute({0, Instant{now_}}), Status::kOk);
    EXPECT_TRUE(sink_.last.empty());
}

TEST_F(LinkComponentsTest, AValueThatCannotBeEncodedIsNotSentAndReported) {
    verifies("SWR-LCM-008", Technique::kFaultInjection, Polarity::kViolation);
    sink_.last.clear();
    Cloud invalid{};
    invalid.last.m = static_cast<lcm_sample::Mode>(3);
    source_.write(invalid);
    ++now_;
    ASSERT_TRUE(source_.publish(Instant{now_}));
    sender_.in.take(source_.get_published_sample());

    EXPECT_EQ(sender_.on_execute({0, Instant{now_}}), Status::kBadParameter);
    EXPECT_TRUE(sink_.last.empty());
    EXPECT_EQ(sender_.get_failed_count(), 0U);
}

TEST_F(LinkComponentsTest, MessagesOfAnEarlierRunAreDropped) {
    verifies("SWR-LCM-008", Technique::kStateTransition, Polarity::kViolation);
    for (std::size_t i = 0U; i < Queue::kCapacity; ++i) {
        send(1);
        deliver(sink_.last);
    }

    EXPECT_EQ(receiver_.on_startup({0, Instant{now_}}), Status::kOk);
    EXPECT_FALSE(receive());
}

}  // namespace
}  // namespace mamori::ports::lcm
