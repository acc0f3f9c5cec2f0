// SPDX-License-Identifier: Apache-2.0
/// @file
/// `safe_arm timing`: the system by the clock, measured.
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

/// That the arm left its operating state, with the first fault: a finding of the run. Empty before it began
/// to operate, and while it operates. @param[in] first_fault index of kArmFaultNames; kArmFaultCount and
/// more: none.
std::vector<std::string> make_findings(mamori::safety::SafeState state, std::size_t first_fault);

/// Runs `frames` frames and writes what `mamori timing` reads into the folder `out`. Without a motion the arm
/// holds its position. @return the exit status.
int run_timing_command(const RunOptions& options);

}  // namespace safe_arm

#endif  // EXAMPLES_SAFE_ARM_TIMING_COMMAND_HPP
