// SPDX-License-Identifier: Apache-2.0
// Goal: profiles 1 and 11 write and read the bytes that others write and read; unfit channels are refused.
// Method: byte vectors of the four ways to use the identifier; both sides of each limit; overlapping parts of
// the header.
#include "mamori/safety/e2e/profile_01.hpp"

#include "mamori/safety/e2e/checker.hpp"
#include "mamori/trace/verifies.hpp"
#include "rig.hpp"

namespace mamori::safety {
namespace {

using rig::fill;
using rig::show;
using namespace verification;

using Channel = NibbleCounterChannel;

TEST(E2eProfile01Test, BytesAreThoseOfOthers) {
    verifies("SWR-E2E-003", Technique::kBackToBack);
    constexpr Channel kBoth{0x0123U, DataIdMode::kBoth, 8U};
    constexpr Channel kAlternating{0x0123U, DataIdMode::kAlternating, 8U};
    constexpr Channel kLow{0x0023U, DataIdMode::kLow, 8U};
    constexpr Channel kNibble{0x0123U, DataIdMode::kNibble, 8U};

    EXPECT_EQ(show<E2eProfile01<>>(kBoth, 0U, 8U), fill("cc 00", 8U));
    EXPECT_EQ(show<E2eProfile01<>>(kBoth, 1U, 8U), fill("91 01", 8U));
    EXPECT_EQ(show<E2eProfile01<>>(kAlternating, 0U, 8U), fill("ce 00", 8U));
    EXPECT_EQ(show<E2eProfile01<>>(kAlternating, 1U, 8U), fill("02 01", 8U));
    EXPECT_EQ(show<E2eProfile01<>>(kLow, 0U, 8U), fill("ce 00", 8U));
    EXPECT_EQ(show<E2eProfile01<>>(kLow, 1U, 8U), fill("93 01", 8U));
    EXPECT_EQ(show<E2eProfile01<>>(kNibble, 0U, 8U), fill("2a 10", 8U));
    EXPECT_EQ(show<E2eProfile01<>>(kNibble, 1U, 8U), fill("77 11", 8U));
}

TEST(E2eProfile01Test, HeaderMayLieBehindThePayload) {
    verifies("SWR-E2E-003", Technique::kBackToBack);
    constexpr Channel kNibble{0x0123U, DataIdMode::kNibble, 16U, 64U, 72U, 76U};

    EXPECT_EQ(show<E2eProfile01<>>(kNibble, 0U, 16U), fill(fill("", 8U) + " 7d 10", 16U));
    EXPECT_EQ(show<E2eProfile01<>>(kNibble, 1U, 16U), fill(fill("", 8U) + " 20 11", 16U));
    EXPECT_EQ(show<E2eProfile11<>>(kNibble, 1U, 16U), fill(fill("", 8U) + " 20 11", 16U));
}

TEST(E2eProfile01Test, HeaderBehindThePayloadIsReadThere) {
    verifies("SWR-E2E-004", Technique::kBoundaryValues);
    constexpr Channel kNibble{0x0123U, DataIdMode::kNibble, 16U, 64U, 72U, 76U};
    for (std::uint32_t sent = 0U; sent <= E2eProfile01<>::kCounterMax; ++sent) {
        rig::Frame frame = rig::protect<E2eProfile01<>>(kNibble, sent, 16U);
        std::uint32_t counter = 99U;
        EXPECT_EQ(E2eProfile01<>::read(kNibble, rig::view(frame), counter), FrameCause::kGood);
        EXPECT_EQ(counter, sent);
        frame[0] ^= std::byte{1U};
        EXPECT_EQ(E2eProfile01<>::read(kNibble, rig::view(frame), counter), FrameCause::kChecksum);
    }
}

TEST(E2eProfile01Test, Profile11WritesTheSameBytes) {
    verifies("SWR-E2E-003", Technique::kBackToBack);

    EXPECT_EQ(show<E2eProfile11<>>({0x0123U, DataIdMode::kBoth, 8U}, 0U, 8U), fill("cc 00", 8U));
    EXPECT_EQ(show<E2eProfile11<>>({0x0123U, DataIdMode::kBoth, 8U}, 1U, 8U), fill("91 01", 8U));
    EXPECT_EQ(show<E2eProfile11<>>({0x0123U, DataIdMode::kNibble, 8U}, 0U, 8U), fill("2a 10", 8U));
    EXPECT_EQ(show<E2eProfile11<>>({0x0123U, DataIdMode::kNibble, 8U}, 1U, 8U), fill("77 11", 8U));
}

TEST(E2eProfile01Test, LengthsOutsideTheLimitsAreRefused) {
    verifies("SWR-E2E-009", Technique::kBoundaryValues, Polarity::kViolation);
    EXPECT_EQ(E2eProfile01<>::kFirstCounter, 0U);
    const auto find = [](std::size_t length) {
        return E2eProfile01<>::find_fault({1U, DataIdMode::kBoth, length});
    };

    EXPECT_EQ(find(1U), ChannelFault::kLength);
    EXPECT_EQ(find(2U), ChannelFault::kNone);
    EXPECT_EQ(find(30U), ChannelFault::kNone);
    EXPECT_EQ(find(31U), ChannelFault::kLength);
}

TEST(E2eProfile01Test, HeadersThatOverlapOrLieOutsideAreRefused) {
    verifies("SWR-E2E-009", Technique::kBoundaryValues, Polarity::kViolation);
    const auto find = [](std::size_t crc, std::size_t counter, std::size_t nibble, DataIdMode mode) {
        return E2eProfile01<>::find_fault({1U, mode, 8U, crc, counter, nibble});
    };
    constexpr DataIdMode kBoth = DataIdMode::kBoth;
    constexpr DataIdMode kNibble = DataIdMode::kNibble;

    EXPECT_EQ(find(0U, 8U, 12U, kNibble), ChannelFault::kNone);
    EXPECT_EQ(find(56U, 0U, 52U, kNibble), ChannelFault::kNone);
    EXPECT_EQ(find(4U, 8U, 12U, kBoth), ChannelFault::kOffset);   // checksum over two bytes
    EXPECT_EQ(find(64U, 8U, 12U, kBoth), ChannelFault::kOffset);  // checksum behind the frame
    EXPECT_EQ(find(0U, 9U, 12U, kBoth), ChannelFault::kOffset);   // counter over two nibbles
    EXPECT_EQ(find(0U, 60U, 12U, kBoth), ChannelFault::kNone);
    EXPECT_EQ(find(0U, 64U, 12U, kBoth), ChannelFault::kOffset);  // counter behind the frame
    EXPECT_EQ(find(0U, 4U, 12U, kBoth), ChannelFault::kOffset);   // counter inside the checksum
    EXPECT_EQ(find(0U, 8U, 8U, kNibble), ChannelFault::kOffset);  // one nibble for two things
    EXPECT_EQ(find(0U, 8U, 4U, kNibble), ChannelFault::kOffset);  // nibble inside the checksum
    EXPECT_EQ(find(0U, 8U, 64U, kNibble), ChannelFault::kOffset);
    EXPECT_EQ(find(0U, 8U, 8U, kBoth), ChannelFault::kNone);  // not used
}

TEST(E2eProfile01Test, IdentifiersWithoutRoomAreRefused) {
    verifies("SWR-E2E-009", Technique::kBoundaryValues, Polarity::kViolation);
    const auto find = [](std::uint16_t id, DataIdMode mode) {
        return E2eProfile01<>::find_fault({id, mode, 8U});
    };
    const auto find_11 = [](std::uint16_t id, DataIdMode mode) {
        return E2eProfile11<>::find_fault({id, mode, 8U});
    };

    EXPECT_EQ(find(0xFFFFU, DataIdMode::kBoth), ChannelFault::kNone);
    EXPECT_EQ(find(0xFFFFU, DataIdMode::kAlternating), ChannelFault::kNone);
    EXPECT_EQ(find(0x00FFU, DataIdMode::kLow), ChannelFault::kNone);
    EXPECT_EQ(find(0x0100U, DataIdMode::kLow), ChannelFault::kDataId);
    EXPECT_EQ(find(0x0FFFU, DataIdMode::kNibble), ChannelFault::kNone);
    EXPECT_EQ(find(0x1000U, DataIdMode::kNibble), ChannelFault::kDataId);
    EXPECT_EQ(find(0x0001U, static_cast<DataIdMode>(4U)), ChannelFault::kDataId);
    EXPECT_EQ(find_11(0xFFFFU, DataIdMode::kBoth), ChannelFault::kNone);
    EXPECT_EQ(find_11(0x0FFFU, DataIdMode::kNibble), ChannelFault::kNone);
    EXPECT_EQ(find_11(0x1000U, DataIdMode::kNibble), ChannelFault::kDataId);
    EXPECT_EQ(find_11(0x0001U, DataIdMode::kAlternating), ChannelFault::kDataId);
    EXPECT_EQ(find_11(0x0001U, DataIdMode::kLow), ChannelFault::kDataId);
}

/// Number of identifiers with which a line stuck at 0 would be a good frame; each must be refused.
std::size_t count_stuck(DataIdMode mode) {
    const rig::Frame zeros(8U);
    std::size_t count = 0U;
    for (std::uint32_t id = 0U; id <= 0xFFFFU; ++id) {
        const Channel channel{static_cast<std::uint16_t>(id), mode, 8U};
        const ChannelFault fault = E2eProfile01<>::find_fault(channel);
        std::uint32_t counter = 0U;
        const bool is_good = E2eProfile01<>::read(channel, rig::view(zeros), counter) == FrameCause::kGood;
        count += fault == ChannelFault::kStuckFrame ? 1U : 0U;
        EXPECT_TRUE(fault == ChannelFault::kDataId || is_good == (fault == ChannelFault::kStuckFrame)) << id;
    }
    return count;
}

TEST(E2eProfile01Test, IdentifierThatALineStuckAtZeroFitsIsRefused) {
    verifies("SWR-E2E-009", Technique::kErrorGuessing, Polarity::kViolation);

    // A checksum that begins at 0 stays there through zeros, and two bytes bring it there in 256 ways, one
    // byte in one.
    EXPECT_EQ(count_stuck(DataIdMode::kBoth), 256U);
    EXPECT_EQ(count_stuck(DataIdMode::kAlternating), 256U);
    EXPECT_EQ(count_stuck(DataIdMode::kLow), 1U);
    EXPECT_EQ(count_stuck(DataIdMode::kNibble), 1U);
}

TEST(E2eProfile01Test, CounterThatIsNeverSentIsRefused) {
    verifies("SWR-E2E-004", Technique::kBoundaryValues, Polarity::kViolation);
    constexpr Channel kChannel{0x0123U, DataIdMode::kBoth, 8U};
    rig::Frame frame(8U);
    E2eProfile01<>::write(kChannel, 15U, rig::edit(frame));
    E2eChecker<E2eProfile01<>> sut{kChannel, {}};

    EXPECT_EQ(sut.check(rig::view(frame)), CheckStatus::kError);
    EXPECT_EQ(sut.get_cause(), FrameCause::kCounter);
}

TEST(E2eProfile01Test, WholeFrameWithTheNibbleOfAnotherChannelIsRefused) {
    verifies("SWR-E2E-004", Technique::kErrorGuessing, Polarity::kViolation);
    constexpr Channel kChannel{0x0123U, DataIdMode::kNibble, 8U};
    constexpr Channel kOther{0x0223U, DataIdMode::kNibble, 8U};
    E2eChecker<E2eProfile01<>> sut{kChannel, {}};

    // The checksum covers the low byte only, which the two have in common.
    EXPECT_EQ(sut.check(rig::view(rig::protect<E2eProfile01<>>(kOther, 0U, 8U))), CheckStatus::kError);
    EXPECT_EQ(sut.get_cause(), FrameCause::kDataId);
}

}  // namespace
}  // namespace mamori::safety
