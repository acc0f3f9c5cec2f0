// SPDX-License-Identifier: Apache-2.0
// Goal: a protected input hands out a value only when frame, content, age and channel allow it, and its
// substitute else; each reading is counted by one outcome.
// Method: both ends by hand with a way between them on which frames are damaged, lost, repeated, delayed and
// replaced; both orders; both sides of each limit; every profile; both kinds of input.
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "mamori/verification/verifies.hpp"
#include "port_rig.hpp"

namespace e2e_port_test {
namespace {

using mamori::Duration;
using mamori::verification::Polarity;
using mamori::verification::Technique;
using mamori::verification::verifies;

constexpr Instant kFirst{std::numeric_limits<std::int64_t>::min()};
constexpr Instant kLast{std::numeric_limits<std::int64_t>::max()};

// ---- Every profile, both orders, both kinds of input ----

template <typename M, typename O, bool kQueues>
struct Way {
    using Message = M;
    using Order = O;
    using Port = std::conditional_t<kQueues, mamori::QueueInPort<typename M::Frame, 4U>,
                                    mamori::InPort<typename M::Frame>>;
    using Both = Ends<M, kLoose<O>, Port>;
};
template <typename M>
using Conformant = Way<M, typename M::Profile::Sequence, false>;
template <typename M>
using Hardened = Way<M, HardenedSequence, true>;

template <typename TheWay>
class E2eInPortTest : public ::testing::Test {};
using Ways =
    ::testing::Types<Conformant<M01>, Conformant<M02>, Conformant<M04>, Conformant<M05>, Conformant<M06>,
                     Conformant<M07>, Conformant<M08>, Conformant<M11>, Conformant<M22>, Conformant<M44>,
                     Hardened<M01>, Hardened<M02>, Hardened<M04>, Hardened<M05>, Hardened<M06>, Hardened<M07>,
                     Hardened<M08>, Hardened<M11>, Hardened<M22>, Hardened<M44>>;
struct WayName {
    template <typename TheWay>
    static std::string GetName(int) {  // NOLINT(readability-identifier-naming)
        return "P" + std::to_string(TheWay::Message::Profile::kNumber) +
               (TheWay::Port::kIsQueue ? "HardenedQueue" : "ConformantLatest");
    }
};
TYPED_TEST_SUITE(E2eInPortTest, Ways, WayName);

TYPED_TEST(E2eInPortTest, ValuesArriveInOrderAcrossTheWrap) {
    verifies("SWR-E2E-031", Technique::kBoundaryValues);
    typename TypeParam::Both ends{kSafe, TypeParam::Message::Profile::kCounterMax - 6U};
    ends.synchronise();

    for (int i = 0; i < 40; ++i) {
        EXPECT_EQ(ends.send({0.5 * i, Gear::kDrive}), E2eWorth::kNew) << i;
        EXPECT_EQ(ends.value.rad_s, 0.5 * i);
        EXPECT_EQ(ends.value.gear, Gear::kDrive);
        EXPECT_EQ(ends.sut.get_outcome(), E2eOutcome::kAccepted);
    }
    EXPECT_EQ(ends.sut.get_state(), ChannelState::kValid);
}

TYPED_TEST(E2eInPortTest, EachTurnedBitKeepsTheValueIn) {
    verifies("SWR-E2E-031", Technique::kFaultInjection, Polarity::kViolation);
    typename TypeParam::Both ends{kSafe};
    ends.synchronise();

    const auto good = ends.make({5.0, Gear::kDrive});
    for (std::size_t bit = 0U; bit < good.size() * 8U; ++bit) {
        auto frame = good;
        frame[bit / 8U] = static_cast<std::uint8_t>(frame[bit / 8U] ^ (1U << (bit % 8U)));
        EXPECT_NE(ends.receive(frame), E2eWorth::kNew) << bit;
        EXPECT_NE(ends.value.rad_s, 5.0) << bit;
        EXPECT_EQ(ends.sut.get_outcome(), E2eOutcome::kRefused);
    }
    EXPECT_EQ(ends.sut.get_checker().get_count(FrameCause::kChecksum), good.size() * 8U);
    EXPECT_EQ(ends.sut.get_state(), ChannelState::kInvalid);
}

// ---- Each cause, both orders ----

/// Frames of a port may be longer than those of the message.
using Roomy = mamori::InPort<E2eFrame<40U>>;
constexpr SentIdChannel kOther{0x0A0B0C0EU, 24U, 24U};
using OtherMessage = E2eMessage<Speed, E2eProfile04<>, kOther>;

template <typename O>
class E2eCausesTest : public ::testing::Test {
  protected:
    using Both = Ends<M04, kLoose<O>, Roomy>;
    using Frame = typename Both::Frame;

