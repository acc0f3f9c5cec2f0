// SPDX-License-Identifier: Apache-2.0
// Goal: a state machine moves through its table, in its context's cycle, and those that act on a state or a
// transition are called for exit, transition and entry. Method: a door with two spies beside it; each answer
// of send_stimulus; failures and cut-offs in each phase; each rule of the table.
#include "mamori/kernel/component/fsm_component.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <type_traits>
#include <vector>

#include "mamori/kernel/component/execution_context.hpp"
#include "mamori/kernel/component/fsm_check.hpp"
#include "mamori/trace/verifies.hpp"
#include "support/spy_component.hpp"

namespace mamori {
namespace {

using namespace testing_support;
using namespace verification;

enum : FsmIndex { kClosed, kOpen, kLocked };
enum : FsmIndex { kPush, kPull, kTurnKey };

bool is_right_key(const FsmComponent&, const FsmEvent& event) noexcept {
    return event.argument == 42;
}

constexpr std::array<FsmState, 3> kStates{{{"closed"}, {"open"}, {"locked"}}};
constexpr std::array<FsmMessage, 3> kMessages{{{"push"}, {"pull"}, {"turn key", "TimedLong"}}};
constexpr std::array<FsmTransition, 5> kTransitions{{
    {kClosed, kPush, kOpen},
    {kOpen, kPull, kClosed},
    {kClosed, kTurnKey, kLocked, &is_right_key},
    {kLocked, kTurnKey, kClosed, &is_right_key},
    {kOpen, kPush, kOpen},
}};
constexpr FsmTable kDoor{"door", kStates, kMessages, kTransitions, kClosed};
MAMORI_CHECK_FSM(kDoor);

class SpyDoor final : public SpyActions<FsmComponentFor<4U>> {
  public:
    SpyDoor(Calls& calls, const FsmTable& table, FsmProfile profile)
        : SpyActions(calls, static_cast<const char*>("door"), std::cref(table), profile) {}
};

class FsmComponentTest : public ::testing::Test {
  protected:
    static constexpr std::int32_t kId = 3;
    void SetUp() override {
        plan_.kind = ExecutionKind::kEventDriven;
        plan_.events_per_cycle = 2U;
        for (Component* component : participants_) {
            ASSERT_EQ(component->initialize(), Status::kOk);
        }
        ASSERT_EQ(context_.attach(kId, participants_, plan_), Status::kOk);
        ASSERT_EQ(context_.start(now_), Status::kOk);
        for (Component* component : participants_) {
            ASSERT_EQ(context_.activate_component(*component, now_), Status::kOk);
        }
        calls_.clear();
    }
    Calls run_cycle() {
        EXPECT_EQ(context_.begin_cycle(now_), Status::kOk);
        context_.execute_range(0U, participants_.size());
        context_.update_range(0U, participants_.size());
        context_.end_cycle();
        return take(calls_);
    }
    void send(FsmIndex message, std::int64_t argument = 0) {
        ASSERT_EQ(door_.send_stimulus(message, {}, argument), Status::kOk);
    }
    LifecycleState get_state(const Component& component) const {
        return context_.get_component_state(component).get_value();
    }

