// SPDX-License-Identifier: Apache-2.0
/// @file
/// What a run in virtual time and one by the clock have in common before their first frame.
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

/// The path begins here: operational since 0.1 s, brakes open, hold settled.
inline constexpr mamori::Duration kMotionStart{500'000'000};

/// Reads the model, which must lie around the safe limits, and the motion, when one is named.
/// @return one line with file and reason, or nothing.
std::string load_inputs(const std::string& model_path, const std::string& motion_path,
                        mamori::sim::LoadedModel& loaded, MotionTrack& track);

/// @return why `fault`, whose instant counts from the start of the motion, cannot be injected during the
/// motion of `track`; or nothing.
std::string check_fault_instant(const mamori::sim::FaultPlan& fault, const MotionTrack& track);

/// Configures the components and puts the executive under supervision.
/// @param[in] track, law must outlive the run. @return why the system does not start, or nothing.
std::string prepare_system(const mamori::sim::ArmModel& model, const MotionTrack& track,
                           mamori::sim::ComputedTorqueController& law);

/// @return which component prevented the start.
std::string describe_failed_start();

/// The same as prepare_system(); then initialises and starts the executive.
std::string start_system(const mamori::sim::ArmModel& model, const MotionTrack& track,
                         mamori::sim::ComputedTorqueController& law);

}  // namespace safe_arm

#endif  // EXAMPLES_SAFE_ARM_ARM_START_HPP
