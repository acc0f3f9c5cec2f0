// SPDX-License-Identifier: Apache-2.0
/// @file
/// `safe_arm timing`: the system by the clock, measured.
///
/// @satisfies SWR-TIM-004      Design: docs/design/timing_run.md#plant
#ifndef EXAMPLES_SAFE_ARM_TIMING_COMMAND_HPP
#define EXAMPLES_SAFE_ARM_TIMING_COMMAND_HPP

#include "run_options.hpp"

namespace safe_arm {

/// Runs `frames` frames and writes what `mamori timing` reads into the folder `out`. Without a motion the arm
/// holds its position. @return the exit status.
int run_timing_command(const RunOptions& options);

}  // namespace safe_arm

#endif  // EXAMPLES_SAFE_ARM_TIMING_COMMAND_HPP
