// SPDX-License-Identifier: Apache-2.0
// Goal: a protected message passes between two processes. If the other process corrupts the shared memory,
// its messages are rejected: truncated, too long, overwritten, repeated, or of another channel. Method: both
// ends of the connection of a partition, called directly on one memory; some contents are written directly.
#include <functional>
#include <vector>

#include "mamori/ports/posix_rt/partition_link.hpp"
#include "mamori/trace/verifies.hpp"
#include "protected_speed.hpp"

namespace mamori::protected_speed {
namespace {

using ports::posix_rt::calc_frame_region_size;
using ports::posix_rt::FrameOutcome;
using ports::posix_rt::FrameReader;
using ports::posix_rt::FrameWriter;
using ports::posix_rt::PartitionReceiver;
using ports::posix_rt::PartitionSender;
using safety::E2eOutcome;
using safety::E2eWorth;
using safety::FrameCause;
using namespace verification;

using Frame = SafeSpeed::Frame;
using Bytes = std::vector<std::byte>;
constexpr std::size_t kCapacity = PartitionSender<Frame>::kCapacity;

class PartitionWayTest : public ::testing::Test {
  protected:
    void SetUp() override {
        const Span<std::byte> region{reinterpret_cast<std::byte*>(words_.data()), words_.size() * 8U};
        ASSERT_EQ(writer_.open(region, kCapacity), Status::kOk);
        ASSERT_EQ(reader_.open({region.data(), region.size()}, kCapacity), Status::kOk);
        for (int i = 0; i < 10; ++i) {
            send();
            receive();
        }
        ASSERT_EQ(drive_.worth, E2eWorth::kNew);
    }
    /// A cycle of the other process.
    void send() {
        ASSERT_EQ(planner_.on_execute({0, now_}), Status::kOk);
        ASSERT_TRUE(planner_.out.publish(now_));
        sender_.in.take(planner_.out.get_published_sample());
        ASSERT_EQ(sender_.on_execute({0, now_}), Status::kOk);
        sender_.in.mark_read();
    }
    /// A cycle of this process.
    void receive() {
        now_ = now_ + 10_ms;
        ASSERT_EQ(receiver_.on_execute({0, now_}), Status::kOk);
        ASSERT_TRUE(receiver_.news.publish(now_));
        static_cast<void>(receiver_.out.publish(now_));
        drive_.in.take(receiver_.out.get_published_sample());
        ASSERT_EQ(drive_.on_execute({0, now_}), Status::kOk);
        drive_.in.mark_read();
    }
    /// The next content that the sender would write to the shared memory: a length of four bytes, then the
    /// message.
    Bytes make_content() {
        EXPECT_EQ(planner_.on_execute({0, now_}), Status::kOk);
        EXPECT_TRUE(planner_.out.publish(now_));
        Bytes content(kCapacity);
        EXPECT_EQ(encode(planner_.out.get_published(), {content.data(), content.size()},
                         ports::posix_rt::kFrameOrder)
                      .get_value(),
                  kCapacity);
        return content;
    }
    /// Another process writes `content` instead of the sender, then this process runs its cycle.
    void receive(const Bytes& content) {
        ASSERT_EQ(writer_.write({content.data(), content.size()}, now_), Status::kOk);
        receive();
    }
    FrameOutcome get_news() const { return receiver_.news.get_published().outcome; }
    FrameCause get_cause() const { return drive_.get_protection().get_checker().get_cause(); }

