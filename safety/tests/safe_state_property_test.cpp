// SPDX-License-Identifier: Apache-2.0
// Goal: what must never happen, never happens. Method: the whole state space of the machine is searched: from
// every situation that can be reached, every combination of inputs is tried, and each step is judged by rules
// that are written without looking at the table.
#include <cstdint>
#include <set>
#include <tuple>
#include <vector>

#include "mamori/safety/reaction/safe_state_machine.hpp"
#include "mamori/safety/reaction/stop_outputs.hpp"
#include "mamori/trace/verifies.hpp"

namespace mamori::safety {
namespace {

using namespace verification;

// Time goes on by one per step, and after three nothing depends on it any more.
constexpr StopBounds kBounds{Duration{1}, Duration{2}};
constexpr std::int64_t kOldest = 3;

/// One step as an onlooker sees it.
struct Step {
    SafeState before;
    SafeState after;
    SafeStateInputs inputs;
    bool has_start_risen;
    bool has_reset_risen;
    Duration elapsed;
};

using Situation = std::tuple<SafeState, bool, bool, bool, std::int64_t>;

struct Node {
    SafeStateMachine machine;
    SafeStateInputs last;
};

std::vector<SafeStateInputs> make_all_inputs() {
    std::vector<SafeStateInputs> all;
    for (unsigned demand = 0U; demand <= 4U; ++demand) {
        for (unsigned self_test = 0U; self_test <= 2U; ++self_test) {
            for (unsigned bits = 0U; bits < 128U; ++bits) {
                SafeStateInputs inputs;
                inputs.demand = static_cast<Reaction>(demand);
                inputs.self_test = static_cast<SelfTestStatus>(self_test);
                inputs.start_button = (bits & 1U) != 0U;
                inputs.reset_button = (bits & 2U) != 0U;
                inputs.standstill = (bits & 4U) != 0U;
                inputs.faults_cleared = (bits & 8U) != 0U;
                inputs.start_permitted = (bits & 16U) != 0U;
                inputs.lock_out = (bits & 32U) != 0U;
                inputs.brakes_failed = (bits & 64U) != 0U;
                all.push_back(inputs);
            }
        }
    }
    return all;
}

/// All steps that the machine can make, found by breadth-first search.
const std::vector<Step>& get_all_steps() {
    static const std::vector<Step> all_steps = [] {
        const std::vector<SafeStateInputs> all_inputs = make_all_inputs();
        SafeStateInputs held;  // before power-up nobody knows the buttons; the machine takes them as held
        held.start_button = true;
        held.reset_button = true;
        std::vector<Node> pending{{SafeStateMachine{kBounds}, held}};
        std::set<Situation> seen;
        std::vector<Step> steps;
        while (!pending.empty()) {
            const Node node = pending.back();
            pending.pop_back();
            for (SafeStateInputs inputs : all_inputs) {
                inputs.now = node.last.now + Duration{1};
                SafeStateMachine machine = node.machine;
                const SafeState before = machine.get_state();
                const Duration elapsed = inputs.now - machine.get_entered_at();
                const SafeState after = machine.step(inputs);
                steps.push_back({before, after, inputs, inputs.start_button && !node.last.start_button,
                                 inputs.reset_button && !node.last.reset_button, elapsed});
                const std::int64_t age = (inputs.now - machine.get_entered_at()).ns;
                const bool has_test_run = after == SafeState::kSelfTest && before == after &&
                                          inputs.self_test == SelfTestStatus::kRunning;
                if (seen.insert({after, inputs.start_button, inputs.reset_button, has_test_run,
                                 age < kOldest ? age : kOldest})
                        .second) {
                    pending.push_back({machine, inputs});
                }
            }
        }
        return steps;
    }();
    return all_steps;
}

bool is_moving(SafeState state) {
    return state == SafeState::kOperational || state == SafeState::kDegraded;
}
bool has_torque(SafeState state) {
    return calc_stop_outputs(state).torque_enable;
}
bool has_changed_to(const Step& step, SafeState state) {
    return step.after == state && step.before != state;
}

/// Calls `judge` for each step; it says whether the step is allowed.
template <typename Judge>
void expect_always(Judge judge) {
    std::size_t forbidden = 0U;
    for (const Step& step : get_all_steps()) {
        if (!judge(step)) {
            ++forbidden;
            ADD_FAILURE() << get_name(step.before) << " -> " << get_name(step.after) << ", demand "
                          << get_name(step.inputs.demand) << ", elapsed " << step.elapsed.ns;
            ASSERT_LT(forbidden, 10U) << "further ones are not shown";
        }
    }
}

TEST(SafeStatePropertyTest, SearchReachesEveryState) {
    verifies("SWR-FSM-001", Technique::kStateTransition);
    std::set<SafeState> reached;
    for (const Step& step : get_all_steps()) {
        reached.insert(step.after);
    }

    EXPECT_EQ(reached.size(), kSafeStateCount);
    EXPECT_GT(get_all_steps().size(), 50000U);
}

TEST(SafeStatePropertyTest, SafeIsLeftByADeliberateResetOrForLockedOutOnly) {
    verifies("SWR-FSM-006", Technique::kStateTransition, Polarity::kViolation);

    expect_always([](const Step& step) {
        const bool may_reset = step.has_reset_risen && step.inputs.demand == Reaction::kNone &&
                               step.inputs.faults_cleared && step.inputs.standstill;
        return step.before != SafeState::kSafe || step.after == SafeState::kSafe ||
               step.after == SafeState::kLockedOut || (step.after == SafeState::kSelfTest && may_reset);
    });
}

TEST(SafeStatePropertyTest, TorqueComesOnByADeliberateStartUnderItsConditionsOnly) {
    verifies("SWR-FSM-006", Technique::kStateTransition, Polarity::kViolation);

    expect_always([](const Step& step) {
        const bool may_start = step.before == SafeState::kStandby && step.has_start_risen &&
                               step.inputs.demand == Reaction::kNone && step.inputs.faults_cleared &&
                               step.inputs.standstill && step.inputs.start_permitted;
        return has_torque(step.before) || !has_torque(step.after) || may_start;
    });
}

TEST(SafeStatePropertyTest, LimitsAreLiftedByADeliberateResetOnly) {
    verifies("SWR-FSM-006", Technique::kStateTransition, Polarity::kViolation);

    expect_always([](const Step& step) {
        const bool may_restore =
            step.has_reset_risen && step.inputs.demand == Reaction::kNone && step.inputs.faults_cleared;
        return step.before != SafeState::kDegraded || step.after != SafeState::kOperational || may_restore;
    });
}

TEST(SafeStatePropertyTest, LockedOutIsNeverLeft) {
    verifies("SWR-FSM-003", Technique::kStateTransition, Polarity::kViolation);

    expect_always([](const Step& step) {
        return step.before != SafeState::kLockedOut || step.after == SafeState::kLockedOut;
    });
}

TEST(SafeStatePropertyTest, LockedHoldIsEnteredByFailedBrakesAndLeftForLockedOutOnly) {
    verifies("SWR-FSM-037", Technique::kStateTransition, Polarity::kViolation);

    expect_always([](const Step& step) {
        if (step.before == SafeState::kLockedHold) {
            return step.after == SafeState::kLockedHold || step.after == SafeState::kLockedOut;
        }
        return step.after != SafeState::kLockedHold ||
               (step.before == SafeState::kProtectiveStopSs1 && step.inputs.brakes_failed);
    });
}

TEST(SafeStatePropertyTest, MachineThatStopsNeverMovesAgainWithoutStandby) {
    verifies("SWR-FSM-002", Technique::kStateTransition, Polarity::kViolation);

    expect_always([](const Step& step) {
        return !is_moving(step.after) || is_moving(step.before) || step.before == SafeState::kStandby;
    });
}

TEST(SafeStatePropertyTest, DemandIsMetInTheCycleInWhichItIsMade) {
    verifies("SWR-FSM-005", Technique::kStateTransition, Polarity::kViolation);

    expect_always([](const Step& step) {
        switch (step.inputs.demand) {
            case Reaction::kNone:
                return true;
            case Reaction::kDegrade:
                return step.after != SafeState::kOperational;
            case Reaction::kSs2:
                return !is_moving(step.after);
            case Reaction::kSs1:
                return !has_torque(step.after) || step.after == SafeState::kProtectiveStopSs1 ||
                       step.after == SafeState::kLockedHold;
            case Reaction::kSto:
                return !has_torque(step.after);
        }
        return false;
    });
}

TEST(SafeStatePropertyTest, LockOutAndFailedSelfTestBeatEverything) {
    verifies("SWR-FSM-005", Technique::kStateTransition, Polarity::kViolation);

    expect_always([](const Step& step) {
        const bool is_lost = step.inputs.lock_out || step.inputs.self_test == SelfTestStatus::kFailed;
        return !is_lost || step.after == SafeState::kLockedOut;
    });
}

TEST(SafeStatePropertyTest, NoStopOutlivesItsBound) {
    verifies("SWR-FSM-004", Technique::kStateTransition, Polarity::kViolation);

    expect_always([](const Step& step) {
        const bool stays_in_ss2 = step.before == SafeState::kProtectiveStopSs2 &&
                                  step.elapsed >= kBounds.ss2_within &&
                                  step.after == SafeState::kProtectiveStopSs2;
        const bool keeps_torque = step.before == SafeState::kProtectiveStopSs1 &&
                                  step.elapsed >= kBounds.ss1_within && has_torque(step.after) &&
                                  step.after != SafeState::kLockedHold;
        return !stays_in_ss2 && !keeps_torque;
    });
}

TEST(SafeStatePropertyTest, HoldIsEnteredAtStandstillOnly) {
    verifies("SWR-FSM-004", Technique::kStateTransition, Polarity::kViolation);

    expect_always([](const Step& step) {
        return !has_changed_to(step, SafeState::kStandstillHold) || step.inputs.standstill;
    });
}

}  // namespace
}  // namespace mamori::safety
