// SPDX-License-Identifier: Apache-2.0
// Goal: profiles 2 and 22 write and read the bytes that others write and read; unfit channels are refused.
// Method: a byte vector for each counter; both sides of each limit; identifiers that a stuck line fits.
#include "mamori/safety/e2e/profile_02.hpp"

#include <array>
#include <string>

#include "mamori/trace/verifies.hpp"
#include "rig.hpp"

namespace mamori::safety {
namespace {

using rig::fill;
using rig::show;
using namespace verification;

/// First two bytes of a frame of 8 zeros, by counter.
constexpr std::array<const char*, 16U> kHeaders{"0e 00", "1b 01", "98 02", "31 03", "0d 04", "18 05",
                                                "9b 06", "65 07", "08 08", "1d 09", "9e 0a", "37 0b",
                                                "0b 0c", "1e 0d", "9d 0e", "cd 0f"};

template <typename Case>
void expect_headers() {
    for (std::uint32_t counter = 0U; counter < kHeaders.size(); ++counter) {
        EXPECT_EQ(show<typename Case::Profile>(Case::make(8U), counter, 8U), fill(kHeaders[counter], 8U));
    }
}

TEST(E2eProfile02Test, BytesAreThoseOfOthers) {
    verifies("SWR-E2E-003", Technique::kBackToBack);

    expect_headers<rig::P02>();
    expect_headers<rig::P22>();
}

TEST(E2eProfile02Test, Profile22WritesItsHeaderAtItsOffset) {
    verifies("SWR-E2E-003", Technique::kBackToBack);
    IdListChannel channel = rig::P22::make(16U);
    channel.offset = 8U;

    EXPECT_EQ(show<E2eProfile22<>>(channel, 0U, 16U), fill(fill("", 8U) + " 01 00", 16U));
    EXPECT_EQ(show<E2eProfile22<>>(channel, 1U, 16U), fill(fill("", 8U) + " 14 01", 16U));
    EXPECT_EQ(show<E2eProfile22<>>(channel, 2U, 16U), fill(fill("", 8U) + " 97 02", 16U));
    EXPECT_EQ(show<E2eProfile22<>>(channel, 15U, 16U), fill(fill("", 8U) + " c2 0f", 16U));
}

TEST(E2eProfile02Test, TheHalfByteBesideTheCounterStaysThePayloads) {
    verifies("SWR-E2E-003", Technique::kBoundaryValues);
    rig::Frame frame(8U);
    frame[1] = std::byte{0xA5U};
    frame[2] = std::byte{0x5AU};
    E2eProtector<E2eProfile02<>> sut{rig::P02::make(8U)};

    ASSERT_EQ(sut.protect(rig::edit(frame)), Status::kOk);
    EXPECT_EQ(frame[1], std::byte{0xA1U});
    EXPECT_EQ(frame[2], std::byte{0x5AU});
}

TEST(E2eProfile02Test, FirstCounterSentIsOne) {
    verifies("SWR-E2E-003", Technique::kBoundaryValues);
    rig::Frame frame(8U);
    E2eProtector<E2eProfile02<>> sut{rig::P02::make(8U)};

    ASSERT_EQ(sut.protect(rig::edit(frame)), Status::kOk);
    EXPECT_EQ(rig::to_hex(frame), fill("1b 01", 8U));
}

TEST(E2eProfile02Test, ChannelsOutsideTheLimitsAreRefused) {
    verifies("SWR-E2E-009", Technique::kBoundaryValues, Polarity::kViolation);
    const auto find = [](std::size_t length, std::size_t offset) {
        const IdListChannel channel{rig::P02::make(16U).data_ids, length, offset};
        return std::array<ChannelFault, 2U>{E2eProfile02<>::find_fault(channel),
                                            E2eProfile22<>::find_fault(channel)};
    };
    const auto both = [](ChannelFault fault) { return std::array<ChannelFault, 2U>{fault, fault}; };

    EXPECT_EQ(find(2U, 0U), both(ChannelFault::kNone));
    EXPECT_EQ(find(256U, 0U), both(ChannelFault::kNone));
    EXPECT_EQ(find(1U, 0U), both(ChannelFault::kLength));
    EXPECT_EQ(find(257U, 0U), both(ChannelFault::kLength));
    EXPECT_EQ(find(256U, 255U), both(ChannelFault::kOffset));
    EXPECT_EQ(find(16U, 14U)[0], ChannelFault::kOffset);
    EXPECT_EQ(find(16U, 14U)[1], ChannelFault::kNone);
}

/// Number of identifiers for one counter with which a line stuck at `value` would be a good frame; each must
/// be refused.
std::size_t count_stuck(std::byte value, std::size_t index) {
    constexpr std::size_t kLength = 8U;
    const rig::Frame stuck(kLength, value);
    std::size_t count = 0U;
    for (std::uint32_t id = 0U; id <= 0xFFU; ++id) {
        IdListChannel channel = rig::P02::make(kLength);
        channel.data_ids[index] = static_cast<std::uint8_t>(id);
        std::uint32_t counter = 0U;
        const bool is_good = E2eProfile02<>::read(channel, rig::view(stuck), counter) == FrameCause::kGood;
        count += is_good ? 1U : 0U;
        EXPECT_TRUE(!is_good || E2eProfile02<>::find_fault(channel) == ChannelFault::kStuckFrame) << id;
    }
    return count;
}

TEST(E2eProfile02Test, IdentifierThatAStuckLineFitsIsRefused) {
    verifies("SWR-E2E-009", Technique::kErrorGuessing, Polarity::kViolation);

    EXPECT_EQ(count_stuck(std::byte{0U}, 0U), 1U);
    EXPECT_EQ(count_stuck(std::byte{0xFFU}, 15U), 1U);
}

}  // namespace
}  // namespace mamori::safety
