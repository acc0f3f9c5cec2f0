// SPDX-License-Identifier: Apache-2.0
// Goal: while a protected connection of the table brings nothing fresh, the machine does not start, and the
// fault of the connection is present while the machine moves. Method: a table with two receivers that accept
// what a test states, at both sides of each limit; then both ends of a real connection.
#include <gtest/gtest.h>

#include "mamori/safety/e2e/profile_01.hpp"
#include "mamori/safety/e2e/profile_04.hpp"
#include "mamori/safety/e2e/protected_link.hpp"
#include "safety_cycle_fixture.hpp"

namespace mamori::safety::testing_of_cycle {
namespace {

enum class Loss : FaultIndex { kLate, kStartUp, kBrake, kCommand, kHint };
constexpr Duration kCommandAge = 3_ms;
constexpr Duration kHintAge = 5_ms;
constexpr Duration kHintLead = 2_ms;

/// Accepts what a test states.
class Receiver final : public Component, public ProtectedReceiver {
  public:
    using Value = Stamped<double>;
    static constexpr std::uint8_t kProfile = 4U;
    static constexpr std::uint32_t kMaxDelta = 3U;
    constexpr explicit Receiver(const char* name) noexcept : Component(name) {}
    void accept(Instant sent_at) noexcept { record_accepted(Value{sent_at.ns, 0.0}); }
    void forget() noexcept { static_cast<ProtectedReceiver&>(*this) = Receiver{"none"}; }
};

Decider g_cycle{"cycle"};
Sensor g_eyes{"eyes"};
Receiver g_command{"command"};
Receiver g_hint{"hint"};
constexpr auto kConnected = safety::system(
    frame(kFrame), window("all", 0_us, kFrame, budget(kFrame), run(g_eyes, g_cycle, g_command, g_hint)),
    connect(g_eyes.seen, g_cycle.seen, any_age()),
    faults<Loss::kLate, Loss::kStartUp, Loss::kBrake, Loss::kCommand, Loss::kHint>(),
    react(Loss::kLate, Reaction::kSto, within(1_ms)), react(Loss::kStartUp, Reaction::kSto, within(2_ms)),
    react(Loss::kBrake, Reaction::kSs1, within(2_ms)), react(Loss::kCommand, Reaction::kSs1, within(2_ms)),
    react(Loss::kHint, Reaction::kDegrade, within(2_ms)), supervise(g_cycle, alive(), deadline(100_us)),
    supervise(g_eyes, alive(), deadline(100_us)),
    confirmed_by(g_eyes.seen, StopConfirmation::kStandstill, StopConfirmation::kClosedBrakes,
                 StopConfirmation::kTorqueOff),
    protect(g_command, fresh_within(kCommandAge), raises(Loss::kCommand)),
    protect(g_hint, fresh_within(kHintAge, kHintLead), raises(Loss::kHint)),
    cycle(StopBounds{20_ms, 20_ms}, BrakeLimits{10_ms, true}, WatchdogWindow{500_us, 4_ms},
          torque_feedback(kTorqueFeedback), tolerated_lateness(50_us), on_late_reaction(raises(Loss::kLate)),
          on_failed_self_test(raises(Loss::kStartUp)), on_unconfirmed_brakes(raises(Loss::kBrake))));
MAMORI_SAFETY_CHECK(kConnected);

class ProtectedConnectionTest : public ::testing::Test {
  protected:
    void SetUp() override {
        g_command.forget();
        ASSERT_EQ(sut_.initialize(), Status::kOk);
        sut_.inputs.is_standing = true;
        sut_.inputs.are_brakes_closed = true;
        sut_.inputs.may_start = true;
        while (step() != SafeState::kStandby) {
        }
    }
    SafeState step() {
        state_.get_observer().get_records()[0U].note_run(now_, now_ + 10_us);
        state_.get_observer().get_records()[1U].note_run(now_, now_ + 10_us);
        EXPECT_EQ(sut_.on_execute({0, now_}), Status::kOk);
        sut_.inputs.applied = sut_.outputs;
        sut_.inputs.has_torque = sut_.outputs.torque_enable;
        sut_.inputs.are_brakes_closed = !sut_.outputs.brake_release;
        now_ = now_ + kFrame;
        return sut_.get_state();
    }
    /// Both are sent at the planned start of this cycle.
    void accept_both() {
        g_command.accept(now_);
        g_hint.accept(now_);
    }
    SafeState push_start() {
        sut_.inputs.start_button = false;
        step();
        sut_.inputs.start_button = true;
        return step();
    }
    void operate() {
        accept_both();
        g_command.accept(now_ + kFrame);
        ASSERT_EQ(push_start(), SafeState::kOperational);
        accept_both();
        ASSERT_EQ(step(), SafeState::kOperational);
    }
    bool is_latched(Loss fault) const {
        return state_.get_faults().is_latched(static_cast<FaultIndex>(fault));
    }

