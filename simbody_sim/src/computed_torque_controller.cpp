// SPDX-License-Identifier: Apache-2.0
#include "mamori/simbody_sim/computed_torque_controller.hpp"

namespace mamori::sim {

ComputedTorqueController::ComputedTorqueController(const ArmModel& model, TrackingGains gains)
    : dynamics_(model), gains_(gains) {}

JointVector ComputedTorqueController::calc_torque(const JointVector& q_ref, const JointVector& qd_ref,
                                                  const JointVector& qdd_ref, const JointVector& q,
                                                  const JointVector& qd) {
    JointVector qdd{};
    for (std::size_t i = 0U; i < kArmJointCount; ++i) {
        qdd[i] = qdd_ref[i] + gains_.kd_per_s * (qd_ref[i] - qd[i]) + gains_.kp_per_s2 * (q_ref[i] - q[i]);
    }
    return dynamics_.calc_inverse_dynamics(q, qd, qdd);
}

JointVector ComputedTorqueController::calc_gravity_torque(const JointVector& q) {
    return dynamics_.calc_gravity_torque(q);
}

}  // namespace mamori::sim
