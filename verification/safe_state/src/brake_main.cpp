// SPDX-License-Identifier: Apache-2.0
/// @file
/// Prints all results of the compiled brake sequence as JSON. Exit status 1 if the sequence has no such
/// description.
///
///     mamori_brake_sequence_relation
///
/// @satisfies SWR-FSM-032, SWR-FSM-033      Design: docs/design/safe_state.md#brakes-in-the-models
#include <exception>
#include <iostream>
#include <nlohmann/json.hpp>

#include "brake_explorer.hpp"

namespace mamori::verification {
namespace {

using Json = nlohmann::ordered_json;

const char* get_state_name(std::size_t digit) {
    const bool is_state = digit < safety::kSafeStateCount;
    return is_state ? get_name(static_cast<SafeState>(digit + 1U)) : "Invalid";
}

/// Levels are 0 and 1.
Json make_situation(const BrakeSituation& situation) {
    Json confirm;
    for (const CallAnswer& answer : situation.confirm) {
        confirm.push_back({int{answer.is_confirmed}, int{answer.is_told_now}, answer.next});
    }
    Json apply;
    for (const CallAnswer& answer : situation.apply) {
        const StopOutputs& outputs = answer.outputs;
        apply.push_back({int{outputs.torque_enable}, int{outputs.brake_release}, int{outputs.stop_requested},
                         int{outputs.hold_requested}, int{answer.is_told_now}, answer.next});
    }
    Json overdue;
    Json closing;
    for (std::size_t time = 0U; time < kClosingTimeCount; ++time) {
        overdue.push_back(int{situation.is_overdue[time]});
        closing.push_back(int{situation.is_closing[time]});
    }
    return {{"overdue", overdue}, {"closing", closing}, {"confirm", confirm}, {"apply", apply}};
}

Json make_document(const BrakeRelation& relation) {
    Json document{
        {"schema", "mamori.brake_sequence/1"},
        {"times", {"BeforeCommand", "Within", "AtBound", "Beyond"}},
        {"confirm_letter", {"state", "standstill", "closed", "time"}},
        {"confirm_answer", {"confirmed", "told_now", "next"}},
        {"apply_letter", Json::array({"state", "time"})},
        {"apply_answer",
         {"torque_enable", "brake_release", "stop_requested", "hold_requested", "told_now", "next"}},
        {"first", {{"with_contacts", 0}, {"without_contacts", relation.first_without_contacts}}},
        {"calls", relation.calls}};
    for (std::size_t digit = 0U; digit < kCallStateCount; ++digit) {
        document["states"].push_back(get_state_name(digit));
    }
    for (const BrakeSituation& situation : relation.situations) {
        document["situations"].push_back(make_situation(situation));
    }
    return document;
}

}  // namespace
}  // namespace mamori::verification

int main() {
    try {
        const auto relation = mamori::verification::explore_all_brakes<mamori::safety::BrakeSequence>();
        std::cout << mamori::verification::make_document(relation) << '\n';
        return std::cout.flush() ? 0 : 1;
    } catch (const std::exception& error) {
        std::cerr << "mamori_brake_sequence_relation: " << error.what() << '\n';
        return 1;
    }
}
