// SPDX-License-Identifier: Apache-2.0
// Goal: the samples of docs/manual/lcm.md compile and do what the page says. Method: the samples, used once.
#include <gtest/gtest.h>

#include <array>
#include <cstdint>

#include "mamori/ports/lcm/protected_message.hpp"
#include "mamori/safety/e2e/checker.hpp"
#include "mamori/safety/e2e/profile_04.hpp"
#include "mamori/safety/e2e/protector.hpp"
#include "mamori/trace/verifies.hpp"

namespace lcm_page {

struct JointState {
    std::array<double, 7U> position_rad{};
    mamori::BoundedSequence<std::uint16_t, 4U> warnings{};
};

}  // namespace lcm_page

MAMORI_LCM_FIELDS(lcm_page::JointState, position_rad, warnings)

namespace lcm_page {

using Profile = mamori::safety::E2eProfile04<>;
inline constexpr mamori::safety::SentIdChannel kStateChannel{
    0x00000101U, mamori::ports::lcm::kChannelLengthMin<JointState, Profile>,
    mamori::ports::lcm::kChannelLengthMax<JointState, Profile>, 0U};
using StateMessage = mamori::ports::lcm::LcmMessage<JointState, Profile, kStateChannel>;

namespace {

using namespace mamori;
using namespace mamori::verification;

TEST(LcmPageTest, AProtectedStateArrivesAsItWasSent) {
    verifies("SWR-LCM-005", Technique::kRequirementsBased, Polarity::kNominal);
    safety::E2eProtector<Profile> protector(kStateChannel);
    safety::E2eChecker<Profile> checker(kStateChannel, {});
    std::array<std::byte, StateMessage::kSizeMax> buffer{};
    JointState sent{};
    sent.position_rad[6] = 0.5;
    sent.warnings = std::array<std::uint16_t, 1U>{7U};

    const Result<std::size_t> size = ports::lcm::encode_protected<StateMessage>(sent, protector, buffer);
    ASSERT_TRUE(size.has_value());
    const Span<const std::byte> message(buffer.data(), size.get_value());
    ASSERT_TRUE(is_usable(checker.check(ports::lcm::get_protected_part(message))));
    JointState received{};
    ASSERT_EQ(ports::lcm::decode_protected<StateMessage>(message, received), Status::kOk);

    EXPECT_EQ(received.position_rad, sent.position_rad);
    EXPECT_EQ(received.warnings, sent.warnings);
}

}  // namespace
}  // namespace lcm_page
