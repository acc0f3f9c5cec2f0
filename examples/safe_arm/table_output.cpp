// SPDX-License-Identifier: Apache-2.0
#include "table_output.hpp"

#include <array>

#include "arm_faults.hpp"
#include "mamori/table_dump/table_dump.hpp"
#include "safe_arm_system.hpp"

namespace safe_arm {

std::string save_table(const std::string& path) {
    // The safety layer contains the reactions of this example (arm_faults.hpp). They are added to the
    // picture.
    std::array<mamori::FaultRow, kArmFaultCount> faults{};
    std::array<mamori::ReactionRow, kArmFaultCount> reactions{};
    for (std::size_t i = 0U; i < kArmFaultCount; ++i) {
        faults[i].fault = kArmReactions[i].fault;
        reactions[i] = {kArmReactions[i].fault, static_cast<std::uint32_t>(kArmReactions[i].reaction),
                        kArmReactions[i].within};
    }
    mamori::SystemView view = executive.get_view();
    view.faults = faults;
    view.reactions = reactions;
    mamori::table_dump::Names names{{kArmFaultNames.begin(), kArmFaultNames.end()}, {}};
    for (std::uint32_t i = 0U; i <= static_cast<std::uint32_t>(Reaction::kSto); ++i) {
        names.reactions.emplace_back(mamori::safety::get_name(static_cast<Reaction>(i)));
    }
    return mamori::table_dump::save_json(path, view, names);
}

}  // namespace safe_arm
