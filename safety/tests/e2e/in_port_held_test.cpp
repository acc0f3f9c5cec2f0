// SPDX-License-Identifier: Apache-2.0
// Goal: the last value of a protected input is held only while channel, age and mode allow it, and its
// substitute stands there else.
// Method: both ends by hand; channels that lose and regain their validity, clocks that jump, delayed frames,
// changes of the mode, senders that begin anew; both sides of each limit.
#include <limits>
#include <string>

#include "mamori/trace/verifies.hpp"
#include "port_rig.hpp"

namespace e2e_port_test {
namespace {

using namespace mamori::verification;

constexpr Instant kFirst{std::numeric_limits<std::int64_t>::min()};
constexpr Instant kLast{std::numeric_limits<std::int64_t>::max()};

// ---- State of the channel ----

TEST(E2eStateTest, NothingIsHandedOutUntilTheChannelIsProven) {
    verifies("SWR-E2E-031", Technique::kBoundaryValues, Polarity::kViolation);
    Strict ends{kSafe};

    EXPECT_EQ(ends.send({1.0, Gear::kDrive}), E2eWorth::kSubstitute);
    EXPECT_EQ(ends.value.rad_s, kSafe.rad_s);
    EXPECT_EQ(ends.sut.get_outcome(), E2eOutcome::kUnproven);
    EXPECT_EQ(ends.send({2.0, Gear::kDrive}), E2eWorth::kNew);
    EXPECT_EQ(ends.value.rad_s, 2.0);
}

TEST(E2eStateTest, ChannelThatIsNotValidAnyMoreTakesItsValueBack) {
    verifies("SWR-E2E-032", Technique::kStateTransition, Polarity::kViolation);
    Strict ends{kSafe};
    ends.synchronise();
    ASSERT_EQ(ends.send({1.0, Gear::kDrive}), E2eWorth::kNew);
    auto damaged = ends.make({2.0, Gear::kDrive});
    damaged[20U] = static_cast<std::uint8_t>(damaged[20U] ^ 1U);

    EXPECT_EQ(ends.receive(damaged), E2eWorth::kSubstitute);
    EXPECT_EQ(ends.value.rad_s, kSafe.rad_s);
    EXPECT_EQ(ends.sut.get_state(), ChannelState::kInvalid);
    EXPECT_EQ(ends.send({3.0, Gear::kDrive}),
              E2eWorth::kSubstitute);  // whole and in order: the loss was its own
    EXPECT_EQ(ends.sut.get_outcome(), E2eOutcome::kRefused);
    EXPECT_EQ(ends.send({4.0, Gear::kDrive}), E2eWorth::kSubstitute);
    EXPECT_EQ(ends.sut.get_outcome(), E2eOutcome::kUnproven);
    EXPECT_EQ(ends.send({5.0, Gear::kDrive}), E2eWorth::kSubstitute);
    EXPECT_EQ(ends.send({6.0, Gear::kDrive}), E2eWorth::kNew);
    EXPECT_EQ(ends.value.rad_s, 6.0);
    EXPECT_EQ(ends.sut.get_count(E2eOutcome::kUnproven), 3U);
}

TEST(E2eStateTest, SilenceIsCountedAndEndsValidity) {
    verifies("SWR-E2E-033", Technique::kBoundaryValues, Polarity::kViolation);
    Strict ends{kSafe};
    ends.synchronise();
    ASSERT_EQ(ends.send({1.0, Gear::kDrive}), E2eWorth::kNew);

    EXPECT_EQ(ends.read(), E2eWorth::kHeld);
    EXPECT_EQ(ends.read(), E2eWorth::kHeld);
    EXPECT_EQ(ends.value.rad_s, 1.0);
    EXPECT_EQ(ends.read(), E2eWorth::kSubstitute);  // no good one among the last three
    EXPECT_EQ(ends.sut.get_state(), ChannelState::kInvalid);
    EXPECT_EQ(ends.sut.get_outcome(), E2eOutcome::kSilent);
    EXPECT_EQ(ends.sut.get_count(E2eOutcome::kSilent), 3U);
    EXPECT_EQ(ends.sut.get_checker().get_count(FrameCause::kSilence), 3U);
}

TEST(E2eStateTest, AHeldValueIsWrittenWhateverStoodThere) {
    verifies("SWR-E2E-033", Technique::kErrorGuessing);
    Strict ends{kSafe};
    ends.synchronise();
    ASSERT_EQ(ends.send({1.0, Gear::kDrive}), E2eWorth::kNew);

    ends.value = {99.0, Gear::kPark};
    EXPECT_EQ(ends.read(), E2eWorth::kHeld);
    EXPECT_EQ(ends.value.rad_s, 1.0);
    EXPECT_EQ(ends.value.gear, Gear::kDrive);
}

TEST(E2eStateTest, SilenceFromTheStartGivesTheSubstitute) {
    verifies("SWR-E2E-033", Technique::kErrorGuessing);
    Strict ends{kSafe};
    EXPECT_EQ(ends.sut.get_outcome(), E2eOutcome::kSilent);

    EXPECT_EQ(ends.read(), E2eWorth::kSubstitute);
    EXPECT_EQ(ends.value.rad_s, kSafe.rad_s);
    EXPECT_EQ(ends.sut.get_state(), ChannelState::kNoData);
    EXPECT_EQ(ends.sut.get_count(E2eOutcome::kSilent), 1U);
}

// ---- Substitute ----

TEST(E2eSubstituteTest, OutParameterNeverKeepsWhatStoodInIt) {
    verifies("SWR-E2E-032", Technique::kErrorGuessing);
    Strict ends{kSafe};
    ends.value = {99.0, Gear::kDrive};

    EXPECT_EQ(ends.read(), E2eWorth::kSubstitute);
    EXPECT_EQ(ends.value.rad_s, kSafe.rad_s);
    EXPECT_EQ(ends.value.gear, kSafe.gear);
}

// ---- Age ----

TEST(E2eAgeTest, FrameAtTheLimitIsTakenAndOneBeyondItIsNot) {
    verifies("SWR-E2E-034", Technique::kBoundaryValues, Polarity::kViolation);
    Young ends{kSafe};
    ends.synchronise();

    ends.deliver(ends.make({1.0, Gear::kDrive}), ends.now + 10_ms - 25_ms);  // read 10 ms later
    EXPECT_EQ(ends.read(), E2eWorth::kNew);
    ends.deliver(ends.make({2.0, Gear::kDrive}), ends.now + 10_ms - 25_ms - 1_ns);
    EXPECT_EQ(ends.read(), E2eWorth::kSubstitute);
    EXPECT_EQ(ends.value.rad_s, kSafe.rad_s);
    EXPECT_EQ(ends.sut.get_outcome(), E2eOutcome::kLate);
    EXPECT_EQ(ends.sut.get_count(E2eOutcome::kLate), 1U);
}

TEST(E2eAgeTest, ValueIsHeldUpToTheLimitAndNoLonger) {
    verifies("SWR-E2E-034", Technique::kBoundaryValues);
    Young ends{kSafe};
    ends.synchronise();
    ASSERT_EQ(ends.send({1.0, Gear::kDrive}), E2eWorth::kNew);  // 10 ms old
    const Instant sent_at = ends.now - 10_ms;

    EXPECT_EQ(ends.sut.read(sent_at + 25_ms, ends.value), E2eWorth::kHeld);
    EXPECT_EQ(ends.value.rad_s, 1.0);
    EXPECT_EQ(ends.sut.read(sent_at + 25_ms + 1_ns, ends.value), E2eWorth::kSubstitute);
    EXPECT_EQ(ends.value.rad_s, kSafe.rad_s);
    EXPECT_EQ(ends.sut.get_state(), ChannelState::kValid);
}

TEST(E2eAgeTest, ClockThatGoesBackGivesTheSubstitute) {
    verifies("SWR-E2E-034", Technique::kFaultInjection, Polarity::kViolation);
    Young ends{kSafe};
    ends.synchronise();
    ASSERT_EQ(ends.send({1.0, Gear::kDrive}), E2eWorth::kNew);

    EXPECT_EQ(ends.sut.read(ends.now - 10_ms - 1_ns, ends.value), E2eWorth::kSubstitute);
}

constexpr SentIdChannel kStampedChannel{9U, 12U + 20U, 12U + 20U};
using StampedMessage = E2eMessage<Stamped<Speed>, E2eProfile04<>, kStampedChannel>;
using StampedEnds = Ends<StampedMessage, kYoung>;

TEST(E2eAgeTest, DelayOfATransportIsSeenByTheStamp) {
    verifies("SWR-E2E-034", Technique::kFaultInjection, Polarity::kViolation);
    StampedEnds ends{};
    static_cast<void>(ends.send({ends.now.ns, {1.0, Gear::kDrive}}));
    ASSERT_EQ(ends.send({ends.now.ns, {1.0, Gear::kDrive}}), E2eWorth::kNew);

    // A transport that is late from here on, in order and without a gap, hands each frame on as new.
    const std::int64_t limit_ns = (ends.now + 10_ms - 25_ms).ns;
    EXPECT_EQ(ends.send({limit_ns, {2.0, Gear::kDrive}}), E2eWorth::kNew);
    EXPECT_EQ(ends.send({(ends.now + 10_ms - 25_ms).ns - 1, {3.0, Gear::kDrive}}), E2eWorth::kSubstitute);
    EXPECT_EQ(ends.sut.get_outcome(), E2eOutcome::kLate);
}

TEST(E2eAgeTest, StampOfTheFutureIsRefused) {
    verifies("SWR-E2E-034", Technique::kBoundaryValues, Polarity::kViolation);
    StampedEnds ends{};
    static_cast<void>(ends.send({ends.now.ns, {1.0, Gear::kDrive}}));
    ASSERT_EQ(ends.send({(ends.now + 10_ms).ns, {1.0, Gear::kDrive}}), E2eWorth::kNew);  // this very instant
    EXPECT_EQ(ends.send({(ends.now + 10_ms).ns + 1, {2.0, Gear::kDrive}}), E2eWorth::kHeld);
    EXPECT_EQ(ends.value.value.rad_s, 1.0) << "the value of before";
    EXPECT_EQ(ends.sut.get_outcome(), E2eOutcome::kEarly);
}

// A reader that is released late may find a message that was sent after the planned start of its window.

TEST(E2eLateReaderTest, MessageSentAfterThePlannedStartWaitsForTheNextReading) {
    verifies("SWR-E2E-042", Technique::kFaultInjection);
    StampedEnds ends{};
    static_cast<void>(ends.send({ends.now.ns, {1.0, Gear::kDrive}}));
    ASSERT_EQ(ends.send({ends.now.ns, {1.0, Gear::kDrive}}), E2eWorth::kNew);

    EXPECT_EQ(ends.send({(ends.now + 15_ms).ns, {2.0, Gear::kDrive}}), E2eWorth::kHeld);
    EXPECT_EQ(ends.value.value.rad_s, 1.0);
    EXPECT_EQ(ends.sut.get_outcome(), E2eOutcome::kEarly);
    EXPECT_EQ(ends.read(), E2eWorth::kNew) << "its instant has come";
    EXPECT_EQ(ends.value.value.rad_s, 2.0);
    EXPECT_EQ(ends.sut.get_outcome(), E2eOutcome::kAccepted);
    EXPECT_EQ(ends.read(), E2eWorth::kHeld) << "once only";
    EXPECT_EQ(ends.sut.get_count(E2eOutcome::kAccepted), 2U);
    EXPECT_EQ(ends.sut.get_count(E2eOutcome::kEarly), 1U);
}

TEST(E2eLateReaderTest, QueuedMessageSentAfterThePlannedStartWaitsForTheNextReading) {
    verifies("SWR-E2E-042", Technique::kFaultInjection);
    Ends<StampedMessage, kYoung, mamori::QueueInPort<StampedMessage::Frame, 2U>> ends{};
    static_cast<void>(ends.send({ends.now.ns, {1.0, Gear::kDrive}}));
    ASSERT_EQ(ends.send({ends.now.ns, {1.0, Gear::kDrive}}), E2eWorth::kNew);

    EXPECT_EQ(ends.send({(ends.now + 15_ms).ns, {2.0, Gear::kDrive}}), E2eWorth::kHeld);
    EXPECT_EQ(ends.read(), E2eWorth::kNew);
    EXPECT_EQ(ends.value.value.rad_s, 2.0);
}

TEST(E2eLateReaderTest, ChannelOfALateReaderStaysValid) {
    verifies("SWR-E2E-042", Technique::kFaultInjection);
    // No error is tolerated, and one good reading of two is enough.
    static constexpr E2eInLimits<PlainSequence> kNoError{25_ms, {1U}, 2U, {{1U, 0U}, {1U, 0U}, {1U, 0U}}};
    Ends<StampedMessage, kNoError> ends{};
    static_cast<void>(ends.send({ends.now.ns, {1.0, Gear::kDrive}}));
    for (int i = 0; i < 10; ++i) {
        ASSERT_EQ(ends.send({ends.now.ns, {1.0, Gear::kDrive}}), E2eWorth::kNew);
        ASSERT_EQ(ends.send({(ends.now + 11_ms).ns, {2.0, Gear::kDrive}}), E2eWorth::kHeld);
        ASSERT_EQ(ends.sut.get_state(), ChannelState::kValid);
    }
}

TEST(E2eLateReaderTest, MessageThatIsStillEarlyInTheNextReadingIsAnError) {
    verifies("SWR-E2E-042", Technique::kBoundaryValues, Polarity::kViolation);
    for (const std::int64_t beyond_ns : {0, 1}) {
        static constexpr E2eInLimits<PlainSequence> kNoError{
            100_ms, {1U}, 4U, {{1U, 0U}, {1U, 0U}, {1U, 0U}}};
        Ends<StampedMessage, kNoError> ends{};
        static_cast<void>(ends.send({ends.now.ns, {1.0, Gear::kDrive}}));
        ASSERT_EQ(ends.send({ends.now.ns, {1.0, Gear::kDrive}}), E2eWorth::kNew);

        ASSERT_EQ(ends.send({(ends.now + 20_ms).ns + beyond_ns, {2.0, Gear::kDrive}}), E2eWorth::kHeld);
        EXPECT_EQ(ends.read(), beyond_ns == 0 ? E2eWorth::kNew : E2eWorth::kSubstitute);
        EXPECT_EQ(ends.sut.get_state(), beyond_ns == 0 ? ChannelState::kValid : ChannelState::kInvalid);
    }
}

TEST(E2eLateReaderTest, SecondEarlyMessageInARowIsAnErrorAndEndsTheHeldValue) {
    verifies("SWR-E2E-042", Technique::kFaultInjection, Polarity::kViolation);
    StampedEnds ends{};
    static_cast<void>(ends.send({ends.now.ns, {1.0, Gear::kDrive}}));
    ASSERT_EQ(ends.send({ends.now.ns, {1.0, Gear::kDrive}}), E2eWorth::kNew);

    ASSERT_EQ(ends.send({(ends.now + 11_ms).ns, {2.0, Gear::kDrive}}), E2eWorth::kHeld);
    EXPECT_EQ(ends.send({(ends.now + 11_ms).ns, {3.0, Gear::kDrive}}), E2eWorth::kSubstitute);
    EXPECT_EQ(ends.sut.get_outcome(), E2eOutcome::kEarly);
    EXPECT_EQ(ends.read(), E2eWorth::kSubstitute) << "the rejected message stays rejected";
}

TEST(E2eLateReaderTest, LaterMessageReplacesTheOneThatWaits) {
    verifies("SWR-E2E-042", Technique::kStateTransition);
    StampedEnds ends{};
    static_cast<void>(ends.send({ends.now.ns, {1.0, Gear::kDrive}}));
    ASSERT_EQ(ends.send({ends.now.ns, {1.0, Gear::kDrive}}), E2eWorth::kNew);
    ASSERT_EQ(ends.send({(ends.now + 11_ms).ns, {2.0, Gear::kDrive}}), E2eWorth::kHeld);

    EXPECT_EQ(ends.send({ends.now.ns, {3.0, Gear::kDrive}}), E2eWorth::kNew);
    EXPECT_EQ(ends.value.value.rad_s, 3.0);
    EXPECT_EQ(ends.read(), E2eWorth::kHeld);
    EXPECT_EQ(ends.value.value.rad_s, 3.0);
}

TEST(E2eLateReaderTest, RejectedMessageOrARestartEndsTheWait) {
    verifies("SWR-E2E-042", Technique::kFaultInjection, Polarity::kViolation);
    for (const bool is_restarted : {false, true}) {
        StampedEnds ends{};
        static_cast<void>(ends.send({ends.now.ns, {1.0, Gear::kDrive}}));
        ASSERT_EQ(ends.send({(ends.now + 10_ms).ns, {1.0, Gear::kDrive}}), E2eWorth::kNew);
        ASSERT_EQ(ends.send({(ends.now + 11_ms).ns, {2.0, Gear::kDrive}}), E2eWorth::kHeld);

        if (is_restarted) {
            ends.in.restart(ends.now, ends.revision);
            EXPECT_EQ(ends.read(), E2eWorth::kSubstitute);
        } else {
            EXPECT_EQ(ends.receive(ends.out.get_published()), E2eWorth::kHeld) << "a repetition";
            EXPECT_EQ(ends.value.value.rad_s, 1.0);
        }
        EXPECT_NE(ends.read(), E2eWorth::kNew);
        EXPECT_EQ(ends.sut.get_count(E2eOutcome::kAccepted), 1U);
    }
}

TEST(E2eLateReaderTest, ResetEndsTheWait) {
    verifies("SWR-E2E-042", Technique::kStateTransition, Polarity::kViolation);
    StampedEnds ends{};
    static_cast<void>(ends.send({ends.now.ns, {1.0, Gear::kDrive}}));
    ASSERT_EQ(ends.send({ends.now.ns, {1.0, Gear::kDrive}}), E2eWorth::kNew);
    ASSERT_EQ(ends.send({(ends.now + 11_ms).ns, {2.0, Gear::kDrive}}), E2eWorth::kHeld);

    ends.sut.restart();
    EXPECT_EQ(ends.read(), E2eWorth::kSubstitute);
    EXPECT_EQ(ends.sut.get_outcome(), E2eOutcome::kSilent);
}

/// As kYoung, with a sender whose clock may be 2 ms ahead.
inline constexpr E2eInLimits<PlainSequence> kTolerant{
    25_ms, {1U}, 12U, {{1U, 11U}, {1U, 11U}, {1U, 11U}}, MappingRule::kSyncIsOk, 2_ms};

TEST(E2eAgeTest, StampAheadOfNowIsAcceptedUpToTheTolerance) {
    verifies("SWR-E2E-034", Technique::kBoundaryValues, Polarity::kViolation);
    Ends<StampedMessage, kTolerant> ends{};
    static_cast<void>(ends.send({ends.now.ns, {1.0, Gear::kDrive}}));
    ASSERT_EQ(ends.send({(ends.now + 12_ms).ns, {1.0, Gear::kDrive}}), E2eWorth::kNew);
    EXPECT_EQ(ends.send({(ends.now + 12_ms).ns + 1, {2.0, Gear::kDrive}}), E2eWorth::kHeld);
    EXPECT_EQ(ends.value.value.rad_s, 1.0) << "the value of before";
    EXPECT_EQ(ends.sut.get_outcome(), E2eOutcome::kEarly);

    EXPECT_EQ(judge_age(kLast, kFirst, 1_ns, {kLast.ns}), E2eOutcome::kEarly);
    EXPECT_EQ(judge_age(kLast, {0}, 1_ns, {kLast.ns}), E2eOutcome::kAccepted);
}

TEST(E2eAgeTest, StampsBeyondAllTimesAreRefusedWithoutOverflow) {
    verifies("SWR-E2E-034", Technique::kErrorGuessing, Polarity::kViolation);
    StampedEnds ends{};
    EXPECT_EQ(ends.send({kFirst.ns, {1.0, Gear::kDrive}}), E2eWorth::kSubstitute);
    EXPECT_EQ(ends.sut.get_outcome(), E2eOutcome::kLate);
    EXPECT_EQ(ends.send({kLast.ns, {1.0, Gear::kDrive}}), E2eWorth::kSubstitute);
    EXPECT_EQ(ends.sut.get_outcome(), E2eOutcome::kEarly);

    EXPECT_EQ(judge_age(kFirst, kLast, 1_ns), E2eOutcome::kLate);
    EXPECT_EQ(judge_age(kLast, kFirst, 1_ns), E2eOutcome::kEarly);
    EXPECT_EQ(judge_age(kFirst, kFirst, 1_ns), E2eOutcome::kAccepted);
    EXPECT_EQ(judge_age({-1}, {0}, 1_ns), E2eOutcome::kAccepted);
    EXPECT_EQ(judge_age({-2}, {0}, 1_ns), E2eOutcome::kLate);
}

// ---- Modes ----

template <typename Port>
class E2eModeTest : public ::testing::Test {
  protected:
    void SetUp() override {
        ends_.synchronise();
        ASSERT_EQ(ends_.send({1.0, Gear::kDrive}), E2eWorth::kNew);
    }
    Ends<M04, kLoose<HardenedSequence>, Port> ends_{kSafe};
};
using Inputs = ::testing::Types<mamori::InPort<M04::Frame>, Queue>;
struct InputName {
    template <typename Port>
    static std::string GetName(int) {  // NOLINT(readability-identifier-naming)
        return Port::kIsQueue ? "Queue" : "Latest";
    }
};
TYPED_TEST_SUITE(E2eModeTest, Inputs, InputName);

TYPED_TEST(E2eModeTest, ValueOfAnotherModeIsNotHeld) {
    verifies("SWR-E2E-041", Technique::kStateTransition, Polarity::kViolation);
    ASSERT_EQ(this->ends_.read(), E2eWorth::kHeld);

    this->ends_.in.restart(this->ends_.now, this->ends_.revision);
    EXPECT_EQ(this->ends_.read(), E2eWorth::kSubstitute);
    EXPECT_EQ(this->ends_.value.rad_s, kSafe.rad_s);
    EXPECT_EQ(this->ends_.sut.get_state(), ChannelState::kValid);
}

TYPED_TEST(E2eModeTest, ValueOfAnEarlierRunIsNotHeld) {
    verifies("SWR-E2E-041", Technique::kStateTransition, Polarity::kViolation);
    for (int run = 0; run < 2; ++run) {
        ASSERT_EQ(this->ends_.send({1.0, Gear::kDrive}), E2eWorth::kNew);
        ASSERT_EQ(this->ends_.read(), E2eWorth::kHeld);

        // As each start of an executive does: with one and the same instant.
        this->ends_.in.restart(mamori::kBeforeAll, this->ends_.revision);
        EXPECT_EQ(this->ends_.read(), E2eWorth::kSubstitute);
        EXPECT_EQ(this->ends_.value.rad_s, kSafe.rad_s);
    }
}

TYPED_TEST(E2eModeTest, FrameAtAnInstantOfAnEarlierRunIsSeen) {
    verifies("SWR-E2E-041", Technique::kErrorGuessing);
    const Instant first = this->ends_.now;
    ASSERT_EQ(this->ends_.send({1.0, Gear::kDrive}), E2eWorth::kNew);
    this->ends_.in.restart(mamori::kBeforeAll, this->ends_.revision);

    this->ends_.now = first;  // the time line of the new run begins again
    EXPECT_EQ(this->ends_.send({2.0, Gear::kDrive}), E2eWorth::kNew);
}

TYPED_TEST(E2eModeTest, RefusedFrameOfTheNewModeDoesNotBringTheOldValueBack) {
    verifies("SWR-E2E-041", Technique::kFaultInjection, Polarity::kViolation);
    const auto repeated = this->ends_.out.get_published();
    this->ends_.in.restart(this->ends_.now, this->ends_.revision);
    this->ends_.now = this->ends_.now + 10_ms;

    EXPECT_EQ(this->ends_.receive(repeated), E2eWorth::kSubstitute);
    EXPECT_EQ(this->ends_.sut.get_outcome(), E2eOutcome::kRefused);
    EXPECT_EQ(this->ends_.read(), E2eWorth::kSubstitute);
}

TYPED_TEST(E2eModeTest, SameChannelGoesOnInTheNewMode) {
    verifies("SWR-E2E-041", Technique::kStateTransition);
    this->ends_.in.restart(this->ends_.now, this->ends_.revision);
    ASSERT_EQ(this->ends_.read(), E2eWorth::kSubstitute);

    EXPECT_EQ(this->ends_.send({2.0, Gear::kDrive}), E2eWorth::kNew);
    EXPECT_EQ(this->ends_.value.rad_s, 2.0);
    EXPECT_EQ(this->ends_.read(), E2eWorth::kHeld);
}

// ---- Reset ----

TEST(E2eRestartTest, SenderThatBeganAnewIsHeardAfterADeliberateResetOnly) {
    verifies("SWR-E2E-039", Technique::kStateTransition, Polarity::kViolation);
    Ends<M04, kLoose<HardenedSequence>> ends{kSafe, 1000U};
    ends.synchronise();
    ASSERT_EQ(ends.send({1.0, Gear::kDrive}), E2eWorth::kNew);
    mamori::OutPort<M04::Frame> out{mamori::kNoOwner, "out"};
    E2eOutPort<M04> sender{out};
    const auto send = [&]() {
        static_cast<void>(sender.write({2.0, Gear::kDrive}));
        static_cast<void>(out.publish(ends.now));
        return ends.receive(out.get_published());
    };
    for (int i = 0; i < 20; ++i) {
        ASSERT_NE(send(), E2eWorth::kNew);
    }

    ends.sut.restart();
    EXPECT_EQ(ends.read(), E2eWorth::kSubstitute);
    EXPECT_EQ(send(), E2eWorth::kSubstitute);  // two frames find the order
    EXPECT_EQ(send(), E2eWorth::kSubstitute);
    EXPECT_EQ(send(), E2eWorth::kNew);
    EXPECT_EQ(ends.value.rad_s, 2.0);
    EXPECT_EQ(ends.sut.get_checker().get_restart_count(), 1U);
}

TEST(E2eRestartTest, ResetTakesTheValueBackAndKeepsTheCounts) {
    verifies("SWR-E2E-039", Technique::kStateTransition);
    Ends<M04, kLoose<PlainSequence>> ends{kSafe};
    ends.synchronise();
    ASSERT_EQ(ends.send({1.0, Gear::kDrive}), E2eWorth::kNew);

    ends.sut.restart();
    EXPECT_EQ(ends.sut.get_state(), ChannelState::kNoData);
    EXPECT_EQ(ends.read(), E2eWorth::kSubstitute);
    EXPECT_EQ(ends.sut.get_count(E2eOutcome::kAccepted), 4U);
}

}  // namespace
}  // namespace e2e_port_test
