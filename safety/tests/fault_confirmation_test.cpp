// SPDX-License-Identifier: Apache-2.0
// Goal: a fault that flickers is confirmed by a count that decays, one that stays by its time.
// Method: both sides of each limit, breaks in between, a clock that runs backwards, refused rules.
#include <limits>

#include "mamori/trace/verifies.hpp"
#include "support/fault_register_fixture.hpp"

namespace mamori::safety {
namespace {

using namespace verification;

using FaultConfirmationTest = testing_support::FaultRegisterFixture;

// ---- By a count that decays ----

TEST_F(FaultConfirmationTest, FaultThatFlickersIsConfirmedWhereItsCountDecaysSlowly) {
    verifies("SWR-FLT-007");
    ASSERT_EQ(sut_.set_confirmation(0U, {4U, 1U}), Status::kOk);

    for (const bool is_present : {true, true, false, true, true, false, true}) {  // 1 2 1 2 3 2 3
        report(0U, is_present);
        ASSERT_FALSE(sut_.is_latched(0U));
    }
    report(0U, true);
    EXPECT_TRUE(sut_.is_latched(0U));
    EXPECT_EQ(sut_.get_record(0U).seen_at, Instant{10}) << "the first cycle of what was latched";
}

TEST_F(FaultConfirmationTest, FaultThatDecaysAsFastAsItCountsIsNeverConfirmed) {
    verifies("SWR-FLT-007", Technique::kBoundaryValues, Polarity::kViolation);
    ASSERT_EQ(sut_.set_confirmation(0U, {3U, 2U}), Status::kOk);

    for (int i = 0; i < 100; ++i) {
        report(0U, true);
        report(0U, true);
        report(0U, false);
    }
    EXPECT_FALSE(sut_.is_latched(0U));
    EXPECT_EQ(sut_.get_record(0U).count, 0U);
    report(0U, true);
    report(0U, false);
    EXPECT_EQ(sut_.get_record(0U).count, 0U) << "a decay beyond the count ends at 0";
}

TEST_F(FaultConfirmationTest, CountDecaysInEachCycleWithoutTheFaultAndIsNotForgotten) {
    verifies("SWR-FLT-007", Technique::kBoundaryValues, Polarity::kViolation);
    ASSERT_EQ(sut_.set_confirmation(1U, {5U, 1U}), Status::kOk);
    for (const bool is_present : {true, true, true, true, false, false, false}) {
        report(1U, is_present);
    }
    EXPECT_EQ(sut_.get_record(1U).count, 1U);

    for (int i = 0; i < 3; ++i) {
        report(1U, true);
        EXPECT_FALSE(sut_.is_latched(1U)) << i;
    }
    report(1U, true);
    EXPECT_TRUE(sut_.is_latched(1U));
}

TEST_F(FaultConfirmationTest, PresenceThatWasConfirmedLeavesNoCountBehind) {
    verifies("SWR-FLT-007", Technique::kStateTransition, Polarity::kViolation);
    ASSERT_EQ(sut_.set_confirmation(0U, {3U, 1U}), Status::kOk);
    for (int i = 0; i < 100; ++i) {
        report(0U, true);
    }
    report(0U, false);
    EXPECT_EQ(sut_.get_record(0U).count, 0U);
    report(0U, true);
    report(0U, false);
    report(0U, true);
    report(0U, false);

    EXPECT_EQ(sut_.get_record(0U).occurrences, 1U);
}

TEST_F(FaultConfirmationTest, AcknowledgementLeavesNoCountOfAFlickerBehind) {
    verifies("SWR-FLT-007", Technique::kErrorGuessing, Polarity::kViolation);
    ASSERT_EQ(sut_.set_confirmation(0U, {3U, 1U}), Status::kOk);
    for (const bool is_present : {true, true, true, false, true, true, false}) {
        report(0U, is_present);
    }
    ASSERT_EQ(sut_.get_record(0U).count, 1U);
    ASSERT_EQ(sut_.acknowledge(0U), Status::kOk);

    report(0U, true);
    EXPECT_EQ(sut_.get_record(0U).seen_at, now_);
    EXPECT_EQ(sut_.get_record(0U).count, 1U);
}

// ---- By time ----

TEST_F(FaultConfirmationTest, FaultIsConfirmedWhenItWasThereForItsTime) {
    verifies("SWR-FLT-008", Technique::kBoundaryValues);
    ASSERT_EQ(sut_.set_confirmation(0U, {0U, 0U, Duration{100}}), Status::kOk);

    sut_.report(0U, true, Instant{7});
    sut_.report(0U, true, Instant{106});
    EXPECT_FALSE(sut_.is_latched(0U));
    sut_.report(0U, true, Instant{107});
    EXPECT_TRUE(sut_.is_latched(0U));
    EXPECT_EQ(sut_.get_record(0U).seen_at, Instant{7});
    EXPECT_EQ(sut_.get_record(0U).latched_at, Instant{107});
}

TEST_F(FaultConfirmationTest, ShortestTimeOfAllConfirms) {
    verifies("SWR-FLT-001", Technique::kBoundaryValues);
    ASSERT_EQ(sut_.set_confirmation(1U, {0U, 0U, Duration{1}}), Status::kOk);

    sut_.report(1U, true, Instant{5});
    EXPECT_FALSE(sut_.is_latched(1U));
    sut_.report(1U, true, Instant{6});
    EXPECT_TRUE(sut_.is_latched(1U));
}

TEST_F(FaultConfirmationTest, BreakBeginsTheTimeAnew) {
    verifies("SWR-FLT-008", Technique::kBoundaryValues, Polarity::kViolation);
    ASSERT_EQ(sut_.set_confirmation(0U, {0U, 0U, Duration{100}}), Status::kOk);

    sut_.report(0U, true, Instant{0});
    sut_.report(0U, false, Instant{50});
    sut_.report(0U, true, Instant{60});
    sut_.report(0U, true, Instant{159});
    EXPECT_FALSE(sut_.is_latched(0U));
    EXPECT_EQ(sut_.get_record(0U).seen_at, Instant{60});
    sut_.report(0U, true, Instant{160});
    EXPECT_TRUE(sut_.is_latched(0U));
}

TEST_F(FaultConfirmationTest, FirstOfCountAndTimeConfirms) {
    verifies("SWR-FLT-008", Technique::kEquivalenceClasses);
    const Confirmation both{3U, 0U, Duration{100}};
    ASSERT_EQ(sut_.set_confirmation(0U, both), Status::kOk);
    ASSERT_EQ(sut_.set_confirmation(1U, both), Status::kOk);

    for (const std::int64_t now : {0, 1, 2}) {
        sut_.report(0U, true, Instant{now});
    }
    sut_.report(1U, true, Instant{0});
    sut_.report(1U, true, Instant{100});
    EXPECT_TRUE(sut_.is_latched(0U)) << "by count";
    EXPECT_TRUE(sut_.is_latched(1U)) << "by time";
}

TEST_F(FaultConfirmationTest, ClockThatRunsBackwardsConfirmsAFaultThatIsJudgedByTime) {
    verifies("SWR-FLT-008", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_EQ(sut_.set_confirmation(0U, {0U, 0U, Duration{100}}), Status::kOk);
    ASSERT_EQ(sut_.set_confirmation(1U, {9U}), Status::kOk);
    for (const FaultIndex fault : {FaultIndex{0U}, FaultIndex{1U}}) {
        sut_.report(fault, true, Instant{50});
        sut_.report(fault, true, Instant{60});
        sut_.report(fault, true, Instant{59});
    }

    EXPECT_TRUE(sut_.is_latched(0U));
    EXPECT_FALSE(sut_.is_latched(1U)) << "judged by count";
}

TEST_F(FaultConfirmationTest, TimeHoldsAtTheEndsOfTheTimeLine) {
    verifies("SWR-FLT-008", Technique::kBoundaryValues, Polarity::kViolation);
    constexpr std::int64_t kLast = std::numeric_limits<std::int64_t>::max();
    ASSERT_EQ(sut_.set_confirmation(0U, {0U, 0U, Duration{kLast}}), Status::kOk);

    sut_.report(0U, true, Instant{0});
    sut_.report(0U, true, Instant{kLast - 1});
    EXPECT_FALSE(sut_.is_latched(0U));
    sut_.report(0U, true, Instant{kLast});
    EXPECT_TRUE(sut_.is_latched(0U));
}

TEST_F(FaultConfirmationTest, ConfirmationThatCouldNeverConfirmIsRefused) {
    verifies("SWR-FLT-008", Technique::kEquivalenceClasses, Polarity::kViolation);

    EXPECT_EQ(sut_.set_confirmation(0U, {}), Status::kBadParameter) << "neither count nor time";
    EXPECT_EQ(sut_.set_confirmation(0U, {0U, 1U, Duration{1}}), Status::kBadParameter) << "decay of no count";
    EXPECT_EQ(sut_.set_confirmation(0U, {1U, 0U, Duration{-1}}), Status::kBadParameter);
    EXPECT_EQ(sut_.set_confirmation(0U, {0U, 0U, Duration{-1}}), Status::kBadParameter);
    EXPECT_EQ(sut_.set_confirmation(0U, {0U, 0U, Duration{1}}), Status::kOk);
    report(0U, true);
    EXPECT_FALSE(sut_.is_latched(0U)) << "refused rules left nothing behind";
}

TEST_F(FaultConfirmationTest, RulesOfAFaultThatIsCountedAreKept) {
    verifies("SWR-FLT-007", Technique::kStateTransition, Polarity::kViolation);
    ASSERT_EQ(sut_.set_confirmation(0U, {3U, 1U}), Status::kOk);
    report(0U, true);
    report(0U, true);
    report(0U, false);
    ASSERT_EQ(sut_.get_record(0U).count, 1U);

    EXPECT_EQ(sut_.set_confirmation(0U, {9U}), Status::kPreconditionNotMet);
    EXPECT_EQ(sut_.set_healing(0U, {}), Status::kPreconditionNotMet);
    EXPECT_EQ(sut_.get_record(0U).confirmation.cycles, 3U);
}

}  // namespace
}  // namespace mamori::safety