    std::vector<std::uint64_t> words_ = std::vector<std::uint64_t>(calc_frame_region_size(kCapacity) / 8U);
    FrameWriter writer_{};
    FrameReader reader_{};
    Planner planner_{};
    PartitionSender<Frame> sender_{"sender", writer_};
    PartitionReceiver<Frame> receiver_{"receiver", reader_};
    Drive drive_{};
    Instant now_{};
};

TEST_F(PartitionWayTest, ValuesArrive) {
    verifies("SWR-E2E-031");
    for (int i = 0; i < 20; ++i) {
        send();
        receive();
        EXPECT_EQ(drive_.worth, E2eWorth::kNew);
        EXPECT_EQ(drive_.setpoint_rad_s, planner_.wanted_rad_s);
    }
}

TEST_F(PartitionWayTest, FrameThatWasCutIsRefused) {
    verifies("SWR-E2E-031", Technique::kBoundaryValues, Polarity::kViolation);
    Bytes content = make_content();
    for (const std::size_t length : {std::size_t{0U}, std::size_t{1U}, std::size_t{16U}, kCapacity - 1U}) {
        receive(Bytes(content.begin(), content.begin() + static_cast<std::ptrdiff_t>(length)));
        EXPECT_NE(drive_.worth, E2eWorth::kNew) << length;
        EXPECT_EQ(get_news(), FrameOutcome::kMalformed);
        EXPECT_EQ(get_cause(), FrameCause::kSilence);
    }
}

TEST_F(PartitionWayTest, FrameOfAnotherSizeThatSaysSoIsRefused) {
    verifies("SWR-E2E-031", Technique::kBoundaryValues, Polarity::kViolation);
    const Bytes good = make_content();
    for (const std::uint8_t size : {std::uint8_t{0U}, std::uint8_t{12U}, std::uint8_t{27U}}) {
        Bytes content(good.begin(), good.begin() + 4 + size);
        content[0] = std::byte{size};
        receive(content);
        EXPECT_NE(drive_.worth, E2eWorth::kNew) << unsigned{size};
        EXPECT_EQ(get_news(), FrameOutcome::kNew);
        EXPECT_EQ(get_cause(), FrameCause::kTooShort);
    }
}

TEST_F(PartitionWayTest, FrameThatSaysToBeLongerThanItIsIsRefused) {
    verifies("SWR-E2E-031", Technique::kErrorGuessing, Polarity::kViolation);
    Bytes content = make_content();
    for (const std::uint8_t size : {std::uint8_t{29U}, std::uint8_t{255U}}) {
        content[0] = std::byte{size};
        receive(content);
        EXPECT_NE(drive_.worth, E2eWorth::kNew) << unsigned{size};
        EXPECT_EQ(get_news(), FrameOutcome::kMalformed);
        EXPECT_EQ(get_cause(), FrameCause::kSilence);
    }
}

TEST_F(PartitionWayTest, ContentThatWasOverwrittenIsRefused) {
    verifies("SWR-E2E-031", Technique::kFaultInjection, Polarity::kViolation);
    const Bytes good = make_content();
    const std::vector<std::pair<FrameCause, std::function<void(Bytes&)>>> faults{
        {FrameCause::kChecksum, [](Bytes& content) { content[4U + 25U] ^= std::byte{0x10U}; }},
        {FrameCause::kAllZero,
         [](Bytes& content) { std::fill(content.begin() + 4, content.end(), std::byte{0U}); }},
        {FrameCause::kAllOnes,
         [](Bytes& content) { std::fill(content.begin() + 4, content.end(), std::byte{0xFFU}); }},
    };
    for (const auto& [cause, damage] : faults) {
        Bytes content = good;
        damage(content);
        receive(content);
        EXPECT_NE(drive_.worth, E2eWorth::kNew);
        EXPECT_EQ(get_news(), FrameOutcome::kNew);
        EXPECT_STREQ(get_name(get_cause()), get_name(cause));
    }
}

TEST_F(PartitionWayTest, FrameThatIsHandedOnAgainIsRefused) {
    verifies("SWR-E2E-031", Technique::kFaultInjection, Polarity::kViolation);
    const Bytes content = make_content();
    receive(content);
    ASSERT_EQ(drive_.worth, E2eWorth::kNew);

    receive(content);
    EXPECT_EQ(drive_.worth, E2eWorth::kHeld);
    EXPECT_EQ(get_cause(), FrameCause::kRepeated);
}

TEST_F(PartitionWayTest, ProcessThatStandsStillIsSilence) {
    verifies("SWR-E2E-033", Technique::kFaultInjection, Polarity::kViolation);
    receive();
    EXPECT_EQ(drive_.worth, E2eWorth::kHeld);
    receive();
    EXPECT_EQ(drive_.worth, E2eWorth::kSubstitute);  // 30 ms
    EXPECT_EQ(drive_.setpoint_rad_s, 0.0);
    EXPECT_EQ(drive_.get_protection().get_outcome(), E2eOutcome::kSilent);
}

}  // namespace
}  // namespace mamori::protected_speed
