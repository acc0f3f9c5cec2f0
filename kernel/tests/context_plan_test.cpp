// SPDX-License-Identifier: Apache-2.0
// Goal: a context takes a plan that is whole and refuses every other; ranges run as single positions do.
// Method: each field on both sides of its limit; two spies; a range that ends its own cycle from within.
#include "mamori/kernel/component/context_plan.hpp"

#include <limits>

#include "mamori/kernel/component/external_trigger.hpp"
#include "mamori/trace/verifies.hpp"
#include "mamori/verification/failed_check.hpp"
#include "support/context_fixture.hpp"

namespace mamori {
namespace {

using testing_support::Calls;
using testing_support::take;
using namespace verification;

class ContextPlanTest : public testing_support::ContextFixture {
  protected:
    Status try_attach(const ContextPlan& plan) {
        ExecutionContext context;
        const std::array<Component*, 1> participants{&stranger_};
        const Status result = context.attach(0, participants, plan);
        if (result == Status::kOk) {
            EXPECT_EQ(context.detach(), Status::kOk);
        }
        return result;
    }
    ExternalTrigger trigger_;
};

TEST_F(ContextPlanTest, NumbersOfTheKindsAreThoseOfTheStandard) {
    verifies("SWR-RTC-001", Technique::kInterface);

    EXPECT_EQ(static_cast<std::uint32_t>(ExecutionKind::kPeriodic), 0U);
    EXPECT_EQ(static_cast<std::uint32_t>(ExecutionKind::kEventDriven), 1U);
    EXPECT_EQ(static_cast<std::uint32_t>(ExecutionKind::kOther), 2U);
}

TEST_F(ContextPlanTest, APlanOfEachKindIsTaken) {
    verifies("SWR-RTC-001", Technique::kEquivalenceClasses);
    static constexpr std::array<Duration, 2> kAlternatives{2_ms, 3_ms};
    ContextPlan periodic{1_ms};
    periodic.alternative_periods = kAlternatives;
    ContextPlan event_driven{1_ms};
    event_driven.kind = ExecutionKind::kEventDriven;
    ContextPlan triggered{1_ms};
    triggered.kind = ExecutionKind::kOther;
    triggered.trigger = &trigger_;

    EXPECT_EQ(try_attach(periodic), Status::kOk);
    EXPECT_EQ(try_attach(event_driven), Status::kOk);
    EXPECT_EQ(try_attach(triggered), Status::kOk);
}

TEST_F(ContextPlanTest, AContextIsAttachedOnceAndAsNewAfterItWasDetached) {
    verifies("SWR-RTC-001", Technique::kStateTransition, Polarity::kViolation);
    ExecutionContext context;
    const std::array<Component*, 1> participants{&stranger_};
    ContextPlan plan{2_ms};
    plan.kind = ExecutionKind::kOther;
    plan.trigger = &trigger_;
    ASSERT_EQ(context.attach(0, participants, plan), Status::kOk);
    EXPECT_EQ(context.attach(0, participants, plan), Status::kPreconditionNotMet) << "0 is an identity";
    EXPECT_EQ(context.get_kind(), ExecutionKind::kOther);

    ASSERT_EQ(context.detach(), Status::kOk);
    EXPECT_EQ(context.get_kind(), ExecutionKind::kPeriodic);
    EXPECT_EQ(context.get_period(), 0_ms);
    EXPECT_EQ(context.get_id(), -1);
    EXPECT_EQ(context.get_participant_count(), 0U);
    EXPECT_EQ(context.detach(), Status::kPreconditionNotMet);
}

TEST_F(ContextPlanTest, APlanThatContradictsItselfIsRefused) {
    verifies("SWR-RTC-001", Technique::kBoundaryValues, Polarity::kViolation);
    static constexpr std::array<Duration, 1> kSame{1_ms};
    static constexpr std::array<Duration, 2> kUneven{2_ms, Duration{2500000}};
    static constexpr std::array<Duration, 1> kNegative{Duration{-2000000}};
    static constexpr std::array<Duration, 1> kDouble{2_ms};

    const auto refused = [this](auto change) {
        ContextPlan plan{1_ms};
        change(plan);
        return try_attach(plan) == Status::kBadParameter;
    };
    EXPECT_TRUE(refused([](ContextPlan& plan) { plan.period = 0_ns; }));
    EXPECT_TRUE(refused([](ContextPlan& plan) { plan.period = Duration{-1}; }));
    EXPECT_TRUE(refused([](ContextPlan& plan) { plan.events_per_cycle = 0U; }));
    EXPECT_TRUE(refused([](ContextPlan& plan) { plan.alternative_periods = kSame; }));
    EXPECT_TRUE(refused([](ContextPlan& plan) { plan.alternative_periods = kUneven; }));
    EXPECT_TRUE(refused([](ContextPlan& plan) { plan.alternative_periods = kNegative; }));
    EXPECT_TRUE(refused([](ContextPlan& plan) { plan.kind = ExecutionKind::kOther; }));
    EXPECT_TRUE(refused([this](ContextPlan& plan) { plan.trigger = &trigger_; }));
    EXPECT_TRUE(refused([this](ContextPlan& plan) {
        plan.kind = ExecutionKind::kEventDriven;
        plan.trigger = &trigger_;
    }));
    EXPECT_TRUE(refused([](ContextPlan& plan) {
        plan.kind = ExecutionKind::kEventDriven;
        plan.alternative_periods = kDouble;
    }));
}

TEST_F(ContextPlanTest, ARangeWhoseCycleWasEndedMeanwhileBeginsNoFurtherAction) {
    verifies("SWR-RTC-002", Technique::kFaultInjection, Polarity::kViolation);
    start_and_activate();
    // What an executive does when the host has given the work up; here the action returns at last.
    a_.inside = [this](const std::string&) {
        sut_.end_cycle();
        EXPECT_EQ(sut_.begin_cycle(now_), Status::kPreconditionNotMet) << "the work has not returned yet";
    };

    ASSERT_EQ(sut_.begin_cycle(now_), Status::kOk);
    sut_.execute_range(0U, 2U);
    EXPECT_EQ(take(calls_), Calls{"a.on_execute"});
    EXPECT_FALSE(sut_.get_acting_position().has_value());
    ASSERT_EQ(sut_.begin_cycle(now_), Status::kOk);
    sut_.update_range(0U, 2U);

    EXPECT_EQ(take(calls_), Calls{"a.on_state_update"});
}

TEST_F(ContextPlanTest, ARangeBeyondTheListOrOutsideACycleEndsInTheAssertion) {
    verifies("SWR-RTC-002", Technique::kBoundaryValues, Polarity::kViolation);
    start_and_activate();

    EXPECT_CHECK_FAILS(sut_.execute_range(0U, 1U), "execution_cycle.cpp", 1);
    EXPECT_CHECK_FAILS(sut_.update_range(0U, 1U), "execution_cycle.cpp", 1);
    EXPECT_CHECK_FAILS(static_cast<void>(sut_.get_state_at(2U)), "span.hpp", 1);
    ASSERT_EQ(sut_.begin_cycle(now_), Status::kOk);
    EXPECT_CHECK_FAILS(sut_.execute_range(1U, 2U), "execution_cycle.cpp", 4);
    EXPECT_CHECK_FAILS(sut_.execute_range(2U, std::numeric_limits<std::size_t>::max()), "execution_cycle.cpp",
                       4);
    EXPECT_CHECK_FAILS(sut_.update_range(2U, 1U), "execution_cycle.cpp", 4);
    sut_.execute_range(2U, 0U);
    sut_.end_cycle();

    EXPECT_TRUE(calls_.empty()) << "an empty range does nothing";
}

}  // namespace
}  // namespace mamori
