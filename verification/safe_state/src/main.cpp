// SPDX-License-Identifier: Apache-2.0
/// @file
/// Prints the complete behaviour of the compiled safe-state machine as JSON: its table, its outputs, the
/// order of its events, and its step relation. Exit status 1 if the machine has no such description.
///
///     mamori_safe_state_relation
///
/// @satisfies SWR-FSM-020, SWR-FSM-021      Design: docs/design/safe_state.md#step-relation
#include <exception>
#include <iostream>
#include <nlohmann/json.hpp>

#include "explorer.hpp"
#include "mamori/safety/reaction/stop_outputs.hpp"

namespace mamori::verification {
namespace {

using Json = nlohmann::ordered_json;
using safety::SafeStateEvent;
using safety::StopOutputs;

SafeState get_state(std::size_t index) {
    return static_cast<SafeState>(index + 1U);
}

Json make_outputs(SafeState state) {
    const StopOutputs outputs = safety::calc_stop_outputs(state);
    return {{"torque_enable", outputs.torque_enable},
            {"brake_release", outputs.brake_release},
            {"stop_requested", outputs.stop_requested},
            {"hold_requested", outputs.hold_requested}};
}

const char* get_limit_name(Limit limit) {
    switch (limit) {
        case Limit::kNone:
            return "none";
        case Limit::kSs2:
            return "ss2_within";
        case Limit::kSs1:
            return "ss1_within";
    }
    return "invalid";
}

Json make_document(const Relation& relation) {
    Json document{{"schema", "mamori.safe_state/1"}};
    for (std::size_t event = 0U; event < safety::kSafeStateEventCount; ++event) {
        document["events"].push_back(get_name(static_cast<SafeStateEvent>(event)));
    }
    for (std::size_t state = 0U; state < safety::kSafeStateCount; ++state) {
        document["states"].push_back(get_name(get_state(state)));
        Json row;
        for (std::size_t event = 0U; event < safety::kSafeStateEventCount; ++event) {
            row.push_back(get_name(calc_next_state(get_state(state), static_cast<SafeStateEvent>(event))));
        }
        document["table"].push_back(row);
    }
    for (const InputKind& kind : make_input_kinds()) {
        document["inputs"].push_back({{"name", kind.name}, {"values", kind.values}});
    }
    document["steps"] = relation.steps;
    document["corrupted_objects"] = relation.corrupted_objects;
    for (const Situation& situation : relation.situations) {
        document["situations"].push_back({{"state", get_name(situation.state)},
                                          {"is_consistent", situation.is_consistent},
                                          {"limit", get_limit_name(situation.limit)},
                                          {"outputs", make_outputs(situation.state)},
                                          {"next", situation.next}});
    }
    return document;
}

}  // namespace
}  // namespace mamori::verification

int main() {
    try {
        const auto relation = mamori::verification::explore_all<mamori::safety::SafeStateMachine>();
        std::cout << mamori::verification::make_document(relation) << '\n';
        return std::cout.flush() ? 0 : 1;
    } catch (const std::exception& error) {
        std::cerr << "mamori_safe_state_relation: " << error.what() << '\n';
        return 1;
    }
}
