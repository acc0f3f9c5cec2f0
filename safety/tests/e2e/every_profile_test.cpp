// SPDX-License-Identifier: Apache-2.0
// Goal: in every profile the good frames of a channel pass in order, across the wrap; no other frame does,
// and each
//       is counted by its cause.
// Method: typed tests over all profiles and their variants: wrong lengths, stuck lines, each bit turned,
// foreign frames.
#include <array>
#include <cstdint>
#include <limits>
#include <string>

#include "mamori/safety/e2e/e2e.hpp"
#include "mamori/trace/verifies.hpp"
#include "rig.hpp"

namespace mamori::safety {
namespace {

using verification::Polarity;
using verification::Technique;
using verification::verifies;

constexpr std::size_t kLength = 24U;

template <typename Case>
class EveryProfileTest : public ::testing::Test {
  protected:
    using Subject = typename Case::Profile;

    CheckStatus check(const rig::Frame& frame) { return sut_.check(rig::view(frame)); }
    rig::Frame make(std::uint32_t counter) {
        return rig::protect<Subject>(Case::make(kLength), counter, kLength);
    }
    void expect_refused(const rig::Frame& frame, FrameCause cause) {
        const std::uint32_t before = sut_.get_count(cause);
        EXPECT_EQ(check(frame), CheckStatus::kError);
        EXPECT_STREQ(get_name(sut_.get_cause()), get_name(cause));
        EXPECT_EQ(sut_.get_count(cause), before + 1U);
    }

