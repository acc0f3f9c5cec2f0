// SPDX-License-Identifier: Apache-2.0
#include "mamori/simbody_sim/arm_model.hpp"

namespace mamori::sim {

double calc_armature(const JointModel& joint) noexcept {
    return joint.gear_ratio * joint.gear_ratio * joint.rotor_inertia_kg_m2;
}

}  // namespace mamori::sim
