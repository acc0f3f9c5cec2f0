// SPDX-License-Identifier: Apache-2.0
// Goal: a channel is valid only on enough good checks and few enough bad ones; silence alone ends it.
// Method: both sides of each demand in each state, every status, the ring beyond its end, unfit demands.
#include "mamori/safety/e2e/state_machine.hpp"

#include <array>
#include <limits>

#include "mamori/trace/verifies.hpp"

namespace mamori::safety {
namespace {

using namespace verification;

constexpr ChannelDemands kDemands{{3U, 1U}, {2U, 2U}, {4U, 0U}};

class ChannelStateMachineTest : public ::testing::Test {
  protected:
    ChannelState check(ProfileStatus status, int times = 1) {
        for (int i = 0; i < times; ++i) {
            EXPECT_EQ(sut_.check(status), Status::kOk);
        }
        return sut_.get_state();
    }
    void make_valid() { ASSERT_EQ(check(ProfileStatus::kOk, 5), ChannelState::kValid); }

    std::array<ProfileStatus, 5U> window_{};
    ChannelStateMachine sut_{window_, kDemands};
};

TEST_F(ChannelStateMachineTest, GoodFramesMakeAChannelValid) {
    verifies("SWR-E2E-010", Technique::kStateTransition);
    ASSERT_EQ(sut_.get_state(), ChannelState::kNoData);

    EXPECT_EQ(check(ProfileStatus::kOk), ChannelState::kInit);
    EXPECT_EQ(check(ProfileStatus::kOk), ChannelState::kInit);
    EXPECT_FALSE(sut_.is_valid());
    EXPECT_EQ(check(ProfileStatus::kOk), ChannelState::kValid);
    EXPECT_TRUE(sut_.is_valid());
    EXPECT_EQ(sut_.get_ok_count(), 3U);
}

TEST_F(ChannelStateMachineTest, SilenceAndDamageAreNoData) {
    verifies("SWR-E2E-010", Technique::kStateTransition, Polarity::kViolation);

    EXPECT_EQ(check(ProfileStatus::kNoNewData, 10), ChannelState::kNoData);
    EXPECT_EQ(check(ProfileStatus::kError, 10), ChannelState::kNoData);
    EXPECT_EQ(check(ProfileStatus::kRepeated), ChannelState::kInit);
}

TEST_F(ChannelStateMachineTest, OneErrorMoreThanAllowedEndsTheStart) {
    verifies("SWR-E2E-010", Technique::kBoundaryValues, Polarity::kViolation);
    ASSERT_EQ(check(ProfileStatus::kWrongSequence), ChannelState::kInit);

    EXPECT_EQ(check(ProfileStatus::kError), ChannelState::kInit);
    EXPECT_EQ(check(ProfileStatus::kError), ChannelState::kInvalid);
    EXPECT_EQ(sut_.get_error_count(), 2U);
}

TEST_F(ChannelStateMachineTest, OneErrorMoreThanAllowedEndsAValidChannel) {
    verifies("SWR-E2E-010", Technique::kBoundaryValues, Polarity::kViolation);
    make_valid();

    EXPECT_EQ(check(ProfileStatus::kError, 2), ChannelState::kValid);
    EXPECT_EQ(check(ProfileStatus::kError), ChannelState::kInvalid);
}

TEST_F(ChannelStateMachineTest, InvalidChannelNeedsItsOwnProof) {
    verifies("SWR-E2E-010", Technique::kStateTransition, Polarity::kViolation);
    make_valid();
    ASSERT_EQ(check(ProfileStatus::kError, 3), ChannelState::kInvalid);

    EXPECT_EQ(check(ProfileStatus::kOk, 4), ChannelState::kInvalid) << "an error is still in the window";
    EXPECT_EQ(check(ProfileStatus::kOk), ChannelState::kValid);
}

TEST_F(ChannelStateMachineTest, TooFewGoodFramesKeepAChannelInvalid) {
    verifies("SWR-E2E-010", Technique::kBoundaryValues, Polarity::kViolation);
    make_valid();
    ASSERT_EQ(check(ProfileStatus::kWrongSequence, 5), ChannelState::kInvalid);

    EXPECT_EQ(check(ProfileStatus::kOk, 3), ChannelState::kInvalid);
    EXPECT_EQ(check(ProfileStatus::kOk), ChannelState::kValid);
}

/// Checks without a good frame that a valid channel survives.
int count_survived(ProfileStatus status) {
    std::array<ProfileStatus, 5U> window{};
    ChannelStateMachine sut{window, kDemands};
    for (int i = 0; i < 5; ++i) {
        EXPECT_EQ(sut.check(ProfileStatus::kOk), Status::kOk);
    }
    int count = 0;
    for (; count < 100 && sut.is_valid(); ++count) {
        EXPECT_EQ(sut.check(status), Status::kOk);
        EXPECT_EQ(sut.get_error_count(), 0U) << "not counted as an error";
    }
    return count - 1;
}

TEST_F(ChannelStateMachineTest, SilenceAloneEndsAValidChannelWithinItsWindow) {
    verifies("SWR-E2E-011", Technique::kFaultInjection, Polarity::kViolation);

    // Five good ones are in the window, two are demanded: the fourth silent check is the one too many.
    EXPECT_EQ(count_survived(ProfileStatus::kNoNewData), 3);
    EXPECT_EQ(count_survived(ProfileStatus::kRepeated), 3);
    EXPECT_EQ(count_survived(ProfileStatus::kWrongSequence), 3);
    EXPECT_EQ(count_survived(ProfileStatus::kNotAvailable), 3);
}

TEST_F(ChannelStateMachineTest, FewSilentChecksAreSurvived) {
    verifies("SWR-E2E-011", Technique::kBoundaryValues);
    make_valid();

    EXPECT_EQ(check(ProfileStatus::kNoNewData, 3), ChannelState::kValid);
    EXPECT_EQ(check(ProfileStatus::kOk), ChannelState::kValid);
}

TEST_F(ChannelStateMachineTest, DemandsThatSilenceWouldMeetAreRefused) {
    verifies("SWR-E2E-011", Technique::kErrorGuessing, Polarity::kViolation);

    EXPECT_FALSE(are_sound({{0U, 0U}, {1U, 0U}, {1U, 0U}}, 5U));
    EXPECT_FALSE(are_sound({{1U, 0U}, {0U, 0U}, {1U, 0U}}, 5U));
    EXPECT_FALSE(are_sound({{1U, 0U}, {1U, 0U}, {0U, 0U}}, 5U));
}

TEST_F(ChannelStateMachineTest, DemandsOutsideTheWindowAreRefused) {
    verifies("SWR-E2E-010", Technique::kBoundaryValues, Polarity::kViolation);
    static_assert(are_sound(kDemands, 5U));

    EXPECT_TRUE(are_sound({{5U, 4U}, {5U, 4U}, {5U, 4U}}, 5U));
    EXPECT_FALSE(are_sound({{5U, 4U}, {6U, 4U}, {5U, 4U}}, 5U));
    EXPECT_FALSE(are_sound({{5U, 4U}, {5U, 4U}, {5U, 5U}}, 5U));
    EXPECT_FALSE(are_sound({}, 0U));
    EXPECT_TRUE(are_sound({}, 255U));
    EXPECT_FALSE(are_sound({}, 256U));

    ChannelStateMachine sut{{}, kDemands};
    EXPECT_EQ(sut.check(ProfileStatus::kOk), Status::kPreconditionNotMet);
    EXPECT_EQ(sut.get_state(), ChannelState::kNoData);
}

TEST_F(ChannelStateMachineTest, RestartForgetsEverything) {
    verifies("SWR-E2E-010", Technique::kStateTransition);
    make_valid();
    ASSERT_EQ(check(ProfileStatus::kError), ChannelState::kValid);

    sut_.restart();
    EXPECT_EQ(sut_.get_state(), ChannelState::kNoData);
    EXPECT_EQ(sut_.get_ok_count(), 0U);
    EXPECT_EQ(sut_.get_error_count(), 0U);
    EXPECT_EQ(check(ProfileStatus::kOk), ChannelState::kInit);
    EXPECT_EQ(sut_.get_ok_count(), 1U);
}

TEST_F(ChannelStateMachineTest, StatusesCountAsTheRuleSays) {
    verifies("SWR-E2E-010", Technique::kEquivalenceClasses);
    constexpr MappingRule kNew = MappingRule::kSyncIsOk;
    constexpr MappingRule kOld = MappingRule::kInitialIsOk;

    EXPECT_EQ(to_profile_status(CheckStatus::kOk, kNew), ProfileStatus::kOk);
    EXPECT_EQ(to_profile_status(CheckStatus::kOkSomeLost, kNew), ProfileStatus::kOk);
    EXPECT_EQ(to_profile_status(CheckStatus::kSync, kNew), ProfileStatus::kOk);
    EXPECT_EQ(to_profile_status(CheckStatus::kSync, kOld), ProfileStatus::kWrongSequence);
    EXPECT_EQ(to_profile_status(CheckStatus::kInitial, kNew), ProfileStatus::kWrongSequence);
    EXPECT_EQ(to_profile_status(CheckStatus::kInitial, kOld), ProfileStatus::kOk);
    EXPECT_EQ(to_profile_status(CheckStatus::kWrongSequence, kNew), ProfileStatus::kWrongSequence);
    EXPECT_EQ(to_profile_status(CheckStatus::kRepeated, kOld), ProfileStatus::kRepeated);
    EXPECT_EQ(to_profile_status(CheckStatus::kNoNewData, kNew), ProfileStatus::kNoNewData);
    EXPECT_EQ(to_profile_status(CheckStatus::kError, kNew), ProfileStatus::kError);
    EXPECT_EQ(to_profile_status(static_cast<CheckStatus>(0x7FU), kNew), ProfileStatus::kError);
}

}  // namespace
}  // namespace mamori::safety
