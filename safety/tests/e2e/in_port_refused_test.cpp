// SPDX-License-Identifier: Apache-2.0
// Goal: a protected input hands out a value only when frame, content and order allow it.
// Method: both ends by hand with a way between them on which frames are damaged, lost, repeated and replaced;
// both orders; both sides of each limit; every profile; both kinds of input.
#include <string>

#include "mamori/trace/verifies.hpp"
#include "port_rig.hpp"

namespace e2e_port_test {
namespace {

using namespace mamori::verification;

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

}  // namespace
}  // namespace e2e_port_test
