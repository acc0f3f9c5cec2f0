// SPDX-License-Identifier: Apache-2.0
// Goal: a cycle calls the right actions in the right order, and a failure stays with the component that
// failed. Method: two spies in one context; each action that can fail, with each code that is not kOk.
#include <algorithm>

#include "mamori/trace/verifies.hpp"
#include "support/context_fixture.hpp"

namespace mamori {
namespace {

using testing_support::Calls;
using testing_support::take;
using verification::Polarity;
using verification::Technique;
using verification::verifies;

class ExecutionCycleTest : public testing_support::ContextFixture {};

TEST_F(ExecutionCycleTest, FirstAllExecuteThenAllUpdateTheirStateInTableOrder) {
    verifies("SWR-KRN-013");
    start_and_activate();
    const Calls expected{"a.on_execute", "b.on_execute", "a.on_state_update", "b.on_state_update"};

    EXPECT_EQ(run_cycle(), expected);
    EXPECT_EQ(run_cycle(), expected);
}

TEST_F(ExecutionCycleTest, AnInactiveComponentIsLeftOutOfBothPasses) {
    verifies("SWR-KRN-013", Technique::kStateTransition);
    ASSERT_EQ(sut_.start(now_), Status::kOk);
    calls_.clear();

    EXPECT_EQ(run_cycle(), Calls{});
    ASSERT_EQ(sut_.activate_component(b_, now_), Status::kOk);
    calls_.clear();

    EXPECT_EQ(run_cycle(), (Calls{"b.on_execute", "b.on_state_update"}));
}

TEST_F(ExecutionCycleTest, AComponentInErrorGetsOnErrorInPlaceOfBoth) {
    verifies("SWR-KRN-013", Technique::kStateTransition);
    start_and_activate();
    bring_a_into_error();
    const Calls expected{"a.on_error", "b.on_execute", "b.on_state_update"};

    EXPECT_EQ(run_cycle(), expected);
    EXPECT_EQ(run_cycle(), expected);
}

TEST_F(ExecutionCycleTest, AHealthyComponentIsNeverAborted) {
    verifies("SWR-KRN-014");
    start_and_activate();

    for (int cycle = 0; cycle < 100; ++cycle) {
        for (const std::string& call : run_cycle()) {
            EXPECT_TRUE(call.find("on_aborting") == std::string::npos &&
                        call.find("on_error") == std::string::npos);
        }
    }
    EXPECT_EQ(get_state(a_), LifecycleState::kActive);
}

/// The five codes that are not kOk are one and the same to the state machine.
class FailureCodeTest : public ExecutionCycleTest, public ::testing::WithParamInterface<Status> {};

TEST_P(FailureCodeTest, AFailedExecuteLeadsToErrorAndTheOtherComponentGoesOn) {
    verifies("SWR-KRN-014", Technique::kFaultInjection, Polarity::kViolation);
    start_and_activate();
    a_.answers["on_execute"] = GetParam();

    EXPECT_EQ(run_cycle(), (Calls{"a.on_execute", "a.on_aborting", "b.on_execute", "b.on_state_update"}));

    EXPECT_EQ(get_state(a_), LifecycleState::kError);
    EXPECT_EQ(get_state(b_), LifecycleState::kActive);
    EXPECT_EQ(run_cycle(), (Calls{"a.on_error", "b.on_execute", "b.on_state_update"}));
}

TEST_P(FailureCodeTest, AFailedStateUpdateLeadsToErrorAndTheOtherComponentGoesOn) {
    verifies("SWR-KRN-014", Technique::kFaultInjection, Polarity::kViolation);
    start_and_activate();
    a_.answers["on_state_update"] = GetParam();

    EXPECT_EQ(run_cycle(), (Calls{"a.on_execute", "b.on_execute", "a.on_state_update", "a.on_aborting",
                                  "b.on_state_update"}));

    EXPECT_EQ(get_state(a_), LifecycleState::kError);
    EXPECT_EQ(run_cycle(), (Calls{"a.on_error", "b.on_execute", "b.on_state_update"}));
}

TEST_P(FailureCodeTest, AFailedActivationLeadsToErrorAtOnceAndIsNeverSeenActive) {
    verifies("SWR-KRN-014", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_EQ(sut_.start(now_), Status::kOk);
    calls_.clear();
    a_.answers["on_activated"] = GetParam();
    a_.inside = [this](const std::string&) { EXPECT_NE(get_state(a_), LifecycleState::kActive); };

    EXPECT_EQ(sut_.activate_component(a_, now_), GetParam());

    EXPECT_EQ(get_state(a_), LifecycleState::kError);
    EXPECT_EQ(take(calls_), (Calls{"a.on_activated", "a.on_aborting"}));
    EXPECT_EQ(run_cycle(), Calls{"a.on_error"});
}

TEST_P(FailureCodeTest, AFailedResetKeepsItInErrorWithoutASecondAbort) {
    verifies("SWR-KRN-014", Technique::kFaultInjection, Polarity::kViolation);
    start_and_activate();
    bring_a_into_error();
    a_.answers["on_reset"] = GetParam();

    EXPECT_EQ(sut_.reset_component(a_, now_), GetParam());

    EXPECT_EQ(take(calls_), Calls{"a.on_reset"});
    EXPECT_EQ(get_state(a_), LifecycleState::kError);
    EXPECT_EQ(run_cycle(), (Calls{"a.on_error", "b.on_execute", "b.on_state_update"}));
    a_.answers.clear();
    EXPECT_EQ(sut_.reset_component(a_, now_), Status::kOk) << "a second request may succeed";
}

TEST_P(FailureCodeTest, FailuresOfOnAbortingAndOnErrorChangeNothing) {
    verifies("SWR-KRN-014", Technique::kFaultInjection, Polarity::kViolation);
    start_and_activate();
    a_.answers = {{"on_execute", GetParam()}, {"on_aborting", GetParam()}, {"on_error", GetParam()}};

    EXPECT_EQ(run_cycle(), (Calls{"a.on_execute", "a.on_aborting", "b.on_execute", "b.on_state_update"}));
    EXPECT_EQ(run_cycle(), (Calls{"a.on_error", "b.on_execute", "b.on_state_update"}));
    EXPECT_EQ(run_cycle(), (Calls{"a.on_error", "b.on_execute", "b.on_state_update"}));

    EXPECT_EQ(get_state(a_), LifecycleState::kError);
}

INSTANTIATE_TEST_SUITE_P(AllCodes, FailureCodeTest,
                         ::testing::Values(Status::kError, Status::kBadParameter, Status::kUnsupported,
                                           Status::kOutOfResources, Status::kPreconditionNotMet),
                         [](const auto& parameter) { return std::string(get_name(parameter.param)); });

TEST_F(ExecutionCycleTest, EachEntryIntoErrorAbortsOnce) {
    verifies("SWR-KRN-014", Technique::kStateTransition, Polarity::kViolation);
    start_and_activate();

    for (int entry = 0; entry < 3; ++entry) {
        a_.answers["on_execute"] = Status::kError;
        const Calls calls = run_cycle();
        EXPECT_EQ(std::count(calls.begin(), calls.end(), "a.on_aborting"), 1);
        a_.answers.clear();
        ASSERT_EQ(sut_.reset_component(a_, now_), Status::kOk);
        ASSERT_EQ(sut_.activate_component(a_, now_), Status::kOk);
        calls_.clear();
    }
}

TEST_F(ExecutionCycleTest, AnErrorWinsOverADeactivationThatIsAskedForInTheSameCycle) {
    verifies("SWR-KRN-014", Technique::kStateTransition, Polarity::kViolation);
    start_and_activate();
    a_.answers["on_execute"] = Status::kError;
    a_.inside = [this](const std::string&) {
        EXPECT_EQ(sut_.deactivate_component(a_, now_), Status::kPreconditionNotMet);
    };

    run_cycle();

    EXPECT_EQ(get_state(a_), LifecycleState::kError);
    EXPECT_EQ(sut_.deactivate_component(a_, now_), Status::kPreconditionNotMet);
}

TEST_F(ExecutionCycleTest, AnErrorInOneContextLeavesTheOtherContextAlone) {
    verifies("SWR-KRN-014", Technique::kFaultInjection, Polarity::kViolation);
    const std::array<Component*, 1> others{&stranger_};
    ExecutionContext other;
    ASSERT_EQ(stranger_.initialize(), Status::kOk);
    ASSERT_EQ(other.attach(8, others, ContextPlan{1_ms}), Status::kOk);
    ASSERT_EQ(other.start(now_), Status::kOk);
    ASSERT_EQ(other.activate_component(stranger_, now_), Status::kOk);
    start_and_activate();

    bring_a_into_error();

    EXPECT_EQ(other.get_component_state(stranger_).get_value(), LifecycleState::kActive);
    EXPECT_TRUE(other.is_running());
}

}  // namespace
}  // namespace mamori
