// SPDX-License-Identifier: Apache-2.0
// Goal: a protected message has its header first, and any damage to an octet after the fingerprint is
// detected. Method: every single bit of a message is flipped; both ends by hand.
#include "mamori/ports/lcm/protected_message.hpp"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "mamori/safety/e2e/checker.hpp"
#include "mamori/safety/e2e/protector.hpp"
#include "mamori/trace/verifies.hpp"
#include "support/random_value.hpp"
#include "support/sample_types.hpp"

namespace mamori::ports::lcm {
namespace {

using lcm_sample::Cloud;
using Message = lcm_sample::CloudMessage;
using namespace verification;

class ProtectedMessageTest : public ::testing::Test {
  protected:
    Span<const std::byte> encode(const Cloud& value) {
        const Result<std::size_t> size =
            encode_protected<Message>(value, protector_, {buffer_.data(), buffer_.size()});
        EXPECT_TRUE(size.has_value());
        return {buffer_.data(), size.has_value() ? size.get_value() : 0U};
    }

    std::array<std::byte, Message::kSizeMax> buffer_{};
    safety::E2eProtector<Message::Profile> protector_{Message::kChannel};
    safety::E2eChecker<Message::Profile> checker_{Message::kChannel, {}};
    std::mt19937_64 random_{11U};
};

TEST_F(ProtectedMessageTest, TheHeaderFollowsTheFingerprintAndHoldsLengthCounterAndIdentifier) {
    verifies("SWR-LCM-005", Technique::kRequirementsBased, Polarity::kNominal);
    static_cast<void>(encode(lcm_sample::make_random<Cloud>(random_)));
    const Span<const std::byte> message = encode(Cloud{});

    ASSERT_EQ(message.size(), Message::kSizeMin);
    EXPECT_EQ(detail::read_fingerprint(message), Message::kFingerprint);
    EXPECT_EQ(std::to_integer<std::size_t>(message[9U]), message.size() - kFingerprintSize);  // length
    EXPECT_EQ(std::to_integer<int>(message[11U]), 1);                                         // counter
    EXPECT_EQ(std::to_integer<int>(message[12U]), 0x0A);                                      // identifier
    EXPECT_EQ(Message::kBodyAt, kFingerprintSize + 12U);
}

TEST_F(ProtectedMessageTest, EveryFlippedBitAfterTheFingerprintIsDetected) {
    verifies("SWR-LCM-005", Technique::kFaultInjection, Polarity::kViolation);
    const Span<const std::byte> message = encode(lcm_sample::make_random<Cloud>(random_));
    for (std::size_t bit = kFingerprintSize * 8U; bit < message.size() * 8U; ++bit) {
        buffer_[bit / 8U] ^= std::byte{1U} << (bit % 8U);
        EXPECT_FALSE(is_usable(checker_.check(get_protected_part(message)))) << bit;
        buffer_[bit / 8U] ^= std::byte{1U} << (bit % 8U);
    }
    EXPECT_TRUE(is_usable(checker_.check(get_protected_part(message))));
}

TEST_F(ProtectedMessageTest, AnUnprotectedMessageAndATruncatedOneAreRejected) {
    verifies("SWR-LCM-005", Technique::kEquivalenceClasses, Polarity::kViolation);
    std::array<std::byte, Message::kSizeMax> plain{};
    const Cloud sent = lcm_sample::make_random<Cloud>(random_);
    const std::size_t plain_size = encode_lcm(sent, {plain.data(), plain.size()}).get_value();
    Cloud value{};

    EXPECT_EQ(decode_protected<Message>({plain.data(), plain_size}, value), Status::kUnsupported);
    const Span<const std::byte> message = encode(sent);
    EXPECT_EQ(decode_protected<Message>(message.subspan(0U, Message::kSizeMin - 1U), value),
              Status::kBadParameter);
    EXPECT_EQ(decode_protected<Message>(message.subspan(0U, message.size() - 1U), value),
              Status::kBadParameter);
    EXPECT_EQ(decode_protected<Message>(message, value), Status::kOk);
}

TEST_F(ProtectedMessageTest, WhatCannotBeEncodedDoesNotMoveTheCounter) {
    verifies("SWR-LCM-005", Technique::kFaultInjection, Polarity::kViolation);
    Cloud invalid{};
    invalid.last.m = static_cast<lcm_sample::Mode>(3);
    const Span<std::byte> buffer{buffer_.data(), buffer_.size()};

    EXPECT_EQ(encode_protected<Message>(invalid, protector_, buffer).get_status(), Status::kBadParameter);
    EXPECT_EQ(encode_protected<Message>(Cloud{}, protector_, buffer.subspan(0U, Message::kSizeMin - 1U))
                  .get_status(),
              Status::kOutOfResources);
    EXPECT_EQ(protector_.get_counter(), 0U);
}

TEST_F(ProtectedMessageTest, AMessageThatIsTooLongForTheChannelIsReported) {
    verifies("SWR-LCM-005", Technique::kBoundaryValues, Polarity::kViolation);
    constexpr std::uint32_t kShortest = Message::kChannel.length_min;
    static constexpr safety::SentIdChannel kShort{1U, kShortest, kShortest, 0U};
    safety::E2eProtector<Message::Profile> protector(kShort);
    const Span<std::byte> buffer{buffer_.data(), buffer_.size()};

    EXPECT_TRUE(encode_protected<Message>(Cloud{}, protector, buffer).has_value());
    Cloud longer{};
    ASSERT_EQ(longer.octets.resize(1U), Status::kOk);
    EXPECT_EQ(encode_protected<Message>(longer, protector, buffer).get_status(), Status::kBadParameter);
    for (std::size_t i = kFingerprintSize; i < Message::kBodyAt; ++i) {
        EXPECT_EQ(buffer_[i], std::byte{0}) << i;  // the header of the message before it is gone
    }
}

}  // namespace
}  // namespace mamori::ports::lcm
