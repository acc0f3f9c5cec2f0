// SPDX-License-Identifier: Apache-2.0
// Goal: each operation of the context does what the standard says and refuses everything else unchanged.
// Method: two spies in one context; each status of each operation; calls from within actions and cycles.
// What a cycle does: execution_cycle_test.cpp.
#include "mamori/kernel/component/execution_context.hpp"

#include <limits>

#include "mamori/trace/verifies.hpp"
#include "mamori/verification/failed_check.hpp"
#include "support/context_fixture.hpp"

namespace mamori {
namespace {

using testing_support::Calls;
using testing_support::SpyComponent;
using testing_support::take;
using verification::Polarity;
using verification::Technique;
using verification::verifies;

class ExecutionContextTest : public testing_support::ContextFixture {};

TEST_F(ExecutionContextTest, StartCallsOnStartupOfEveryParticipantInOrder) {
    verifies("SWR-KRN-012", Technique::kStateTransition);

    EXPECT_EQ(sut_.start(now_), Status::kOk);

    EXPECT_TRUE(sut_.is_running());
    EXPECT_EQ(calls_, (Calls{"a.on_startup", "b.on_startup"}));
    EXPECT_EQ(get_state(a_), LifecycleState::kInactive);
}

TEST_F(ExecutionContextTest, StopCallsOnShutdownAndKeepsEveryComponentsState) {
    verifies("SWR-KRN-012", Technique::kStateTransition);
    start_and_activate();

    EXPECT_EQ(sut_.stop(now_), Status::kOk);
    EXPECT_FALSE(sut_.is_running());
    EXPECT_EQ(take(calls_), (Calls{"a.on_shutdown", "b.on_shutdown"}));
    EXPECT_EQ(get_state(a_), LifecycleState::kActive);

    EXPECT_EQ(sut_.start(now_), Status::kOk);
    EXPECT_EQ(take(calls_), (Calls{"a.on_startup", "b.on_startup"}));
    EXPECT_EQ(run_cycle(), (Calls{"a.on_execute", "b.on_execute", "a.on_state_update", "b.on_state_update"}));
}

TEST_F(ExecutionContextTest, ErrorOutlivesStopAndStart) {
    verifies("SWR-KRN-012", Technique::kStateTransition);
    start_and_activate();
    bring_a_into_error();

    ASSERT_EQ(sut_.stop(now_), Status::kOk);
    EXPECT_EQ(get_state(a_), LifecycleState::kError);
    ASSERT_EQ(sut_.start(now_), Status::kOk);

    EXPECT_EQ(get_state(a_), LifecycleState::kError);
}

TEST_F(ExecutionContextTest, ActivationAndDeactivationCallTheirActionsAtOnce) {
    verifies("SWR-KRN-012", Technique::kStateTransition);
    ASSERT_EQ(sut_.start(now_), Status::kOk);
    calls_.clear();

    EXPECT_EQ(sut_.activate_component(a_, now_), Status::kOk);
    EXPECT_EQ(get_state(a_), LifecycleState::kActive);
    EXPECT_EQ(sut_.deactivate_component(a_, now_), Status::kOk);
    EXPECT_EQ(get_state(a_), LifecycleState::kInactive);

    EXPECT_EQ(calls_, (Calls{"a.on_activated", "a.on_deactivated"}));
    EXPECT_EQ(get_state(b_), LifecycleState::kInactive);
}

TEST_F(ExecutionContextTest, ActionsAreGivenTheIdOfTheirContextAndTheInstantOfTheOperation) {
    verifies("SWR-KRN-012", Technique::kInterface);
    start_and_activate();
    now_ = Instant{2000};

    run_cycle();

    ASSERT_EQ(a_.handles.size(), 4U);
    for (const ContextHandle& handle : a_.handles) {
        EXPECT_EQ(handle.id, kId);
    }
    EXPECT_EQ(a_.handles[1].now, Instant{1000});  // on_activated
    EXPECT_EQ(a_.handles[2].now, Instant{2000});  // on_execute
}

TEST_F(ExecutionContextTest, ResetLeadsToInactiveSoThatANewActivationIsNeeded) {
    verifies("SWR-KRN-012", Technique::kStateTransition);
    start_and_activate();
    bring_a_into_error();

    EXPECT_EQ(sut_.reset_component(a_, now_), Status::kOk);

    EXPECT_EQ(take(calls_), Calls{"a.on_reset"});
    EXPECT_EQ(get_state(a_), LifecycleState::kInactive);
    EXPECT_EQ(run_cycle(), (Calls{"b.on_execute", "b.on_state_update"}));
    EXPECT_EQ(sut_.activate_component(a_, now_), Status::kOk);
}

TEST_F(ExecutionContextTest, TheRateIsThatOfTheTable) {
    verifies("SWR-KRN-012", Technique::kInterface);
    const ExecutionContext unattached;

    EXPECT_DOUBLE_EQ(sut_.get_rate(), 1000.0);
    EXPECT_LT(unattached.get_rate(), 0.0);
    EXPECT_EQ(sut_.get_participant_count(), 2U);
    EXPECT_EQ(unattached.get_participant_count(), 0U);
}

TEST_F(ExecutionContextTest, ADetachedComponentIsInactiveInItsNextContextEvenAfterAnError) {
    verifies("SWR-KRN-012", Technique::kStateTransition);
    start_and_activate();
    bring_a_into_error();
    ASSERT_EQ(sut_.deactivate_component(b_, now_), Status::kOk);
    ASSERT_EQ(sut_.stop(now_), Status::kOk);

    EXPECT_EQ(sut_.detach(), Status::kOk);
    ExecutionContext next;
    ASSERT_EQ(next.attach(1, participants_, ContextPlan{1_ms}), Status::kOk);

    EXPECT_EQ(next.get_component_state(a_).get_value(), LifecycleState::kInactive);
    EXPECT_EQ(sut_.get_component_state(a_).get_status(), Status::kBadParameter);
}

TEST_F(ExecutionContextTest, AttachRefusesEachWrongArgumentAndTakesNobody) {
    verifies("SWR-KRN-012", Technique::kBoundaryValues, Polarity::kViolation);
    ExecutionContext other;
    const std::array<Component*, 1> one{&stranger_};
    const std::array<Component*, 2> with_null{&stranger_, nullptr};
    const std::array<Component*, 2> twice{&stranger_, &stranger_};
    const std::array<Component*, 2> taken{&stranger_, &a_};

    EXPECT_EQ(other.attach(-1, one, ContextPlan{1_ms}), Status::kBadParameter);
    EXPECT_EQ(other.attach(0, one, ContextPlan{0_ns}), Status::kBadParameter);
    EXPECT_EQ(other.attach(0, one, ContextPlan{Duration{-1}}), Status::kBadParameter);
    EXPECT_EQ(other.attach(0, {}, ContextPlan{1_ms}), Status::kBadParameter);
    EXPECT_EQ(other.attach(0, with_null, ContextPlan{1_ms}), Status::kBadParameter);
    EXPECT_EQ(other.attach(0, twice, ContextPlan{1_ms}), Status::kBadParameter);
    EXPECT_EQ(other.attach(0, taken, ContextPlan{1_ms}), Status::kBadParameter);
    EXPECT_EQ(sut_.attach(0, one, ContextPlan{1_ms}), Status::kPreconditionNotMet);

    EXPECT_EQ(other.attach(0, one, ContextPlan{1_ns}), Status::kOk) << "nobody was taken by the refused ones";
}

TEST_F(ExecutionContextTest, DetachIsRefusedWhileRunningActiveOrEmpty) {
    verifies("SWR-KRN-012", Technique::kStateTransition, Polarity::kViolation);
    ExecutionContext unattached;
    start_and_activate();

    EXPECT_EQ(unattached.detach(), Status::kPreconditionNotMet);
    EXPECT_EQ(sut_.detach(), Status::kPreconditionNotMet);  // Running
    ASSERT_EQ(sut_.stop(now_), Status::kOk);
    EXPECT_EQ(sut_.detach(), Status::kPreconditionNotMet);  // Active
    ASSERT_EQ(sut_.deactivate_component(a_, now_), Status::kOk);
    EXPECT_EQ(sut_.detach(), Status::kPreconditionNotMet);  // the other one is
    ASSERT_EQ(sut_.deactivate_component(b_, now_), Status::kOk);

    EXPECT_EQ(sut_.detach(), Status::kOk);
}

TEST_F(ExecutionContextTest, StartWhileRunningAndStopWhileStoppedAreRefused) {
    verifies("SWR-KRN-012", Technique::kStateTransition, Polarity::kViolation);
    ExecutionContext unattached;

    EXPECT_EQ(unattached.start(now_), Status::kPreconditionNotMet);
    EXPECT_EQ(sut_.stop(now_), Status::kPreconditionNotMet);
    ASSERT_EQ(sut_.start(now_), Status::kOk);
    calls_.clear();
    EXPECT_EQ(sut_.start(now_), Status::kPreconditionNotMet);

    EXPECT_TRUE(calls_.empty());
    EXPECT_TRUE(sut_.is_running());
}

TEST_F(ExecutionContextTest, StartWithAParticipantThatIsNotAliveIsRefused) {
    verifies("SWR-KRN-012", Technique::kStateTransition, Polarity::kViolation);
    ExecutionContext other;
    const std::array<Component*, 1> created{&stranger_};
    ASSERT_EQ(other.attach(0, created, ContextPlan{1_ms}), Status::kOk);

    EXPECT_EQ(other.start(now_), Status::kPreconditionNotMet);
    EXPECT_EQ(other.activate_component(stranger_, now_), Status::kBadParameter);
    EXPECT_EQ(other.deactivate_component(stranger_, now_), Status::kBadParameter);
    EXPECT_EQ(other.reset_component(stranger_, now_), Status::kPreconditionNotMet);
    EXPECT_EQ(other.get_component_state(stranger_).get_status(), Status::kBadParameter);

    EXPECT_TRUE(calls_.empty());
}

TEST_F(ExecutionContextTest, ARefusedStartupKeepsTheContextStoppedAndShutsTheStartedDown) {
    verifies("SWR-KRN-012", Technique::kFaultInjection, Polarity::kViolation);
    b_.answers["on_startup"] = Status::kOutOfResources;

    EXPECT_EQ(sut_.start(now_), Status::kOutOfResources);

    EXPECT_FALSE(sut_.is_running());
    EXPECT_EQ(take(calls_), (Calls{"a.on_startup", "b.on_startup", "a.on_shutdown"}));
    EXPECT_EQ(sut_.get_refusing_position().get_value(), 1U);
    b_.answers.clear();
    EXPECT_EQ(sut_.start(now_), Status::kOk);
    EXPECT_FALSE(sut_.get_refusing_position().has_value());
}

TEST_F(ExecutionContextTest, AStartThatAParticipantCannotFollowNamesIt) {
    verifies("SWR-KRN-012", Technique::kErrorGuessing, Polarity::kViolation);
    a_.answers["on_startup"] = Status::kError;
    ASSERT_EQ(sut_.start(now_), Status::kError);
    ASSERT_EQ(sut_.get_refusing_position().get_value(), 0U);
    ASSERT_EQ(b_.exit(now_), Status::kOk);

    EXPECT_EQ(sut_.start(now_), Status::kPreconditionNotMet);

    EXPECT_EQ(sut_.get_refusing_position().get_value(), 1U);
}

TEST_F(ExecutionContextTest, AFailingShutdownIsReportedButStopsAnyway) {
    verifies("SWR-KRN-012", Technique::kFaultInjection, Polarity::kViolation);
    start_and_activate();
    a_.answers["on_shutdown"] = Status::kUnsupported;
    b_.answers["on_shutdown"] = Status::kError;

    EXPECT_EQ(sut_.stop(now_), Status::kUnsupported) << "the first failure";

    EXPECT_FALSE(sut_.is_running());
    EXPECT_EQ(calls_.size(), 2U);
}

TEST_F(ExecutionContextTest, AFailingDeactivationIsReportedButLeadsToInactive) {
    verifies("SWR-KRN-012", Technique::kFaultInjection, Polarity::kViolation);
    start_and_activate();
    a_.answers["on_deactivated"] = Status::kError;

    EXPECT_EQ(sut_.deactivate_component(a_, now_), Status::kError);

    EXPECT_EQ(get_state(a_), LifecycleState::kInactive);
    EXPECT_EQ(calls_, Calls{"a.on_deactivated"});
}

TEST_F(ExecutionContextTest, OperationsInTheWrongStateAreRefusedWithoutACall) {
    verifies("SWR-KRN-012", Technique::kStateTransition, Polarity::kViolation);
    start_and_activate();
    bring_a_into_error();

    EXPECT_EQ(sut_.activate_component(a_, now_), Status::kPreconditionNotMet);    // Error
    EXPECT_EQ(sut_.deactivate_component(a_, now_), Status::kPreconditionNotMet);  // Error
    EXPECT_EQ(get_state(a_), LifecycleState::kError);
    EXPECT_EQ(sut_.activate_component(b_, now_), Status::kPreconditionNotMet);  // Active
    EXPECT_EQ(sut_.reset_component(b_, now_), Status::kPreconditionNotMet);     // Active
    EXPECT_EQ(get_state(b_), LifecycleState::kActive);
    ASSERT_EQ(sut_.deactivate_component(b_, now_), Status::kOk);
    calls_.clear();
    EXPECT_EQ(sut_.deactivate_component(b_, now_), Status::kPreconditionNotMet);  // Inactive
    EXPECT_EQ(sut_.reset_component(b_, now_), Status::kPreconditionNotMet);       // Inactive
    EXPECT_EQ(get_state(b_), LifecycleState::kInactive);

    EXPECT_TRUE(calls_.empty());
}

TEST_F(ExecutionContextTest, EveryOperationOnAStrangerIsABadParameter) {
    verifies("SWR-KRN-012", Technique::kEquivalenceClasses, Polarity::kViolation);
    ASSERT_EQ(stranger_.initialize(), Status::kOk);
    start_and_activate();

    EXPECT_EQ(sut_.activate_component(stranger_, now_), Status::kBadParameter);
    EXPECT_EQ(sut_.deactivate_component(stranger_, now_), Status::kBadParameter);
    EXPECT_EQ(sut_.reset_component(stranger_, now_), Status::kBadParameter);
    EXPECT_EQ(sut_.get_component_state(stranger_).get_status(), Status::kBadParameter);

    EXPECT_TRUE(calls_.empty());
}

TEST_F(ExecutionContextTest, ARateThatIsNoRateIsABadParameterAndOneThatIsNotDeclaredIsUnsupported) {
    verifies("SWR-KRN-012", Technique::kBoundaryValues, Polarity::kViolation);

    EXPECT_EQ(sut_.set_rate(0.0), Status::kBadParameter);
    EXPECT_EQ(sut_.set_rate(-0.0), Status::kBadParameter);
    EXPECT_EQ(sut_.set_rate(-1.0), Status::kBadParameter);
    EXPECT_EQ(sut_.set_rate(std::numeric_limits<double>::quiet_NaN()), Status::kBadParameter);
    EXPECT_EQ(sut_.set_rate(std::numeric_limits<double>::infinity()), Status::kBadParameter);
    EXPECT_EQ(sut_.set_rate(std::numeric_limits<double>::denorm_min()), Status::kUnsupported);
    EXPECT_EQ(sut_.set_rate(500.0), Status::kUnsupported);

    EXPECT_DOUBLE_EQ(sut_.get_rate(), 1000.0);
    EXPECT_TRUE(calls_.empty());
}

TEST_F(ExecutionContextTest, OperationsFromWithinAnyActionAreRefused) {
    verifies("SWR-KRN-012", Technique::kErrorGuessing, Polarity::kViolation);
    std::size_t refusals = 0U;
    a_.inside = [this, &refusals](const std::string& action) {
        SCOPED_TRACE(action);
        EXPECT_EQ(sut_.start(now_), Status::kPreconditionNotMet);
        EXPECT_EQ(sut_.stop(now_), Status::kPreconditionNotMet);
        EXPECT_EQ(sut_.detach(), Status::kPreconditionNotMet);
        EXPECT_EQ(sut_.activate_component(b_, now_), Status::kPreconditionNotMet);
        EXPECT_EQ(sut_.deactivate_component(b_, now_), Status::kPreconditionNotMet);
        EXPECT_EQ(sut_.reset_component(a_, now_), Status::kPreconditionNotMet);
        EXPECT_EQ(sut_.begin_cycle(now_), Status::kPreconditionNotMet);
        EXPECT_EQ(sut_.get_acting_position().get_value(), 0U);
        ++refusals;
    };

    ASSERT_EQ(sut_.start(now_), Status::kOk);
    ASSERT_EQ(sut_.activate_component(a_, now_), Status::kOk);
    run_cycle();
    a_.answers["on_state_update"] = Status::kError;
    run_cycle();
    run_cycle();
    ASSERT_EQ(sut_.reset_component(a_, now_), Status::kOk);
    ASSERT_EQ(sut_.activate_component(a_, now_), Status::kOk);
    ASSERT_EQ(sut_.deactivate_component(a_, now_), Status::kOk);
    ASSERT_EQ(sut_.stop(now_), Status::kOk);

    EXPECT_EQ(refusals, 12U);
    EXPECT_FALSE(sut_.get_acting_position().has_value());
}

TEST_F(ExecutionContextTest, OperationsInMidCycleAreRefusedBetweenTheActionsToo) {
    verifies("SWR-KRN-012", Technique::kErrorGuessing, Polarity::kViolation);
    start_and_activate();
    ASSERT_EQ(sut_.begin_cycle(now_), Status::kOk);
    sut_.execute(0U);

    EXPECT_EQ(sut_.begin_cycle(now_), Status::kPreconditionNotMet);
    EXPECT_EQ(sut_.stop(now_), Status::kPreconditionNotMet);
    EXPECT_EQ(sut_.detach(), Status::kPreconditionNotMet);
    EXPECT_EQ(sut_.deactivate_component(a_, now_), Status::kPreconditionNotMet);
    EXPECT_EQ(sut_.get_component_state(a_).get_value(), LifecycleState::kActive) << "asking is allowed";
    sut_.end_cycle();

    EXPECT_EQ(sut_.deactivate_component(a_, now_), Status::kOk);
}

TEST_F(ExecutionContextTest, ACycleDoesNotBeginWhileStopped) {
    verifies("SWR-KRN-012", Technique::kStateTransition, Polarity::kViolation);

    EXPECT_EQ(sut_.begin_cycle(now_), Status::kPreconditionNotMet);
}

TEST_F(ExecutionContextTest, StepsOutsideACycleOrBeyondTheListEndInTheAssertion) {
    verifies("SWR-KRN-012", Technique::kBoundaryValues, Polarity::kViolation);
    start_and_activate();

    EXPECT_CHECK_FAILS(sut_.execute(0U), "execution_cycle.cpp", 1);
    EXPECT_CHECK_FAILS(sut_.update_state(0U), "execution_cycle.cpp", 1);
    ASSERT_EQ(sut_.begin_cycle(now_), Status::kOk);
    EXPECT_CHECK_FAILS(sut_.execute(2U), "execution_cycle.cpp", 4);
    EXPECT_CHECK_FAILS(sut_.update_state(2U), "execution_cycle.cpp", 4);
    EXPECT_CHECK_FAILS(sut_.execute(3U), "execution_cycle.cpp", 4);
    EXPECT_CHECK_FAILS(sut_.update_state(3U), "execution_cycle.cpp", 4);
}

}  // namespace
}  // namespace mamori
