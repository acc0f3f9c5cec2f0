// SPDX-License-Identifier: Apache-2.0
// Goal: the rules (R), decisions (D) and error paths (E) of the object model that need more than the
// scenarios of rtc_scenario_test.cpp: numbers, handles, events, modes, triggers, windows and ports. Method:
// two spies in one context; for windows and ports an executive with a host whose clock is set.
#include <limits>
#include <utility>

#include "mamori/kernel/component/external_trigger.hpp"
#include "mamori/kernel/component/fsm_component.hpp"
#include "mamori/kernel/component/multi_mode.hpp"
#include "mamori/kernel/run/executive.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/trace/verifies.hpp"
#include "mamori/verification/failed_check.hpp"
#include "support/context_fixture.hpp"
#include "support/fake_host.hpp"

namespace mamori {
namespace {

using namespace testing_support;
using namespace verification;

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

    /// The same participants under another plan; nothing is recorded.
    void attach_again(const ContextPlan& plan) {
        ASSERT_EQ(sut_.detach(), Status::kOk);
        ASSERT_EQ(sut_.attach(kId, participants_, plan), Status::kOk);
    }
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
    EXPECT_STREQ(get_name(static_cast<ComponentAction>(200U)), "invalid_action");
}

TEST_F(RtcRulesTest, R1_FailuresAreCodesAndNotSpecialValues) {
    verifies("SWR-RTC-011", Technique::kInterface, Polarity::kViolation);
    const ExecutionContext unattached;

    EXPECT_LT(unattached.get_rate(), 0.0) << "the standard's own form for a rate";
    EXPECT_EQ(sut_.get_component_state(stranger_).get_status(), Status::kBadParameter);
    EXPECT_EQ(a_.get_context(ContextHandle{99, {}}), nullptr) << "the standard's own form for a reference";
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

TEST_F(RtcRulesTest, E20_EveryActionIsGivenTheHandleOfItsContext) {
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

TEST_F(RtcRulesTest, D8_HandlesAndPositionsHaveNoOffByOne) {
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

TEST_F(RtcRulesTest, D15_ActionsCannotThrow) {
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
    OutPort<std::int32_t> out{*this, "out"};
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
class RtcRulesSystemTest : public ::testing::Test {
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

TEST_F(RtcRulesSystemTest, D16_CyclesFollowThePlannedInstantsAndDoNotDrift) {
    verifies("SWR-RTC-011", Technique::kBoundaryValues, Polarity::kViolation);
    host_.durations[{0U, WindowHost::Pass::kExecute}] = 70_us;

    for (std::int64_t frame = 0; frame < 3; ++frame) {
        const Instant release = Instant{} + 1_ms * frame;
        EXPECT_EQ(run_frame(release), WindowOutcome::kCompleted);
        EXPECT_EQ(writer_.out.get_published(), frame + 1);
    }

    EXPECT_EQ(host_.deadlines.back(), Instant{} + 2_ms + 100_us);
}

TEST_F(RtcRulesSystemTest, D17_AMissedDeadlineIsReportedAndItsOutputsThrownAway) {
    verifies("SWR-RTC-011", Technique::kFaultInjection, Polarity::kViolation);
    host_.durations[{0U, WindowHost::Pass::kExecute}] = 101_us;

    EXPECT_EQ(run_frame(Instant{}), WindowOutcome::kOverrun);

    EXPECT_EQ(writer_.out.get_sequence(), 0U);
    EXPECT_EQ(observer_.heard.back(), "overrun window 0 component 0 @100000");
}

TEST_F(RtcRulesTest, D18_ThereIsNoDefaultRate) {
    verifies("SWR-RTC-011", Technique::kBoundaryValues, Polarity::kViolation);
    ExecutionContext context;
    const std::array<Component*, 1> participants{&stranger_};

    EXPECT_EQ(context.attach(0, participants, ContextPlan{}), Status::kBadParameter);
    EXPECT_LT(context.get_rate(), 0.0);
}

TEST_F(RtcRulesSystemTest, D21_OutputsLeaveAfterTheSecondPassWithWhatOnAbortingWroteLast) {
    verifies("SWR-RTC-011", Technique::kStateTransition, Polarity::kViolation);
    writer_.answer = Status::kError;
    writer_.is_writing_in_aborting = true;

    EXPECT_EQ(run_frame(Instant{}), WindowOutcome::kCompleted);

    EXPECT_EQ(writer_.out.get_published(), -1) << "the safe value replaces that of the failed action";
    EXPECT_EQ(writer_.out.get_sequence(), 1U);
}

TEST_F(RtcRulesTest, D22_TicksAreCountedAndNeverLost) {
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
