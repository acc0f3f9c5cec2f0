// SPDX-License-Identifier: Apache-2.0
// Goal: each rule of the object model, one test per rule: R1 numbers, R2 life of a component, R3 contexts,
// R31 actions, R32 data flow, R33 events, R34 modes, R35 several contexts. Method: two spies in one context.
#include <algorithm>

#include "mamori/kernel/component/fsm_component.hpp"
#include "mamori/kernel/component/multi_mode.hpp"
#include "mamori/trace/verifies.hpp"
#include "support/context_fixture.hpp"

namespace mamori {
namespace {

using testing_support::Calls;
using testing_support::SpyActions;
using testing_support::take;
using verification::Polarity;
using verification::Technique;
using verification::verifies;

constexpr std::array<Duration, 1> kAlternatives{2_ms};
constexpr Mode kFirst{"first"};
constexpr Mode kSecond{"second"};
constexpr std::array<const Mode*, 2> kModes{&kFirst, &kSecond};
constexpr std::array<FsmState, 2> kStates{{{"off"}, {"on"}}};
constexpr std::array<FsmMessage, 1> kMessages{{{"press"}}};
constexpr std::array<FsmTransition, 1> kTransitions{{{0U, 0U, 1U}}};
constexpr FsmTable kTable{"lamp", kStates, kMessages, kTransitions, 0U};

class RtcRulesTest : public testing_support::ContextFixture {
  protected:
    RtcRulesTest() { plan_.alternative_periods = kAlternatives; }
};

TEST(RtcNumbersTest, R1_ReturnCodesStatesAndKindsHaveTheNumbersOfTheStandard) {
    verifies("SWR-RTC-011", Technique::kInterface);
    const auto number = [](auto value) { return static_cast<std::uint32_t>(value); };

    EXPECT_EQ(number(Status::kOk), 0U);
    EXPECT_EQ(number(Status::kError), 1U);
    EXPECT_EQ(number(Status::kBadParameter), 2U);
    EXPECT_EQ(number(Status::kUnsupported), 3U);
    EXPECT_EQ(number(Status::kOutOfResources), 4U);
    EXPECT_EQ(number(Status::kPreconditionNotMet), 5U);
    EXPECT_EQ(number(LifecycleState::kCreated), 0U);
    EXPECT_EQ(number(LifecycleState::kInactive), 1U);
    EXPECT_EQ(number(LifecycleState::kActive), 2U);
    EXPECT_EQ(number(LifecycleState::kError), 3U);
    EXPECT_EQ(number(ExecutionKind::kPeriodic), 0U);
    EXPECT_EQ(number(ExecutionKind::kEventDriven), 1U);
    EXPECT_EQ(number(ExecutionKind::kOther), 2U);
}

TEST_F(RtcRulesTest, R1_FailuresAreCodesAndNotSpecialValues) {
    verifies("SWR-RTC-011", Technique::kInterface, Polarity::kViolation);
    const ExecutionContext unattached;

    EXPECT_LT(unattached.get_rate(), 0.0) << "the standard's own form for a rate";
    EXPECT_EQ(sut_.get_component_state(stranger_).get_status(), Status::kBadParameter);
    EXPECT_EQ(a_.get_context(ContextHandle{99, {}}), nullptr) << "the standard's own form for a reference";
}

TEST_F(RtcRulesTest, R2_InitializeCallsOnInitializeOnceAndOnlyWhenCreated) {
    verifies("SWR-RTC-011", Technique::kStateTransition);

    EXPECT_EQ(stranger_.initialize(), Status::kOk);
    EXPECT_EQ(stranger_.initialize(), Status::kPreconditionNotMet);

    EXPECT_EQ(calls_, Calls{"stranger.on_initialize"});
}

TEST_F(RtcRulesTest, R2_AFailedInitializeIsTheAnswerAndStaysCreated) {
    verifies("SWR-RTC-011", Technique::kFaultInjection, Polarity::kViolation);
    stranger_.answers["on_initialize"] = Status::kOutOfResources;

    EXPECT_EQ(stranger_.initialize(), Status::kOutOfResources);

    EXPECT_FALSE(stranger_.is_alive());
}

TEST_F(RtcRulesTest, R2_FinalizeIsForThoseAliveThatParticipateNowhere) {
    verifies("SWR-RTC-011", Technique::kStateTransition, Polarity::kViolation);

    EXPECT_EQ(stranger_.finalize(), Status::kPreconditionNotMet) << "Created";
    EXPECT_EQ(a_.finalize(), Status::kPreconditionNotMet) << "participating";
    ASSERT_EQ(sut_.detach(), Status::kOk);
    EXPECT_EQ(a_.finalize(), Status::kOk);

    EXPECT_EQ(calls_, Calls{"a.on_finalize"});
}

TEST_F(RtcRulesTest, R2_ExitDeactivatesAndFinalizesWhileTheOthersGoOn) {
    verifies("SWR-RTC-010", Technique::kStateTransition);
    start_and_activate();

    EXPECT_EQ(a_.exit(now_), Status::kOk);

    EXPECT_EQ(take(calls_), (Calls{"a.on_deactivated", "a.on_finalize"}));
    EXPECT_EQ(sut_.get_state_at(0U), LifecycleState::kCreated);
    EXPECT_TRUE(sut_.is_running());
    EXPECT_EQ(run_cycle(), (Calls{"b.on_execute", "b.on_state_update"}));
    EXPECT_EQ(sut_.stop(now_), Status::kOk);
    EXPECT_EQ(take(calls_), Calls{"b.on_shutdown"});
}

TEST_F(RtcRulesTest, R2_AfterExitANewLifeMayBeginInTheSamePlace) {
    verifies("SWR-RTC-010", Technique::kStateTransition);
    start_and_activate();
    bring_a_into_error();
    ASSERT_EQ(a_.exit(now_), Status::kOk);

    EXPECT_EQ(a_.initialize(), Status::kOk);
    EXPECT_EQ(get_state(a_), LifecycleState::kInactive) << "its Error has gone with its life";
    EXPECT_EQ(sut_.activate_component(a_, now_), Status::kOk);
    calls_.clear();

    EXPECT_EQ(run_cycle(), (Calls{"a.on_execute", "b.on_execute", "a.on_state_update", "b.on_state_update"}));
}

TEST_F(RtcRulesTest, R2_ExitOutsideAContextFinalizesOnly) {
    verifies("SWR-RTC-010", Technique::kStateTransition);
    ASSERT_EQ(stranger_.initialize(), Status::kOk);
    calls_.clear();

    EXPECT_EQ(stranger_.exit(now_), Status::kOk);

    EXPECT_EQ(calls_, Calls{"stranger.on_finalize"});
}

TEST_F(RtcRulesTest, R2_ExitIsRefusedWhenCreatedAndFromWithinActions) {
    verifies("SWR-RTC-010", Technique::kStateTransition, Polarity::kViolation);
    EXPECT_EQ(stranger_.exit(now_), Status::kPreconditionNotMet);
    start_and_activate();
    int refusals = 0;
    a_.inside = [this, &refusals](const std::string&) {
        EXPECT_EQ(a_.exit(now_), Status::kPreconditionNotMet);
        EXPECT_EQ(b_.exit(now_), Status::kPreconditionNotMet);
        ++refusals;
    };

    run_cycle();

    EXPECT_EQ(refusals, 2);
    EXPECT_TRUE(a_.is_alive() && b_.is_alive());
}

TEST_F(RtcRulesTest, R2_ContextsMapToHandlesAndBack) {
    verifies("SWR-RTC-010", Technique::kInterface);

    EXPECT_EQ(a_.get_context_handle(sut_).get_value().id, kId);
    EXPECT_EQ(a_.get_context(a_.get_context_handle(sut_).get_value()), &sut_);
    ASSERT_EQ(a_.get_participating_contexts().size(), 1U);
    EXPECT_EQ(a_.get_participating_contexts()[0U], &sut_);
    EXPECT_TRUE(a_.get_owned_contexts().empty()) << "contexts belong to the table";
    EXPECT_TRUE(stranger_.get_participating_contexts().empty());
}

TEST_F(RtcRulesTest, R3_StartAndStopNeverChangeTheStateOfAComponent) {
    verifies("SWR-RTC-011", Technique::kStateTransition);
    start_and_activate();
    bring_a_into_error();

    ASSERT_EQ(sut_.stop(now_), Status::kOk);
    ASSERT_EQ(sut_.start(now_), Status::kOk);

    EXPECT_EQ(get_state(a_), LifecycleState::kError);
    EXPECT_EQ(get_state(b_), LifecycleState::kActive);
}

TEST_F(RtcRulesTest, R3_StartNeedsEveryParticipantAlive) {
    verifies("SWR-RTC-011", Technique::kStateTransition, Polarity::kViolation);
    ASSERT_EQ(a_.exit(now_), Status::kOk);
    calls_.clear();

    EXPECT_EQ(sut_.start(now_), Status::kPreconditionNotMet);

    EXPECT_TRUE(calls_.empty());
    ASSERT_EQ(a_.initialize(), Status::kOk);
    EXPECT_EQ(sut_.start(now_), Status::kOk);
}

TEST_F(RtcRulesTest, R3_ActivationAndDeactivationReturnAfterTheirActions) {
    verifies("SWR-RTC-011", Technique::kStateTransition);

    EXPECT_EQ(sut_.activate_component(a_, now_), Status::kOk);
    EXPECT_EQ(take(calls_), Calls{"a.on_activated"});
    EXPECT_EQ(sut_.deactivate_component(a_, now_), Status::kOk);
    EXPECT_EQ(take(calls_), Calls{"a.on_deactivated"});
}

TEST_F(RtcRulesTest, R3_AFailedResetRequestDoesNotLeadToError) {
    verifies("SWR-RTC-011", Technique::kStateTransition, Polarity::kViolation);

    EXPECT_EQ(sut_.reset_component(a_, now_), Status::kPreconditionNotMet);

    EXPECT_EQ(get_state(a_), LifecycleState::kInactive);
}

TEST_F(RtcRulesTest, R3_TheRateOfAPeriodicContextIsPositiveAndOfTheOthersNegative) {
    verifies("SWR-RTC-011", Technique::kEquivalenceClasses);
    EXPECT_GT(sut_.get_rate(), 0.0);
    EXPECT_EQ(sut_.get_kind(), ExecutionKind::kPeriodic);
    ASSERT_EQ(sut_.detach(), Status::kOk);
    ContextPlan plan{1_ms};
    plan.kind = ExecutionKind::kEventDriven;
    ASSERT_EQ(sut_.attach(kId, participants_, plan), Status::kOk);

    EXPECT_LT(sut_.get_rate(), 0.0);
    EXPECT_EQ(sut_.get_kind(), ExecutionKind::kEventDriven);
}

TEST_F(RtcRulesTest, R3_SetRateStoresAndThenTellsEveryParticipant) {
    verifies("SWR-RTC-011", Technique::kStateTransition);
    ASSERT_EQ(sut_.start(now_), Status::kOk);
    ASSERT_EQ(sut_.set_rate(500.0), Status::kOk);
    ASSERT_TRUE(sut_.apply_pending_rate());
    a_.inside = [this](const std::string&) { EXPECT_DOUBLE_EQ(sut_.get_rate(), 500.0); };
    calls_.clear();

    EXPECT_EQ(run_cycle(), (Calls{"a.on_rate_changed", "b.on_rate_changed"}));
}

TEST_F(RtcRulesTest, R31_EachActionComesAsOftenAsTheTableOfTheStandardSays) {
    verifies("SWR-RTC-011", Technique::kStateTransition);
    calls_.clear();
    ASSERT_EQ(stranger_.initialize(), Status::kOk);
    ExecutionContext context;
    const std::array<Component*, 1> one{&stranger_};
    ASSERT_EQ(context.attach(1, one, ContextPlan{1_ms}), Status::kOk);
    const auto cycle = [&context] {
        ASSERT_EQ(context.begin_cycle({}), Status::kOk);
        context.execute(0U);
        context.update_state(0U);
        context.end_cycle();
    };

    ASSERT_EQ(context.start(now_), Status::kOk);
    ASSERT_EQ(context.activate_component(stranger_, now_), Status::kOk);
    cycle();
    cycle();
    stranger_.answers["on_execute"] = Status::kError;
    cycle();
    cycle();
    cycle();
    stranger_.answers.clear();
    ASSERT_EQ(context.reset_component(stranger_, now_), Status::kOk);
    ASSERT_EQ(context.activate_component(stranger_, now_), Status::kOk);
    ASSERT_EQ(context.deactivate_component(stranger_, now_), Status::kOk);
    ASSERT_EQ(context.stop(now_), Status::kOk);
    ASSERT_EQ(context.detach(), Status::kOk);
    ASSERT_EQ(stranger_.finalize(), Status::kOk);

    const auto count = [this](const char* action) {
        return std::count(calls_.begin(), calls_.end(), std::string("stranger.") + action);
    };
    EXPECT_EQ(count("on_initialize"), 1);
    EXPECT_EQ(count("on_finalize"), 1);
    EXPECT_EQ(count("on_startup"), 1);
    EXPECT_EQ(count("on_shutdown"), 1);
    EXPECT_EQ(count("on_activated"), 2);
    EXPECT_EQ(count("on_deactivated"), 1);
    EXPECT_EQ(count("on_aborting"), 1);
    EXPECT_EQ(count("on_error"), 2);
    EXPECT_EQ(count("on_reset"), 1);
    EXPECT_EQ(count("on_execute"), 3);
    EXPECT_EQ(count("on_state_update"), 2);
    EXPECT_EQ(calls_.size(), 16U);
}

TEST_F(RtcRulesTest, R32_AllExecuteBeforeAnyUpdatesItsState) {
    verifies("SWR-RTC-011", Technique::kStateTransition);
    start_and_activate();

    EXPECT_EQ(run_cycle(), (Calls{"a.on_execute", "b.on_execute", "a.on_state_update", "b.on_state_update"}));
}

TEST_F(RtcRulesTest, R32_NothingRunsUnlessTheContextRunsAndTheComponentIsActive) {
    verifies("SWR-RTC-011", Technique::kStateTransition, Polarity::kViolation);
    EXPECT_EQ(sut_.begin_cycle(now_), Status::kPreconditionNotMet);
    EXPECT_FALSE(sut_.take_turn());
    ASSERT_EQ(sut_.start(now_), Status::kOk);
    calls_.clear();

    EXPECT_EQ(run_cycle(), Calls{});
}

TEST_F(RtcRulesTest, R32_OnErrorComesInPlaceOfThePair) {
    verifies("SWR-RTC-011", Technique::kStateTransition, Polarity::kViolation);
    start_and_activate();
    bring_a_into_error();

    EXPECT_EQ(run_cycle(), (Calls{"a.on_error", "b.on_execute", "b.on_state_update"}));
}

TEST_F(RtcRulesTest, R33_AStimulusCallsOnActionAndAnUnknownContextIsABadParameter) {
    verifies("SWR-RTC-011", Technique::kStateTransition);
    class Lamp final : public FsmComponentFor<2U> {
      public:
        explicit Lamp(FsmProfile profile) : FsmComponentFor("lamp", kTable, profile) {}
    };
    const std::array<FsmBehavior, 2> profile{
        {{&stranger_, {FsmElement::Kind::kState, 1U}}, {&stranger_, {FsmElement::Kind::kTransition, 0U}}}};
    Lamp lamp{profile};
    ExecutionContext context;
    const std::array<Component*, 2> both{&lamp, &stranger_};
    ContextPlan plan{1_ms};
    plan.kind = ExecutionKind::kEventDriven;
    plan.events_per_cycle = 2U;
    ASSERT_EQ(lamp.initialize(), Status::kOk);
    ASSERT_EQ(stranger_.initialize(), Status::kOk);
    ASSERT_EQ(context.attach(1, both, plan), Status::kOk);
    ASSERT_EQ(context.start(now_), Status::kOk);
    ASSERT_EQ(context.activate_component(lamp, now_), Status::kOk);
    ASSERT_EQ(context.activate_component(stranger_, now_), Status::kOk);
    calls_.clear();

    EXPECT_EQ(lamp.send_stimulus(0U, ContextHandle{kId, {}}), Status::kBadParameter);
    EXPECT_EQ(lamp.send_stimulus(0U, ContextHandle{}), Status::kOk);
    EXPECT_EQ(lamp.send_stimulus(0U, ContextHandle{1, {}}), Status::kOk) << "no transition: no effect";
    ASSERT_EQ(context.begin_cycle(now_), Status::kOk);
    context.execute_range(0U, 2U);
    context.end_cycle();

    EXPECT_EQ(calls_, (Calls{"stranger.on_action", "stranger.on_action"}));
    EXPECT_EQ(lamp.get_current_state(), 1U);
}

TEST_F(RtcRulesTest, R34_APendingModeIsToldBeforeOnExecuteAndAnImmediateOneAtOnce) {
    verifies("SWR-RTC-011", Technique::kStateTransition);
    class Modes final : public SpyActions<MultiModeComponent> {
      public:
        explicit Modes(Calls& calls) : SpyActions(calls, "m", kModes) {}
    };
    Modes component{calls_};
    ExecutionContext context;
    const std::array<Component*, 1> one{&component};
    ASSERT_EQ(component.initialize(), Status::kOk);
    ASSERT_EQ(context.attach(1, one, ContextPlan{1_ms}), Status::kOk);
    ASSERT_EQ(context.start(now_), Status::kOk);
    ASSERT_EQ(context.activate_component(component, now_), Status::kOk);
    ASSERT_EQ(component.set_mode(kSecond, false, now_), Status::kOk);
    EXPECT_EQ(component.get_pending_mode(), &kSecond);
    EXPECT_EQ(&component.get_current_mode(), &component.get_default_mode());
    calls_.clear();

    ASSERT_EQ(context.begin_cycle(now_), Status::kOk);
    context.execute(0U);
    context.end_cycle();
    EXPECT_EQ(take(calls_), (Calls{"m.on_mode_changed", "m.on_execute"}));
    EXPECT_EQ(component.get_pending_mode(), nullptr) << "stabilised";
    ASSERT_EQ(component.set_mode(kFirst, true, now_), Status::kOk);

    EXPECT_EQ(take(calls_), Calls{"m.on_mode_changed"});
    EXPECT_EQ(&component.get_current_mode(), &kFirst);
}

TEST_F(RtcRulesTest, R35_AComponentBelongsToOneContext) {
    verifies("SWR-RTC-011", Technique::kEquivalenceClasses, Polarity::kViolation);
    ExecutionContext other;
    const std::array<Component*, 2> shared{&stranger_, &a_};

    EXPECT_EQ(other.attach(1, shared, ContextPlan{1_ms}), Status::kBadParameter);

    EXPECT_TRUE(stranger_.get_participating_contexts().empty()) << "nobody was taken";
    EXPECT_EQ(a_.get_participating_contexts()[0U], &sut_);
}

}  // namespace
}  // namespace mamori
