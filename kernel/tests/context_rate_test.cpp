// SPDX-License-Identifier: Apache-2.0
// Goal: a rate changes at a frame boundary, among those that the plan declares.
// Method: two spies, windows counted; each rejected rate. What the participants do: rtc_scenario_test.cpp.
#include <limits>

#include "mamori/kernel/component/external_trigger.hpp"
#include "mamori/trace/verifies.hpp"
#include "support/context_fixture.hpp"

namespace mamori {
namespace {

using namespace verification;

constexpr std::array<Duration, 2> kAlternatives{2_ms, 3_ms};

class ContextRateTest : public testing_support::ContextFixture {
  protected:
    ContextRateTest() { plan_.alternative_periods = kAlternatives; }

    /// Windows in which a cycle ran, as a row of '1' and '0'.
    std::string run_windows(int count) {
        std::string turns;
        for (int i = 0; i < count; ++i) {
            const bool is_due = sut_.take_turn();
            turns += is_due ? '1' : '0';
            if (is_due) {
                run_cycle();
            }
        }
        return turns;
    }
};

TEST_F(ContextRateTest, ADeclaredRateComesIntoUseAtTheBoundary) {
    verifies("SWR-RTC-003");
    start_and_activate();
    EXPECT_EQ(run_windows(3), "111");

    ASSERT_EQ(sut_.set_rate(500.0), Status::kOk);
    EXPECT_DOUBLE_EQ(sut_.get_rate(), 1000.0) << "a wish only";
    EXPECT_EQ(run_windows(3), "111");
    EXPECT_TRUE(sut_.apply_pending_rate());

    EXPECT_DOUBLE_EQ(sut_.get_rate(), 500.0);
    EXPECT_EQ(sut_.get_period(), 2_ms);
    EXPECT_EQ(sut_.get_divisor(), 2);
    EXPECT_EQ(run_windows(5), "10101");
    EXPECT_FALSE(sut_.apply_pending_rate()) << "nothing is pending any more";
}

TEST_F(ContextRateTest, TheNextWindowIsTheFirstAtTheNewRateWhereverTheOldOneStood) {
    verifies("SWR-RTC-003", Technique::kBoundaryValues);
    start_and_activate();
    ASSERT_EQ(sut_.set_rate(500.0), Status::kOk);
    ASSERT_TRUE(sut_.apply_pending_rate());
    EXPECT_EQ(run_windows(1), "1") << "the next one would be left out";

    ASSERT_EQ(sut_.set_rate(1000.0), Status::kOk);
    ASSERT_TRUE(sut_.apply_pending_rate());
    EXPECT_EQ(run_windows(2), "11");
}

TEST_F(ContextRateTest, ThePeriodIsMeantThatLiesWithinHalfANanosecond) {
    verifies("SWR-RTC-003", Technique::kBoundaryValues);
    start_and_activate();

    EXPECT_EQ(sut_.set_rate(1.0e9 / 3000000.4), Status::kOk);
    EXPECT_EQ(sut_.set_rate(1.0e9 / 2999999.6), Status::kOk);
    EXPECT_TRUE(sut_.apply_pending_rate());

    EXPECT_EQ(sut_.get_period(), 3_ms);
    EXPECT_EQ(run_windows(7), "1001001");
}

TEST_F(ContextRateTest, TheLastWishCountsAndTheRateInUseTakesItBack) {
    verifies("SWR-RTC-003", Technique::kStateTransition);
    ASSERT_EQ(sut_.set_rate(500.0), Status::kOk);
    ASSERT_EQ(sut_.set_rate(1000.0), Status::kOk);
    EXPECT_FALSE(sut_.apply_pending_rate());

    ASSERT_EQ(sut_.set_rate(500.0), Status::kOk);
    ASSERT_EQ(sut_.set_rate(1.0e9 / 3.0e6), Status::kOk);
    EXPECT_TRUE(sut_.apply_pending_rate());
    EXPECT_EQ(sut_.get_divisor(), 3);
    ASSERT_EQ(sut_.set_rate(1000.0), Status::kOk);
    EXPECT_TRUE(sut_.apply_pending_rate());

    EXPECT_EQ(sut_.get_divisor(), 1);
}

TEST_F(ContextRateTest, ARestartBeginsWithACycleAndANewContextWithThePlan) {
    verifies("SWR-RTC-003", Technique::kStateTransition);
    ASSERT_EQ(sut_.start(now_), Status::kOk);
    ASSERT_EQ(sut_.set_rate(500.0), Status::kOk);
    ASSERT_TRUE(sut_.apply_pending_rate());
    EXPECT_EQ(run_windows(3), "101");
    ASSERT_EQ(sut_.stop(now_), Status::kOk);
    EXPECT_EQ(run_windows(2), "00");
    ASSERT_EQ(sut_.start(now_), Status::kOk);
    EXPECT_EQ(run_windows(2), "10");
    ASSERT_EQ(sut_.stop(now_), Status::kOk);
    ASSERT_EQ(sut_.set_rate(1.0e9 / 3.0e6), Status::kOk);
    ASSERT_EQ(sut_.detach(), Status::kOk);

    ASSERT_EQ(sut_.attach(kId, participants_, plan_), Status::kOk);

    EXPECT_FALSE(sut_.apply_pending_rate());
    EXPECT_DOUBLE_EQ(sut_.get_rate(), 1000.0);
}

TEST_F(ContextRateTest, TheFirstContextOfASystemHasARateUntilItIsDetached) {
    verifies("SWR-RTC-003", Technique::kBoundaryValues);
    ASSERT_EQ(sut_.detach(), Status::kOk);
    ASSERT_EQ(sut_.attach(0, participants_, plan_), Status::kOk);
    EXPECT_DOUBLE_EQ(sut_.get_rate(), 1000.0);
    ASSERT_EQ(sut_.set_rate(500.0), Status::kOk);
    ASSERT_TRUE(sut_.apply_pending_rate());
    EXPECT_DOUBLE_EQ(sut_.get_rate(), 500.0);

    ASSERT_EQ(sut_.detach(), Status::kOk);

    EXPECT_LT(sut_.get_rate(), 0.0);
    EXPECT_EQ(sut_.get_period(), 0_ns);
    EXPECT_EQ(sut_.get_divisor(), 1);
    EXPECT_FALSE(sut_.apply_pending_rate());
    EXPECT_EQ(sut_.set_rate(1000.0), Status::kUnsupported);
}

TEST_F(ContextRateTest, WhatIsNoRateOrNotDeclaredIsRefusedAndTheWishKept) {
    verifies("SWR-RTC-003", Technique::kBoundaryValues, Polarity::kViolation);
    using Limits = std::numeric_limits<double>;
    ASSERT_EQ(sut_.set_rate(500.0), Status::kOk);

    for (const double wrong : {0.0, -0.0, -1.0, -500.0, Limits::quiet_NaN(), Limits::infinity(),
                               -Limits::infinity(), Limits::lowest(), -Limits::denorm_min()}) {
        EXPECT_EQ(sut_.set_rate(wrong), Status::kBadParameter) << wrong;
    }
    for (const double foreign :
         {250.0, 1001.0, 499.99, 1.0e9 / 3000000.6, 1.0e9 / 2999999.4, Limits::denorm_min(), Limits::max()}) {
        EXPECT_EQ(sut_.set_rate(foreign), Status::kUnsupported) << foreign;
    }

    EXPECT_TRUE(sut_.apply_pending_rate());
    EXPECT_DOUBLE_EQ(sut_.get_rate(), 500.0);
}

TEST_F(ContextRateTest, KindsWithoutPeriodicProcessingHaveNoRate) {
    verifies("SWR-RTC-003", Technique::kEquivalenceClasses, Polarity::kViolation);
    ExternalTrigger trigger;
    ExecutionContext event_driven;
    ExecutionContext triggered;
    ExecutionContext unattached;
    ASSERT_EQ(sut_.detach(), Status::kOk);
    ContextPlan plan{1_ms};
    plan.kind = ExecutionKind::kEventDriven;
    ASSERT_EQ(event_driven.attach(0, Span<Component* const>{participants_}.subspan(0U, 1U), plan),
              Status::kOk);
    plan.kind = ExecutionKind::kOther;
    plan.trigger = &trigger;
    ASSERT_EQ(triggered.attach(1, Span<Component* const>{participants_}.subspan(1U, 1U), plan), Status::kOk);

    for (ExecutionContext* context : {&event_driven, &triggered, &unattached}) {
        EXPECT_EQ(context->set_rate(1000.0), Status::kUnsupported);
        EXPECT_EQ(context->set_rate(-1.0), Status::kBadParameter);
        EXPECT_LT(context->get_rate(), 0.0);
    }
    EXPECT_EQ(event_driven.get_kind(), ExecutionKind::kEventDriven);
    EXPECT_EQ(triggered.get_kind(), ExecutionKind::kOther);
    EXPECT_EQ(event_driven.get_period(), 1_ms);
}

TEST_F(ContextRateTest, ABusyContextTakesNoWishAndKeepsTheOneItHas) {
    verifies("SWR-RTC-003", Technique::kErrorGuessing, Polarity::kViolation);
    start_and_activate();
    ASSERT_EQ(sut_.set_rate(500.0), Status::kOk);
    a_.inside = [this](const std::string&) {
        EXPECT_EQ(sut_.set_rate(1.0e9 / 3.0e6), Status::kPreconditionNotMet);
        EXPECT_FALSE(sut_.apply_pending_rate());
    };
    run_cycle();

    EXPECT_TRUE(sut_.apply_pending_rate());
    EXPECT_DOUBLE_EQ(sut_.get_rate(), 500.0);
}

}  // namespace
}  // namespace mamori
