// SPDX-License-Identifier: Apache-2.0
/// @file
/// The system table of the example in readable form: `safe_arm table --out FILE`, shown by `mamori table
/// FILE`.
///
/// Design: docs/design/cost.md#library
#ifndef EXAMPLES_SAFE_ARM_TABLE_OUTPUT_HPP
#define EXAMPLES_SAFE_ARM_TABLE_OUTPUT_HPP

#include <string>
#include <vector>

namespace safe_arm {

/// Spelling of the faults in logs and reports, by their numbers.
const std::vector<std::string>& get_fault_names();

/// Writes windows, components and connections of the static table, and the rows of the safety layer.
/// @return empty on success, otherwise one sentence with the path and the cause.
[[nodiscard]] std::string save_table(const std::string& path);

}  // namespace safe_arm

#endif  // EXAMPLES_SAFE_ARM_TABLE_OUTPUT_HPP
