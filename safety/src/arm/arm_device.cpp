// SPDX-License-Identifier: Apache-2.0
#include "mamori/safety/arm/arm_device.hpp"

namespace mamori::safety {

// The image crosses process and port boundaries as bytes.
static_assert(is_payload<ArmInputs>() && is_payload<ArmOutputs>());

}  // namespace mamori::safety
