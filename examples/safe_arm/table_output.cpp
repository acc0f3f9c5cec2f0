// SPDX-License-Identifier: Apache-2.0
#include "table_output.hpp"

#include "arm_faults.hpp"
#include "mamori/table_dump/table_dump.hpp"
#include "safe_arm_system.hpp"

namespace safe_arm {

using mamori::safety::Reaction;

std::string save_table(const std::string& path) {
    mamori::table_dump::Names names{
        {kArmFaultNames.begin(), kArmFaultNames.end()}, {}, {"HoldToRun", "ReducedSpeed", "Automatic"}};
    for (std::uint32_t i = 0U; i <= static_cast<std::uint32_t>(Reaction::kSto); ++i) {
        names.reactions.emplace_back(mamori::safety::get_name(static_cast<Reaction>(i)));
    }
    return mamori::table_dump::save_json(path, executive.get_view(), names);
}

}  // namespace safe_arm
