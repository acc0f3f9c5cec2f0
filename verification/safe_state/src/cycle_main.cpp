// SPDX-License-Identifier: Apache-2.0
/// @file
/// Prints as JSON when the compiled safety cycle keeps torque. Exit status 1 if it does what its machine and
/// brakes cannot do.
///
///     mamori_safety_cycle_relation
///
/// @satisfies SWR-PRF-052, SWR-PRF-053      Design: docs/design/safe_state.md#the-cycle-in-the-models
#include <exception>
#include <iostream>
#include <nlohmann/json.hpp>

#include "cycle_explorer.hpp"

namespace mamori::verification {
namespace {

nlohmann::ordered_json make_document(const CycleRelation& relation) {
    nlohmann::ordered_json document{
        {"schema", "mamori.safety_cycle/1"},
        {"letter", {"state", "own_torque", "closing", "had_torque", "can_hold", "sto_cause", "torque"}},
        {"situations", relation.situations},
        {"cycles", relation.cycles}};
    for (const auto& [letter, torque] : relation.torque) {
        document["rows"].push_back({get_name(letter.state), int{letter.is_own}, int{letter.is_closing},
                                    int{letter.had_torque}, int{letter.can_hold},
                                    static_cast<int>(letter.cause), int{torque}});
    }
    return document;
}

}  // namespace
}  // namespace mamori::verification

int main() {
    try {
        mamori::verification::CycleExplorer explorer;
        std::cout << mamori::verification::make_document(explorer.explore()) << '\n';
        return std::cout.flush() ? 0 : 1;
    } catch (const std::exception& error) {
        std::cerr << "mamori_safety_cycle_relation: " << error.what() << '\n';
        return 1;
    }
}