    SafetyStorage<kConnected> storage_{};
    SpyWatchdog watchdog_{};
    SafetyState state_{storage_, watchdog_};
    FakeMachine sut_{state_, nullptr};
    Instant now_{100'000'000};
};

TEST_F(ProtectedConnectionTest, AFreshMessagePermitsTheStartAndGivesNoFault) {
    verifies("SWR-CYC-034");
    operate();
    for (int i = 0; i < 20; ++i) {
        accept_both();
        EXPECT_EQ(step(), SafeState::kOperational);
    }
    EXPECT_EQ(state_.get_faults().get_latched_count(), 0U);
}

TEST_F(ProtectedConnectionTest, NoStartBeforeEachConnectionIsFresh) {
    verifies("SWR-CYC-034", Technique::kBoundaryValues, Polarity::kViolation);
    g_hint.accept(now_ + kFrame);
    EXPECT_EQ(push_start(), SafeState::kStandby) << "no command yet";
    g_hint.accept(now_ + kFrame);
    g_command.accept(now_ + kFrame - kCommandAge - 1_ns);
    EXPECT_EQ(push_start(), SafeState::kStandby) << "the command is too old";
    g_command.accept(now_ + kFrame);
    g_hint.accept(now_ + kFrame - kHintAge - 1_ns);
    EXPECT_EQ(push_start(), SafeState::kStandby) << "the hint is too old";
    EXPECT_EQ(state_.get_faults().get_latched_count(), 0U) << "no fault at rest";
    g_command.accept(now_ + kFrame - kCommandAge);
    g_hint.accept(now_ + kFrame - kHintAge);
    EXPECT_EQ(push_start(), SafeState::kOperational) << "both are at their limit";
}

TEST_F(ProtectedConnectionTest, AMessageOlderThanItsLimitLeadsToTheReactionOfItsFault) {
    verifies("SWR-CYC-034", Technique::kBoundaryValues, Polarity::kViolation);
    operate();
    g_command.accept(now_ - kCommandAge);
    g_hint.accept(now_ + kFrame);
    EXPECT_EQ(step(), SafeState::kOperational) << "at its limit";
    g_command.accept(now_ - kCommandAge - 1_ns);

    EXPECT_EQ(step(), SafeState::kProtectiveStopSs1);
    EXPECT_TRUE(is_latched(Loss::kCommand));
    EXPECT_FALSE(is_latched(Loss::kHint));
}

TEST_F(ProtectedConnectionTest, AConnectionIsNeededWhileTheMachineIsDegraded) {
    verifies("SWR-CYC-034", Technique::kStateTransition, Polarity::kViolation);
    operate();
    accept_both();
    g_hint.accept(now_ - kHintAge - 1_ns);
    ASSERT_EQ(step(), SafeState::kDegraded);
    EXPECT_TRUE(is_latched(Loss::kHint));
    EXPECT_FALSE(is_latched(Loss::kCommand));
    g_command.accept(now_ - kCommandAge - 1_ns);

    EXPECT_EQ(step(), SafeState::kProtectiveStopSs1);
    EXPECT_TRUE(is_latched(Loss::kCommand));
}

TEST_F(ProtectedConnectionTest, AMessageFromTheFutureIsNotFreshBeyondTheLeadOfItsRow) {
    verifies("SWR-CYC-034", Technique::kBoundaryValues, Polarity::kViolation);
    operate();
    g_command.accept(now_);
    g_hint.accept(now_ + kHintLead);
    EXPECT_EQ(step(), SafeState::kOperational);
    g_command.accept(now_);
    g_hint.accept(now_ + kHintLead + 1_ns);
    EXPECT_EQ(step(), SafeState::kDegraded);
    g_command.accept(now_ + 1_ns);
    EXPECT_EQ(step(), SafeState::kProtectiveStopSs1) << "without a lead";
}

TEST_F(ProtectedConnectionTest, AStopNeedsNoConnectionAndItsFaultHeals) {
    verifies("SWR-CYC-034", Technique::kStateTransition);
    operate();
    g_command.accept(now_ - kCommandAge - 1_ns);
    g_hint.accept(now_);
    ASSERT_EQ(step(), SafeState::kProtectiveStopSs1);
    for (int i = 0; i < 40; ++i) {
        step();
    }
    EXPECT_FALSE(is_latched(Loss::kHint)) << "it is stale by now, and the machine does not move";
    ASSERT_EQ(sut_.get_state(), SafeState::kSafe);
    sut_.inputs.reset_button = true;
    step();
    EXPECT_EQ(state_.get_faults().get_latched_count(), 0U);
}

// Both ends of a real connection.

constexpr SentIdChannel kChannel{7U, 12U + 16U, 12U + 16U};
using Message = E2eMessage<Stamped<double>, E2eProfile04<>, kChannel>;
constexpr E2eInLimits<HardenedSequence> kLimits{2_ms, {3U}, 1U, {{1U, 0U}, {1U, 0U}, {1U, 0U}}};
constexpr E2eInLimits<PlainSequence> kPlain{2_ms, {5U}, 1U, {{1U, 0U}, {1U, 0U}, {1U, 0U}}};
constexpr NibbleCounterChannel kShort{1U, DataIdMode::kBoth, 2U + 16U};
using ShortMessage = E2eMessage<Stamped<double>, E2eProfile01<>, kShort>;
constexpr E2eInLimits<SynchronisingSequence> kSynchronising{2_ms, {}, 1U, {{1U, 0U}, {1U, 0U}, {1U, 0U}}};

static_assert(E2eReceiver<Message, kLimits>::kMaxDelta == 3U);
static_assert(E2eReceiver<Message, kLimits>::kProfile == 4U);
static_assert(E2eReceiver<Message, kPlain>::kMaxDelta == 5U);
static_assert(E2eReceiver<ShortMessage, kSynchronising>::kMaxDelta == 0U, "it grows with silence");
static_assert(E2eReceiver<ShortMessage, kSynchronising>::kProfile == 1U);

class ProtectedLinkTest : public ::testing::Test {
  protected:
    void SetUp() override {
        for (int i = 0; i < 3; ++i) {  // a run of messages makes the order known
            deliver(send(0.0));
        }
    }
    Message::Frame send(double value) {
        source_.write({now_.ns, value});
        sender_.in.take(source_.get_staged_sample(now_));
        EXPECT_EQ(sender_.on_execute({0, now_}), Status::kOk);
        EXPECT_TRUE(sender_.out.publish(now_));
        sender_.in.mark_read();
        return sender_.out.get_published();
    }
    /// @return true if a value was forwarded.
    bool deliver(const Message::Frame& frame) {
        channel_.write(frame);
        sut_.in.take(channel_.get_staged_sample(now_));
        EXPECT_EQ(sut_.on_execute({0, now_}), Status::kOk);
        sut_.in.mark_read();
        now_ = now_ + kFrame;
        return sut_.out.publish(now_);
    }

