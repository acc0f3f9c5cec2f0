// SPDX-License-Identifier: Apache-2.0
// Goal: a link sends each message unchanged except in the planned frames, and what it does there is the
// planned error of IEC 61784-3, which the receiver detects. Method: a sink with an error between sender and
// receiver components; the counters of the receiver are the oracle.
#include "link_errors.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "hil_ends.hpp"
#include "mamori/trace/verifies.hpp"
#include "virtual_hil.hpp"

namespace safe_arm {
namespace {

using mamori::Instant;
using mamori::Status;
using mamori::ports::lcm::LinkNews;
using namespace mamori::verification;

constexpr std::uint64_t kFirst = 20U;

class LinkErrorsTest : public ::testing::Test {
  protected:
    /// Sends 100 messages over a link with this error, one per frame. Each used message is noted by its
    /// number.
    LinkNews send_all(LinkError error, std::uint64_t count, std::uint64_t delay = 0U) {
        LinkErrorPlan plan;
        plan.link = Link::kDrive;
        plan.error = error;
        plan.first_frame = kFirst;
        plan.frame_count = count;
        plan.delay_frames = delay;
        sink_.configure(plan, direct_);
        for (std::uint32_t frame = 0U; frame < 100U; ++frame) {
            const Instant now{static_cast<std::int64_t>(frame) * kFrame.ns};
            DriveFrame message{};
            message.frame = frame;
            sender_.send(message, frame, now);
            if (receiver_.receive(now)) {
                used_.push_back(receiver_.get_received().frame);
            }
        }
        return receiver_.get_news();
    }
    bool is_used(std::uint32_t frame) const {
        return std::find(used_.begin(), used_.end(), frame) != used_.end();
    }