    E2eChecker<Subject> sut_{Case::make(kLength), {}};
};

using Cases = ::testing::Types<rig::P01Both, rig::P01Alternating, rig::P01Low, rig::P01Nibble, rig::P02,
                               rig::P04, rig::P05, rig::P06, rig::P07, rig::P08, rig::P11Both, rig::P11Nibble,
                               rig::P22, rig::P44>;

/// Names a case by its profile; GoogleTest prescribes the spelling of the function.
struct CaseName {
    template <typename Case>
    static std::string GetName(int index) {  // NOLINT(readability-identifier-naming)
        return "P" + std::to_string(Case::Profile::kNumber) + "_" + std::to_string(index);
    }
};
TYPED_TEST_SUITE(EveryProfileTest, Cases, CaseName);

TYPED_TEST(EveryProfileTest, GoodFramesPassInOrderAcrossTheWrap) {
    verifies("SWR-E2E-004", Technique::kBoundaryValues);
    using Profile = typename TypeParam::Profile;
    E2eProtector<Profile> sender{TypeParam::make(kLength), Profile::kCounterMax - 4U};
    rig::Frame frame(kLength, std::byte{0x5AU});
    ASSERT_EQ(sender.protect(rig::edit(frame)), Status::kOk);
    static_cast<void>(this->check(frame));  // finds the order
    ASSERT_EQ(sender.protect(rig::edit(frame)), Status::kOk);
    static_cast<void>(this->check(frame));

    for (std::uint32_t i = 0U; i < 40U; ++i) {
        ASSERT_EQ(sender.protect(rig::edit(frame)), Status::kOk);
        EXPECT_EQ(this->check(frame), CheckStatus::kOk) << i << ": " << rig::to_hex(frame);
    }
    EXPECT_GE(this->sut_.get_count(FrameCause::kGood), 40U);
}

TYPED_TEST(EveryProfileTest, HardenedReceiverFollowsTheSameSender) {
    verifies("SWR-E2E-007");
    using Profile = typename TypeParam::Profile;
    E2eProtector<Profile> sender{TypeParam::make(kLength), Profile::kCounterMax - 4U};
    HardenedE2eChecker<Profile> receiver{TypeParam::make(kLength), {1U}};
    rig::Frame frame(kLength);

    for (std::uint32_t i = 0U; i < 40U; ++i) {
        ASSERT_EQ(sender.protect(rig::edit(frame)), Status::kOk);
        const rig::Frame& received = frame;
        EXPECT_EQ(receiver.check(rig::view(received)),
                  i < 2U ? CheckStatus::kWrongSequence : CheckStatus::kOk);
    }
}

TYPED_TEST(EveryProfileTest, PayloadStaysAsItIs) {
    verifies("SWR-E2E-003", Technique::kInterface);
    using Profile = typename TypeParam::Profile;
    rig::Frame frame(kLength, std::byte{0xA5U});
    Profile::write(TypeParam::make(kLength), 3U, rig::edit(frame));

    EXPECT_EQ(rig::Frame(frame.begin() + Profile::kHeaderSize, frame.end()),
              rig::Frame(kLength - Profile::kHeaderSize, std::byte{0xA5U}));
}

TYPED_TEST(EveryProfileTest, FramesOfAnotherLengthAreRefused) {
    verifies("SWR-E2E-004", Technique::kBoundaryValues, Polarity::kViolation);
    rig::Frame frame = this->make(5U);
    frame.pop_back();
    this->expect_refused(frame, FrameCause::kTooShort);
    this->expect_refused({}, FrameCause::kTooShort);
    frame = this->make(5U);
    frame.push_back(std::byte{0x11U});

    this->expect_refused(frame, FrameCause::kTooLong);
}

TYPED_TEST(EveryProfileTest, StuckLinesAreRefusedAndNamed) {
    verifies("SWR-E2E-005", Technique::kFaultInjection, Polarity::kViolation);

    this->expect_refused(rig::Frame(kLength, std::byte{0U}), FrameCause::kAllZero);
    this->expect_refused(rig::Frame(kLength, std::byte{0xFFU}), FrameCause::kAllOnes);
    this->expect_refused(rig::Frame(kLength - 1U, std::byte{0U}), FrameCause::kAllZero);
    this->expect_refused(rig::Frame(kLength + 1U, std::byte{0xFFU}), FrameCause::kAllOnes);
}

TYPED_TEST(EveryProfileTest, EachTurnedBitIsSeen) {
    verifies("SWR-E2E-004", Technique::kFaultInjection, Polarity::kViolation);
    const rig::Frame good = this->make(5U);

    for (std::size_t bit = 0U; bit < kLength * 8U; ++bit) {
        rig::Frame frame = good;
        frame[bit / 8U] ^= std::byte{1U} << (bit % 8U);
        EXPECT_EQ(this->check(frame), CheckStatus::kError) << bit;
    }
    EXPECT_EQ(this->sut_.get_count(FrameCause::kChecksum), kLength * 8U);
}

TYPED_TEST(EveryProfileTest, FramesOfAnotherChannelAreRefused) {
    verifies("SWR-E2E-004", Technique::kFaultInjection, Polarity::kViolation);
    using Profile = typename TypeParam::Profile;

    for (std::uint32_t counter = 0U; counter <= 14U; ++counter) {
        const rig::Frame frame = rig::protect<Profile>(TypeParam::make_other(kLength), counter, kLength);
        ASSERT_EQ(frame.size(), kLength);
        EXPECT_EQ(this->check(frame), CheckStatus::kError) << counter;
    }
    EXPECT_EQ(this->sut_.get_count(FrameCause::kChecksum) + this->sut_.get_count(FrameCause::kDataId), 15U);
}

TYPED_TEST(EveryProfileTest, OrderIsCountedByItsCause) {
    verifies("SWR-E2E-005", Technique::kStateTransition);
    static_cast<void>(this->check(this->make(0U)));
    ASSERT_EQ(this->sut_.check_silence(), CheckStatus::kNoNewData);
    ASSERT_EQ(this->sut_.get_cause(), FrameCause::kSilence);
    ASSERT_EQ(this->check(this->make(1U)), CheckStatus::kOk);
    ASSERT_EQ(this->check(this->make(1U)), CheckStatus::kRepeated);
    ASSERT_EQ(this->check(this->make(9U)), CheckStatus::kWrongSequence);

    EXPECT_EQ(this->sut_.get_cause(), FrameCause::kOutOfOrder);
    EXPECT_EQ(this->sut_.get_count(FrameCause::kSilence), 1U);
    EXPECT_EQ(this->sut_.get_count(FrameCause::kRepeated), 1U);
    EXPECT_EQ(this->sut_.get_count(FrameCause::kOutOfOrder), 1U);
    EXPECT_EQ(this->sut_.get_count(FrameCause::kGood) + this->sut_.get_count(FrameCause::kInitial), 2U);
}

TYPED_TEST(EveryProfileTest, EndsOfARefusedChannelRefuseEverything) {
    verifies("SWR-E2E-009", Technique::kErrorGuessing, Polarity::kViolation);
    using Profile = typename TypeParam::Profile;
    const auto channel = TypeParam::make(1U);
    ASSERT_EQ(Profile::find_fault(channel), ChannelFault::kLength);
    rig::Frame frame(1U);
    E2eProtector<Profile> sender{channel};
    E2eChecker<Profile> receiver{channel, {}};
    E2eProtector<Profile> unfit_counter{TypeParam::make(kLength),
                                        Profile::kCounterMax < 0xFFFFFFFFU ? Profile::kCounterMax + 1U : 0U};
    HardenedE2eChecker<Profile> unfit_limits{TypeParam::make(kLength), {0U}};
    rig::Frame good = this->make(0U);

    EXPECT_EQ(sender.protect(rig::edit(frame)), Status::kPreconditionNotMet);
    EXPECT_EQ(receiver.check({frame.data(), frame.size()}), CheckStatus::kError);
    EXPECT_EQ(receiver.get_count(FrameCause::kNotReady), 1U);
    EXPECT_EQ(unfit_counter.protect(rig::edit(good)),
              Profile::kCounterMax < 0xFFFFFFFFU ? Status::kPreconditionNotMet : Status::kOk);
    EXPECT_EQ(unfit_limits.check({good.data(), good.size()}), CheckStatus::kError);
    EXPECT_EQ(unfit_limits.get_cause(), FrameCause::kNotReady);
}

TYPED_TEST(EveryProfileTest, SenderRefusesAnotherLengthAndKeepsItsCounter) {
    verifies("SWR-E2E-003", Technique::kBoundaryValues);
    using Profile = typename TypeParam::Profile;
    E2eProtector<Profile> sut{TypeParam::make(kLength), 3U};
    rig::Frame frame(kLength + 1U);

    EXPECT_EQ(sut.protect(rig::edit(frame)), Status::kBadParameter);
    EXPECT_EQ(frame, rig::Frame(kLength + 1U));
    EXPECT_EQ(sut.get_counter(), 3U);
}

// What the compiler proves where a table is made.
constexpr SentIdChannel kChannel{0x0A0B0C0DU, 16U, 64U};
constexpr PlainLimits kLimits{2U};

TEST(E2eChannelTest, SoundChannelIsProvenByTheCompiler) {
    verifies("SWR-E2E-009", Technique::kInterface);
    static_assert(is_sound<E2eProfile04<>, kChannel>());
    static_assert(are_sound<E2eProfile04<>, PlainSequence, kLimits>());

    EXPECT_TRUE((is_sound<E2eProfile04<>, kChannel>()));
    EXPECT_TRUE((are_sound<E2eProfile04<>, PlainSequence, kLimits>()));
    EXPECT_EQ(E2eProfile04<>::find_fault(kChannel), ChannelFault::kNone);
    EXPECT_EQ(PlainSequence::find_fault(kLimits, E2eProfile04<>::kCounterMax), ChannelFault::kNone);
}

TEST(FrameCauseTest, CountsStopAtTheGreatestValue) {
    verifies("SWR-E2E-005", Technique::kBoundaryValues, Polarity::kViolation);
    std::uint32_t count = std::numeric_limits<std::uint32_t>::max() - 1U;

    saturating_increment(count);
    EXPECT_EQ(count, std::numeric_limits<std::uint32_t>::max());
    saturating_increment(count);
    EXPECT_EQ(count, std::numeric_limits<std::uint32_t>::max());
}

TEST(FrameCauseTest, EachCauseHasItsName) {
    verifies("SWR-E2E-005", Technique::kInterface);
    constexpr std::array<const char*, kFrameCauseCount> kNames{
        "Good",   "Silence",     "TooShort", "TooLong",  "AllZero",    "AllOnes", "Checksum",
        "DataId", "LengthField", "Counter",  "Repeated", "OutOfOrder", "Initial", "NotReady"};

    for (std::size_t i = 0U; i < kNames.size(); ++i) {
        EXPECT_STREQ(get_name(static_cast<FrameCause>(i)), kNames[i]);
    }
    EXPECT_STREQ(get_name(static_cast<FrameCause>(kFrameCauseCount)), "Invalid");
}

}  // namespace
}  // namespace mamori::safety