    void SetUp() override {
        ends_.synchronise();
        ASSERT_EQ(ends_.send({1.0, Gear::kDrive}), E2eWorth::kNew);
    }
    /// The frame is refused for `cause`, and the value of before is what there is.
    void expect_refused(const Frame& frame, FrameCause cause) {
        const std::uint32_t before = ends_.sut.get_checker().get_count(cause);
        EXPECT_EQ(ends_.receive(frame), E2eWorth::kHeld) << get_name(cause);
        EXPECT_EQ(ends_.value.rad_s, 1.0);
        EXPECT_EQ(ends_.sut.get_outcome(), E2eOutcome::kRefused);
        EXPECT_STREQ(get_name(ends_.sut.get_checker().get_cause()), get_name(cause));
        EXPECT_EQ(ends_.sut.get_checker().get_count(cause), before + 1U);
    }
    Frame make() { return ends_.make({9.0, Gear::kDrive}); }

    Both ends_{kSafe};
};
using Orders = ::testing::Types<PlainSequence, HardenedSequence>;
struct OrderName {
    template <typename O>
    static std::string GetName(int) {  // NOLINT(readability-identifier-naming)
        return std::is_same_v<O, HardenedSequence> ? "Hardened" : "Conformant";
    }
};
TYPED_TEST_SUITE(E2eCausesTest, Orders, OrderName);

TYPED_TEST(E2eCausesTest, FrameOfAnotherLengthIsRefused) {
    verifies("SWR-E2E-031", Technique::kBoundaryValues, Polarity::kViolation);
    auto shorter = this->make();
    ASSERT_EQ(shorter.resize(23U), Status::kOk);
    this->expect_refused(shorter, FrameCause::kTooShort);
    ASSERT_EQ(shorter.resize(12U), Status::kOk);  // header only
    this->expect_refused(shorter, FrameCause::kTooShort);
    ASSERT_EQ(shorter.resize(0U), Status::kOk);
    this->expect_refused(shorter, FrameCause::kTooShort);

    auto longer = this->make();
    ASSERT_EQ(longer.resize(25U), Status::kOk);
    this->expect_refused(longer, FrameCause::kTooLong);
    ASSERT_EQ(longer.resize(40U), Status::kOk);
    this->expect_refused(longer, FrameCause::kTooLong);
}

TYPED_TEST(E2eCausesTest, StuckLineIsRefused) {
    verifies("SWR-E2E-031", Technique::kFaultInjection, Polarity::kViolation);
    for (const std::size_t length : {23U, 24U, 25U}) {
        auto frame = this->make();
        ASSERT_EQ(frame.resize(length), Status::kOk);
        std::fill(frame.begin(), frame.end(), std::uint8_t{0U});
        this->expect_refused(frame, FrameCause::kAllZero);
        std::fill(frame.begin(), frame.end(), std::uint8_t{0xFFU});
        this->expect_refused(frame, FrameCause::kAllOnes);
    }
}

TYPED_TEST(E2eCausesTest, FrameOfAnotherChannelIsRefused) {
    verifies("SWR-E2E-031", Technique::kFaultInjection, Polarity::kViolation);
    Ends<OtherMessage, kLoose<TypeParam>, Roomy> others{kSafe, this->ends_.sender.get_counter()};

    this->expect_refused(others.make({9.0, Gear::kDrive}), FrameCause::kDataId);
}

TYPED_TEST(E2eCausesTest, RepeatedFrameIsRefused) {
    verifies("SWR-E2E-031", Technique::kFaultInjection, Polarity::kViolation);
    const auto frame = this->ends_.out.get_published();

    this->expect_refused(frame, FrameCause::kRepeated);
    this->expect_refused(frame, FrameCause::kRepeated);
}

TYPED_TEST(E2eCausesTest, FrameAfterMoreLossesThanAllowedIsRefused) {
    verifies("SWR-E2E-031", Technique::kBoundaryValues, Polarity::kViolation);
    static_cast<void>(this->make());

    this->expect_refused(this->make(), FrameCause::kOutOfOrder);
}

TYPED_TEST(E2eCausesTest, FrameThatWasOvertakenIsRefused) {
    verifies("SWR-E2E-031", Technique::kFaultInjection, Polarity::kViolation);
    const auto overtaken = this->ends_.out.get_published();
    ASSERT_EQ(this->ends_.send({1.0, Gear::kDrive}), E2eWorth::kNew);

    this->expect_refused(overtaken, FrameCause::kOutOfOrder);
}

TYPED_TEST(E2eCausesTest, CountsOfTheOutcomesSumUpToTheReadings) {
    verifies("SWR-E2E-035", Technique::kRequirementsBased);
    const std::uint32_t before = 5U;  // readings of the set-up
    const auto repeated = this->ends_.out.get_published();
    static_cast<void>(this->ends_.receive(repeated));
    static_cast<void>(this->ends_.read());
    static_cast<void>(this->ends_.send({2.0, Gear::kDrive}));
    static_cast<void>(this->ends_.read());

    std::uint32_t sum = 0U;
    for (std::size_t i = 0U; i < kE2eOutcomeCount; ++i) {
        sum += this->ends_.sut.get_count(static_cast<E2eOutcome>(i));
    }
    EXPECT_EQ(sum, before + 4U);
    EXPECT_EQ(this->ends_.sut.get_count(E2eOutcome::kSilent), 2U);
    EXPECT_EQ(this->ends_.sut.get_count(E2eOutcome::kRefused),
              this->ends_.sut.get_checker().get_count(FrameCause::kRepeated) +
                  this->ends_.sut.get_checker().get_count(FrameCause::kOutOfOrder));
}

// ---- Losses within the limit ----

constexpr E2eInLimits<PlainSequence> kOneLoss{100_ms, {2U}, 12U, {{1U, 11U}, {1U, 11U}, {1U, 11U}}};
constexpr E2eInLimits<HardenedSequence> kOneLossHard{100_ms, {2U}, 12U, {{1U, 11U}, {1U, 11U}, {1U, 11U}}};

template <const auto& kLimits>
void expect_one_loss_is_allowed() {
    Ends<M04, kLimits> ends{kSafe};
    ends.synchronise();
    ASSERT_EQ(ends.send({1.0, Gear::kDrive}), E2eWorth::kNew);

    static_cast<void>(ends.make({2.0, Gear::kDrive}));
    EXPECT_EQ(ends.send({3.0, Gear::kDrive}), E2eWorth::kNew);
    EXPECT_EQ(ends.value.rad_s, 3.0);
    EXPECT_EQ(ends.sut.get_checker().get_order().get_lost_count(), 1U);

    static_cast<void>(ends.make({4.0, Gear::kDrive}));
    static_cast<void>(ends.make({5.0, Gear::kDrive}));
    EXPECT_EQ(ends.send({6.0, Gear::kDrive}), E2eWorth::kHeld);
    EXPECT_EQ(ends.value.rad_s, 3.0);
}

TEST(E2eLossTest, LossesWithinTheLimitOfTheOrderAreAllowed) {
    verifies("SWR-E2E-031", Technique::kBoundaryValues);
    expect_one_loss_is_allowed<kOneLoss>();
    expect_one_loss_is_allowed<kOneLossHard>();
}

// ---- State of the channel ----

/// Two good readings of three prove the channel; one bad one of three ends that.
constexpr E2eInLimits<PlainSequence> kStrict{100_ms, {1U}, 3U, {{2U, 0U}, {1U, 0U}, {3U, 0U}}};
using Strict = Ends<M04, kStrict>;

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

// ---- Content ----

TEST(E2eContentTest, GoodFrameWithoutAValueOfTheTypeIsRefusedAndAnError) {
    verifies("SWR-E2E-031", Technique::kFaultInjection, Polarity::kViolation);
    Strict ends{kSafe};
    ends.synchronise();
    auto frame = ends.make({2.0, Gear::kDrive});
    frame[20U] = 2U;  // a gear that is none, protected anew as a faulty sender would
    E2eProfile04<>::write(kSent12, 4U, detail::edit_bytes(frame));

    EXPECT_EQ(ends.receive(frame), E2eWorth::kSubstitute);
    EXPECT_EQ(ends.sut.get_outcome(), E2eOutcome::kMalformed);
    EXPECT_EQ(ends.sut.get_checker().get_cause(), FrameCause::kGood);
    EXPECT_EQ(ends.sut.get_state(), ChannelState::kInvalid);
    EXPECT_EQ(ends.sut.get_count(E2eOutcome::kMalformed), 1U);
}

TEST(E2eContentTest, ValueThatWasHeldGoesWithAMalformedOne) {
    verifies("SWR-E2E-032", Technique::kFaultInjection, Polarity::kViolation);
    Ends<M04, kLoose<PlainSequence>> ends{kSafe};
    ends.synchronise();
    ASSERT_EQ(ends.send({1.0, Gear::kDrive}), E2eWorth::kNew);
    auto frame = ends.make({2.0, Gear::kDrive});
    frame[20U] = 2U;
    E2eProfile04<>::write(kSent12, 5U, detail::edit_bytes(frame));

    EXPECT_EQ(ends.receive(frame), E2eWorth::kSubstitute);
    EXPECT_EQ(ends.sut.get_state(), ChannelState::kValid);
    EXPECT_EQ(ends.read(), E2eWorth::kSubstitute);
}

constexpr SentIdChannel kNoteChannel{7U, 12U + 9U, 12U + 16U};
using NoteMessage = E2eMessage<Note, E2eProfile04<>, kNoteChannel>;

TEST(E2eContentTest, ValuesOfEachLengthArrive) {
    verifies("SWR-E2E-031", Technique::kBoundaryValues);
    Ends<NoteMessage, kLoose<PlainSequence>> ends{};
    ends.synchronise();

    for (const char* const text : {"7 chars", "", "1", "1234", "7 again"}) {
        Note note{};
        for (const char* next = text; *next != '\0'; ++next) {
            ASSERT_EQ(note.text.push_back(*next), Status::kOk);
        }
        ASSERT_EQ(ends.send(note), E2eWorth::kNew);
        EXPECT_STREQ(ends.value.text.c_str(), text);
    }
}

TEST(E2eContentTest, FrameThatWasCutToAnotherAllowedLengthIsRefused) {
    verifies("SWR-E2E-031", Technique::kFaultInjection, Polarity::kViolation);
    Ends<NoteMessage, kLoose<PlainSequence>> ends{};
    ends.synchronise();
    auto frame = ends.make({1U, {"1234567"}});

    ASSERT_EQ(frame.resize(frame.size() - 1U), Status::kOk);
    EXPECT_NE(ends.receive(frame), E2eWorth::kNew);
    EXPECT_EQ(ends.sut.get_checker().get_cause(), FrameCause::kChecksum);
    E2eProfile04<>::write(kNoteChannel, 4U,
                          detail::edit_bytes(frame));  // whole again, but a text without end
    EXPECT_EQ(ends.receive(frame), E2eWorth::kSubstitute);
    EXPECT_EQ(ends.sut.get_outcome(), E2eOutcome::kMalformed);
}

using BigMessage = E2eMessage<Speed, E2eProfile04<>, kSent12, mamori::ByteOrder::kBig>;

TEST(E2eContentTest, ByteOrderOfThePayloadIsThatOfTheMessage) {
    verifies("SWR-E2E-031", Technique::kEquivalenceClasses);
    Ends<BigMessage, kLoose<PlainSequence>> ends{kSafe};
    ends.synchronise();

    const auto frame = ends.make({1.0, Gear::kDrive});
    EXPECT_EQ(frame[12U], 0x3FU);  // 1.0 is 3F F0 00 ..
    EXPECT_EQ(frame[23U], 1U);
    ASSERT_EQ(ends.receive(frame), E2eWorth::kNew);
    EXPECT_EQ(ends.value.rad_s, 1.0);
}

// ---- Age ----

constexpr E2eInLimits<PlainSequence> kYoung{25_ms, {1U}, 12U, {{1U, 11U}, {1U, 11U}, {1U, 11U}}};
using Young = Ends<M04, kYoung>;

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
    EXPECT_EQ(ends.send({(ends.now + 10_ms).ns + 1, {2.0, Gear::kDrive}}), E2eWorth::kSubstitute);
    EXPECT_EQ(ends.sut.get_outcome(), E2eOutcome::kEarly);
    EXPECT_EQ(ends.read(), E2eWorth::kSubstitute);  // nor is it there when its instant comes
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

// ---- Each frame once ----

TEST(E2eSourceTest, FrameThatThePortStillCallsNewIsNoSecondFrame) {
    verifies("SWR-E2E-036", Technique::kStateTransition);
    Ends<M04, kLoose<PlainSequence>> ends{kSafe};
    ends.synchronise();
    ends.deliver(ends.make({1.0, Gear::kDrive}));
    ASSERT_TRUE(ends.sut.has_frame());
    ASSERT_EQ(ends.sut.read(ends.now, ends.value),
              E2eWorth::kNew);  // and its cycle is cut off: no mark_read()

    EXPECT_FALSE(ends.sut.has_frame());
    EXPECT_EQ(ends.read(), E2eWorth::kHeld);
    EXPECT_EQ(ends.sut.get_outcome(), E2eOutcome::kSilent);
    EXPECT_EQ(ends.sut.get_checker().get_count(FrameCause::kRepeated), 0U);
    EXPECT_EQ(ends.send({2.0, Gear::kDrive}), E2eWorth::kNew);
}

using Queue = mamori::QueueInPort<M04::Frame, 2U>;

TEST(E2eSourceTest, QueueGivesEachFrameOnceInItsOrder) {
    verifies("SWR-E2E-036", Technique::kStateTransition);
    Ends<M04, kLoose<HardenedSequence>, Queue> ends{kSafe};
    ends.synchronise();
    ends.deliver(ends.make({1.0, Gear::kDrive}));
    ends.deliver(ends.make({2.0, Gear::kDrive}));

    EXPECT_EQ(ends.read(), E2eWorth::kNew);
    EXPECT_EQ(ends.value.rad_s, 1.0);
    ASSERT_TRUE(ends.sut.has_frame());
    EXPECT_EQ(ends.read(), E2eWorth::kNew);
    EXPECT_EQ(ends.value.rad_s, 2.0);
    EXPECT_FALSE(ends.sut.has_frame());
    EXPECT_EQ(ends.read(), E2eWorth::kHeld);  // not the last one again, though the queue would read it back
    EXPECT_EQ(ends.sut.get_outcome(), E2eOutcome::kSilent);
}

TEST(E2eSourceTest, FrameThatGaveWayInAQueueIsALoss) {
    verifies("SWR-E2E-036", Technique::kBoundaryValues, Polarity::kViolation);
    Ends<M04, kLoose<HardenedSequence>, Queue> ends{kSafe};
    ends.synchronise();
    for (const double speed : {1.0, 2.0, 3.0}) {
        static_cast<void>(ends.in.push({ends.make({speed, Gear::kDrive}), ++ends.revision, ends.now}));
    }
    ends.in.open(ends.now);

    EXPECT_NE(ends.read(), E2eWorth::kNew);
    EXPECT_EQ(ends.sut.get_checker().get_cause(), FrameCause::kOutOfOrder);
}

/// A queue that says that a frame waits, and cannot give it.
struct BrokenQueue {
    using Payload = M04::Frame;
    static constexpr bool kIsQueue = true;

