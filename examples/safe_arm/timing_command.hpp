// SPDX-License-Identifier: Apache-2.0
/// @file
/// `safe_arm timing`: runs and measures the system in real time.
///
/// @satisfies SWR-TIM-004, SWR-TIM-005      Design: docs/design/timing.md#plant
#ifndef EXAMPLES_SAFE_ARM_TIMING_COMMAND_HPP
#define EXAMPLES_SAFE_ARM_TIMING_COMMAND_HPP

#include <cstddef>
#include <string>
#include <vector>

#include "mamori/safety/reaction/safe_state.hpp"
#include "run_options.hpp"

namespace safe_arm {

/// Finding of the run if the arm left its operating state, with the first fault. Empty before and during
/// operation. @param[in] first_fault index in get_fault_names(); kArmFaultCount and above: no fault.
std::vector<std::string> make_findings(mamori::safety::SafeState state, std::size_t first_fault);

/// Runs `frames` major frames and writes the files for `mamori timing` to the folder `out`. Without a motion,
/// the arm holds its position. @return the exit status.
int run_timing_command(const RunOptions& options);

}  // namespace safe_arm

#endif  // EXAMPLES_SAFE_ARM_TIMING_COMMAND_HPP
