// SPDX-License-Identifier: Apache-2.0
// Goal: only messages of the type reach the queue, and each other one is counted by its cause. Method:
// messages by hand, on both sides of each limit.
#include "mamori/ports/lcm/message_queue.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "mamori/trace/verifies.hpp"
#include "support/sample_types.hpp"

namespace mamori::ports::lcm {
namespace {

using Message = lcm_sample::CloudMessage;
using namespace verification;

/// Octets of a given size with a fingerprint; the last octet is `mark`.
std::vector<std::byte> make_message(std::size_t size, std::uint64_t fingerprint, int mark = 0) {
    std::vector<std::byte> octets(size < kFingerprintSize ? kFingerprintSize : size);
    for (std::size_t i = 0U; i < kFingerprintSize; ++i) {
        octets[i] = static_cast<std::byte>(fingerprint >> (56U - 8U * i));
    }
    octets.resize(size);
    if (size > kFingerprintSize) {
        octets.back() = static_cast<std::byte>(mark);
    }
    return octets;
}

class MessageQueueTest : public ::testing::Test {
  protected:
    void put(const std::vector<std::byte>& octets) { sut_.put({octets.data(), octets.size()}); }
    void put_good(std::size_t size, int mark = 0) { put(make_message(size, Message::kFingerprint, mark)); }

    MessageQueue<Message, 3U> sut_;
    Span<const std::byte> message_{};
};

TEST_F(MessageQueueTest, MessagesComeOutOnceInOrderWithTheirSize) {
    verifies("SWR-LCM-006", Technique::kRequirementsBased, Polarity::kNominal);
    EXPECT_EQ(sut_.take(message_), Status::kPreconditionNotMet);
    put_good(Message::kSizeMin, 1);
    put_good(Message::kSizeMax, 2);

    ASSERT_EQ(sut_.take(message_), Status::kOk);
    EXPECT_EQ(message_.size(), Message::kSizeMin);
    EXPECT_EQ(message_[message_.size() - 1U], std::byte{1});
    ASSERT_EQ(sut_.take(message_), Status::kOk);
    EXPECT_EQ(message_.size(), Message::kSizeMax);
    EXPECT_EQ(message_[message_.size() - 1U], std::byte{2});
    EXPECT_EQ(sut_.take(message_), Status::kPreconditionNotMet);
    EXPECT_EQ(sut_.get_counts().accepted, 2U);
    EXPECT_EQ(sut_.get_limits().size_min, Message::kSizeMin);
    EXPECT_EQ(sut_.get_limits().size_max, Message::kSizeMax);
}

TEST_F(MessageQueueTest, ForeignTruncatedAndOversizedMessagesAreCountedAndDoNotReachTheQueue) {
    verifies("SWR-LCM-006", Technique::kBoundaryValues, Polarity::kViolation);
    put(make_message(Message::kSizeMin, Message::kFingerprint ^ 1U));
    put(make_message(Message::kSizeMax + 1U, ~Message::kFingerprint));
    put(make_message(kFingerprintSize, ~Message::kFingerprint));
    put({});
    put_good(kFingerprintSize - 1U);
    put_good(kFingerprintSize);
    put_good(Message::kSizeMin - 1U);
    put_good(Message::kSizeMax + 1U);
    sut_.put_oversized();
    sut_.put_damaged();

    const ReceptionCounts counts = sut_.get_counts();
    EXPECT_EQ(counts.foreign, 3U);
    EXPECT_EQ(counts.truncated, 4U);
    EXPECT_EQ(counts.oversized, 2U);
    EXPECT_EQ(counts.damaged, 1U);
    EXPECT_EQ(counts.accepted, 0U);
    EXPECT_EQ(sut_.take(message_), Status::kPreconditionNotMet);
}

TEST_F(MessageQueueTest, AFullQueueOverwritesTheOldestMessageAndCountsIt) {
    verifies("SWR-LCM-006", Technique::kBoundaryValues, Polarity::kViolation);
    for (int mark = 1; mark <= 5; ++mark) {
        put_good(Message::kSizeMin, mark);
    }

    for (int mark = 3; mark <= 5; ++mark) {
        ASSERT_EQ(sut_.take(message_), Status::kOk);
        EXPECT_EQ(std::to_integer<int>(message_[message_.size() - 1U]), mark);
    }
    EXPECT_EQ(sut_.get_counts().overwritten, 2U);
    EXPECT_EQ(sut_.get_counts().accepted, 5U);
}

TEST_F(MessageQueueTest, ATakenMessageStaysValidWhileNewerOnesArrive) {
    verifies("SWR-LCM-006", Technique::kFaultInjection, Polarity::kViolation);
    put_good(Message::kSizeMin, 1);
    ASSERT_EQ(sut_.take(message_), Status::kOk);
    for (int mark = 2; mark <= 9; ++mark) {
        put_good(Message::kSizeMin, mark);
    }

    EXPECT_EQ(message_[message_.size() - 1U], std::byte{1});
    ASSERT_EQ(sut_.take(message_), Status::kOk);
    EXPECT_EQ(message_[message_.size() - 1U], std::byte{7});
}

}  // namespace
}  // namespace mamori::ports::lcm
