// SPDX-License-Identifier: Apache-2.0
/// @file
/// Torque that holds the arm against gravity, from masses and lengths of its links. The gate holds the arm
/// with it and limits the controller around it. The runner rejects an arm with other gravity torques.
///
/// @satisfies SWR-SAF-040      Design: docs/design/safe_arm.md#torque-limits
#ifndef EXAMPLES_SAFE_ARM_GRAVITY_MODEL_HPP
#define EXAMPLES_SAFE_ARM_GRAVITY_MODEL_HPP

#include "messages.hpp"

namespace safe_arm {

/// @param[in] position_rad of the joints, up to 1e6; another one counts as 0.
/// @return torque of each joint that holds the arm [N m], without friction.
/// Calling context: any; no state. Time: O(joints).
JointVector calc_gravity_torque(const JointVector& position_rad) noexcept;

}  // namespace safe_arm

#endif  // EXAMPLES_SAFE_ARM_GRAVITY_MODEL_HPP
