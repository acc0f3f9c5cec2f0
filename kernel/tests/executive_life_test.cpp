// SPDX-License-Identifier: Apache-2.0
// Goal: a system starts as a whole or not at all, and says which component kept it from doing so.
// Method: three spies in two windows; a refusal at each step; each status of each operation.
#include <gtest/gtest.h>

#include "mamori/kernel/run/executive.hpp"
#include "mamori/trace/verifies.hpp"
#include "mamori/verification/failed_check.hpp"
#include "support/fake_host.hpp"
#include "support/flow_components.hpp"
#include "support/spy_component.hpp"

namespace mamori {
namespace {

using namespace testing_support;
using namespace verification;

class ExecutiveLifeTest : public ::testing::Test {
  protected:
    LifecycleState get_state(std::size_t window, const Component& component) {
        return sut_.get_context(window).get_component_state(component).get_value();
    }

    Calls calls_;
    SpyComponent a_{"a", calls_};
    SpyComponent b_{"b", calls_};
    SpyComponent c_{"c", calls_};
    SystemTable<2U, 3U, 0U, 0U> table_ =
        system(frame(1_ms), window("first", 0_us, 500_us, budget(500_us), run(a_, b_)),
               window("second", 500_us, 500_us, budget(500_us), run(c_)));
    FakeHost host_;
    ExecutiveFor<decltype(table_)> sut_{table_};
};

TEST_F(ExecutiveLifeTest, AllAreInitialisedThenAllStartedThenAllActivatedAndStoppedInReverse) {
    verifies("SWR-KRN-024", Technique::kStateTransition);

    EXPECT_EQ(sut_.initialize(), Status::kOk);
    EXPECT_EQ(take(calls_), (Calls{"a.on_initialize", "b.on_initialize", "c.on_initialize"}));
    EXPECT_EQ(sut_.start(), Status::kOk);
    EXPECT_EQ(take(calls_), (Calls{"a.on_startup", "b.on_startup", "c.on_startup", "a.on_activated",
                                   "b.on_activated", "c.on_activated"}));
    EXPECT_EQ(sut_.stop(), Status::kOk);
    EXPECT_EQ(take(calls_), (Calls{"c.on_deactivated", "c.on_shutdown", "b.on_deactivated",
                                   "a.on_deactivated", "a.on_shutdown", "b.on_shutdown"}));
    EXPECT_EQ(sut_.finalize(), Status::kOk);
    EXPECT_EQ(take(calls_), (Calls{"c.on_finalize", "b.on_finalize", "a.on_finalize"}));
    EXPECT_EQ(sut_.get_failed_component(), kNoIndex);
}

TEST_F(ExecutiveLifeTest, ItMayBeStartedAgainAfterAStopAndInitialisedAgainAfterAFinalize) {
    verifies("SWR-KRN-024", Technique::kStateTransition);

    for (int life = 0; life < 2; ++life) {
        ASSERT_EQ(sut_.initialize(), Status::kOk);
        for (int start = 0; start < 2; ++start) {
            ASSERT_EQ(sut_.start(), Status::kOk);
            EXPECT_EQ(sut_.run_window(0U, host_), WindowOutcome::kCompleted);
            ASSERT_EQ(sut_.stop(), Status::kOk);
        }
        ASSERT_EQ(sut_.finalize(), Status::kOk);
    }
}

TEST_F(ExecutiveLifeTest, ActionsOfStopCarryTheInstantOfTheLastWindow) {
    verifies("SWR-KRN-024", Technique::kInterface);
    ASSERT_EQ(sut_.initialize(), Status::kOk);
    ASSERT_EQ(sut_.start(), Status::kOk);
    host_.now = Instant{5000000};
    ASSERT_EQ(sut_.run_window(1U, host_), WindowOutcome::kCompleted);

    ASSERT_EQ(sut_.stop(), Status::kOk);

    EXPECT_EQ(c_.handles.back().now, Instant{5000000});
    EXPECT_EQ(c_.handles.back().id, 1);
    EXPECT_EQ(a_.handles.front().now, Instant{});
}

TEST_F(ExecutiveLifeTest, OperationsOutOfOrderAreRefusedWithoutACall) {
    verifies("SWR-KRN-024", Technique::kStateTransition, Polarity::kViolation);

    EXPECT_EQ(sut_.start(), Status::kPreconditionNotMet);
    EXPECT_EQ(sut_.stop(), Status::kPreconditionNotMet);
    EXPECT_EQ(sut_.finalize(), Status::kPreconditionNotMet);
    EXPECT_EQ(sut_.run_window(0U, host_), WindowOutcome::kStopped);
    EXPECT_TRUE(calls_.empty());
    ASSERT_EQ(sut_.initialize(), Status::kOk);
    ASSERT_EQ(sut_.start(), Status::kOk);
    calls_.clear();

    EXPECT_EQ(sut_.initialize(), Status::kPreconditionNotMet);
    EXPECT_EQ(sut_.start(), Status::kPreconditionNotMet);
    EXPECT_EQ(sut_.finalize(), Status::kPreconditionNotMet);
    EXPECT_TRUE(calls_.empty());
    EXPECT_EQ(get_state(1U, c_), LifecycleState::kActive) << "the running system is not disturbed";
    EXPECT_EQ(sut_.stop(), Status::kOk) << "it is still running";
}

TEST_F(ExecutiveLifeTest, ARefusedInitialiseNamesTheComponentAndGoesOnThereWhenRepeated) {
    verifies("SWR-KRN-024", Technique::kFaultInjection, Polarity::kViolation);
    b_.answers["on_initialize"] = Status::kOutOfResources;

    EXPECT_EQ(sut_.initialize(), Status::kOutOfResources);
    EXPECT_EQ(sut_.get_failed_component(), 1U);
    EXPECT_EQ(take(calls_), (Calls{"a.on_initialize", "b.on_initialize"}));
    EXPECT_EQ(sut_.start(), Status::kPreconditionNotMet);

    b_.answers.clear();
    EXPECT_EQ(sut_.initialize(), Status::kOk);
    EXPECT_EQ(take(calls_), (Calls{"b.on_initialize", "c.on_initialize"}));
    EXPECT_EQ(sut_.get_failed_component(), kNoIndex);
}

TEST_F(ExecutiveLifeTest, AComponentOfAnotherSystemIsRefusedAndNobodyIsTaken) {
    verifies("SWR-KRN-024", Technique::kErrorGuessing, Polarity::kViolation);
    ExecutionContext elsewhere;
    const std::array<Component*, 1> taken{&c_};
    ASSERT_EQ(elsewhere.attach(0, taken, ContextPlan{1_ms}), Status::kOk);

    EXPECT_EQ(sut_.initialize(), Status::kBadParameter);
    EXPECT_EQ(sut_.get_failed_component(), 2U);
    EXPECT_EQ(sut_.get_context(0U).get_participant_count(), 0U);

    ASSERT_EQ(elsewhere.detach(), Status::kOk);
    EXPECT_EQ(sut_.initialize(), Status::kOk);
}

TEST_F(ExecutiveLifeTest, ARefusedStartupStopsWhatWasStarted) {
    verifies("SWR-KRN-024", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_EQ(sut_.initialize(), Status::kOk);
    c_.answers["on_startup"] = Status::kError;
    calls_.clear();

    EXPECT_EQ(sut_.start(), Status::kError);

    EXPECT_EQ(sut_.get_failed_component(), 2U);
    EXPECT_FALSE(sut_.get_context(0U).is_running());
    EXPECT_EQ(calls_,
              (Calls{"a.on_startup", "b.on_startup", "c.on_startup", "a.on_shutdown", "b.on_shutdown"}));
    EXPECT_EQ(sut_.run_window(0U, host_), WindowOutcome::kStopped);
}

TEST_F(ExecutiveLifeTest, ARefusedStartupInsideAWindowNamesTheComponentThatRefused) {
    verifies("SWR-KRN-024", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_EQ(sut_.initialize(), Status::kOk);
    b_.answers["on_startup"] = Status::kError;

    EXPECT_EQ(sut_.start(), Status::kError);

    EXPECT_EQ(sut_.get_failed_component(), 1U);
}

TEST_F(ExecutiveLifeTest, AComponentThatHasLeftRefusesTheNextStartByItsName) {
    verifies("SWR-KRN-024", Technique::kErrorGuessing, Polarity::kViolation);
    ASSERT_EQ(sut_.initialize(), Status::kOk);
    c_.answers["on_startup"] = Status::kError;
    ASSERT_EQ(sut_.start(), Status::kError);
    ASSERT_EQ(sut_.get_failed_component(), 2U);
    ASSERT_EQ(b_.exit(Instant{}), Status::kOk);
    calls_.clear();

    EXPECT_EQ(sut_.start(), Status::kPreconditionNotMet);

    EXPECT_EQ(sut_.get_failed_component(), 1U) << "not the one of the start before";
    EXPECT_TRUE(calls_.empty()) << "nobody was started";
}

TEST_F(ExecutiveLifeTest, ARefusedActivationStopsTheWholeSystemAndLeavesTheGuiltyInError) {
    verifies("SWR-KRN-024", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_EQ(sut_.initialize(), Status::kOk);
    b_.answers["on_activated"] = Status::kUnsupported;

    EXPECT_EQ(sut_.start(), Status::kUnsupported);

    EXPECT_EQ(sut_.get_failed_component(), 1U);
    EXPECT_EQ(get_state(0U, a_), LifecycleState::kInactive);
    EXPECT_EQ(get_state(0U, b_), LifecycleState::kError);
    EXPECT_FALSE(sut_.get_context(0U).is_running() || sut_.get_context(1U).is_running());

    b_.answers.clear();
    EXPECT_EQ(sut_.start(), Status::kPreconditionNotMet) << "Error needs a reset";
    EXPECT_EQ(sut_.get_failed_component(), 1U);
    ASSERT_EQ(sut_.get_context(0U).reset_component(b_, Instant{}), Status::kOk);
    EXPECT_EQ(sut_.start(), Status::kOk);
}

TEST_F(ExecutiveLifeTest, StopReportsTheFirstFailureAndStopsEverythingAnyway) {
    verifies("SWR-KRN-024", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_EQ(sut_.initialize(), Status::kOk);
    ASSERT_EQ(sut_.start(), Status::kOk);
    c_.answers["on_deactivated"] = Status::kOutOfResources;
    a_.answers["on_shutdown"] = Status::kError;

    EXPECT_EQ(sut_.stop(), Status::kOutOfResources);

    EXPECT_FALSE(sut_.get_context(0U).is_running() || sut_.get_context(1U).is_running());
    EXPECT_EQ(get_state(1U, c_), LifecycleState::kInactive);
}

TEST_F(ExecutiveLifeTest, FinalizeIsRefusedWhileAComponentIsActiveAndReportsTheFirstFailure) {
    verifies("SWR-KRN-024", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_EQ(sut_.initialize(), Status::kOk);
    ASSERT_EQ(sut_.get_context(1U).activate_component(c_, Instant{}), Status::kOk);
    EXPECT_EQ(sut_.finalize(), Status::kPreconditionNotMet);
    ASSERT_EQ(sut_.stop(), Status::kOk);
    ASSERT_EQ(sut_.get_context(0U).activate_component(b_, Instant{}), Status::kOk);
    EXPECT_EQ(sut_.finalize(), Status::kPreconditionNotMet) << "the second component of a window";
    ASSERT_EQ(sut_.stop(), Status::kOk);
    b_.answers["on_finalize"] = Status::kError;

    EXPECT_EQ(sut_.finalize(), Status::kError);

    EXPECT_FALSE(a_.is_alive() || b_.is_alive() || c_.is_alive());
}

TEST_F(ExecutiveLifeTest, TheAbortPolicyOfTheTableIsThatOfItsContexts) {
    verifies("SWR-KRN-024", Technique::kInterface);
    auto table = table_;
    table.abort_policy = AbortPolicy::kOpenRtmCompat;
    ExecutiveFor<decltype(table)> sut{table};
    ASSERT_EQ(sut.initialize(), Status::kOk);
    ASSERT_EQ(sut.start(), Status::kOk);
    static_cast<void>(take(calls_));
    a_.answers["on_execute"] = Status::kError;

    ASSERT_EQ(sut.run_window(0U, host_), WindowOutcome::kCompleted);
    const Calls calls = take(calls_);
    ASSERT_GE(calls.size(), 3U);
    EXPECT_EQ(Calls(calls.begin(), calls.begin() + 3),
              (Calls{"a.on_execute", "a.on_deactivated", "a.on_aborting"}));
}

TEST_F(ExecutiveLifeTest, AComponentWhoseLifeHasEndedIsNotFinalizedAgain) {
    verifies("SWR-KRN-024", Technique::kErrorGuessing, Polarity::kViolation);
    ASSERT_EQ(sut_.initialize(), Status::kOk);
    ASSERT_EQ(b_.exit(Instant{}), Status::kOk);
    static_cast<void>(take(calls_));

    EXPECT_EQ(sut_.finalize(), Status::kOk);
    EXPECT_EQ(take(calls_), (Calls{"c.on_finalize", "a.on_finalize"}));
}

TEST_F(ExecutiveLifeTest, AnObserverFromWithinAnActionEndsInTheAssertion) {
    verifies("SWR-KRN-024", Technique::kErrorGuessing, Polarity::kViolation);
    ASSERT_EQ(sut_.initialize(), Status::kOk);
    ASSERT_EQ(sut_.start(), Status::kOk);
    a_.inside = [this](const std::string& action) {
        if (action == "on_execute") {
            sut_.set_observer(nullptr);
        }
    };

    EXPECT_CHECK_FAILS(static_cast<void>(sut_.run_window(0U, host_)), "executive.cpp", 5);
}

TEST_F(ExecutiveLifeTest, AnObserverFromWithinInitializeOrFinalizeEndsInTheAssertion) {
    verifies("SWR-KRN-024", Technique::kErrorGuessing, Polarity::kViolation);
    a_.inside = [this](const std::string&) { sut_.set_observer(nullptr); };

    EXPECT_CHECK_FAILS(static_cast<void>(sut_.initialize()), "executive.cpp", 5);
    a_.inside = nullptr;
    ASSERT_EQ(sut_.initialize(), Status::kOk);
    a_.inside = [this](const std::string&) { sut_.set_observer(nullptr); };
    EXPECT_CHECK_FAILS(static_cast<void>(sut_.finalize()), "executive.cpp", 5);
}

TEST_F(ExecutiveLifeTest, OperationsFromWithinAnActionAreRefused) {
    verifies("SWR-KRN-024", Technique::kErrorGuessing, Polarity::kViolation);
    std::size_t refusals = 0U;
    c_.inside = [this, &refusals](const std::string&) {
        EXPECT_EQ(sut_.initialize(), Status::kPreconditionNotMet);
        EXPECT_EQ(sut_.start(), Status::kPreconditionNotMet);
        EXPECT_EQ(sut_.stop(), Status::kPreconditionNotMet);
        EXPECT_EQ(sut_.finalize(), Status::kPreconditionNotMet);
        ++refusals;
    };

    ASSERT_EQ(sut_.initialize(), Status::kOk);
    ASSERT_EQ(sut_.start(), Status::kOk);
    EXPECT_EQ(sut_.run_window(1U, host_), WindowOutcome::kCompleted);
    ASSERT_EQ(sut_.stop(), Status::kOk);
    ASSERT_EQ(sut_.finalize(), Status::kOk);

    EXPECT_EQ(refusals, 8U);
}

TEST_F(ExecutiveLifeTest, RunningAWindowFromWithinAnActionEndsInTheAssertion) {
    verifies("SWR-KRN-024", Technique::kErrorGuessing, Polarity::kViolation);
    ASSERT_EQ(sut_.initialize(), Status::kOk);
    ASSERT_EQ(sut_.start(), Status::kOk);
    a_.inside = [this](const std::string&) { static_cast<void>(sut_.run_window(1U, host_)); };

    EXPECT_CHECK_FAILS(static_cast<void>(sut_.run_window(0U, host_)), "executive.cpp", 2);
}

TEST_F(ExecutiveLifeTest, AComponentOfAnotherWindowMayBeResetFromAnAction) {
    verifies("SWR-KRN-024", Technique::kInterface);
    ASSERT_EQ(sut_.initialize(), Status::kOk);
    ASSERT_EQ(sut_.start(), Status::kOk);
    a_.answers["on_execute"] = Status::kError;
    ASSERT_EQ(sut_.run_window(0U, host_), WindowOutcome::kCompleted);
    ASSERT_EQ(get_state(0U, a_), LifecycleState::kError);
    Status answer = Status::kError;
    c_.inside = [this, &answer](const std::string& action) {
        if (action == "on_execute") {
            answer = sut_.get_context(0U).reset_component(a_, Instant{});
        }
    };

    ASSERT_EQ(sut_.run_window(1U, host_), WindowOutcome::kCompleted);

    EXPECT_EQ(answer, Status::kOk);
    EXPECT_EQ(get_state(0U, a_), LifecycleState::kInactive);
}

TEST(ExecutiveOfNothingTest, ASystemWithoutWindowsStartsAndStops) {
    verifies("SWR-KRN-024", Technique::kBoundaryValues);
    static constexpr auto kEmpty = system(frame(1_ms));
    ExecutiveFor sut{kEmpty};

    EXPECT_EQ(sut.initialize(), Status::kOk);
    EXPECT_EQ(sut.start(), Status::kOk);
    EXPECT_EQ(sut.stop(), Status::kOk);
    EXPECT_EQ(sut.finalize(), Status::kOk);
}

TEST(ExecutiveOfNothingTest, AnExecutiveOutlivedByItsTableDoesNotCompile) {
    verifies("SWR-KRN-024", Technique::kErrorGuessing, Polarity::kViolation);
    using Table = SystemTable<0U, 0U, 0U, 0U>;

    static_assert(std::is_constructible_v<ExecutiveFor<Table>, const Table&>);
    static_assert(!std::is_constructible_v<ExecutiveFor<Table>, Table>, "a temporary table would dangle");
    SUCCEED();
}

}  // namespace
}  // namespace mamori