    bool has_waiting() noexcept { return is_waiting; }
    Status read(Payload& frame) noexcept {
        if (!is_broken) {
            frame = next;
        }
        return is_broken ? Status::kOutOfResources : Status::kOk;
    }
    Instant get_published_at() const noexcept { return Instant{}; }
    Instant get_restarted_at() const noexcept { return Instant{}; }

    Payload next{};
    bool is_waiting{true};
    bool is_broken{false};
};

TEST(E2eSourceTest, FrameThatAQueueCannotGiveIsNone) {
    verifies("SWR-E2E-036", Technique::kFaultInjection, Polarity::kViolation);
    mamori::OutPort<M04::Frame> out{"out"};
    E2eOutPort<M04> sender{out};
    BrokenQueue queue;
    E2eInPort<M04, kLoose<PlainSequence>, BrokenQueue> sut{queue, kSafe};
    Speed value{};
    for (int i = 0; i < 3; ++i) {
        ASSERT_EQ(sender.write({1.0, Gear::kDrive}), Status::kOk);
        static_cast<void>(out.publish(Instant{}));
        queue.next = out.get_published();
        static_cast<void>(sut.read(Instant{}, value));
    }
    ASSERT_EQ(sut.get_outcome(), E2eOutcome::kAccepted);

    queue.is_broken = true;
    EXPECT_EQ(sut.read(Instant{}, value), E2eWorth::kHeld);
    EXPECT_EQ(sut.get_checker().get_cause(), FrameCause::kTooShort);
    EXPECT_EQ(sut.get_checker().get_count(FrameCause::kRepeated), 0U);
}

TEST(E2eSourceTest, AgeOfAQueuedFrameIsItsOwn) {
    verifies("SWR-E2E-034", Technique::kBoundaryValues, Polarity::kViolation);
    Ends<M04, kYoung, Queue> ends{kSafe};
    ends.synchronise();
    const Instant start = ends.now;
    static_cast<void>(ends.in.push({ends.make({1.0, Gear::kDrive}), ++ends.revision, start}));
    static_cast<void>(ends.in.push({ends.make({2.0, Gear::kDrive}), ++ends.revision, start + 10_ms}));
    ends.in.open(start + 35_ms);

    EXPECT_EQ(ends.sut.read(start + 35_ms, ends.value), E2eWorth::kSubstitute);
    EXPECT_EQ(ends.sut.get_outcome(), E2eOutcome::kLate);
    EXPECT_EQ(ends.sut.read(start + 35_ms, ends.value), E2eWorth::kNew);
    EXPECT_EQ(ends.value.rad_s, 2.0);
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
    mamori::OutPort<M04::Frame> out{"out"};
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

// ---- Names ----

TEST(E2eOutcomeTest, EachOutcomeHasItsName) {
    verifies("SWR-E2E-035", Technique::kInterface);
    constexpr std::array<const char*, kE2eOutcomeCount> kOutcomes{
        "Accepted", "Silent", "Refused", "Malformed", "Early", "Late", "Unproven"};
    constexpr std::array<const char*, 3U> kWorths{"Substitute", "Held", "New"};

    for (std::size_t i = 0U; i < kOutcomes.size(); ++i) {
        EXPECT_STREQ(get_name(static_cast<E2eOutcome>(i)), kOutcomes[i]);
    }
    EXPECT_STREQ(get_name(static_cast<E2eOutcome>(kOutcomes.size())), "Invalid");
    for (std::size_t i = 0U; i < kWorths.size(); ++i) {
        EXPECT_STREQ(get_name(static_cast<E2eWorth>(i)), kWorths[i]);
    }
    EXPECT_STREQ(get_name(static_cast<E2eWorth>(kWorths.size())), "Invalid");
}

}  // namespace
}  // namespace e2e_port_test
