// SPDX-License-Identifier: Apache-2.0
/// @file
/// The simulated arm as data, and the reader of its model file. Every figure of a file names its source or
/// says that it is an assumption; a figure that is missing, impossible or without origin is refused by name
/// and line.
///
/// @satisfies SWR-SIM-001, SWR-SIM-002      Design: docs/design/simulation.md#model-file
#ifndef MAMORI_SIMBODY_SIM_ARM_MODEL_HPP
#define MAMORI_SIMBODY_SIM_ARM_MODEL_HPP

#include <array>
#include <optional>
#include <string>

#include "mamori/kernel/base/time.hpp"
#include "mamori/safety/arm/arm_device.hpp"

namespace mamori::sim {

using safety::JointVector;
using safety::kArmJointCount;

/// x, y, z in the frame that the user of the type names.
using Vector3 = std::array<double, 3U>;
/// Row-major square matrix over the joints.
using JointMatrix = std::array<JointVector, kArmJointCount>;

/// Step of the plant's integrator. Part of the model's contract: a model that is too stiff for it is refused.
inline constexpr Duration kPlantSubstep{250000};

/// Rigid body in the frame of the link that carries it.
struct BodyModel {
    double mass_kg{0.0};                     ///< > 0
    Vector3 center_of_mass_m{};              ///< from the origin of the link frame
    std::array<double, 6U> inertia_kg_m2{};  ///< xx, yy, zz, xy, xz, yz about the centre of mass
};

/// Spring-applied brake at the joint side.
struct BrakeModel {
    double torque_nm{0.0};         ///< > 0: holds up to this, slips at this
    Duration closing_delay{};      ///< from losing its current until it holds
    Duration opening_delay{};      ///< from getting its current until it is free
    double stiffness_nm_rad{0.0};  ///< > 0: of the bristle, while it holds
    double damping_nm_s_rad{0.0};  ///< >= 0: of the bristle, while it holds
};

/// One joint with the link that it moves. The link frame sits on the joint; all link frames are parallel at
/// zero.
struct JointModel {
    std::string name;
    Vector3 axis{};      ///< unit vector in the link frame
    Vector3 offset_m{};  ///< from the parent's frame to this one, at zero position
    BodyModel link;
    double position_min_rad{0.0};     ///< mechanical end stop
    double position_max_rad{0.0};     ///< mechanical end stop, > position_min_rad
    double speed_limit_rad_s{0.0};    ///< > 0: mechanical limit = speed at which the motor's torque is zero
    double torque_limit_nm{0.0};      ///< > 0: at the joint side, at standstill
    double rotor_inertia_kg_m2{0.0};  ///< > 0: at the motor side, gear input included
    double gear_ratio{0.0};           ///< > 0: motor turns per joint turn
    double viscous_friction_nm_s_rad{0.0};  ///< >= 0
    BrakeModel brake;
    double stop_stiffness_nm_rad{0.0};     ///< > 0
    double stop_dissipation_s_rad{0.0};    ///< >= 0: torque = stiffness * depth * (1 + dissipation * speed)
    double encoder_a_counts_per_rad{0.0};  ///< > 0
    double encoder_b_counts_per_rad{0.0};  ///< > 0
};

/// Whole arm, fixed to the floor.
struct ArmModel {
    std::string name;
    std::array<JointModel, kArmJointCount> joints;
    BodyModel gripper;  ///< in the frame of the last link, to which it is fixed
    Vector3 gravity_m_s2{};
    Duration sto_delay{};  ///< from the safe-torque-off input to zero torque
    std::size_t motion_columns_ignored{
        0U};  ///< trailing columns of a motion table that are not joints of this arm
};

/// Inertia of the rotor as the joint feels it: gear_ratio^2 * rotor_inertia [kg m^2].
double calc_armature(const JointModel& joint) noexcept;

/// A model, or the reason in one line: `<file>:<line>: <where>: <key>: <what is wrong>`.
struct LoadedModel {
    std::optional<ArmModel> model;
    std::string error;
};

/// Reads a model file. @param[in] path as the user gave it; it is repeated in the error.
/// Calling context: host, start-up only; reads one file.
LoadedModel load_arm_model(const std::string& path);

/// As load_arm_model, from a text. @param[in] name what the error calls the text.
LoadedModel parse_arm_model(const std::string& text, const std::string& name);

}  // namespace mamori::sim

#endif  // MAMORI_SIMBODY_SIM_ARM_MODEL_HPP
