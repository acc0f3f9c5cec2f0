// SPDX-License-Identifier: Apache-2.0
#include "mamori/simbody_sim/arm_dynamics.hpp"

#include <kdl/chain.hpp>
#include <kdl/chaindynparam.hpp>
#include <kdl/chainidsolver_recursive_newton_euler.hpp>
#include <kdl/jntspaceinertiamatrix.hpp>

#include "mamori/kernel/base/assert.hpp"

namespace mamori::sim {
namespace {

KDL::Vector to_vector(const Vector3& v) {
    return {v[0], v[1], v[2]};
}

KDL::RigidBodyInertia to_inertia(const BodyModel& body) {
    const auto [xx, yy, zz, xy, xz, yz] = body.inertia_kg_m2;
    return KDL::RigidBodyInertia(body.mass_kg, to_vector(body.center_of_mass_m),
                                 KDL::RotationalInertia(xx, yy, zz, xy, xz, yz));
}

/// One segment per joint. KDL takes a segment's inertia in the frame of its tip: joint and tip are put at the
/// same point, so that the tip frame is the link frame.
KDL::Chain to_chain(const ArmModel& model) {
    KDL::Chain chain;
    for (std::size_t i = 0U; i < kArmJointCount; ++i) {
        const JointModel& joint = model.joints[i];
        const KDL::Vector offset = to_vector(joint.offset_m);
        const KDL::RigidBodyInertia link = to_inertia(joint.link);
        const bool last = i + 1U == kArmJointCount;
        chain.addSegment(KDL::Segment(KDL::Joint(joint.name, offset, to_vector(joint.axis),
                                                 KDL::Joint::RotAxis, 1.0, 0.0, calc_armature(joint)),
                                      KDL::Frame(offset), last ? link + to_inertia(model.gripper) : link));
    }
    return chain;
}

void copy(const JointVector& from, KDL::JntArray& to) {
    for (std::size_t i = 0U; i < kArmJointCount; ++i) {
        to(static_cast<unsigned>(i)) = from[i];
    }
}

JointVector to_joint_vector(const KDL::JntArray& from) {
    JointVector result{};
    for (std::size_t i = 0U; i < kArmJointCount; ++i) {
        result[i] = from(static_cast<unsigned>(i));
    }
    return result;
}

}  // namespace

struct ArmDynamics::Impl {
    static constexpr unsigned kSize = static_cast<unsigned>(kArmJointCount);

    explicit Impl(const ArmModel& model)
        : chain(to_chain(model)),
          parameters(chain, to_vector(model.gravity_m_s2)),
          inverse(chain, to_vector(model.gravity_m_s2)),
          no_forces(chain.getNrOfSegments(), KDL::Wrench::Zero()) {}

    KDL::Chain chain;
    KDL::ChainDynParam parameters;
    KDL::ChainIdSolver_RNE inverse;
    KDL::Wrenches no_forces;
    KDL::JntArray q{kSize};
    KDL::JntArray qd{kSize};
    KDL::JntArray qdd{kSize};
    KDL::JntArray torque{kSize};
    KDL::JntSpaceInertiaMatrix mass{static_cast<int>(kSize)};
};

ArmDynamics::ArmDynamics(const ArmModel& model) : impl_(std::make_unique<Impl>(model)) {}
ArmDynamics::~ArmDynamics() = default;

JointMatrix ArmDynamics::calc_mass_matrix(const JointVector& q) {
    copy(q, impl_->q);
    MAMORI_ENSURE(1, impl_->parameters.JntToMass(impl_->q, impl_->mass) == KDL::SolverI::E_NOERROR);
    JointMatrix result{};
    for (std::size_t i = 0U; i < kArmJointCount; ++i) {
        for (std::size_t k = 0U; k < kArmJointCount; ++k) {
            result[i][k] = impl_->mass(static_cast<unsigned>(i), static_cast<unsigned>(k));
        }
    }
    return result;
}

JointVector ArmDynamics::calc_gravity_torque(const JointVector& q) {
    return calc_inverse_dynamics(q, {}, {});
}

JointVector ArmDynamics::calc_inverse_dynamics(const JointVector& q, const JointVector& qd,
                                               const JointVector& qdd) {
    copy(q, impl_->q);
    copy(qd, impl_->qd);
    copy(qdd, impl_->qdd);
    MAMORI_ENSURE(2, impl_->inverse.CartToJnt(impl_->q, impl_->qd, impl_->qdd, impl_->no_forces,
                                              impl_->torque) == KDL::SolverI::E_NOERROR);
    return to_joint_vector(impl_->torque);
}

}  // namespace mamori::sim
