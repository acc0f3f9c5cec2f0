// SPDX-License-Identifier: Apache-2.0
/// @file
/// Prints, as JSON, all that the compiled safe-state machine can do: its table, its outputs, the order of its
/// events, and its whole step relation. Exit status 1 when the machine has no such description.
///
///     mamori_safe_state_relation
///
/// @satisfies SWR-FSM-020, SWR-FSM-021      Design: docs/design/safe_state.md#step-relation
#include <cstdio>
#include <exception>
#include <iostream>
#include <string>

#include "explorer.hpp"
#include "mamori/safety/reaction/stop_outputs.hpp"

namespace mamori::verification {
namespace {

using safety::SafeStateEvent;
using safety::StopOutputs;

std::string quote(const char* text) {
    return '"' + std::string{text} + '"';  // names of enumerators: nothing to escape
}

/// "[a, b, ...]" of what `make(0)` .. `make(count - 1)` give.
template <typename Make>
std::string make_list(std::size_t count, Make make) {
    std::string text = "[";
    for (std::size_t i = 0U; i < count; ++i) {
        text += (i == 0U ? "" : ", ") + make(i);
    }
    return text + "]";
}

SafeState get_state(std::size_t index) {
    return static_cast<SafeState>(index + 1U);
}

std::string write_outputs(SafeState state) {
    const StopOutputs outputs = safety::calc_stop_outputs(state);
    const auto write = [](bool level) { return std::string{level ? "true" : "false"}; };
    return "{\"torque_enable\": " + write(outputs.torque_enable) +
           ", \"brake_release\": " + write(outputs.brake_release) +
           ", \"stop_requested\": " + write(outputs.stop_requested) +
           ", \"hold_requested\": " + write(outputs.hold_requested) + "}";
}

std::string write_row(std::size_t state) {
    return make_list(safety::kSafeStateEventCount, [state](std::size_t event) {
        return quote(get_name(calc_next_state(get_state(state), static_cast<SafeStateEvent>(event))));
    });
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

std::string write_situation(const Situation& situation) {
    return "{\"state\": " + quote(get_name(situation.state)) +
           ", \"is_consistent\": " + (situation.is_consistent ? "true" : "false") +
           ", \"limit\": " + quote(get_limit_name(situation.limit)) +
           ", \"outputs\": " + write_outputs(situation.state) + ",\n  \"next\": " +
           make_list(situation.next.size(),
                     [&](std::size_t i) { return std::to_string(situation.next[i]); }) +
           "}";
}

void write(const Relation& relation, std::ostream& out) {
    const std::vector<InputKind> kinds = make_input_kinds();
    out << "{\"schema\": \"mamori.safe_state/1\",\n\"states\": "
        << make_list(safety::kSafeStateCount, [](std::size_t i) { return quote(get_name(get_state(i))); })
        << ",\n\"events\": "
        << make_list(safety::kSafeStateEventCount,
                     [](std::size_t i) { return quote(get_name(static_cast<SafeStateEvent>(i))); })
        << ",\n\"table\": " << make_list(safety::kSafeStateCount, write_row) << ",\n\"inputs\": "
        << make_list(kinds.size(),
                     [&](std::size_t i) {
                         return "{\"name\": " + quote(kinds[i].name) + ", \"values\": " +
                                make_list(kinds[i].values.size(),
                                          [&](std::size_t k) { return quote(kinds[i].values[k]); }) +
                                "}";
                     })
        << ",\n\"steps\": " << relation.steps << ", \"corrupted_objects\": " << relation.corrupted_objects
        << ",\n\"situations\": "
        << make_list(relation.situations.size(),
                     [&](std::size_t i) { return "\n " + write_situation(relation.situations[i]); })
        << "}\n";
}

}  // namespace
}  // namespace mamori::verification

int main() {
    try {
        const auto relation = mamori::verification::explore_all<mamori::safety::SafeStateMachine>();
        mamori::verification::write(relation, std::cout);
        return std::cout.flush() ? 0 : 1;
    } catch (const std::exception& error) {
        std::cerr << "mamori_safe_state_relation: " << error.what() << '\n';
        return 1;
    }
}
