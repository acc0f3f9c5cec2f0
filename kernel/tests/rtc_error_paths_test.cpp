// SPDX-License-Identifier: Apache-2.0
// Goal: each item of the list of error paths that a context must handle, one test per item, named E<item>.
// Method: two spies in one context, under the default policy. Every combination: rtc_enumeration_test.cpp.
#include <algorithm>
#include <limits>

#include "mamori/trace/verifies.hpp"
#include "support/context_fixture.hpp"

namespace mamori {
namespace {

using testing_support::Calls;
using testing_support::SpyComponent;
using testing_support::take;
using verification::Polarity;
using verification::Technique;
using verification::verifies;

constexpr std::array<Duration, 1> kAlternatives{2_ms};

class RtcErrorPathsTest : public testing_support::ContextFixture {
  protected:
    RtcErrorPathsTest() { plan_.alternative_periods = kAlternatives; }

    static std::ptrdiff_t count(const Calls& calls, const std::string& call) {
        return std::count(calls.begin(), calls.end(), call);
    }
    /// Brings a_ into Error by a failure of `action` with `code`. @return the actions called meanwhile.
    Calls fail(const std::string& action, Status code) {
        calls_.clear();
        a_.answers[action] = code;
        if (action == "on_activated") {
            EXPECT_EQ(sut_.activate_component(a_, now_), code);
            return take(calls_);
        }
        EXPECT_EQ(sut_.activate_component(a_, now_), Status::kOk);
        calls_.clear();
        if (action == "on_rate_changed") {
            EXPECT_EQ(sut_.set_rate(sut_.get_divisor() == 1 ? 500.0 : 1000.0), Status::kOk);
            EXPECT_TRUE(sut_.apply_pending_rate());
        }
        return run_cycle();
    }
    void reset() {
        a_.answers.clear();
        ASSERT_EQ(sut_.reset_component(a_, now_), Status::kOk);
        calls_.clear();
    }
};

TEST_F(RtcErrorPathsTest, E1_EachFailureWhileActiveAbortsOnceAndThenErrsEachCycle) {
    verifies("SWR-RTC-011", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_EQ(sut_.start(now_), Status::kOk);

    for (const char* action : {"on_activated", "on_execute", "on_state_update", "on_rate_changed"}) {
        SCOPED_TRACE(action);
        EXPECT_EQ(count(fail(action, Status::kError), "a.on_aborting"), 1);
        EXPECT_EQ(get_state(a_), LifecycleState::kError);
        for (int cycle = 0; cycle < 3; ++cycle) {
            const Calls calls = run_cycle();
            EXPECT_EQ(count(calls, "a.on_error"), 1);
            EXPECT_EQ(count(calls, "a.on_aborting") + count(calls, "a.on_execute"), 0);
        }
        reset();
    }
}

TEST_F(RtcErrorPathsTest, E2_EveryCodeThatIsNotOkIsTheSameToTheStateMachine) {
    verifies("SWR-RTC-011", Technique::kEquivalenceClasses, Polarity::kViolation);
    ASSERT_EQ(sut_.start(now_), Status::kOk);

    for (const char* action : {"on_activated", "on_execute", "on_state_update", "on_rate_changed"}) {
        const Calls expected = fail(action, Status::kError);
        reset();
        for (const Status code : {Status::kBadParameter, Status::kUnsupported, Status::kOutOfResources,
                                  Status::kPreconditionNotMet}) {
            EXPECT_EQ(fail(action, code), expected) << action;
            EXPECT_EQ(get_state(a_), LifecycleState::kError);
            reset();
        }
    }
}

TEST_F(RtcErrorPathsTest, E3_FailuresOfOnAbortingAndOnErrorChangeNothingAndDoNotRecur) {
    verifies("SWR-RTC-011", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_EQ(sut_.start(now_), Status::kOk);
    a_.answers = {{"on_aborting", Status::kError}, {"on_error", Status::kOutOfResources}};

    EXPECT_EQ(fail("on_execute", Status::kError), (Calls{"a.on_execute", "a.on_aborting"}));
    EXPECT_EQ(run_cycle(), Calls{"a.on_error"});
    EXPECT_EQ(run_cycle(), Calls{"a.on_error"});

    EXPECT_EQ(get_state(a_), LifecycleState::kError);
}

TEST_F(RtcErrorPathsTest, E4_AFailedResetStaysInErrorWithoutASecondAbort) {
    verifies("SWR-RTC-011", Technique::kFaultInjection, Polarity::kViolation);
    start_and_activate();
    bring_a_into_error();
    a_.answers["on_reset"] = Status::kError;

    EXPECT_EQ(sut_.reset_component(a_, now_), Status::kError);

    EXPECT_EQ(take(calls_), Calls{"a.on_reset"});
    EXPECT_EQ(run_cycle(), (Calls{"a.on_error", "b.on_execute", "b.on_state_update"}));
}

TEST_F(RtcErrorPathsTest, E5_AResetLeadsToInactiveAndNeedsANewActivation) {
    verifies("SWR-RTC-011", Technique::kStateTransition, Polarity::kViolation);
    start_and_activate();
    bring_a_into_error();

    EXPECT_EQ(sut_.reset_component(a_, now_), Status::kOk);

    EXPECT_EQ(get_state(a_), LifecycleState::kInactive);
    EXPECT_EQ(count(run_cycle(), "a.on_execute"), 0);
    EXPECT_EQ(sut_.activate_component(a_, now_), Status::kOk);
    EXPECT_EQ(count(run_cycle(), "a.on_execute"), 1);
}

TEST_F(RtcErrorPathsTest, E6_AResetWhileActiveOrInactiveIsRefusedWithoutAChange) {
    verifies("SWR-RTC-011", Technique::kStateTransition, Polarity::kViolation);

    EXPECT_EQ(sut_.reset_component(a_, now_), Status::kPreconditionNotMet);
    EXPECT_EQ(get_state(a_), LifecycleState::kInactive);
    start_and_activate();
    EXPECT_EQ(sut_.reset_component(a_, now_), Status::kPreconditionNotMet);

    EXPECT_EQ(get_state(a_), LifecycleState::kActive);
    EXPECT_TRUE(calls_.empty());
}

TEST_F(RtcErrorPathsTest, E7_AnActivationWhileInErrorOrActiveIsRefused) {
    verifies("SWR-RTC-011", Technique::kStateTransition, Polarity::kViolation);
    start_and_activate();
    bring_a_into_error();

    EXPECT_EQ(sut_.activate_component(a_, now_), Status::kPreconditionNotMet);
    EXPECT_EQ(sut_.activate_component(b_, now_), Status::kPreconditionNotMet);

    EXPECT_EQ(get_state(a_), LifecycleState::kError);
    EXPECT_EQ(get_state(b_), LifecycleState::kActive);
    EXPECT_TRUE(calls_.empty());
}

TEST_F(RtcErrorPathsTest, E8_ADeactivationWhileInactiveOrInErrorIsRefused) {
    verifies("SWR-RTC-011", Technique::kStateTransition, Polarity::kViolation);
    EXPECT_EQ(sut_.deactivate_component(a_, now_), Status::kPreconditionNotMet);
    start_and_activate();
    bring_a_into_error();

    EXPECT_EQ(sut_.deactivate_component(a_, now_), Status::kPreconditionNotMet);

    EXPECT_EQ(get_state(a_), LifecycleState::kError);
    EXPECT_TRUE(calls_.empty());
}

TEST_F(RtcErrorPathsTest, E9_EveryOperationOnAStrangerIsABadParameter) {
    verifies("SWR-RTC-011", Technique::kEquivalenceClasses, Polarity::kViolation);
    ASSERT_EQ(stranger_.initialize(), Status::kOk);
    calls_.clear();

    EXPECT_EQ(sut_.activate_component(stranger_, now_), Status::kBadParameter);
    EXPECT_EQ(sut_.deactivate_component(stranger_, now_), Status::kBadParameter);
    EXPECT_EQ(sut_.reset_component(stranger_, now_), Status::kBadParameter);
    EXPECT_EQ(sut_.get_component_state(stranger_).get_status(), Status::kBadParameter);
    EXPECT_EQ(stranger_.get_context_handle(sut_).get_status(), Status::kBadParameter);

    EXPECT_TRUE(calls_.empty());
}

TEST_F(RtcErrorPathsTest, E10_ARateThatIsNoneIsABadParameterAndTheRateStays) {
    verifies("SWR-RTC-011", Technique::kBoundaryValues, Polarity::kViolation);

    for (const double rate :
         {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        EXPECT_EQ(sut_.set_rate(rate), Status::kBadParameter) << rate;
    }

    EXPECT_FALSE(sut_.apply_pending_rate());
    EXPECT_DOUBLE_EQ(sut_.get_rate(), 1000.0);
}

TEST_F(RtcErrorPathsTest, E11_StartWhileRunningAndStopWhileStoppedAreRefused) {
    verifies("SWR-RTC-011", Technique::kStateTransition, Polarity::kViolation);

    EXPECT_EQ(sut_.stop(now_), Status::kPreconditionNotMet);
    ASSERT_EQ(sut_.start(now_), Status::kOk);
    calls_.clear();
    EXPECT_EQ(sut_.start(now_), Status::kPreconditionNotMet);

    EXPECT_TRUE(calls_.empty());
}

TEST_F(RtcErrorPathsTest, E12_StopKeepsActiveComponentsActiveWithoutDeactivation) {
    verifies("SWR-RTC-011", Technique::kStateTransition, Polarity::kViolation);
    start_and_activate();

    ASSERT_EQ(sut_.stop(now_), Status::kOk);
    EXPECT_EQ(take(calls_), (Calls{"a.on_shutdown", "b.on_shutdown"}));
    EXPECT_EQ(get_state(a_), LifecycleState::kActive);
    ASSERT_EQ(sut_.start(now_), Status::kOk);
    EXPECT_EQ(take(calls_), (Calls{"a.on_startup", "b.on_startup"}));

    EXPECT_EQ(run_cycle(), (Calls{"a.on_execute", "b.on_execute", "a.on_state_update", "b.on_state_update"}));
}

TEST_F(RtcErrorPathsTest, E13_ErrorOutlivesAStop) {
    verifies("SWR-RTC-011", Technique::kStateTransition, Polarity::kViolation);
    start_and_activate();
    bring_a_into_error();

    ASSERT_EQ(sut_.stop(now_), Status::kOk);
    EXPECT_EQ(get_state(a_), LifecycleState::kError);
    ASSERT_EQ(sut_.start(now_), Status::kOk);
    calls_.clear();

    EXPECT_EQ(run_cycle(), (Calls{"a.on_error", "b.on_execute", "b.on_state_update"}));
}

TEST_F(RtcErrorPathsTest, E14_FinalizeWhileParticipatingIsRefusedAndExitLeavesByItself) {
    verifies("SWR-RTC-011", Technique::kStateTransition, Polarity::kViolation);
    start_and_activate();

    EXPECT_EQ(a_.finalize(), Status::kPreconditionNotMet);
    EXPECT_TRUE(calls_.empty());
    EXPECT_EQ(a_.exit(now_), Status::kOk);

    EXPECT_EQ(take(calls_), (Calls{"a.on_deactivated", "a.on_finalize"}));
    EXPECT_FALSE(a_.is_alive());
    EXPECT_EQ(run_cycle(), (Calls{"b.on_execute", "b.on_state_update"}));
}

TEST_F(RtcErrorPathsTest, E15_AFailingComponentDoesNotStopThePassOfTheOthers) {
    verifies("SWR-RTC-011", Technique::kFaultInjection, Polarity::kViolation);
    start_and_activate();
    a_.answers["on_execute"] = Status::kError;

    EXPECT_EQ(run_cycle(), (Calls{"a.on_execute", "a.on_aborting", "b.on_execute", "b.on_state_update"}));
}

TEST_F(RtcErrorPathsTest, E16_AComponentIsInOneContextSoAnErrorStaysInIt) {
    verifies("SWR-RTC-011", Technique::kFaultInjection, Polarity::kViolation);
    ExecutionContext other;
    const std::array<Component*, 1> same{&a_};
    const std::array<Component*, 1> another{&stranger_};
    EXPECT_EQ(other.attach(8, same, ContextPlan{1_ms}), Status::kBadParameter);
    ASSERT_EQ(stranger_.initialize(), Status::kOk);
    ASSERT_EQ(other.attach(8, another, ContextPlan{1_ms}), Status::kOk);
    ASSERT_EQ(other.start(now_), Status::kOk);
    ASSERT_EQ(other.activate_component(stranger_, now_), Status::kOk);
    start_and_activate();

    bring_a_into_error();

    EXPECT_EQ(other.get_component_state(stranger_).get_value(), LifecycleState::kActive);
}

TEST_F(RtcErrorPathsTest, E17_AnErrorWinsOverADeactivationOfTheSameCycle) {
    verifies("SWR-RTC-011", Technique::kStateTransition, Polarity::kViolation);
    start_and_activate();
    a_.answers["on_execute"] = Status::kError;
    b_.inside = [this](const std::string&) {
        EXPECT_EQ(sut_.deactivate_component(a_, now_), Status::kPreconditionNotMet);
    };

    run_cycle();

    EXPECT_EQ(get_state(a_), LifecycleState::kError);
}

TEST_F(RtcErrorPathsTest, E18_ParticipantsDoNotChangeDuringACycle) {
    verifies("SWR-RTC-011", Technique::kErrorGuessing, Polarity::kViolation);
    start_and_activate();
    a_.inside = [this](const std::string&) {
        EXPECT_EQ(sut_.detach(), Status::kPreconditionNotMet);
        EXPECT_EQ(sut_.add_component(stranger_), Status::kUnsupported);
        EXPECT_EQ(sut_.remove_component(b_), Status::kUnsupported);
        EXPECT_EQ(b_.exit(now_), Status::kPreconditionNotMet);
    };

    EXPECT_EQ(run_cycle(), (Calls{"a.on_execute", "b.on_execute", "a.on_state_update", "b.on_state_update"}));
    EXPECT_EQ(sut_.get_participant_count(), 2U);
}

TEST_F(RtcErrorPathsTest, E19_ActionsAreNeverReentrantWithinOneContext) {
    verifies("SWR-RTC-011", Technique::kErrorGuessing, Polarity::kViolation);
    int depth = 0;
    const auto inside = [this, &depth](const std::string&) {
        ++depth;
        EXPECT_EQ(depth, 1);
        EXPECT_EQ(sut_.start(now_), Status::kPreconditionNotMet);
        EXPECT_EQ(sut_.stop(now_), Status::kPreconditionNotMet);
        EXPECT_EQ(sut_.begin_cycle(now_), Status::kPreconditionNotMet);
        for (Component* component : participants_) {
            EXPECT_EQ(sut_.activate_component(*component, now_), Status::kPreconditionNotMet);
            EXPECT_EQ(sut_.deactivate_component(*component, now_), Status::kPreconditionNotMet);
            EXPECT_EQ(sut_.reset_component(*component, now_), Status::kPreconditionNotMet);
            EXPECT_EQ(component->exit(now_), Status::kPreconditionNotMet);
        }
        --depth;
    };
    a_.inside = inside;
    b_.inside = inside;

    ASSERT_EQ(sut_.start(now_), Status::kOk);
    ASSERT_EQ(sut_.activate_component(a_, now_), Status::kOk);
    a_.answers["on_execute"] = Status::kError;
    run_cycle();
    run_cycle();
    ASSERT_EQ(sut_.reset_component(a_, now_), Status::kOk);
    ASSERT_EQ(sut_.stop(now_), Status::kOk);
}

TEST_F(RtcErrorPathsTest, E20_EveryActionIsGivenTheHandleOfItsContext) {
    verifies("SWR-RTC-011", Technique::kInterface, Polarity::kViolation);
    start_and_activate();
    bring_a_into_error();
    run_cycle();
    ASSERT_EQ(sut_.reset_component(a_, now_), Status::kOk);
    ASSERT_EQ(sut_.set_rate(500.0), Status::kOk);
    ASSERT_TRUE(sut_.apply_pending_rate());
    run_cycle();
    ASSERT_EQ(sut_.activate_component(a_, now_), Status::kOk);
    ASSERT_EQ(sut_.deactivate_component(a_, now_), Status::kOk);
    ASSERT_EQ(sut_.stop(now_), Status::kOk);

    EXPECT_EQ(a_.handles.size(), 10U);
    for (const ContextHandle& handle : a_.handles) {
        EXPECT_EQ(handle.id, a_.get_context_handle(sut_).get_value().id);
        EXPECT_EQ(a_.get_context(handle), &sut_);
    }
}

}  // namespace
}  // namespace mamori
