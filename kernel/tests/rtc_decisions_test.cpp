// SPDX-License-Identifier: Apache-2.0
// Goal: each decision of the kernel where the standard leaves a choice or OpenRTM-aist 2.x departs from it,
// one test per decision, named D<number> as in docs/design/rtc_semantics.md#decisions. Method: two spies in
// one context; for frames, windows and ports an executive with a host whose clock is set.
#include <limits>
#include <utility>

#include "mamori/kernel/component/external_trigger.hpp"
#include "mamori/kernel/run/executive.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/trace/verifies.hpp"
#include "mamori/verification/failed_check.hpp"
#include "support/context_fixture.hpp"
#include "support/fake_host.hpp"

namespace mamori {
namespace {

using testing_support::Calls;
using testing_support::FakeHost;
using testing_support::SpyObserver;
using testing_support::take;
using verification::Polarity;
using verification::Technique;
using verification::verifies;

constexpr std::array<Duration, 1> kAlternatives{2_ms};

class RtcDecisionsTest : public testing_support::ContextFixture {
  protected:
    RtcDecisionsTest() { plan_.alternative_periods = kAlternatives; }

    /// The same participants under another plan; nothing is recorded.
    void attach_again(const ContextPlan& plan) {
        ASSERT_EQ(sut_.detach(), Status::kOk);
        ASSERT_EQ(sut_.attach(kId, participants_, plan), Status::kOk);
    }
};

TEST_F(RtcDecisionsTest, D1_ActiveToErrorCallsOnAbortingOnly) {
    verifies("SWR-RTC-011", Technique::kStateTransition, Polarity::kViolation);
    start_and_activate();
    a_.answers["on_execute"] = Status::kError;

    EXPECT_EQ(run_cycle(), (Calls{"a.on_execute", "a.on_aborting", "b.on_execute", "b.on_state_update"}));
}

TEST_F(RtcDecisionsTest, D1_UnderOpenRtmCompatOnDeactivatedComesBeforeOnAborting) {
    verifies("SWR-RTC-011", Technique::kStateTransition, Polarity::kViolation);
    plan_.abort_policy = AbortPolicy::kOpenRtmCompat;
    attach_again(plan_);
    start_and_activate();
    a_.answers["on_execute"] = Status::kError;

    EXPECT_EQ(run_cycle(), (Calls{"a.on_execute", "a.on_deactivated", "a.on_aborting", "b.on_execute",
                                  "b.on_state_update"}));
}

TEST_F(RtcDecisionsTest, D2_AFailedActivationIsTheAnswerAndNeverSeenActive) {
    verifies("SWR-RTC-011", Technique::kFaultInjection, Polarity::kViolation);
    a_.answers["on_activated"] = Status::kOutOfResources;
    a_.inside = [this](const std::string&) { EXPECT_NE(get_state(a_), LifecycleState::kActive); };

    EXPECT_EQ(sut_.activate_component(a_, now_), Status::kOutOfResources);

    EXPECT_EQ(get_state(a_), LifecycleState::kError);
}

TEST_F(RtcDecisionsTest, D3_AFailedDeactivationIsTheAnswerAndLeadsToInactive) {
    verifies("SWR-RTC-011", Technique::kFaultInjection, Polarity::kViolation);
    start_and_activate();
    a_.answers["on_deactivated"] = Status::kError;

    EXPECT_EQ(sut_.deactivate_component(a_, now_), Status::kError);

    EXPECT_EQ(get_state(a_), LifecycleState::kInactive);
    EXPECT_EQ(a_.get_last_failure().action, ComponentAction::kDeactivated);
}

TEST_F(RtcDecisionsTest, D4_NoFailureOfAnActionIsSwallowed) {
    verifies("SWR-RTC-011", Technique::kFaultInjection, Polarity::kViolation);
    start_and_activate();
    a_.answers["on_execute"] = Status::kError;
    b_.answers["on_state_update"] = Status::kError;

    run_cycle();

    EXPECT_EQ(get_state(a_), LifecycleState::kError);
    EXPECT_EQ(get_state(b_), LifecycleState::kError);
    EXPECT_EQ(a_.get_last_failure().action, ComponentAction::kExecute);
    EXPECT_EQ(b_.get_last_failure().action, ComponentAction::kStateUpdate);
}

TEST_F(RtcDecisionsTest, D5_AFailedStartupKeepsTheContextStopped) {
    verifies("SWR-RTC-011", Technique::kFaultInjection, Polarity::kViolation);
    b_.answers["on_startup"] = Status::kError;

    EXPECT_EQ(sut_.start(now_), Status::kError);

    EXPECT_FALSE(sut_.is_running());
    EXPECT_EQ(sut_.get_refusing_position().get_value(), 1U);
}

TEST_F(RtcDecisionsTest, D6_ASecondInitializeIsRefused) {
    verifies("SWR-RTC-011", Technique::kStateTransition, Polarity::kViolation);

    EXPECT_EQ(a_.initialize(), Status::kPreconditionNotMet);

    EXPECT_TRUE(calls_.empty());
}

TEST_F(RtcDecisionsTest, D7_AnActiveComponentIsNotGivenUp) {
    verifies("SWR-RTC-011", Technique::kStateTransition, Polarity::kViolation);
    start_and_activate();
    ASSERT_EQ(sut_.stop(now_), Status::kOk);

    EXPECT_EQ(sut_.detach(), Status::kPreconditionNotMet);
    EXPECT_EQ(sut_.remove_component(a_), Status::kUnsupported) << "participants change as a whole";

    EXPECT_EQ(sut_.get_participant_count(), 2U);
}

TEST_F(RtcDecisionsTest, D8_HandlesAndPositionsHaveNoOffByOne) {
    verifies("SWR-RTC-011", Technique::kBoundaryValues, Polarity::kViolation);

    EXPECT_EQ(a_.get_context(ContextHandle{kId, {}}), &sut_);
    for (const std::int32_t foreign : {kId - 1, kId + 1, -1, 0, std::numeric_limits<std::int32_t>::max()}) {
        EXPECT_EQ(a_.get_context(ContextHandle{foreign, {}}), nullptr) << foreign;
    }
    EXPECT_EQ(stranger_.get_context(ContextHandle{-1, {}}), nullptr);
    EXPECT_EQ(sut_.get_state_at(1U), LifecycleState::kInactive);
    EXPECT_CHECK_FAILS(static_cast<void>(sut_.get_state_at(2U)), "span.hpp", 1);
    EXPECT_EQ(a_.attach_context(sut_), Status::kUnsupported);
    EXPECT_EQ(a_.detach_context(ContextHandle{kId, {}}), Status::kUnsupported);
}

TEST_F(RtcDecisionsTest, D9_ASecondExitIsRefused) {
    verifies("SWR-RTC-011", Technique::kStateTransition, Polarity::kViolation);
    ASSERT_EQ(a_.exit(now_), Status::kOk);
    calls_.clear();

    EXPECT_EQ(a_.exit(now_), Status::kPreconditionNotMet);

    EXPECT_TRUE(calls_.empty());
}

TEST_F(RtcDecisionsTest, D10_WhetherItIsAliveDoesNotDependOnAContext) {
    verifies("SWR-RTC-011", Technique::kEquivalenceClasses, Polarity::kViolation);
    ASSERT_EQ(stranger_.initialize(), Status::kOk);

    EXPECT_TRUE(stranger_.is_alive()) << "it participates nowhere";
    EXPECT_TRUE(a_.is_alive());
    start_and_activate();
    bring_a_into_error();
    EXPECT_TRUE(a_.is_alive()) << "in Error too";
}

TEST_F(RtcDecisionsTest, D11_TheStateOfAStrangerIsABadParameterAndNeverCreated) {
    verifies("SWR-RTC-011", Technique::kEquivalenceClasses, Polarity::kViolation);
    ASSERT_EQ(a_.exit(now_), Status::kOk);

    EXPECT_EQ(sut_.get_component_state(stranger_).get_status(), Status::kBadParameter);
    EXPECT_EQ(sut_.get_component_state(a_).get_status(), Status::kBadParameter) << "not alive any more";
}

TEST_F(RtcDecisionsTest, D12_ARefusedRateLeadsToErrorAndTheRateStays) {
    verifies("SWR-RTC-011", Technique::kFaultInjection, Polarity::kViolation);
    start_and_activate();
    a_.answers["on_rate_changed"] = Status::kUnsupported;
    ASSERT_EQ(sut_.set_rate(500.0), Status::kOk);
    ASSERT_TRUE(sut_.apply_pending_rate());

    run_cycle();

    EXPECT_EQ(get_state(a_), LifecycleState::kError);
    EXPECT_EQ(get_state(b_), LifecycleState::kActive);
    EXPECT_DOUBLE_EQ(sut_.get_rate(), 500.0);
    EXPECT_EQ(a_.get_last_failure().action, ComponentAction::kRateChanged);
}

TEST_F(RtcDecisionsTest, D13_AContextWhoseComponentsAreAllInactiveGoesOnTicking) {
    verifies("SWR-RTC-011", Technique::kStateTransition, Polarity::kViolation);
    ASSERT_EQ(sut_.start(now_), Status::kOk);

    for (int window = 0; window < 3; ++window) {
        EXPECT_TRUE(sut_.take_turn());
        calls_.clear();
        EXPECT_EQ(run_cycle(), Calls{});
    }
    EXPECT_TRUE(sut_.is_running());
}

TEST_F(RtcDecisionsTest, D14_ThePeriodicContextCallsNeitherOnActionNorOnModeChangedOfAPlainComponent) {
    verifies("SWR-RTC-011", Technique::kInterface, Polarity::kViolation);
    start_and_activate();

    EXPECT_EQ(run_cycle(), (Calls{"a.on_execute", "b.on_execute", "a.on_state_update", "b.on_state_update"}));
}

TEST_F(RtcDecisionsTest, D14_TheEventDrivenContextCallsNoDataFlowAction) {
    verifies("SWR-RTC-011", Technique::kInterface, Polarity::kViolation);
    ContextPlan plan{1_ms};
    plan.kind = ExecutionKind::kEventDriven;
    attach_again(plan);
    start_and_activate();

    EXPECT_EQ(run_cycle(), Calls{}) << "actions come with events: fsm_component_test.cpp";
}

TEST_F(RtcDecisionsTest, D15_ActionsCannotThrow) {
    verifies("SWR-RTC-011", Technique::kInterface, Polarity::kViolation);

    EXPECT_TRUE(noexcept(a_.on_execute({})));
    EXPECT_TRUE(noexcept(a_.on_initialize()));
    EXPECT_TRUE(noexcept(a_.on_action({})));
    EXPECT_TRUE(noexcept(sut_.execute(0U)));
}

/// Writes the number of its cycle, and -1 when it is aborted.
class Writer final : public Component {
  public:
    constexpr Writer() noexcept : Component("writer") {}
    OutPort<std::int32_t> out{"out"};
    using Ports = mamori::Ports<&Writer::out>;

