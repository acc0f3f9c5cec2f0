// SPDX-License-Identifier: Apache-2.0
/// @file
/// `safe_arm cost`: runs the system in virtual time, so that the instructions of each step can be counted.
///
/// @satisfies SWR-TIM-030      Design: docs/design/cost.md#counting
#ifndef EXAMPLES_SAFE_ARM_COST_COMMAND_HPP
#define EXAMPLES_SAFE_ARM_COST_COMMAND_HPP

#include "run_options.hpp"

namespace safe_arm {

/// Runs `frames` major frames with the motion and the fault of the options, and writes the files for `mamori
/// cost` to the folder `out`. Without a motion, the arm holds its position. @return the exit status.
int run_cost_command(const RunOptions& options);

}  // namespace safe_arm

#endif  // EXAMPLES_SAFE_ARM_COST_COMMAND_HPP
