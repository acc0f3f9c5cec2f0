// SPDX-License-Identifier: Apache-2.0
// Goal: a value that one side publishes is output once on the other side, with its age; invalid messages are
// not output. Method: the test calls the cycles of both components over one memory and writes messages of its
// own.
#include "mamori/ports/posix_rt/partition_link.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "mamori/trace/verifies.hpp"

namespace partition_link_test {

enum class Colour : std::uint32_t { kRed, kGreen };
struct Message {
    std::uint32_t sequence{0U};
    double value{0.0};
    Colour colour{Colour::kRed};
};

}  // namespace partition_link_test

MAMORI_LAST_ENUMERATOR(partition_link_test::Colour, kGreen)
MAMORI_FIELDS(partition_link_test::Message, sequence, value, colour)

namespace mamori::ports::posix_rt {
namespace {

using partition_link_test::Colour;
using partition_link_test::Message;
using namespace verification;

constexpr std::size_t kCapacity = PartitionSender<Message>::kCapacity;

class PartitionLinkTest : public ::testing::Test {
  protected:
    void SetUp() override {
        const Span<std::byte> region{reinterpret_cast<std::byte*>(words_.data()), words_.size() * 8U};
        ASSERT_EQ(writer_.open(region, kCapacity), Status::kOk);
        ASSERT_EQ(reader_.open({region.data(), region.size()}, kCapacity), Status::kOk);
        ASSERT_EQ(sender_.on_initialize(), Status::kOk);
        ASSERT_EQ(receiver_.on_initialize(), Status::kOk);
    }
    Status send(const Message& message, Instant published_at) {
        source_.write(message);
        EXPECT_TRUE(source_.publish(published_at));
        return send_again();
    }
    Status send_again() {
        sender_.in.take(source_.get_published_sample());
        const Status result = sender_.on_execute({0, Instant{}});
        sender_.in.mark_read();
        return result;
    }
    /// Runs a cycle of the receiver. @return true if a message was output.
    bool receive(Instant now) {
        EXPECT_EQ(receiver_.on_execute({0, now}), Status::kOk);
        EXPECT_TRUE(receiver_.news.publish(now));
        return receiver_.out.publish(now);
    }
    const PartitionNews& get_news() const { return receiver_.news.get_published(); }

