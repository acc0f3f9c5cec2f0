// SPDX-License-Identifier: Apache-2.0
// Goal: a stack that was used beyond its limit, or whose guard was touched, is found; its use is known.
// Method: words of a painted area are touched one by one, at both sides of the limit, and by a real function.
#include "mamori/safety/self_test/stack_check.hpp"

#include <array>

#include "mamori/trace/verifies.hpp"
#include "mamori/verification/failed_check.hpp"

namespace mamori::safety {
namespace {

using namespace verification;

constexpr std::size_t kWords = 20U;
constexpr StackLimits kLimits{2U, 8U, 5U};  // a margin of 12 words, in three steps

class StackCheckTest : public ::testing::Test {
  protected:
    StackCheckTest() { sut_.paint(kWords); }
    SelfTestStatus run_pass() {
        sut_.begin();
        SelfTestStatus status = SelfTestStatus::kRunning;
        for (std::size_t i = 0U; i < sut_.get_step_count() && status == SelfTestStatus::kRunning; ++i) {
            status = sut_.step();
        }
        return status;
    }
    /// As a stack is used: from the highest address down.
    void use(std::size_t words) {
        for (std::size_t i = 0U; i < words; ++i) {
            words_[kWords - 1U - i] = 0U;
        }
    }

    std::array<std::uint32_t, kWords> words_{};
    StackCheck sut_{RamArea(words_.data(), kWords), kLimits};
};

TEST_F(StackCheckTest, UseUpToTheLimitPasses) {
    verifies("SWR-SLF-010", Technique::kBoundaryValues);
    EXPECT_EQ(sut_.get_step_count(), 3U);
    EXPECT_EQ(run_pass(), SelfTestStatus::kPassed);
    EXPECT_EQ(sut_.calc_used_words(), 0U);

    use(8U);
    EXPECT_EQ(run_pass(), SelfTestStatus::kPassed);
    EXPECT_EQ(sut_.calc_used_words(), 8U);
}

TEST_F(StackCheckTest, StepsAreAsManyAsTheMarginNeeds) {
    verifies("SWR-SLF-010", Technique::kBoundaryValues);
    const RamArea area(words_.data(), kWords);

    EXPECT_EQ((StackCheck{area, {2U, 8U, 3U}}.get_step_count()), 4U);
    EXPECT_EQ((StackCheck{area, {2U, 8U, 4U}}.get_step_count()), 3U);
    EXPECT_EQ((StackCheck{area, {2U, 8U, 11U}}.get_step_count()), 2U);
    EXPECT_EQ((StackCheck{area, {2U, 8U, 12U}}.get_step_count()), 1U);
    EXPECT_EQ((StackCheck{area, {2U, 8U, 13U}}.get_step_count()), 1U);
}

TEST_F(StackCheckTest, UseBeyondTheLimitIsFoundAndItsSizeKnown) {
    verifies("SWR-SLF-010", Technique::kBoundaryValues, Polarity::kViolation);

    for (std::size_t used = 9U; used <= kWords; ++used) {
        sut_.paint(kWords);
        use(used);
        EXPECT_EQ(run_pass(), SelfTestStatus::kFailed) << used;
        EXPECT_EQ(sut_.calc_used_words(), used);
    }
}

TEST_F(StackCheckTest, EachTouchedWordOfTheMarginIsFoundAndNoneAboveIt) {
    verifies("SWR-SLF-010", Technique::kFaultInjection, Polarity::kViolation);

    for (std::size_t word = 0U; word < kWords; ++word) {
        words_[word] ^= 0x80U;
        EXPECT_EQ(run_pass(), word < 12U ? SelfTestStatus::kFailed : SelfTestStatus::kPassed) << word;
        EXPECT_EQ(sut_.calc_used_words(), kWords - word);
        words_[word] ^= 0x80U;
    }
}

TEST_F(StackCheckTest, TouchedGuardIsFoundInTheNextStepWhereverThePassIs) {
    verifies("SWR-SLF-010", Technique::kFaultInjection, Polarity::kViolation);
    for (std::size_t word = 0U; word < kLimits.guard_words; ++word) {
        sut_.paint(kWords);
        sut_.begin();
        ASSERT_EQ(sut_.step(), SelfTestStatus::kRunning) << "the words of the guard were looked at";

        words_[word] = 0U;
        EXPECT_EQ(sut_.step(), SelfTestStatus::kFailed) << word;
    }
}

TEST_F(StackCheckTest, PassThatBeginsAnewLooksAtEveryWordAgain) {
    verifies("SWR-SLF-010", Technique::kStateTransition, Polarity::kViolation);
    sut_.begin();
    ASSERT_EQ(sut_.step(), SelfTestStatus::kRunning);

    words_[4] = 0U;  // of the first step, and not of the guard
    sut_.begin();
    EXPECT_EQ(sut_.step(), SelfTestStatus::kFailed);
}

TEST_F(StackCheckTest, StackThatWasNeverPaintedIsFound) {
    verifies("SWR-SLF-010", Technique::kErrorGuessing, Polarity::kViolation);
    words_.fill(0U);

    EXPECT_EQ(run_pass(), SelfTestStatus::kFailed);
    EXPECT_EQ(sut_.calc_used_words(), kWords);
}

TEST_F(StackCheckTest, PaintLeavesWhatIsInUse) {
    verifies("SWR-SLF-010", Technique::kBoundaryValues);
    words_.fill(7U);

    sut_.paint(12U);
    EXPECT_EQ(words_[12], 7U);
    EXPECT_EQ(sut_.calc_used_words(), 8U);
    EXPECT_EQ(run_pass(), SelfTestStatus::kPassed);
}

TEST_F(StackCheckTest, LimitsOutsideTheirRangeGoToTheAssertionHandler) {
    verifies("SWR-SLF-010", Technique::kBoundaryValues, Polarity::kViolation);
    const RamArea area(words_.data(), kWords);

    EXPECT_CHECK_FAILS((StackCheck{area, {0U, 8U, 5U}}), "stack_check.hpp", 1);
    EXPECT_CHECK_FAILS((StackCheck{area, {2U, 8U, 0U}}), "stack_check.hpp", 1);
    EXPECT_CHECK_FAILS((StackCheck{area, {21U, 0U, 1U}}), "stack_check.hpp", 2);
    EXPECT_CHECK_FAILS((StackCheck{area, {2U, 19U, 1U}}), "stack_check.hpp", 3);
    EXPECT_CHECK_FAILS(sut_.paint(11U), "stack_check.cpp", 4);
    EXPECT_CHECK_FAILS(sut_.paint(21U), "stack_check.cpp", 4);
    static_cast<void>(StackCheck{area, {20U, 0U, 1U}});
    static_cast<void>(StackCheck{area, {2U, 18U, 1U}});
}

}  // namespace
}  // namespace mamori::safety
