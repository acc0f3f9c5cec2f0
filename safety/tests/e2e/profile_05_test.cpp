// SPDX-License-Identifier: Apache-2.0
// Goal: profiles 5 and 6 write and read the bytes that others write and read; unfit channels are refused.
// Method: byte vectors that other implementations share; both sides of each limit; identifiers that a stuck
// line fits.
#include "mamori/safety/e2e/profile_05.hpp"

#include "mamori/trace/verifies.hpp"
#include "rig.hpp"

namespace mamori::safety {
namespace {

using rig::fill;
using rig::show;
using namespace verification;

TEST(E2eProfile05Test, BytesAreThoseOfOthers) {
    verifies("SWR-E2E-003", Technique::kBackToBack);
    constexpr KnownIdChannel kShort{0x1234U, 8U, 8U};
    constexpr KnownIdChannel kOffset{0x1234U, 16U, 16U, 8U};

    EXPECT_EQ(show<E2eProfile05<>>(kShort, 0U, 8U), fill("1c ca", 8U));
    EXPECT_EQ(show<E2eProfile05<>>(kShort, 1U, 8U), fill("cf 8d 01", 8U));
    EXPECT_EQ(show<E2eProfile05<>>(kOffset, 0U, 16U), fill(fill("", 8U) + " 28 91", 16U));
    EXPECT_EQ(show<E2eProfile05<>>(kOffset, 1U, 16U), fill(fill("", 8U) + " fb d6 01", 16U));
}

TEST(E2eProfile05Test, Profile06WritesTheBytesOfOthers) {
    verifies("SWR-E2E-003", Technique::kBackToBack);
    constexpr KnownIdChannel kShort{0x1234U, 8U, 8U};
    constexpr KnownIdChannel kOffset{0x1234U, 16U, 16U, 8U};

    EXPECT_EQ(show<E2eProfile06<>>(kShort, 0U, 8U), fill("b1 55 00 08 00", 8U));
    EXPECT_EQ(show<E2eProfile06<>>(kShort, 1U, 8U), fill("f4 f5 00 08 01", 8U));
    EXPECT_EQ(show<E2eProfile06<>>(kOffset, 0U, 16U), fill(fill("", 8U) + " 4e b7 00 10 00", 16U));
    EXPECT_EQ(show<E2eProfile06<>>(kOffset, 1U, 16U), fill(fill("", 8U) + " 0b 17 00 10 01", 16U));
}

TEST(E2eProfile05Test, HeaderIsReadAtItsOffset) {
    verifies("SWR-E2E-004", Technique::kBoundaryValues);
    constexpr KnownIdChannel kChannel{0x1234U, 16U, 16U, 8U};
    std::uint32_t counter = 0U;

    EXPECT_EQ(
        E2eProfile05<>::read(kChannel, rig::view(rig::protect<E2eProfile05<>>(kChannel, 255U, 16U)), counter),
        FrameCause::kGood);
    EXPECT_EQ(counter, 255U);
    EXPECT_EQ(
        E2eProfile06<>::read(kChannel, rig::view(rig::protect<E2eProfile06<>>(kChannel, 9U, 16U)), counter),
        FrameCause::kGood);
    EXPECT_EQ(counter, 9U);
}

TEST(E2eProfile05Test, CounterWrapsBehind255) {
    verifies("SWR-E2E-003", Technique::kBoundaryValues);
    constexpr KnownIdChannel kChannel{0x1234U, 8U, 8U};
    rig::Frame frame(8U);
    E2eProtector<E2eProfile05<>> sut{kChannel, 255U};

    ASSERT_EQ(sut.protect(rig::edit(frame)), Status::kOk);
    EXPECT_EQ(frame[2], std::byte{255U});
    EXPECT_EQ(sut.get_counter(), 0U);
    EXPECT_EQ(E2eProfile05<>::kCounterMax, 255U);
}

TEST(E2eProfile05Test, ChannelsOutsideTheLimitsAreRefused) {
    verifies("SWR-E2E-009", Technique::kBoundaryValues, Polarity::kViolation);

    EXPECT_EQ(E2eProfile05<>::find_fault({1U, 3U, 3U}), ChannelFault::kNone);
    EXPECT_EQ(E2eProfile05<>::kFirstCounter, 0U);
    EXPECT_EQ(E2eProfile05<>::find_fault({1U, 4096U, 4096U, 4093U}), ChannelFault::kNone);
    EXPECT_EQ(E2eProfile05<>::find_fault({1U, 2U, 2U}), ChannelFault::kLength);
    EXPECT_EQ(E2eProfile05<>::find_fault({1U, 4097U, 4097U}), ChannelFault::kLength);
    EXPECT_EQ(E2eProfile05<>::find_fault({1U, 8U, 9U}), ChannelFault::kLength);
    EXPECT_EQ(E2eProfile05<>::find_fault({1U, 4096U, 4096U, 4094U}), ChannelFault::kOffset);
    EXPECT_EQ(E2eProfile06<>::find_fault({1U, 5U, 4096U}), ChannelFault::kNone);
    EXPECT_EQ(E2eProfile06<>::find_fault({1U, 4U, 4096U}), ChannelFault::kLength);
    EXPECT_EQ(E2eProfile06<>::find_fault({1U, 9U, 8U}), ChannelFault::kLength);
    EXPECT_EQ(E2eProfile06<>::find_fault({1U, 5U, 4097U}), ChannelFault::kLength);
    EXPECT_EQ(E2eProfile06<>::find_fault({1U, 8U, 8U, 4U}), ChannelFault::kOffset);
}

/// Number of identifiers of profile 5 with which a line stuck at `value` would be a good frame; each must be
/// refused.
std::size_t count_stuck(std::byte value) {
    constexpr std::size_t kLength = 8U;
    const rig::Frame stuck(kLength, value);
    std::size_t count = 0U;
    for (std::uint32_t id = 0U; id <= 0xFFFFU; ++id) {
        const KnownIdChannel channel{static_cast<std::uint16_t>(id), kLength, kLength};
        std::uint32_t counter = 0U;
        const bool is_good = E2eProfile05<>::read(channel, rig::view(stuck), counter) == FrameCause::kGood;
        const ChannelFault fault = E2eProfile05<>::find_fault(channel);
        count += is_good ? 1U : 0U;
        EXPECT_TRUE(!is_good || fault == ChannelFault::kStuckFrame) << id;
    }
    return count;
}

TEST(E2eProfile05Test, IdentifierThatAStuckLineFitsIsRefused) {
    verifies("SWR-E2E-009", Technique::kErrorGuessing, Polarity::kViolation);

    // The last two bytes of a CRC-16 can bring it to any value in exactly one way.
    EXPECT_EQ(count_stuck(std::byte{0U}), 1U);
    EXPECT_EQ(count_stuck(std::byte{0xFFU}), 1U);
}

TEST(E2eProfile05Test, WholeFrameOfAnotherLengthIsRefusedByItsLengthField) {
    verifies("SWR-E2E-004", Technique::kErrorGuessing, Polarity::kViolation);
    constexpr KnownIdChannel kChannel{0x1234U, 8U, 32U};
    rig::Frame frame = rig::protect<E2eProfile06<>>(kChannel, 7U, 12U);
    frame[3] = std::byte{13U};
    Crc<kCrc16> crc;
    crc.add({frame.data() + 2U, 10U});
    crc.add(std::byte{0x12U});
    crc.add(std::byte{0x34U});
    detail::store_big(frame.data(), crc.get_value());
    std::uint32_t counter = 99U;

    EXPECT_EQ(E2eProfile06<>::read(kChannel, rig::view(frame), counter), FrameCause::kLengthField);
    EXPECT_EQ(counter, 99U);
}

}  // namespace
}  // namespace mamori::safety
