// SPDX-License-Identifier: Apache-2.0
#include "mamori/simbody_sim/arm_multibody.hpp"

#include <Simbody.h>

namespace mamori::sim {
namespace {

SimTK::Vec3 to_vec3(const Vector3& v) {
    return {v[0], v[1], v[2]};
}

/// Inertia about the origin of the link frame.
SimTK::Inertia calc_origin_inertia(const BodyModel& body) {
    const auto [xx, yy, zz, xy, xz, yz] = body.inertia_kg_m2;
    const SimTK::Inertia central({xx, yy, zz}, {xy, xz, yz});
    return central.shiftFromMassCenter(to_vec3(body.center_of_mass_m), body.mass_kg);
}

SimTK::MassProperties to_mass_properties(const BodyModel& body) {
    return {body.mass_kg, to_vec3(body.center_of_mass_m), calc_origin_inertia(body)};
}

/// Both bodies as one, in the same frame.
SimTK::MassProperties to_mass_properties(const BodyModel& a, const BodyModel& b) {
    const double mass = a.mass_kg + b.mass_kg;
    const SimTK::Vec3 moment =
        a.mass_kg * to_vec3(a.center_of_mass_m) + b.mass_kg * to_vec3(b.center_of_mass_m);
    return {mass, moment / mass, calc_origin_inertia(a) + calc_origin_inertia(b)};
}

}  // namespace

struct ArmMultibody::Impl {
    explicit Impl(const ArmModel& model)
        : matter(system), forces(system), gravity(forces, matter, to_vec3(model.gravity_m_s2)) {
        SimTK::MobilizedBody parent = matter.Ground();
        for (std::size_t i = 0U; i < kArmJointCount; ++i) {
            const JointModel& joint = model.joints[i];
            const SimTK::MassProperties properties = i + 1U == kArmJointCount
                                                         ? to_mass_properties(joint.link, model.gripper)
                                                         : to_mass_properties(joint.link);
            // A Pin turns about the z axis of its two frames: both are turned until z is the joint's axis.
            const SimTK::Rotation turned(SimTK::UnitVec3(to_vec3(joint.axis)), SimTK::ZAxis);
            SimTK::MobilizedBody::Pin body(parent, SimTK::Transform(turned, to_vec3(joint.offset_m)),
                                           SimTK::Body::Rigid(properties), SimTK::Transform(turned));
            const SimTK::Force::MobilityLinearStop stop(
                forces, body, SimTK::MobilizerQIndex(0), joint.stop_stiffness_nm_rad,
                joint.stop_dissipation_s_rad, joint.position_min_rad, joint.position_max_rad);
            armature[i] = calc_armature(joint);
            parent = body;
        }
        state = system.realizeTopology();
        system.realizeModel(state);
        no_acceleration = SimTK::Vector(static_cast<int>(kArmJointCount), 0.0);
    }

    SimTK::MultibodySystem system;
    SimTK::SimbodyMatterSubsystem matter;
    SimTK::GeneralForceSubsystem forces;
    SimTK::Force::Gravity gravity;
    SimTK::State state;
    SimTK::Vector no_acceleration;
    SimTK::Vector residual;
    SimTK::Matrix mass;

    JointVector armature{};
    JointVector velocity{};
    JointMatrix mass_matrix{};
    JointVector bias_torque{};
};

ArmMultibody::ArmMultibody(const ArmModel& model) : impl_(std::make_unique<Impl>(model)) {
    evaluate({}, {});
}
ArmMultibody::~ArmMultibody() = default;

void ArmMultibody::evaluate(const JointVector& q, const JointVector& u) {
    Impl& m = *impl_;
    SimTK::Vector& state_q = m.state.updQ();
    SimTK::Vector& state_u = m.state.updU();
    for (std::size_t i = 0U; i < kArmJointCount; ++i) {
        state_q[static_cast<int>(i)] = q[i];
        state_u[static_cast<int>(i)] = u[i];
    }
    m.velocity = u;
    m.system.realize(m.state, SimTK::Stage::Dynamics);
    m.matter.calcM(m.state, m.mass);
    m.matter.calcResidualForceIgnoringConstraints(
        m.state, m.system.getMobilityForces(m.state, SimTK::Stage::Dynamics),
        m.system.getRigidBodyForces(m.state, SimTK::Stage::Dynamics), m.no_acceleration, m.residual);
    for (std::size_t i = 0U; i < kArmJointCount; ++i) {
        for (std::size_t k = 0U; k < kArmJointCount; ++k) {
            m.mass_matrix[i][k] = m.mass(static_cast<int>(i), static_cast<int>(k));
        }
        m.mass_matrix[i][i] += m.armature[i];
        m.bias_torque[i] = m.residual[static_cast<int>(i)];
    }
}

const JointMatrix& ArmMultibody::get_mass_matrix() const noexcept {
    return impl_->mass_matrix;
}
const JointVector& ArmMultibody::get_bias_torque() const noexcept {
    return impl_->bias_torque;
}

double ArmMultibody::calc_energy_j() const {
    double energy = impl_->system.calcEnergy(impl_->state);
    for (std::size_t i = 0U; i < kArmJointCount; ++i) {
        energy += 0.5 * impl_->armature[i] * impl_->velocity[i] * impl_->velocity[i];
    }
    return energy;
}

}  // namespace mamori::sim
