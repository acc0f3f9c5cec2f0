// SPDX-License-Identifier: Apache-2.0
// Goal: with brakes that need time, nothing is open without torque, and torque outlives its state nowhere but
// after a hold. Method: the whole state space of the safe-state machine together with its brake sequence is
// searched, and each step is judged by rules that are written without looking at either.
#include <algorithm>
#include <cstdint>
#include <set>
#include <tuple>
#include <vector>

#include "mamori/safety/reaction/brake_sequence.hpp"
#include "mamori/trace/verifies.hpp"

namespace mamori::safety {
namespace {

using namespace verification;

// Time goes on by one per step, and after five nothing depends on it any more.
constexpr StopBounds kBounds{Duration{1}, Duration{4}};
constexpr Duration kCloses{2};
constexpr std::int64_t kOldest = 5;

/// One step as an onlooker sees it.
struct Step {
    SafeState before;
    SafeState after;
    Reaction demand;
    bool is_standing;
    bool are_closed;
    bool has_opened;  ///< the contacts reported open in the cycle of the command or after it
    StopOutputs outputs;
    Duration elapsed;      ///< since the entry into `before`
    std::int64_t closing;  ///< cycles since the brakes were told to close, this one not counted; 0 while open
    std::int64_t held;     ///< cycles since the last one that ended in the hold
};

/// Machine and sequence after a step, and what their answers depend on.
struct Node {
    SafeStateMachine machine;
    BrakeSequence brakes;
    SafeStateInputs last;
    StopOutputs outputs;
    bool are_closed;
    bool has_opened;
    bool has_run;
    std::int64_t closing;
    std::int64_t held;
};

using Key =
    std::tuple<SafeState, bool, bool, bool, bool, bool, bool, bool, std::int64_t, std::int64_t, std::int64_t>;

Key make_key(const Node& node) {
    const std::int64_t age = (node.last.now - node.machine.get_entered_at()).ns;
    return {node.machine.get_state(),
            node.last.start_button,
            node.last.reset_button,
            node.has_run,
            node.are_closed,
            node.has_opened,
            node.outputs.torque_enable,
            node.outputs.brake_release,
            std::min(age, kOldest),
            node.closing,
            node.held};
}

/// All inputs of a cycle; nothing is latched, and every start is permitted.
std::vector<std::tuple<SafeStateInputs, bool>> make_all_inputs() {
    std::vector<std::tuple<SafeStateInputs, bool>> all;
    for (unsigned demand = 0U; demand <= 4U; ++demand) {
        for (unsigned bits = 0U; bits < 64U; ++bits) {
            SafeStateInputs inputs;
            inputs.demand = static_cast<Reaction>(demand);
            inputs.faults_cleared = true;
            inputs.start_permitted = true;
            inputs.start_button = (bits & 1U) != 0U;
            inputs.reset_button = (bits & 2U) != 0U;
            inputs.standstill = (bits & 4U) != 0U;
            inputs.self_test = (bits & 8U) != 0U ? SelfTestStatus::kRunning : SelfTestStatus::kPassed;
            inputs.brakes_failed = (bits & 32U) != 0U;
            all.emplace_back(inputs, (bits & 16U) != 0U);
        }
    }
    return all;
}

Node advance(const Node& from, SafeStateInputs inputs, bool are_closed, std::vector<Step>& steps) {
    Node to = from;
    const SafeState before = from.machine.get_state();
    const bool is_standing = inputs.standstill;
    inputs.now = from.last.now + Duration{1};
    const Duration elapsed = inputs.now - from.machine.get_entered_at();
    inputs.standstill = to.brakes.confirm(before, is_standing, are_closed, inputs.now);
    inputs.brakes_failed = inputs.brakes_failed && to.brakes.is_waiting();
    const SafeState after = to.machine.step(inputs);
    to.outputs = to.brakes.apply(after, inputs.now);
    to.last = inputs;
    to.are_closed = are_closed;
    to.has_opened = !are_closed || (from.has_opened && !from.outputs.brake_release);
    const bool is_running = inputs.self_test == SelfTestStatus::kRunning;
    to.has_run = before == after && (from.has_run || is_running);
    to.closing = from.outputs.brake_release ? 0 : std::min(from.closing + 1, kOldest);
    to.held = before == SafeState::kStandstillHold ? 0 : std::min(from.held + 1, kOldest);
    steps.push_back({before, after, inputs.demand, is_standing, are_closed, to.has_opened, to.outputs,
                     elapsed, to.closing, to.held});
    to.closing = to.outputs.brake_release ? 0 : to.closing;
    return to;
}

/// All steps that the two can make together.
std::vector<Step> search(BrakeLimits limits) {
    const auto all_inputs = make_all_inputs();
    SafeStateInputs held;  // before power-up nobody knows the buttons; the machine takes them as held
    held.start_button = true;
    held.reset_button = true;
    // Brakes that are closed before power-up were told so long ago, which the first step forgets.
    std::vector<Node> pending{{SafeStateMachine{kBounds},
                               BrakeSequence{limits},
                               held,
                               {true, true, false, false},
                               false,
                               false,
                               false,
                               0,
                               kOldest}};
    std::set<Key> seen;
    std::vector<Step> steps;
    while (!pending.empty()) {
        const Node node = pending.back();
        pending.pop_back();
        for (const auto& [inputs, are_closed] : all_inputs) {
            const Node next = advance(node, inputs, are_closed, steps);
            if (seen.insert(make_key(next)).second) {
                pending.push_back(next);
            }
        }
    }
    return steps;
}

const std::vector<Step>& get_steps(bool has_contacts) {
    static const std::vector<Step> with_contacts = search({kCloses, true});
    static const std::vector<Step> without_contacts = search({kCloses, false});
    return has_contacts ? with_contacts : without_contacts;
}

/// True when brakes with contacts count as engaged. Contacts that never reported open may be stuck.
bool have_contacts_engaged(const Step& step) {
    return step.are_closed && (step.has_opened || step.closing >= kCloses.ns);
}

/// Calls `judge` for each step, with brakes that report and with others.
template <typename Judge>
void expect_always(Judge judge) {
    for (const bool has_contacts : {true, false}) {
        std::size_t forbidden = 0U;
        for (const Step& step : get_steps(has_contacts)) {
            if (!judge(step, has_contacts)) {
                ++forbidden;
                ADD_FAILURE() << get_name(step.before) << " -> " << get_name(step.after) << ", demand "
                              << get_name(step.demand) << ", elapsed " << step.elapsed.ns << ", closing for "
                              << step.closing << (has_contacts ? ", with contacts" : "");
                ASSERT_LT(forbidden, 10U) << "further ones are not shown";
            }
        }
    }
}

TEST(BrakeSequencePropertyTest, SearchReachesEveryStateThatInputsLeadTo) {
    verifies("SWR-FSM-028", Technique::kStateTransition);

    for (const bool has_contacts : {true, false}) {
        std::set<SafeState> reached;
        for (const Step& step : get_steps(has_contacts)) {
            reached.insert(step.after);
        }
        EXPECT_EQ(reached.size(), has_contacts ? kSafeStateCount : kSafeStateCount - 2U)
            << "brakes without contacts never fail, and nothing else locks out";
        EXPECT_GT(get_steps(has_contacts).size(), 50000U);
    }
}

TEST(BrakeSequencePropertyTest, BrakesAreNeverOpenWithoutTorque) {
    verifies("SWR-FSM-034", Technique::kStateTransition, Polarity::kViolation);

    expect_always(
        [](const Step& step, bool) { return step.outputs.torque_enable || !step.outputs.brake_release; });
}

TEST(BrakeSequencePropertyTest, TorqueOutlivesItsStateAfterTheHoldOnlyAndForLessThanTheClosingTime) {
    verifies("SWR-FSM-028", Technique::kStateTransition, Polarity::kViolation);

    expect_always([](const Step& step, bool has_contacts) {
        const bool is_own = calc_stop_outputs(step.after).torque_enable;
        const bool have_bitten = has_contacts && have_contacts_engaged(step);
        const bool may_outlive = step.after == SafeState::kStandby && step.held < kCloses.ns && !have_bitten;
        const bool must_outlive = may_outlive && step.before == SafeState::kStandstillHold;
        return step.outputs.torque_enable ? is_own || may_outlive : !is_own && !must_outlive;
    });
}

TEST(BrakeSequencePropertyTest, StoTakesTorqueAwayInTheCycleInWhichItIsDemanded) {
    verifies("SWR-FSM-028", Technique::kStateTransition, Polarity::kViolation);

    expect_always(
        [](const Step& step, bool) { return step.demand != Reaction::kSto || !step.outputs.torque_enable; });
}

TEST(BrakeSequencePropertyTest, BrakesCloseUnderTorqueAtTheEndOfAnSs1AndAfterTheHoldOnly) {
    verifies("SWR-FSM-026", Technique::kStateTransition, Polarity::kViolation);

    expect_always([](const Step& step, bool) {
        const bool is_against = step.outputs.torque_enable && !step.outputs.brake_release;
        return !is_against || step.after == SafeState::kProtectiveStopSs1 ||
               step.after == SafeState::kStandby || step.after == SafeState::kLockedHold;
    });
}

TEST(BrakeSequencePropertyTest, Ss1EndsByItsBrakesItsBoundOrSomethingWorse) {
    verifies("SWR-FSM-027", Technique::kStateTransition, Polarity::kViolation);

    expect_always([](const Step& step, bool has_contacts) {
        const bool has_ended = step.before == SafeState::kProtectiveStopSs1 && step.after != step.before;
        const bool have_bitten = has_contacts ? have_contacts_engaged(step) : step.closing >= kCloses.ns;
        const bool is_worse = step.demand == Reaction::kSto || step.elapsed >= kBounds.ss1_within;
        return !has_ended || is_worse || step.after == SafeState::kLockedHold ||
               (step.is_standing && have_bitten);
    });
}

}  // namespace
}  // namespace mamori::safety
