// SPDX-License-Identifier: Apache-2.0
/// @file
/// Start of the system, common to runs in virtual time and in real time.
///
/// @satisfies SWR-SAF-024      Design: docs/design/safe_arm.md#record
#ifndef EXAMPLES_SAFE_ARM_ARM_START_HPP
#define EXAMPLES_SAFE_ARM_ARM_START_HPP

#include <string>

#include "mamori/kernel/base/time.hpp"
#include "mamori/simbody_sim/arm_model.hpp"
#include "mamori/simbody_sim/computed_torque_controller.hpp"
#include "mamori/simbody_sim/fault_plan.hpp"
#include "motion_track.hpp"

namespace safe_arm {

/// Start of the path: the arm is operational since 0.3 s, the brakes are open, and the position control has
/// settled.
inline constexpr mamori::Duration kMotionStart{500'000'000};

/// Reads the model, whose limits must contain the safe limits, and the motion, if one is specified.
/// @return one line with file and cause; empty on success.
std::string load_inputs(const std::string& model_path, const std::string& motion_path,
                        mamori::sim::LoadedModel& loaded, MotionTrack& track);

/// @return the reason if `fault`, whose instant counts from the start of the motion, cannot be injected
///         during the motion of `track`; otherwise empty.
std::string check_fault_instant(const mamori::sim::FaultPlan& fault, const MotionTrack& track);

/// Configures the components and starts the supervision of the executive.
/// @param[in] track, law must outlive the run. @return the cause of a failed start; empty on success.
std::string prepare_system(const mamori::sim::ArmModel& model, const MotionTrack& track,
                           mamori::sim::ComputedTorqueController& law);

/// @return which component prevented the start.
std::string describe_failed_start();

/// The same as prepare_system(); then initialises and starts the executive.
std::string start_system(const mamori::sim::ArmModel& model, const MotionTrack& track,
                         mamori::sim::ComputedTorqueController& law);

}  // namespace safe_arm

#endif  // EXAMPLES_SAFE_ARM_ARM_START_HPP
