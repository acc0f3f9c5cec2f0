// SPDX-License-Identifier: Apache-2.0
/// @file
/// Prints, as JSON, all that the compiled brake sequence answers to its calls. Exit status 1 when the
/// sequence has no such description.
///
///     mamori_brake_sequence_relation
///
/// @satisfies SWR-FSM-032, SWR-FSM-033      Design: docs/design/safe_state.md#brakes-in-the-models
#include <exception>
#include <iostream>
#include <string>

#include "brake_explorer.hpp"

namespace mamori::verification {
namespace {

/// "[a, b, ...]" of what `make(0)` .. `make(count - 1)` give.
template <typename Make>
std::string make_list(std::size_t count, Make make) {
    std::string text = "[";
    for (std::size_t i = 0U; i < count; ++i) {
        text += (i == 0U ? "" : ", ") + make(i);
    }
    return text + "]";
}

std::string get_state_name(std::size_t digit) {
    const bool is_state = digit < safety::kSafeStateCount;
    return '"' + std::string{is_state ? get_name(static_cast<SafeState>(digit + 1U)) : "Invalid"} + '"';
}

std::string write_level(bool level) {
    return level ? "1" : "0";
}

std::string write_confirm(const CallAnswer& answer) {
    return "[" + write_level(answer.is_confirmed) + "," + write_level(answer.is_told_now) + "," +
           std::to_string(answer.next) + "]";
}

std::string write_apply(const CallAnswer& answer) {
    const StopOutputs& outputs = answer.outputs;
    return "[" + write_level(outputs.torque_enable) + "," + write_level(outputs.brake_release) + "," +
           write_level(outputs.stop_requested) + "," + write_level(outputs.hold_requested) + "," +
           write_level(answer.is_told_now) + "," + std::to_string(answer.next) + "]";
}

std::string write_situation(const BrakeSituation& situation) {
    return "\n {\"overdue\": " +
           make_list(kClosingTimeCount, [&](std::size_t i) { return write_level(situation.is_overdue[i]); }) +
           ",\n  \"confirm\": " +
           make_list(situation.confirm.size(),
                     [&](std::size_t i) { return write_confirm(situation.confirm[i]); }) +
           ",\n  \"apply\": " +
           make_list(situation.apply.size(), [&](std::size_t i) { return write_apply(situation.apply[i]); }) +
           "}";
}

void write(const BrakeRelation& relation, std::ostream& out) {
    out << "{\"schema\": \"mamori.brake_sequence/1\",\n\"states\": "
        << make_list(kCallStateCount, get_state_name)
        << ",\n\"times\": [\"BeforeCommand\", \"Within\", \"AtBound\", \"Beyond\"]"
        << ",\n\"confirm_letter\": [\"state\", \"standstill\", \"closed\", \"time\"]"
        << ",\n\"confirm_answer\": [\"confirmed\", \"told_now\", \"next\"]"
        << ",\n\"apply_letter\": [\"state\", \"time\"]"
        << ",\n\"apply_answer\": [\"torque_enable\", \"brake_release\", \"stop_requested\", "
           "\"hold_requested\", \"told_now\", \"next\"]"
        << ",\n\"first\": {\"with_contacts\": 0, \"without_contacts\": " << relation.first_without_contacts
        << "},\n\"calls\": " << relation.calls << ",\n\"situations\": "
        << make_list(relation.situations.size(),
                     [&](std::size_t i) { return write_situation(relation.situations[i]); })
        << "}\n";
}

}  // namespace
}  // namespace mamori::verification

int main() {
    try {
        const auto relation = mamori::verification::explore_all_brakes<mamori::safety::BrakeSequence>();
        mamori::verification::write(relation, std::cout);
        return std::cout.flush() ? 0 : 1;
    } catch (const std::exception& error) {
        std::cerr << "mamori_brake_sequence_relation: " << error.what() << '\n';
        return 1;
    }
}