    Status answer{Status::kOk};
    bool is_writing_in_aborting{false};
    std::int32_t cycle{0};

    Status on_execute(ContextHandle) noexcept override {
        ++cycle;
        out.write(cycle);
        return answer;
    }
    Status on_aborting(ContextHandle) noexcept override {
        if (is_writing_in_aborting) {
            out.write(-1);
        }
        return Status::kOk;
    }
};

auto describe(Writer& writer) {
    return mamori::system(mamori::frame(1_ms),
                          mamori::window("only", 0_us, 500_us, mamori::budget(100_us), mamori::run(writer)));
}

/// A system of one window.
class RtcDecisionsSystemTest : public ::testing::Test {
  protected:
    void SetUp() override {
        executive_.set_observer(&observer_);
        ASSERT_EQ(executive_.initialize(), Status::kOk);
        ASSERT_EQ(executive_.start(), Status::kOk);
    }
    WindowOutcome run_frame(Instant release) {
        host_.now = host_.now < release ? release : host_.now;
        return executive_.run_window(0U, release, host_);
    }
    Writer writer_;
    decltype(describe(std::declval<Writer&>())) table_{describe(writer_)};
    ExecutiveFor<decltype(table_)> executive_{table_};
    SpyObserver observer_;
    FakeHost host_;
};

TEST_F(RtcDecisionsSystemTest, D16_CyclesFollowThePlannedInstantsAndDoNotDrift) {
    verifies("SWR-RTC-011", Technique::kBoundaryValues, Polarity::kViolation);
    host_.durations[{0U, WindowHost::Pass::kExecute}] = 70_us;

    for (std::int64_t frame = 0; frame < 3; ++frame) {
        const Instant release = Instant{} + 1_ms * frame;
        EXPECT_EQ(run_frame(release), WindowOutcome::kCompleted);
        EXPECT_EQ(writer_.out.get_published(), frame + 1);
    }

    EXPECT_EQ(host_.deadlines.back(), Instant{} + 2_ms + 100_us);
}

TEST_F(RtcDecisionsSystemTest, D17_AMissedDeadlineIsReportedAndItsOutputsThrownAway) {
    verifies("SWR-RTC-011", Technique::kFaultInjection, Polarity::kViolation);
    host_.durations[{0U, WindowHost::Pass::kExecute}] = 101_us;

    EXPECT_EQ(run_frame(Instant{}), WindowOutcome::kOverrun);

    EXPECT_EQ(writer_.out.get_sequence(), 0U);
    EXPECT_EQ(observer_.heard.back(), "overrun window 0 component 0 @100000");
}

TEST_F(RtcDecisionsTest, D18_ThereIsNoDefaultRate) {
    verifies("SWR-RTC-011", Technique::kBoundaryValues, Polarity::kViolation);
    ExecutionContext context;
    const std::array<Component*, 1> participants{&stranger_};

    EXPECT_EQ(context.attach(0, participants, ContextPlan{}), Status::kBadParameter);
    EXPECT_LT(context.get_rate(), 0.0);
}

TEST_F(RtcDecisionsTest, D19_AnActivationIsSynchronous) {
    verifies("SWR-RTC-011", Technique::kStateTransition, Polarity::kViolation);
    ASSERT_EQ(sut_.start(now_), Status::kOk);
    calls_.clear();

    EXPECT_EQ(sut_.activate_component(a_, now_), Status::kOk);
    EXPECT_EQ(take(calls_), Calls{"a.on_activated"}) << "before the call returns, with no cycle in between";
    EXPECT_EQ(get_state(a_), LifecycleState::kActive);
    EXPECT_EQ(sut_.deactivate_component(a_, now_), Status::kOk);

    EXPECT_EQ(take(calls_), Calls{"a.on_deactivated"});
}

TEST_F(RtcDecisionsTest, D20_BetweenTwoCyclesThereIsAMomentInWhichNothingActs) {
    verifies("SWR-RTC-011", Technique::kInterface, Polarity::kViolation);
    start_and_activate();
    a_.inside = [this](const std::string&) { EXPECT_TRUE(sut_.is_busy()); };

    ASSERT_EQ(sut_.begin_cycle(now_), Status::kOk);
    sut_.execute_range(0U, 2U);
    EXPECT_TRUE(sut_.is_busy()) << "between the passes too";
    sut_.update_range(0U, 2U);
    sut_.end_cycle();

    EXPECT_FALSE(sut_.is_busy()) << "parameters may be switched here";
}

TEST_F(RtcDecisionsSystemTest, D21_OutputsLeaveAfterTheSecondPassWithWhatOnAbortingWroteLast) {
    verifies("SWR-RTC-011", Technique::kStateTransition, Polarity::kViolation);
    writer_.answer = Status::kError;
    writer_.is_writing_in_aborting = true;

    EXPECT_EQ(run_frame(Instant{}), WindowOutcome::kCompleted);

    EXPECT_EQ(writer_.out.get_published(), -1) << "the safe value replaces that of the failed action";
    EXPECT_EQ(writer_.out.get_sequence(), 1U);
}

TEST_F(RtcDecisionsTest, D22_TicksAreCountedAndNeverLost) {
    verifies("SWR-RTC-011", Technique::kErrorGuessing, Polarity::kViolation);
    ExternalTrigger trigger{2U};
    ContextPlan plan{1_ms};
    plan.kind = ExecutionKind::kOther;
    plan.trigger = &trigger;
    attach_again(plan);
    trigger.tick();
    start_and_activate();
    EXPECT_FALSE(sut_.take_turn()) << "a tick while Stopped is ignored";
    EXPECT_EQ(trigger.get_ignored_count(), 1U);
    trigger.tick();
    a_.inside = [&trigger](const std::string& action) {
        if (action == "on_execute") {
            trigger.tick();
        }
    };

    EXPECT_TRUE(sut_.take_turn());
    run_cycle();
    a_.inside = nullptr;
    EXPECT_TRUE(sut_.take_turn()) << "a tick during a cycle is served by the next one";
    run_cycle();
    EXPECT_FALSE(sut_.take_turn());
    for (int tick = 0; tick < 3; ++tick) {
        trigger.tick();
    }

    EXPECT_TRUE(sut_.take_turn());
    EXPECT_TRUE(sut_.take_turn());
    EXPECT_FALSE(sut_.take_turn());
    EXPECT_EQ(trigger.get_overflow_count(), 1U);
}

}  // namespace
}  // namespace mamori