    std::vector<std::uint64_t> words_ = std::vector<std::uint64_t>(calc_frame_region_size(kCapacity) / 8U);
    FrameWriter writer_{};
    FrameReader reader_{};
    PartitionSender<Message> sender_{"sender", writer_};
    PartitionReceiver<Message> receiver_{"receiver", reader_};
    OutPort<Message> source_{kNoOwner, "source"};
};

TEST_F(PartitionLinkTest, AMessageOfAnEarlierRunIsNotOutput) {
    verifies("SWR-PRT-013", Technique::kStateTransition);
    ASSERT_EQ(send({7U, 1.5, Colour::kGreen}, Instant{1000}), Status::kOk);

    EXPECT_EQ(receiver_.on_startup({0, Instant{5000}}), Status::kOk);
    EXPECT_FALSE(receive(Instant{5300}));
    EXPECT_EQ(get_news().outcome, FrameOutcome::kNothingNew);
    ASSERT_EQ(send({8U, 2.5, Colour::kGreen}, Instant{6000}), Status::kOk);
    EXPECT_TRUE(receive(Instant{6300}));
}

TEST_F(PartitionLinkTest, AMessageIsOutputOnceWithItsAgeSincePublication) {
    verifies("SWR-PRT-013");
    EXPECT_FALSE(receive(Instant{500}));
    EXPECT_EQ(get_news().outcome, FrameOutcome::kNothingNew);

    ASSERT_EQ(send({7U, 1.5, Colour::kGreen}, Instant{1000}), Status::kOk);
    ASSERT_TRUE(receive(Instant{1300}));
    const Message& message = receiver_.out.get_published();
    EXPECT_EQ(message.sequence, 7U);
    EXPECT_EQ(message.value, 1.5);
    EXPECT_EQ(message.colour, Colour::kGreen);
    EXPECT_EQ(get_news().outcome, FrameOutcome::kNew);
    EXPECT_EQ(get_news().age_ns, 300);
    EXPECT_EQ(get_news().number, 1U);

    ASSERT_EQ(send_again(), Status::kOk) << "without a new input, nothing is sent";
    EXPECT_FALSE(receive(Instant{1400}));
    EXPECT_EQ(get_news().outcome, FrameOutcome::kNothingNew);
    EXPECT_EQ(get_news().age_ns, 0);
    EXPECT_EQ(get_news().number, 1U);
}

TEST_F(PartitionLinkTest, MessagesThatWereOverwrittenAreCounted) {
    verifies("SWR-PRT-013", Technique::kBoundaryValues);
    for (std::uint32_t i = 1U; i <= 3U; ++i) {
        ASSERT_EQ(send({i, 0.0, Colour::kRed}, Instant{i}), Status::kOk);
    }
    ASSERT_TRUE(receive(Instant{10}));
    EXPECT_EQ(get_news().skipped, 0U) << "there was no valid message before";
    EXPECT_EQ(receiver_.out.get_published().sequence, 3U);
    for (std::uint32_t i = 4U; i <= 8U; ++i) {
        ASSERT_EQ(send({i, 0.0, Colour::kRed}, Instant{i}), Status::kOk);
    }

    ASSERT_TRUE(receive(Instant{20}));
    EXPECT_EQ(get_news().skipped, 4U);
    EXPECT_EQ(get_news().number, 8U);
    ASSERT_EQ(send({9U, 0.0, Colour::kRed}, Instant{25}), Status::kOk);
    ASSERT_TRUE(receive(Instant{30}));
    EXPECT_EQ(get_news().skipped, 0U);
}

TEST_F(PartitionLinkTest, AMessageOfTheFutureIsNotOutput) {
    verifies("SWR-PRT-014", Technique::kBoundaryValues, Polarity::kViolation);
    ASSERT_EQ(send({1U, 0.0, Colour::kRed}, Instant{1000}), Status::kOk);
    ASSERT_FALSE(receive(Instant{999}));
    EXPECT_EQ(get_news().outcome, FrameOutcome::kMalformed);
    EXPECT_EQ(get_news().refused, 1U);
    ASSERT_EQ(send({2U, 0.0, Colour::kRed}, Instant{2000}), Status::kOk);
    EXPECT_TRUE(receive(Instant{2000}));
}

TEST_F(PartitionLinkTest, AMessageOfTheFutureIsOutputWithinTheTolerance) {
    verifies("SWR-PRT-014", Technique::kBoundaryValues);
    PartitionReceiver<Message> tolerant{"tolerant", reader_, Duration{100}};
    ASSERT_EQ(send({1U, 0.0, Colour::kRed}, Instant{1000}), Status::kOk);
    EXPECT_EQ(tolerant.on_execute({0, Instant{900}}), Status::kOk);
    EXPECT_TRUE(tolerant.out.publish(Instant{900}));
    ASSERT_TRUE(tolerant.news.publish(Instant{900}));
    EXPECT_EQ(tolerant.news.get_published().age_ns, -100);

    ASSERT_EQ(send({2U, 0.0, Colour::kRed}, Instant{1001}), Status::kOk);
    EXPECT_EQ(tolerant.on_execute({0, Instant{900}}), Status::kOk);
    EXPECT_FALSE(tolerant.out.publish(Instant{900}));
}

/// Writes a message with this content and instant, which the receiver must not output.
TEST_F(PartitionLinkTest, AnInvalidMessageIsNotOutput) {
    verifies("SWR-PRT-014", Technique::kFaultInjection, Polarity::kViolation);
    std::array<std::byte, kCapacity> content{};
    ASSERT_EQ(send({1U, 0.0, Colour::kRed}, Instant{1}), Status::kOk);
    ASSERT_TRUE(receive(Instant{2}));
    struct Row {
        std::size_t length;
        std::byte colour;
        std::int64_t instant_ns;
    };
    constexpr std::int64_t kMax = std::numeric_limits<std::int64_t>::max();
    constexpr std::int64_t kBeyond = std::int64_t{1} << 61U;
    const std::vector<Row> rows{{kCapacity - 1U, std::byte{0U}, 3},  {0U, std::byte{0U}, 3},
                                {kCapacity, std::byte{2U}, 3},       {kCapacity, std::byte{0U}, kMax},
                                {kCapacity, std::byte{0U}, -kMax},   {kCapacity, std::byte{0U}, kBeyond},
                                {kCapacity, std::byte{0U}, -kBeyond}};
    std::uint32_t refused = 0U;

    for (const Row& row : rows) {
        content[kCapacity - 4U] = row.colour;
        ASSERT_EQ(writer_.write({content.data(), row.length}, Instant{row.instant_ns}), Status::kOk);
        EXPECT_FALSE(receive(Instant{4}));
        EXPECT_EQ(get_news().outcome, FrameOutcome::kMalformed);
        EXPECT_EQ(get_news().number, 1U) << "number of the last valid message";
        EXPECT_EQ(get_news().refused, ++refused);
    }
    content[kCapacity - 4U] = std::byte{1U};
    ASSERT_EQ(writer_.write({content.data(), kCapacity}, Instant{kBeyond - 1}), Status::kOk);
    EXPECT_TRUE(receive(Instant{kBeyond - 1}));
    EXPECT_EQ(get_news().skipped, rows.size());
    EXPECT_EQ(get_news().refused, refused);
}

TEST_F(PartitionLinkTest, ATornMessageIsReportedAndCounted) {
    verifies("SWR-PRT-014", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_EQ(send({1U, 0.0, Colour::kRed}, Instant{1}), Status::kOk);
    words_[0U] = 5U;

    EXPECT_FALSE(receive(Instant{2}));
    EXPECT_EQ(get_news().outcome, FrameOutcome::kTorn);
    EXPECT_EQ(get_news().refused, 1U);
}

TEST_F(PartitionLinkTest, AValueWithoutAnEncodingIsNotSent) {
    verifies("SWR-PRT-014", Technique::kFaultInjection, Polarity::kViolation);

    EXPECT_EQ(send({1U, 0.0, static_cast<Colour>(2U)}, Instant{1}), Status::kBadParameter);
    EXPECT_FALSE(receive(Instant{2}));
    EXPECT_EQ(get_news().outcome, FrameOutcome::kNothingNew);
}

TEST_F(PartitionLinkTest, EndsWithoutAnOpenMemoryOfTheRightCapacityAreRejectedAtTheStart) {
    verifies("SWR-PRT-013", Technique::kInterface, Polarity::kViolation);
    FrameWriter closed_writer;
    FrameReader closed_reader;
    FrameReader other_reader;
    const Span<std::byte> region{reinterpret_cast<std::byte*>(words_.data()), words_.size() * 8U};
    ASSERT_EQ(other_reader.open({region.data(), region.size()}, kCapacity - 1U), Status::kOk);
    PartitionSender<Message> sender{"sender", closed_writer};
    PartitionReceiver<Message> receiver{"receiver", closed_reader};
    PartitionReceiver<Message> other{"other", other_reader};

    EXPECT_EQ(sender.on_initialize(), Status::kPreconditionNotMet);
    EXPECT_EQ(receiver.on_initialize(), Status::kPreconditionNotMet);
    EXPECT_EQ(other.on_initialize(), Status::kPreconditionNotMet);
}

}  // namespace
}  // namespace mamori::ports::posix_rt
