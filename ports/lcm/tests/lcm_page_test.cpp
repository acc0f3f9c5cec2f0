// SPDX-License-Identifier: Apache-2.0
// Goal: the samples of docs/manual/lcm.md compile and do what the page says. Method: the samples, used once.
#include <gtest/gtest.h>
#include <poll.h>

#include <array>
#include <cstdint>

#include "mamori/ports/lcm/frame_link.hpp"
#include "mamori/ports/lcm/link_components.hpp"
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

TEST(LcmPageTest, AFrameWithAStateComesOutOfTheReceiver) {
    verifies("SWR-LCM-008", Technique::kInterface, Polarity::kNominal);
    using namespace mamori::ports::lcm;
    MessageQueue<StateMessage, 16U> queue;
    FrameReceiverFor<StateMessage> transport(queue);
    LinkReceiver<StateMessage, MessageQueue<StateMessage, 16U>> receiver("state", queue, {10U});
    FrameSenderFor<StateMessage> sender;
    ASSERT_EQ(transport.open_udp("127.0.0.1", 0U), Status::kOk) << get_advice(transport.get_fault());
    ASSERT_EQ(sender.open_udp("127.0.0.1", transport.get_port()), Status::kOk);
    safety::E2eProtector<Profile> protector(kStateChannel);
    std::array<std::byte, StateMessage::kSizeMax> buffer{};

    for (int i = 0; i < 3; ++i) {
        const Result<std::size_t> size = encode_protected<StateMessage>(JointState{}, protector, buffer);
        ASSERT_EQ(sender.send({buffer.data(), size.get_value()}), Status::kOk);
    }
    for (int i = 0; i < 10'000 && queue.get_counts().accepted < 3U; ++i) {
        ::poll(nullptr, 0U, 1);
    }
    ASSERT_EQ(receiver.on_execute({0, Instant{1}}), Status::kOk);
    EXPECT_TRUE(receiver.out.publish(Instant{1}));
    EXPECT_EQ(receiver.get_news().used, 1U);
    EXPECT_EQ(receiver.get_news().initial, 2U);
}

}  // namespace
}  // namespace lcm_page
