// SPDX-License-Identifier: Apache-2.0
// Goal: a command is used only as it was sent, and in order. Method: each bit inverted, and lost, repeated
// and foreign frames between both ends.
#include "command_link.hpp"

#include "feed.hpp"
#include "mamori/trace/verifies.hpp"

namespace safe_arm {
namespace {

using mamori::Instant;
using mamori::Status;
using mamori::safety::E2eOutcome;
using namespace mamori::verification;

class CommandLinkTest : public ::testing::Test {
  protected:
    CommandLinkTest() {
        for (int i = 0; i < 3; ++i) {  // a run of frames makes the order known
            deliver(send(0.0));
        }
    }

    CommandFrame send(double torque_nm) {
        TorqueCommand command{};
        command.torque_nm.fill(torque_nm);
        command.sent_at_ns = now_.ns;
        feed(sender_.in, command, now_);
        EXPECT_EQ(sender_.on_execute({0, now_}), Status::kOk);
        return take(sender_.out);
    }
    /// @return true when the command was forwarded.
    bool deliver(const CommandFrame& frame) {
        feed(receiver_.in, frame, now_);
        return step();
    }
    bool step() {
        EXPECT_EQ(receiver_.on_execute({0, now_}), Status::kOk);
        receiver_.in.mark_read();
        now_ = now_ + kFrame;
        return receiver_.out.publish(now_);
    }

    CommandSender sender_{"sender"};
    CommandReceiver receiver_{"receiver"};
    Instant now_{};
};

TEST_F(CommandLinkTest, ACommandArrivesAsItWasSent) {
    verifies("SWR-SAF-041");
    ASSERT_TRUE(deliver(send(1.5)));
    EXPECT_EQ(receiver_.out.get_published().torque_nm[6], 1.5);
    EXPECT_EQ(receiver_.out.get_published().sent_at_ns, now_.ns - kFrame.ns);
}

TEST_F(CommandLinkTest, NoInvertedBitPasses) {
    verifies("SWR-SAF-041", Technique::kFaultInjection, Polarity::kViolation);
    for (std::size_t bit = 0U; bit < kCommandLength * 8U; ++bit) {
        CommandFrame frame = send(0.0);
        frame[bit / 8U] ^= static_cast<std::uint8_t>(1U << (bit % 8U));
        ASSERT_FALSE(deliver(frame)) << bit;
        ASSERT_TRUE(deliver(send(0.0))) << bit;
    }
}

TEST_F(CommandLinkTest, ARepeatedOldOrMissingFrameIsNoCommand) {
    verifies("SWR-SAF-041", Technique::kFaultInjection, Polarity::kViolation);
    const CommandFrame old = send(1.0);
    ASSERT_TRUE(deliver(old));
    EXPECT_FALSE(deliver(old)) << "repeated";
    ASSERT_TRUE(deliver(send(2.0)));
    EXPECT_FALSE(deliver(old)) << "old";
    EXPECT_FALSE(step()) << "missing";
    EXPECT_EQ(receiver_.out.get_published().torque_nm[0], 2.0);
}

TEST_F(CommandLinkTest, TheToleratedLossesPassAndOneMoreNeedsANewOrder) {
    verifies("SWR-SAF-041", Technique::kBoundaryValues, Polarity::kViolation);
    for (std::uint32_t i = 0U; i < kCommandLossesMax; ++i) {
        static_cast<void>(send(0.0));
    }
    EXPECT_TRUE(deliver(send(0.0)));
    for (std::uint32_t i = 0U; i <= kCommandLossesMax; ++i) {
        static_cast<void>(send(0.0));
    }
    EXPECT_FALSE(deliver(send(0.0)));
    EXPECT_FALSE(deliver(send(0.0)));
    EXPECT_TRUE(deliver(send(0.0))) << "after a run of two frames";
}

}  // namespace
}  // namespace safe_arm
