// SPDX-License-Identifier: Apache-2.0
// Goal: a rate changes at a frame boundary, among those that the plan declares, and everybody is told.
// Method: two spies, windows counted; each refusal; on_rate_changed with each answer in each state.
#include <limits>

#include "mamori/kernel/component/external_trigger.hpp"
#include "mamori/trace/verifies.hpp"
#include "support/context_fixture.hpp"

namespace mamori {
namespace {

using testing_support::Calls;
using testing_support::take;
using verification::Polarity;
using verification::Technique;
using verification::verifies;

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

TEST_F(ContextRateTest, EveryParticipantIsToldOnceInItsFirstTurnAtTheNewRate) {
    verifies("SWR-RTC-003", Technique::kStateTransition);
    start_and_activate();
    ASSERT_EQ(sut_.deactivate_component(b_, now_), Status::kOk);
    ASSERT_EQ(sut_.set_rate(500.0), Status::kOk);
    ASSERT_TRUE(sut_.apply_pending_rate());
    calls_.clear();

    EXPECT_EQ(run_cycle(),
              (Calls{"a.on_rate_changed", "a.on_execute", "b.on_rate_changed", "a.on_state_update"}));
    EXPECT_EQ(run_cycle(), (Calls{"a.on_execute", "a.on_state_update"}));
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

class RateFailureTest : public ContextRateTest, public ::testing::WithParamInterface<Status> {
  protected:
    void change_rate() {
        ASSERT_EQ(sut_.set_rate(500.0), Status::kOk);
        ASSERT_TRUE(sut_.apply_pending_rate());
        a_.answers["on_rate_changed"] = GetParam();
    }
};

TEST_P(RateFailureTest, AnActiveComponentThatRefusesTheRateGoesToErrorAndTheRateStays) {
    verifies("SWR-RTC-004", Technique::kFaultInjection, Polarity::kViolation);
    start_and_activate();
    change_rate();

    EXPECT_EQ(run_cycle(), (Calls{"a.on_rate_changed", "a.on_aborting", "b.on_rate_changed", "b.on_execute",
                                  "b.on_state_update"}));

    EXPECT_EQ(get_state(a_), LifecycleState::kError);
    EXPECT_DOUBLE_EQ(sut_.get_rate(), 500.0);
    EXPECT_EQ(a_.get_last_failure().action, ComponentAction::kRateChanged);
    EXPECT_EQ(a_.get_last_failure().status, GetParam());
    EXPECT_EQ(a_.get_last_failure().at, now_);
    EXPECT_EQ(run_cycle(), (Calls{"a.on_error", "b.on_execute", "b.on_state_update"}));
}

TEST_P(RateFailureTest, AnInactiveOrFailedComponentThatRefusesTheRateStaysWhatItIs) {
    verifies("SWR-RTC-004", Technique::kFaultInjection, Polarity::kViolation);
    start_and_activate();
    bring_a_into_error();
    change_rate();
    EXPECT_EQ(run_cycle(), (Calls{"a.on_rate_changed", "a.on_error", "b.on_rate_changed", "b.on_execute",
                                  "b.on_state_update"}));
    EXPECT_EQ(get_state(a_), LifecycleState::kError);
    ASSERT_EQ(sut_.reset_component(a_, now_), Status::kOk);
    ASSERT_EQ(sut_.set_rate(1000.0), Status::kOk);
    ASSERT_TRUE(sut_.apply_pending_rate());
    calls_.clear();

    EXPECT_EQ(run_cycle(),
              (Calls{"a.on_rate_changed", "b.on_rate_changed", "b.on_execute", "b.on_state_update"}));
    EXPECT_EQ(get_state(a_), LifecycleState::kInactive);
    EXPECT_EQ(a_.get_last_failure().action, ComponentAction::kRateChanged);
}

INSTANTIATE_TEST_SUITE_P(AllCodes, RateFailureTest,
                         ::testing::Values(Status::kError, Status::kBadParameter, Status::kUnsupported,
                                           Status::kOutOfResources, Status::kPreconditionNotMet),
                         [](const auto& parameter) { return std::string(get_name(parameter.param)); });

TEST_F(ContextRateTest, TheLastFailureNamesTheActionThatFailed) {
    verifies("SWR-RTC-004", Technique::kInterface);
    EXPECT_EQ(a_.get_last_failure().status, Status::kOk) << "nothing has failed yet";
    std::string failing;
    const auto fail = [this, &failing](const char* action) {
        a_.answers = {{action, Status::kUnsupported}};
        failing = action;
    };
    const auto check = [this, &failing] {
        a_.answers.clear();
        EXPECT_EQ(a_.get_last_failure().status, Status::kUnsupported) << failing;
        EXPECT_EQ(get_name(a_.get_last_failure().action), failing);
    };
    fail("on_startup");
    EXPECT_EQ(sut_.start(now_), Status::kUnsupported);
    check();
    ASSERT_EQ(sut_.start(now_), Status::kOk);
    fail("on_shutdown");
    EXPECT_EQ(sut_.stop(now_), Status::kUnsupported);
    check();
    ASSERT_EQ(sut_.start(now_), Status::kOk);
    fail("on_activated");
    EXPECT_EQ(sut_.activate_component(a_, now_), Status::kUnsupported);
    check();
    fail("on_reset");
    EXPECT_EQ(sut_.reset_component(a_, now_), Status::kUnsupported);
    check();
    for (const char* action : {"on_execute", "on_state_update"}) {
        ASSERT_EQ(sut_.reset_component(a_, now_), Status::kOk);
        ASSERT_EQ(sut_.activate_component(a_, now_), Status::kOk);
        fail(action);
        a_.answers["on_aborting"] = Status::kError;
        a_.answers["on_error"] = Status::kError;
        run_cycle();
        run_cycle();
        check();
    }
    ASSERT_EQ(sut_.reset_component(a_, now_), Status::kOk);
    ASSERT_EQ(sut_.activate_component(a_, now_), Status::kOk);
    fail("on_deactivated");
    EXPECT_EQ(sut_.deactivate_component(a_, now_), Status::kUnsupported);
    check();
    EXPECT_STREQ(get_name(static_cast<ComponentAction>(200U)), "invalid_action");
}

/// The same failures under OpenRTM's order.
class AbortPolicyTest : public testing_support::ContextFixture {
  protected:
    AbortPolicyTest() { plan_.abort_policy = AbortPolicy::kOpenRtmCompat; }
};

TEST_F(AbortPolicyTest, UnderOpenRtmCompatOnDeactivatedComesBeforeOnAborting) {
    verifies("SWR-RTC-005", Technique::kStateTransition);
    start_and_activate();
    a_.answers["on_execute"] = Status::kError;
    b_.answers["on_state_update"] = Status::kError;

    EXPECT_EQ(run_cycle(), (Calls{"a.on_execute", "a.on_deactivated", "a.on_aborting", "b.on_execute",
                                  "b.on_state_update", "b.on_deactivated", "b.on_aborting"}));
    EXPECT_EQ(run_cycle(), (Calls{"a.on_error", "b.on_error"}));
}

TEST_F(AbortPolicyTest, UnderOpenRtmCompatAFailedActivationIsCleanedUpToo) {
    verifies("SWR-RTC-005", Technique::kFaultInjection);
    a_.answers["on_activated"] = Status::kError;
    a_.inside = [this](const std::string&) { EXPECT_NE(get_state(a_), LifecycleState::kActive); };

    EXPECT_EQ(sut_.activate_component(a_, now_), Status::kError);

    EXPECT_EQ(take(calls_), (Calls{"a.on_activated", "a.on_deactivated", "a.on_aborting"}));
    EXPECT_EQ(get_state(a_), LifecycleState::kError);
}

TEST_F(AbortPolicyTest, AnOrderlyDeactivationIsTheSameUnderBothPolicies) {
    verifies("SWR-RTC-005", Technique::kBackToBack);
    start_and_activate();

    EXPECT_EQ(sut_.deactivate_component(a_, now_), Status::kOk);

    EXPECT_EQ(take(calls_), Calls{"a.on_deactivated"});
}

}  // namespace
}  // namespace mamori
