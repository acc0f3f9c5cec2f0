// SPDX-License-Identifier: Apache-2.0
// Goal: profiles 4, 7, 8 and 44 write and read the bytes that others write and read; unfit channels are
// refused. Method: byte vectors that two other implementations share (profile 8: of an own model); both sides
// of each limit.
#include "mamori/safety/e2e/profile_04.hpp"

#include "mamori/kernel/base/constant_init.hpp"
#include "mamori/safety/e2e/checker.hpp"
#include "mamori/trace/verifies.hpp"
#include "rig.hpp"

namespace mamori::safety {
namespace {

using rig::fill;
using rig::show;
using namespace verification;

constexpr std::uint32_t kId = 0x0A0B0C0DU;

// As docs/manual/e2e.md shows them: both ends are constants of the program image.
constexpr SentIdChannel kManualChannel{kId, 64U, 64U};
constexpr HardenedLimits kManualLimits{2U, 3U};
static_assert(is_sound<E2eProfile04<>, kManualChannel>());
static_assert(are_sound<E2eProfile04<>, HardenedSequence, kManualLimits>());
MAMORI_CONSTINIT E2eProtector<E2eProfile04<>> g_sender{kManualChannel};
MAMORI_CONSTINIT HardenedE2eChecker<E2eProfile04<>> g_receiver{kManualChannel, kManualLimits};

TEST(E2eProfile04Test, BothEndsMayBeConstantsOfTheImage) {
    verifies("SWR-E2E-003", Technique::kInterface);
    rig::Frame frame(64U);
    const rig::Frame& received = frame;

    for (int i = 0; i < 5; ++i) {
        ASSERT_EQ(g_sender.protect(rig::edit(frame)), Status::kOk);
        EXPECT_EQ(is_usable(g_receiver.check(rig::view(received))), i >= 3) << i;
    }
}

TEST(E2eProfile04Test, BytesAreThoseOfOthers) {
    verifies("SWR-E2E-003", Technique::kBackToBack);
    constexpr SentIdChannel kShort{kId, 16U, 16U};
    constexpr SentIdChannel kOffset{kId, 24U, 24U, 8U};

    EXPECT_EQ(show<E2eProfile04<>>(kShort, 0U, 16U), fill("00 10 00 00 0a 0b 0c 0d 86 2b 05 56", 16U));
    EXPECT_EQ(show<E2eProfile04<>>(kShort, 1U, 16U), fill("00 10 00 01 0a 0b 0c 0d a5 8e 68 07", 16U));
    EXPECT_EQ(show<E2eProfile04<0U>>(kShort, 1U, 16U), fill("00 10 00 01 0a 0b 0c 0d a5 8e 68 07", 16U));
    EXPECT_EQ(show<E2eProfile04<>>(kOffset, 0U, 24U),
              fill(fill("", 8U) + " 00 18 00 00 0a 0b 0c 0d 69 d7 50 2e", 24U));
    EXPECT_EQ(show<E2eProfile04<>>(kOffset, 1U, 24U),
              fill(fill("", 8U) + " 00 18 00 01 0a 0b 0c 0d 4a 72 3d 7f", 24U));
}

TEST(E2eProfile04Test, Profile44WritesTheSameBytes) {
    verifies("SWR-E2E-003", Technique::kBackToBack);
    constexpr SentIdChannel kShort{kId, 16U, 16U};
    constexpr SentIdChannel kOffset{kId, 24U, 24U, 8U};

    EXPECT_EQ(show<E2eProfile44<>>(kShort, 0U, 16U), fill("00 10 00 00 0a 0b 0c 0d 86 2b 05 56", 16U));
    EXPECT_EQ(show<E2eProfile44<>>(kShort, 1U, 16U), fill("00 10 00 01 0a 0b 0c 0d a5 8e 68 07", 16U));
    EXPECT_EQ(show<E2eProfile44<>>(kOffset, 1U, 24U),
              fill(fill("", 8U) + " 00 18 00 01 0a 0b 0c 0d 4a 72 3d 7f", 24U));
}

TEST(E2eProfile04Test, Profile07WritesTheBytesOfOthers) {
    verifies("SWR-E2E-003", Technique::kBackToBack);
    constexpr SentIdChannel kShort{kId, 24U, 24U};
    constexpr SentIdChannel kOffset{kId, 32U, 32U, 8U};

    EXPECT_EQ(show<E2eProfile07<>>(kShort, 0U, 24U),
              fill("1f b2 e7 37 fc ed bc d9 00 00 00 18 00 00 00 00 0a 0b 0c 0d", 24U));
    EXPECT_EQ(show<E2eProfile07<>>(kShort, 1U, 24U),
              fill("7b de 72 68 b8 e9 bc 27 00 00 00 18 00 00 00 01 0a 0b 0c 0d", 24U));
    EXPECT_EQ(show<E2eProfile07<>>(kOffset, 0U, 32U),
              fill(fill("", 8U) + " 17 f7 c8 17 32 38 65 a8 00 00 00 20 00 00 00 00 0a 0b 0c 0d", 32U));
    EXPECT_EQ(show<E2eProfile07<>>(kOffset, 1U, 32U),
              fill(fill("", 8U) + " 73 9b 5d 48 76 3c 65 56 00 00 00 20 00 00 00 01 0a 0b 0c 0d", 32U));
}

TEST(E2eProfile04Test, Profile08WritesTheBytesOfItsModel) {
    verifies("SWR-E2E-003", Technique::kBackToBack);
    constexpr SentIdChannel kShort{kId, 20U, 20U};

    EXPECT_EQ(show<E2eProfile08<>>(kShort, 0U, 20U),
              fill("41 49 4e 52 00 00 00 14 00 00 00 00 0a 0b 0c 0d", 20U));
    EXPECT_EQ(show<E2eProfile08<>>(kShort, 1U, 20U),
              fill("62 ec 23 03 00 00 00 14 00 00 00 01 0a 0b 0c 0d", 20U));
}

template <typename Profile>
void expect_limits() {
    constexpr std::size_t kHeader = Profile::kHeaderSize;
    constexpr std::size_t kMost = Profile::kLengthMax;
    EXPECT_EQ(Profile::find_fault({0U, kHeader, kHeader}), ChannelFault::kNone);
    EXPECT_EQ(Profile::find_fault({0U, kHeader, kMost}), ChannelFault::kNone);
    EXPECT_EQ(Profile::find_fault({0U, kMost, kMost, kMost - kHeader}), ChannelFault::kNone);
    EXPECT_EQ(Profile::find_fault({0U, kHeader - 1U, kMost}), ChannelFault::kLength);
    EXPECT_EQ(Profile::find_fault({0U, kHeader, kMost + 1U}), ChannelFault::kLength);
    EXPECT_EQ(Profile::find_fault({0U, kHeader + 1U, kHeader}), ChannelFault::kLength);
    EXPECT_EQ(Profile::find_fault({0U, kHeader, kMost, 1U}), ChannelFault::kOffset);
    EXPECT_EQ(Profile::find_fault({0U, kMost, kMost, kMost - kHeader + 1U}), ChannelFault::kOffset);
    EXPECT_EQ(Profile::find_fault({0U, kHeader, kHeader, ~std::size_t{0U}}), ChannelFault::kOffset);
}

/// A frame with its header behind `offset` bytes of payload is read there.
template <typename Profile>
void expect_header_at(std::size_t offset) {
    const SentIdChannel channel{kId, 40U, 40U, offset};
    rig::Frame frame = rig::protect<Profile>(channel, 7U, 40U);
    std::uint32_t counter = 0U;
    EXPECT_EQ(Profile::read(channel, rig::view(frame), counter), FrameCause::kGood);
    EXPECT_EQ(counter, 7U);
    frame[0] ^= std::byte{1U};
    EXPECT_EQ(Profile::read(channel, rig::view(frame), counter), FrameCause::kChecksum);
}

TEST(E2eProfile04Test, HeaderIsReadAtItsOffset) {
    verifies("SWR-E2E-004", Technique::kBoundaryValues);

    expect_header_at<E2eProfile04<>>(8U);
    expect_header_at<E2eProfile07<>>(20U);
    expect_header_at<E2eProfile08<>>(3U);
    expect_header_at<E2eProfile44<>>(28U);
}

TEST(E2eProfile04Test, ChannelsOutsideTheLimitsAreRefused) {
    verifies("SWR-E2E-009", Technique::kBoundaryValues, Polarity::kViolation);

    EXPECT_EQ(E2eProfile04<>::kFirstCounter, 0U);
    EXPECT_EQ(E2eProfile04<>::kLengthMax, 4096U);
    EXPECT_EQ(E2eProfile07<>::kLengthMax, 4194304U);
    EXPECT_EQ(E2eProfile08<>::kLengthMax, 4194304U);
    EXPECT_EQ(E2eProfile44<>::kLengthMax, 65535U);
    expect_limits<E2eProfile04<>>();
    expect_limits<E2eProfile07<>>();
    expect_limits<E2eProfile08<>>();
    expect_limits<E2eProfile44<>>();
}

TEST(E2eProfile04Test, LineStuckAtOneIsNoGoodFrameOfTheLongestChannel) {
    verifies("SWR-E2E-004", Technique::kBoundaryValues, Polarity::kViolation);
    // The only channel whose length field and identifier agree with such a line; its checksum does not.
    constexpr SentIdChannel kLongest{0xFFFFFFFFU, 65535U, 65535U};
    const rig::Frame ones(65535U, std::byte{0xFFU});
    std::uint32_t counter = 0U;

    EXPECT_EQ(E2eProfile44<>::read(kLongest, rig::view(ones), counter), FrameCause::kChecksum);
}

TEST(E2eProfile04Test, WholeFrameOfAnotherLengthIsRefusedByItsLengthField) {
    verifies("SWR-E2E-004", Technique::kErrorGuessing, Polarity::kViolation);
    // Both ends agree on everything but the length: a cut frame whose checksum somebody made anew.
    constexpr SentIdChannel kChannel{kId, 16U, 32U};
    rig::Frame frame = rig::protect<E2eProfile04<>>(kChannel, 7U, 20U);
    frame[1] = std::byte{21U};
    Crc<kCrc32P4> crc;
    crc.add({frame.data(), 8U});
    crc.add({frame.data() + 12U, 8U});
    detail::store_big(frame.data() + 8U, crc.get_value());
    std::uint32_t counter = 99U;

    EXPECT_EQ(E2eProfile04<>::read(kChannel, rig::view(frame), counter), FrameCause::kLengthField);
    EXPECT_EQ(counter, 99U);
}

}  // namespace
}  // namespace mamori::safety