    DriveQueue queue_;
    DirectSink direct_{queue_};
    FaultySink sink_{Link::kDrive, kDriveE2e};
    DriveQueue no_queue_;
    FaultySink no_sink_{Link::kDrive, kDriveE2e};
    LinkEnd<DriveMessage, DriveQueue, DriveMessage> sender_{no_queue_, sink_};
    LinkEnd<DriveMessage, DriveQueue, DriveMessage> receiver_{queue_, no_sink_};
    std::vector<std::uint32_t> used_;
};

TEST_F(LinkErrorsTest, WithoutAPlanEachMessageArrivesOnce) {
    verifies("SWR-HIL-004", Technique::kRequirementsBased, Polarity::kNominal);
    const LinkNews news = send_all(LinkError::kLoss, 0U);

    EXPECT_EQ(news.initial, 2U);
    EXPECT_EQ(used_.size(), 98U);
    EXPECT_EQ(news.lost + news.damaged + news.unordered + news.foreign, 0U);
    EXPECT_EQ(sink_.get_injected_count(), 0U);
}

TEST_F(LinkErrorsTest, AnErrorOfAnotherLinkChangesNothing) {
    verifies("SWR-HIL-004", Technique::kEquivalenceClasses, Polarity::kNominal);
    FaultySink other{Link::kState, kStateE2e};
    LinkErrorPlan plan;
    plan.link = Link::kDrive;
    plan.frame_count = 5U;
    EXPECT_TRUE(plan.is_active(Link::kDrive, 0U));
    EXPECT_TRUE(plan.is_active(Link::kDrive, 4U));
    EXPECT_FALSE(plan.is_active(Link::kDrive, 5U));
    EXPECT_FALSE(plan.is_active(Link::kState, 0U));
}

TEST_F(LinkErrorsTest, LostMessagesAreCountedAsLost) {
    verifies("SWR-HIL-004", Technique::kFaultInjection, Polarity::kViolation);
    const LinkNews news = send_all(LinkError::kLoss, 2U);

    EXPECT_EQ(news.lost, 2U);
    EXPECT_TRUE(is_used(kFirst - 1U));
    EXPECT_FALSE(is_used(kFirst));
    EXPECT_FALSE(is_used(kFirst + 1U));
    EXPECT_TRUE(is_used(kFirst + 2U));
}

TEST_F(LinkErrorsTest, CorruptedMessagesAreNeverUsed) {
    verifies("SWR-HIL-004", Technique::kFaultInjection, Polarity::kViolation);
    const LinkNews news = send_all(LinkError::kCorruption, 5U);

    EXPECT_EQ(news.damaged + news.foreign, 5U);
    EXPECT_EQ(used_.size(), 93U);
}

TEST_F(LinkErrorsTest, ARepeatedMessageIsUsedOnce) {
    verifies("SWR-HIL-004", Technique::kFaultInjection, Polarity::kViolation);
    const LinkNews news = send_all(LinkError::kRepetition, 3U);

    EXPECT_EQ(news.unordered, 3U);
    EXPECT_EQ(used_.size(), 98U);
}

TEST_F(LinkErrorsTest, OfTwoMessagesThatChangePlacesTheNewerIsUsed) {
    verifies("SWR-HIL-004", Technique::kFaultInjection, Polarity::kViolation);
    const LinkNews news = send_all(LinkError::kSequence, 1U);

    EXPECT_EQ(news.unordered, 1U);
    EXPECT_FALSE(is_used(kFirst));
    EXPECT_TRUE(is_used(kFirst + 1U));
    EXPECT_EQ(used_.size(), 97U);
}

TEST_F(LinkErrorsTest, ADelayedMessageDelaysThoseBehindIt) {
    verifies("SWR-HIL-004", Technique::kFaultInjection, Polarity::kViolation);
    const LinkNews news = send_all(LinkError::kDelay, 1U, 10U);

    EXPECT_EQ(news.unordered + news.damaged, 0U);
    EXPECT_FALSE(is_used(kFirst)) << "it arrives together with newer ones";
    EXPECT_TRUE(is_used(kFirst + 10U));
    EXPECT_EQ(used_.size(), 88U);
}

TEST_F(LinkErrorsTest, AMessageOfAnUnknownSourceIsInsertedAndNotUsed) {
    verifies("SWR-HIL-004", Technique::kFaultInjection, Polarity::kViolation);
    const LinkNews news = send_all(LinkError::kInsertion, 4U);

    EXPECT_EQ(news.damaged, 4U);
    EXPECT_EQ(used_.size(), 98U);
}

TEST_F(LinkErrorsTest, AnImitatedMessageIsNotUsed) {
    verifies("SWR-HIL-004", Technique::kFaultInjection, Polarity::kViolation);
    const LinkNews news = send_all(LinkError::kMasquerade, 4U);

    EXPECT_EQ(news.damaged, 4U);
    EXPECT_EQ(used_.size(), 98U);
    EXPECT_EQ(used_.back(), 99U);
}

TEST_F(LinkErrorsTest, AMessageForAnotherReceiverIsNotUsed) {
    verifies("SWR-HIL-004", Technique::kFaultInjection, Polarity::kViolation);
    const LinkNews news = send_all(LinkError::kAddressing, 1U);

    EXPECT_EQ(news.damaged, 1U);
    EXPECT_EQ(news.lost, 1U);
    EXPECT_FALSE(is_used(kFirst));
}

TEST_F(LinkErrorsTest, TheSameSeedDamagesTheSameBits) {
    verifies("SWR-HIL-004", Technique::kRequirementsBased, Polarity::kNominal);
    class Recorder final : public mamori::ports::lcm::MessageSink {
      public:
        Status send(mamori::Span<const std::byte> message) noexcept override {
            octets.insert(octets.end(), message.begin(), message.end());
            return Status::kOk;
        }
        std::vector<std::byte> octets;
    };
    const std::array<std::byte, 100U> message{};
    std::array<Recorder, 3U> recorders;
    for (std::size_t i = 0U; i < recorders.size(); ++i) {
        FaultySink sink{Link::kDrive, kDriveE2e};
        LinkErrorPlan plan;
        plan.link = Link::kDrive;
        plan.error = LinkError::kCorruption;
        plan.frame_count = 3U;
        plan.seed = i == 2U ? 8U : 7U;
        sink.configure(plan, recorders[i]);
        ASSERT_EQ(sink.send({message.data(), message.size()}), Status::kOk);
    }

    EXPECT_EQ(recorders[0].octets, recorders[1].octets);
    EXPECT_NE(recorders[0].octets, recorders[2].octets);
}

TEST_F(LinkErrorsTest, ALinkWithoutTransportAndATooLongMessageAreRefused) {
    verifies("SWR-HIL-004", Technique::kBoundaryValues, Polarity::kViolation);
    const std::array<std::byte, FaultySink::kMessageMax + 1U> message{};
    EXPECT_EQ(sink_.send({message.data(), 10U}), Status::kPreconditionNotMet);
    sink_.configure({}, direct_);

    EXPECT_EQ(sink_.send({message.data(), FaultySink::kMessageMax}), Status::kOk);
    EXPECT_EQ(sink_.send({message.data(), FaultySink::kMessageMax + 1U}), Status::kBadParameter);
}

}  // namespace
}  // namespace safe_arm
