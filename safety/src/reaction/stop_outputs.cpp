// SPDX-License-Identifier: Apache-2.0
#include "mamori/safety/reaction/stop_outputs.hpp"

namespace mamori::safety {

static_assert(calc_stop_outputs(static_cast<SafeState>(0)) == StopOutputs{},
              "cleared memory is the safe state");
static_assert(!calc_stop_outputs(SafeState::kSafe).torque_enable &&
              !calc_stop_outputs(SafeState::kLockedOut).torque_enable);

}  // namespace mamori::safety