    Calls calls_;
    SpyComponent bell_{"bell", calls_};
    SpyComponent lamp_{"lamp", calls_};
    SpyComponent stranger_{"stranger", calls_};
    std::array<FsmBehavior, 4> profile_{{
        {&bell_, {FsmElement::Kind::kState, kClosed}},
        {&lamp_, {FsmElement::Kind::kState, kOpen}},
        {&lamp_, {FsmElement::Kind::kTransition, 0U}},
        {&bell_, {FsmElement::Kind::kTransition, 2U}},
    }};
    SpyDoor door_{calls_, kDoor, profile_};
    std::array<Component*, 3> participants_{&door_, &bell_, &lamp_};
    ContextPlan plan_{1_ms};
    Instant now_{1000};
    ExecutionContext context_;
};

TEST_F(FsmComponentTest, AStimulusTakesTheTransitionInTheNextCycle) {
    verifies("SWR-RTC-006");
    EXPECT_STREQ(door_.get_current_state_name(), "closed");

    send(kPush);
    EXPECT_TRUE(calls_.empty()) << "served in the window of the context";
    EXPECT_EQ(door_.get_current_state(), kClosed);

    EXPECT_EQ(run_cycle(), (Calls{"bell.on_action", "lamp.on_action", "lamp.on_action"}));
    EXPECT_EQ(door_.get_current_state(), kOpen);
    EXPECT_EQ(run_cycle(), Calls{}) << "no event, no action";
}

TEST_F(FsmComponentTest, ActionsComeForTheExitTheTransitionAndTheEntry) {
    verifies("SWR-RTC-006", Technique::kStateTransition);
    std::vector<FsmStep::Phase> phases;
    std::vector<FsmIndex> states;
    const auto look = [&](const std::string&) {
        phases.push_back(door_.get_step().phase);
        states.push_back(door_.get_current_state());
        EXPECT_EQ(door_.get_step().transition, 0U);
        EXPECT_EQ(door_.get_step().event.argument, 7);
    };
    bell_.inside = look;
    lamp_.inside = look;
    send(kPush, 7);

    run_cycle();

    EXPECT_EQ(phases, (std::vector<FsmStep::Phase>{FsmStep::Phase::kExit, FsmStep::Phase::kTransition,
                                                   FsmStep::Phase::kEntry}));
    EXPECT_EQ(states, (std::vector<FsmIndex>{kClosed, kClosed, kOpen}));
    EXPECT_EQ(door_.get_step().phase, FsmStep::Phase::kNone);
    EXPECT_EQ(bell_.handles.back().id, kId);
}

TEST_F(FsmComponentTest, AnActionOfATransitionBelongsToTheComponentThatActs) {
    verifies("SWR-RTC-006", Technique::kErrorGuessing);
    std::vector<std::size_t> positions;
    const auto look = [&](const std::string&) {
        positions.push_back(context_.get_acting_position().get_value());
    };
    bell_.inside = look;
    lamp_.inside = look;
    send(kPush);

    run_cycle();

    EXPECT_EQ(positions, (std::vector<std::size_t>{1U, 2U, 2U})) << "not to the state machine at position 0";
}

TEST_F(FsmComponentTest, ATransitionToTheSameStateLeavesAndEntersIt) {
    verifies("SWR-RTC-006", Technique::kBoundaryValues);
    send(kPush);
    run_cycle();
    send(kPush);

    EXPECT_EQ(run_cycle(), (Calls{"lamp.on_action", "lamp.on_action"}));
    EXPECT_EQ(door_.get_current_state(), kOpen);
}

TEST_F(FsmComponentTest, AMessageWithoutATransitionIsUsedUpWithoutAnEffect) {
    verifies("SWR-RTC-006", Technique::kEquivalenceClasses);
    send(kPull);

    EXPECT_EQ(run_cycle(), Calls{});

    EXPECT_EQ(door_.get_current_state(), kClosed);
    EXPECT_EQ(door_.get_ignored_count(), 1U);
    EXPECT_EQ(door_.get_queue().get_size(), 0U);
}

TEST_F(FsmComponentTest, AGuardDecidesByTheArgument) {
    verifies("SWR-RTC-006", Technique::kEquivalenceClasses);
    send(kTurnKey, 41);
    EXPECT_EQ(run_cycle(), Calls{});
    EXPECT_EQ(door_.get_current_state(), kClosed);

    send(kTurnKey, 42);
    EXPECT_EQ(run_cycle(), (Calls{"bell.on_action", "bell.on_action"}));
    EXPECT_EQ(door_.get_current_state(), kLocked);
}

TEST_F(FsmComponentTest, ACycleTakesNoMoreEventsThanItsBound) {
    verifies("SWR-RTC-006", Technique::kBoundaryValues);
    send(kPush);
    send(kPull);
    send(kPull);
    send(kPush);

    run_cycle();
    EXPECT_EQ(door_.get_current_state(), kClosed);
    EXPECT_EQ(door_.get_queue().get_size(), 2U) << "two of four";
    run_cycle();

    EXPECT_EQ(door_.get_current_state(), kOpen);
    EXPECT_EQ(door_.get_ignored_count(), 1U) << "the second pull counts as an event";
}

TEST_F(FsmComponentTest, AStimulusFromAnActionIsServedAfterTheTransition) {
    verifies("SWR-RTC-006", Technique::kErrorGuessing);
    lamp_.inside = [this](const std::string&) {
        if (door_.get_step().phase == FsmStep::Phase::kEntry && door_.get_queue().get_size() == 0U) {
            EXPECT_EQ(door_.send_stimulus(kPull), Status::kOk);
            EXPECT_EQ(door_.get_current_state(), kOpen);
        }
    };
    send(kPush);

    run_cycle();

    EXPECT_EQ(door_.get_current_state(), kClosed);
}

TEST_F(FsmComponentTest, AnActivationBeginsInTheInitialStateWithAnEmptyQueue) {
    verifies("SWR-RTC-006", Technique::kStateTransition);
    send(kPush);
    run_cycle();
    send(kPull);
    ASSERT_EQ(context_.deactivate_component(door_, now_), Status::kOk);
    EXPECT_EQ(door_.get_current_state(), kOpen) << "to be looked at until the next begin";

    ASSERT_EQ(context_.activate_component(door_, now_), Status::kOk);

    EXPECT_EQ(door_.get_current_state(), kClosed);
    EXPECT_EQ(door_.get_queue().get_size(), 0U);
}

TEST_F(FsmComponentTest, WhatToolsAskIsAnsweredAndWhatIsStaticIsUnsupported) {
    verifies("SWR-RTC-006", Technique::kInterface);

    EXPECT_EQ(door_.get_fsm_profile().size(), 4U);
    EXPECT_STREQ(door_.get_fsm_structure().name, "door");
    EXPECT_STREQ(door_.get_fsm_structure().messages[kTurnKey].data_type, "TimedLong");
    for (FsmIndex message = kPush; message <= kTurnKey; ++message) {
        const Result<FsmIndex> found = door_.find_message(kMessages[message].name);
        ASSERT_TRUE(found.has_value()) << message;
        EXPECT_EQ(found.get_value(), message);
    }
    EXPECT_EQ(door_.find_message("turn").get_status(), Status::kBadParameter);
    EXPECT_EQ(door_.find_message(nullptr).get_status(), Status::kBadParameter);
    EXPECT_EQ(door_.set_fsm_profile({}), Status::kUnsupported);
    EXPECT_EQ(door_.set_fsm_structure(kDoor), Status::kUnsupported);
    EXPECT_EQ(door_.get_queue().get_capacity(), 4U);
}

TEST_F(FsmComponentTest, TheContextOfAStimulusIsItsOwnOrLeftToTheMachine) {
    verifies("SWR-RTC-006", Technique::kEquivalenceClasses);

    EXPECT_EQ(door_.send_stimulus(kPush, ContextHandle{-1, {}}), Status::kOk);
    EXPECT_EQ(door_.send_stimulus(kPush, ContextHandle{kId, {}}), Status::kOk);
    EXPECT_EQ(door_.get_queue().get_size(), 2U);
}

TEST_F(FsmComponentTest, AStimulusThatCannotBeTakenIsRefused) {
    verifies("SWR-RTC-006", Technique::kEquivalenceClasses, Polarity::kViolation);
    SpyDoor free{calls_, kDoor, {}};

    EXPECT_EQ(door_.send_stimulus(3U), Status::kBadParameter);
    EXPECT_EQ(door_.send_stimulus(kPush, ContextHandle{kId + 1, {}}), Status::kBadParameter);
    EXPECT_EQ(door_.send_stimulus(kPush, ContextHandle{-2, {}}), Status::kBadParameter);
    EXPECT_EQ(free.send_stimulus(kPush), Status::kPreconditionNotMet);
    for (const std::int32_t id : {-2, 0, kId}) {
        EXPECT_EQ(free.send_stimulus(kPush, ContextHandle{id, {}}), Status::kBadParameter) << id;
    }
    for (int i = 0; i < 4; ++i) {
        send(kPush);
    }
    EXPECT_EQ(door_.send_stimulus(kPush), Status::kOutOfResources);
    EXPECT_EQ(door_.get_queue().get_refused_count(), 1U);
    ASSERT_EQ(context_.deactivate_component(door_, now_), Status::kOk);
    EXPECT_EQ(door_.send_stimulus(kPush), Status::kPreconditionNotMet) << "not Active";
}

TEST_F(FsmComponentTest, AMachineFitsOnlyIntoAnEventDrivenContextThatHasItsWholeProfile) {
    verifies("SWR-RTC-006", Technique::kEquivalenceClasses, Polarity::kViolation);
    const auto attach = [&](const FsmTable& table, FsmBehavior behavior, ExecutionKind kind) {
        const std::array<FsmBehavior, 1> profile{behavior};
        SpyDoor door{calls_, table, profile};
        const std::array<Component*, 2> participants{&stranger_, &door};
        ExecutionContext context;
        ContextPlan plan{1_ms};
        plan.kind = kind;
        const Status result = context.attach(0, participants, plan);
        if (result == Status::kOk) {
            EXPECT_EQ(context.detach(), Status::kOk);
        }
        return result;
    };
    constexpr ExecutionKind kKind = ExecutionKind::kEventDriven;
    constexpr FsmElement kLast{FsmElement::Kind::kTransition, 4U};
    FsmTable broken = kDoor;
    broken.initial = 3U;

    EXPECT_EQ(attach(kDoor, {&stranger_, kLast}, kKind), Status::kOk);
    EXPECT_EQ(attach(kDoor, {&stranger_, kLast}, ExecutionKind::kPeriodic), Status::kPreconditionNotMet);
    EXPECT_EQ(attach(broken, {&stranger_, kLast}, kKind), Status::kBadParameter);
    EXPECT_EQ(attach(kDoor, {nullptr, kLast}, kKind), Status::kBadParameter);
    EXPECT_EQ(attach(kDoor, {&bell_, kLast}, kKind), Status::kBadParameter) << "of another context";
    EXPECT_EQ(attach(kDoor, {&stranger_, {FsmElement::Kind::kTransition, 5U}}, kKind), Status::kBadParameter);
    EXPECT_EQ(attach(kDoor, {&stranger_, {FsmElement::Kind::kState, 3U}}, kKind), Status::kBadParameter);
    EXPECT_EQ(attach(kDoor, {&stranger_, {FsmElement::Kind::kState, 2U}}, kKind), Status::kOk)
        << "the refused ones took nobody";
}

TEST_F(FsmComponentTest, AParticipantThatFailsGoesToErrorAndTheTransitionIsFinished) {
    verifies("SWR-RTC-004", Technique::kFaultInjection, Polarity::kViolation);
    lamp_.answers["on_action"] = Status::kError;
    send(kPush);
    send(kPull);

    EXPECT_EQ(run_cycle(), (Calls{"bell.on_action", "lamp.on_action", "lamp.on_aborting", "lamp.on_error",
                                  "lamp.on_error", "bell.on_action"}))
        << "on_error comes in the place of each further on_action";

    EXPECT_EQ(get_state(lamp_), LifecycleState::kError);
    EXPECT_EQ(get_state(door_), LifecycleState::kActive);
    EXPECT_EQ(door_.get_current_state(), kClosed);
    EXPECT_EQ(lamp_.get_last_failure().action, ComponentAction::kAction);
    EXPECT_EQ(run_cycle(), Calls{}) << "no event, no invocation";
}

TEST_F(FsmComponentTest, AnInactiveParticipantIsLeftOut) {
    verifies("SWR-RTC-006", Technique::kStateTransition);
    ASSERT_EQ(context_.deactivate_component(lamp_, now_), Status::kOk);
    calls_.clear();
    send(kPush);

    EXPECT_EQ(run_cycle(), Calls{"bell.on_action"});
}

TEST_F(FsmComponentTest, ATransitionThatWasCutOffTakesTheMachineToError) {
    verifies("SWR-RTC-006", Technique::kFaultInjection, Polarity::kViolation);
    // What an executive does when the host has given the work up; here the action returns at last.
    lamp_.inside = [this](const std::string&) { context_.end_cycle(); };
    send(kPush);
    send(kPull);
    ASSERT_EQ(context_.begin_cycle(now_), Status::kOk);
    context_.execute_range(0U, participants_.size());
    EXPECT_EQ(take(calls_), (Calls{"bell.on_action", "lamp.on_action"})) << "no further action";
    lamp_.inside = nullptr;

    EXPECT_EQ(run_cycle(), Calls{"door.on_aborting"});
    EXPECT_EQ(get_state(door_), LifecycleState::kError);
    EXPECT_EQ(door_.get_last_failure().action, ComponentAction::kAction);
    EXPECT_EQ(run_cycle(), Calls{"door.on_error"}) << "once in each cycle";
    ASSERT_EQ(context_.reset_component(door_, now_), Status::kOk);
    ASSERT_EQ(context_.activate_component(door_, now_), Status::kOk);
    send(kPush);
    calls_.clear();

    EXPECT_EQ(run_cycle(), (Calls{"bell.on_action", "lamp.on_action", "lamp.on_action"}));
}

/// The machine takes part in its own behaviour.
TEST_F(FsmComponentTest, AMachineThatFailsItselfFinishesTheTransitionAndTakesNoFurtherEvent) {
    verifies("SWR-RTC-004", Technique::kFaultInjection, Polarity::kViolation);
    const auto calls_of = [this](SpyDoor& door) {
        ExecutionContext context;
        const std::array<Component*, 1> participants{&door};
        EXPECT_EQ(door.initialize(), Status::kOk);
        EXPECT_EQ(context.attach(0, participants, plan_), Status::kOk);
        EXPECT_EQ(context.start(now_), Status::kOk);
        EXPECT_EQ(context.activate_component(door, now_), Status::kOk);
        EXPECT_EQ(door.send_stimulus(kPush), Status::kOk);
        EXPECT_EQ(door.send_stimulus(kPull), Status::kOk);
        calls_.clear();
        EXPECT_EQ(context.begin_cycle(now_), Status::kOk);
        context.execute(0U);
        context.end_cycle();
        return take(calls_);
    };
    std::array<FsmBehavior, 2> profile{};
    SpyDoor door{calls_, kDoor, profile};
    profile[0] = {&door, {FsmElement::Kind::kState, kClosed}};
    profile[1] = {&door, {FsmElement::Kind::kState, kOpen}};
    door.answers["on_action"] = Status::kOutOfResources;

    EXPECT_EQ(calls_of(door), (Calls{"door.on_action", "door.on_aborting", "door.on_error"}));

    EXPECT_EQ(door.get_current_state(), kOpen);
    EXPECT_EQ(door.get_queue().get_size(), 1U);
}

TEST(FsmTableTest, EachRuleIsFoundAtItsRow) {
    verifies("SWR-RTC-006", Technique::kBoundaryValues, Polarity::kViolation);
    const auto find = [](auto change) {
        static std::array<FsmState, 3> states;
        static std::array<FsmMessage, 3> messages;
        static std::array<FsmTransition, 5> transitions;
        states = kStates;
        messages = kMessages;
        transitions = kTransitions;
        FsmTable table{"door", states, messages, transitions, kClosed};
        change(table, states, messages, transitions);
        const FsmFinding finding = check(table);
        return std::make_pair(finding.rule, finding.element);
    };
    using Found = std::pair<FsmRule, std::size_t>;
    EXPECT_EQ(find([](auto&, auto&, auto&, auto&) {}), Found(FsmRule::kNone, 0U));
    EXPECT_EQ(find([](auto& table, auto&, auto&, auto&) { table.name = nullptr; }),
              Found(FsmRule::kTableNameMissing, 0U));
    EXPECT_EQ(find([](auto& table, auto&, auto&, auto&) { table.states = {}; }),
              Found(FsmRule::kNoState, 0U));
    EXPECT_EQ(find([](auto&, auto& states, auto&, auto&) { states[2].name = nullptr; }),
              Found(FsmRule::kNameMissing, 2U));
    EXPECT_EQ(find([](auto&, auto&, auto& messages, auto&) { messages[1].name = ""; }),
              Found(FsmRule::kNameMissing, 4U));
    EXPECT_EQ(find([](auto&, auto& states, auto&, auto&) { states[0].name = ""; }),
              Found(FsmRule::kNameMissing, 0U));
    EXPECT_EQ(find([](auto&, auto&, auto& messages, auto&) { messages[2].name = nullptr; }),
              Found(FsmRule::kNameMissing, 5U));
    EXPECT_EQ(find([](auto&, auto& states, auto&, auto&) { states[1].name = "closed"; }),
              Found(FsmRule::kNameTwice, 1U));
    EXPECT_EQ(find([](auto&, auto&, auto& messages, auto&) { messages[2].name = "push"; }),
              Found(FsmRule::kNameTwice, 5U));
    EXPECT_EQ(find([](auto& table, auto&, auto&, auto&) { table.initial = 3U; }),
              Found(FsmRule::kInitialUnknown, 0U));
    EXPECT_EQ(find([](auto&, auto&, auto&, auto& rows) { rows[0].source = 3U; }),
              Found(FsmRule::kTransitionUnknown, 0U));
    EXPECT_EQ(find([](auto&, auto&, auto&, auto& rows) { rows[1].target = 3U; }),
              Found(FsmRule::kTransitionUnknown, 1U));
    EXPECT_EQ(find([](auto&, auto&, auto&, auto& rows) { rows[4].message = 3U; }),
              Found(FsmRule::kTransitionUnknown, 4U));
    EXPECT_EQ(find([](auto&, auto&, auto&, auto& rows) { rows[4] = rows[0]; }),
              Found(FsmRule::kTransitionShadowed, 4U));
    EXPECT_EQ(find([](auto&, auto&, auto&, auto& rows) { rows[4] = rows[2]; }), Found(FsmRule::kNone, 0U))
        << "one behind a guard may still be taken";
    EXPECT_EQ(find([](auto&, auto&, auto&, auto& rows) { rows[2].source = kLocked; }),
              Found(FsmRule::kStateUnreachable, 2U));
}

TEST(FsmTableTest, TheNumberOfStatesIsBounded) {
    verifies("SWR-RTC-006", Technique::kBoundaryValues, Polarity::kViolation);
    static std::array<std::array<char, 3>, kMaxFsmStates + 1U> names;
    static std::array<FsmState, kMaxFsmStates + 1U> states;
    static std::array<FsmTransition, kMaxFsmStates> transitions;
    static constexpr std::array<FsmMessage, 1> kNext{{{"next"}}};
    for (std::size_t i = 0U; i < states.size(); ++i) {
        names[i] = {static_cast<char>('a' + i / 10U), static_cast<char>('0' + i % 10U), '\0'};
        states[i].name = names[i].data();
    }
    // Listed backwards, so that each pass of the check reaches one state only.
    for (std::size_t i = 0U; i < transitions.size(); ++i) {
        const auto source = static_cast<FsmIndex>(transitions.size() - 1U - i);
        transitions[i] = {source, 0U, static_cast<FsmIndex>(source + 1U)};
    }
    FsmTable table{"chain", states, kNext, Span<const FsmTransition>{transitions}.subspan(1U, 63U), 0U};

    EXPECT_EQ(check(table).rule, FsmRule::kTooManyStates);
    EXPECT_EQ(check(table).element, kMaxFsmStates);
    table.states = Span<const FsmState>{states}.subspan(0U, kMaxFsmStates);
    EXPECT_EQ(check(table).rule, FsmRule::kNone);
}

}  // namespace
}  // namespace mamori
