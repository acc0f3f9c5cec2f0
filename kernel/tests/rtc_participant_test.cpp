// SPDX-License-Identifier: Apache-2.0
// Goal: a participant that acts for a state machine follows its own life cycle, in every combination of
// state, answer, running or stopped, and abort policy. Method: one stimulus from a fresh context for each
// combination.
#include <gtest/gtest.h>

#include <array>
#include <iostream>
#include <string>

#include "mamori/kernel/component/execution_context.hpp"
#include "mamori/kernel/component/fsm_component.hpp"
#include "mamori/trace/verifies.hpp"
#include "support/every_status.hpp"
#include "support/spy_component.hpp"

namespace mamori {
namespace {

using namespace testing_support;
using namespace verification;

constexpr std::array<FsmState, 1> kStates{{{"only"}}};
constexpr std::array<FsmMessage, 1> kMessages{{{"go"}}};
constexpr std::array<FsmTransition, 1> kTransitions{{{0U, 0U, 0U}}};
constexpr FsmTable kTable{"machine", kStates, kMessages, kTransitions, 0U};

class Machine final : public FsmComponentFor<2U> {
  public:
    explicit Machine(FsmProfile profile) : FsmComponentFor("machine", kTable, profile) {}
};

/// One stimulus for a machine whose participant acts on its one transition.
void compare_participant(char state, bool is_running, AbortPolicy policy, Status code) {
    SCOPED_TRACE(std::string("participant ") + state + (is_running ? ", running, " : ", stopped, ") +
                 get_name(code));
    Calls calls;
    SpyComponent participant{"p", calls};
    const std::array<FsmBehavior, 1> profile{{{&participant, {FsmElement::Kind::kTransition, 0U}}}};
    Machine machine{profile};
    const std::array<Component*, 2> participants{&machine, &participant};
    ContextPlan plan{1_ms};
    plan.kind = ExecutionKind::kEventDriven;
    plan.abort_policy = policy;
    ExecutionContext context;
    const auto run_event = [&] {
        EXPECT_EQ(machine.send_stimulus(0U), Status::kOk);
        const Status begun = context.begin_cycle({});
        if (begun == Status::kOk) {
            context.execute_range(0U, 2U);
            context.update_range(0U, 2U);
            context.end_cycle();
        }
        return begun;
    };
    ASSERT_EQ(machine.initialize(), Status::kOk);
    ASSERT_EQ(participant.initialize(), Status::kOk);
    ASSERT_EQ(context.attach(0, participants, plan), Status::kOk);
    ASSERT_EQ(context.start({}), Status::kOk);
    ASSERT_EQ(context.activate_component(machine, {}), Status::kOk);
    if (state == 'A' || state == 'E') {
        ASSERT_EQ(context.activate_component(participant, {}), Status::kOk);
    }
    if (state == 'E') {
        participant.answers["on_action"] = Status::kError;
        ASSERT_EQ(run_event(), Status::kOk);
    }
    if (state == 'C') {
        ASSERT_EQ(participant.exit({}), Status::kOk);
    }
    if (!is_running) {
        ASSERT_EQ(context.stop({}), Status::kOk);
    }
    participant.answers = {{"on_action", code}, {"on_error", code}, {"on_aborting", code}};
    calls.clear();

    EXPECT_EQ(run_event(), is_running ? Status::kOk : Status::kPreconditionNotMet);

    Calls expected;
    char state_after = state;
    if (is_running && state == 'A') {
        expected = {"p.on_action"};
        if (code != Status::kOk && policy == AbortPolicy::kOpenRtmCompat) {
            expected.push_back("p.on_deactivated");
        }
        if (code != Status::kOk) {
            expected.push_back("p.on_aborting");
            state_after = 'E';
        }
    }
    if (is_running && state == 'E') {
        expected = {"p.on_error"};
    }
    EXPECT_EQ(calls, expected);
    EXPECT_EQ("CIAE"[static_cast<std::size_t>(context.get_state_at(1U))], state_after);
    EXPECT_EQ(context.get_state_at(0U), LifecycleState::kActive) << "the machine goes on";
}

TEST(RtcParticipantTest, EveryCombinationOfAParticipantOfAStateMachine) {
    verifies("SWR-RTC-011", Technique::kFaultInjection, Polarity::kViolation);
    std::size_t count = 0U;
    for (const char state : {'C', 'I', 'A', 'E'}) {
        for (const bool is_running : {false, true}) {
            for (const AbortPolicy policy : {AbortPolicy::kSpecOnly, AbortPolicy::kOpenRtmCompat}) {
                for (const Status code : kEveryStatus) {
                    compare_participant(state, is_running, policy, code);
                    ++count;
                }
            }
        }
    }
    std::cout << count << " combinations compared\n";

    EXPECT_EQ(count, 96U);
}

}  // namespace
}  // namespace mamori
