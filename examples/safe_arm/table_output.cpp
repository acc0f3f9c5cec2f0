// SPDX-License-Identifier: Apache-2.0
#include "table_output.hpp"

#include "arm_safety.hpp"
#include "mamori/table_dump/fault_names.hpp"
#include "mamori/table_dump/table_dump.hpp"
#include "safe_arm_system.hpp"

namespace safe_arm {

const std::vector<std::string>& get_fault_names() {
    static const std::vector<std::string> names = mamori::table_dump::list_fault_names(kArmReactions);
    return names;
}

std::string save_table(const std::string& path) {
    const mamori::table_dump::Names names{get_fault_names(), {}, {"HoldToRun", "ReducedSpeed", "Automatic"}};
    return mamori::table_dump::save_json(path, executive.get_view(), names, &safety_state.get_table());
}

}  // namespace safe_arm