    OutPort<Message::Value> source_{kNoOwner, "source"};
    OutPort<Message::Frame> channel_{kNoOwner, "channel"};
    E2eSender<Message> sender_{"sender"};
    E2eReceiver<Message, kLimits> sut_{"receiver"};
    Instant now_{1'000'000};
};

TEST_F(ProtectedLinkTest, AnAcceptedValueIsForwardedWithTheTimeOfItsSender) {
    verifies("SWR-CYC-034");
    const Instant sent = now_;
    ASSERT_TRUE(deliver(send(1.5)));

    EXPECT_EQ(sut_.out.get_published().value, 1.5);
    EXPECT_TRUE(sut_.is_fresh(sent + 4_ms, fresh_within(4_ms)));
    EXPECT_FALSE(sut_.is_fresh(sent + 4_ms + 1_ns, fresh_within(4_ms)));
    EXPECT_EQ(sut_.get_count(E2eOutcome::kAccepted), 2U) << "two messages of a run are not used";
}

TEST_F(ProtectedLinkTest, ADamagedOrRepeatedMessageIsNotForwardedAndMakesNothingFresh) {
    verifies("SWR-CYC-034", Technique::kFaultInjection, Polarity::kViolation);
    Message::Frame frame = send(2.0);
    ASSERT_TRUE(deliver(frame));
    const Instant last = now_ - kFrame;
    EXPECT_FALSE(deliver(frame)) << "repeated";
    frame = send(3.0);
    frame[20] ^= 1U;
    EXPECT_FALSE(deliver(frame)) << "damaged";

    EXPECT_EQ(sut_.out.get_published().value, 2.0);
    EXPECT_TRUE(sut_.is_fresh(now_, fresh_within(now_ - last)));
    EXPECT_FALSE(sut_.is_fresh(now_, fresh_within(now_ - last - 1_ns)));
}

TEST_F(ProtectedLinkTest, NothingIsSentWithoutANewValue) {
    verifies("SWR-CYC-034");
    EXPECT_EQ(sender_.on_execute({0, now_}), Status::kOk);
    EXPECT_FALSE(sender_.out.publish(now_));
}

TEST(ProtectedReceiverTest, NothingIsFreshBeforeTheFirstMessageOrWithoutASendTime) {
    verifies("SWR-CYC-034", Technique::kBoundaryValues, Polarity::kViolation);
    class Bare final : public ProtectedReceiver {
      public:
        void accept(double value) noexcept { record_accepted(value); }
    };
    Receiver receiver{"receiver"};
    Bare bare;
    bare.accept(1.0);

    EXPECT_FALSE(receiver.is_fresh({}, fresh_within(1_s)));
    EXPECT_FALSE(bare.is_fresh({}, fresh_within(1_s)));
    receiver.accept({});
    EXPECT_TRUE(receiver.is_fresh({}, fresh_within(1_s)));
}

}  // namespace
}  // namespace mamori::safety::testing_of_cycle
