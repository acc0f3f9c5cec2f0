// SPDX-License-Identifier: Apache-2.0
/// @file
/// Does a machine lie around the safe limits that the program was built for?
#ifndef EXAMPLES_SAFE_ARM_MODEL_CHECK_HPP
#define EXAMPLES_SAFE_ARM_MODEL_CHECK_HPP

#include <string>

#include "arm_reader.hpp"
#include "mamori/simbody_sim/arm_model.hpp"

namespace safe_arm {

/// @return empty when the safe limits fit; else one line that names joint, figure and limit.
/// @satisfies SWR-SAF-003, SWR-SAF-045
std::string check_model(const mamori::sim::ArmModel& model);

/// Encoder resolutions of the model.
EncoderScale get_encoder_scale(const mamori::sim::ArmModel& model);

}  // namespace safe_arm

#endif  // EXAMPLES_SAFE_ARM_MODEL_CHECK_HPP
