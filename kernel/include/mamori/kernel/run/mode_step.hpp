// SPDX-License-Identifier: Apache-2.0
/// @file
/// Steps of a mode switch, and the record of a failed step.
///
/// @satisfies SWR-MOD-005      Design: docs/design/modes.md#the-switch
#ifndef MAMORI_KERNEL_MODE_STEP_HPP
#define MAMORI_KERNEL_MODE_STEP_HPP

#include <cstddef>
#include <cstdint>

#include "mamori/kernel/table/table_index.hpp"

namespace mamori {

/// Action of all cores at one major frame boundary.
enum class ModeStep : std::uint8_t {
    kNone,   ///< no action
    kSet,    ///< a requested configuration set becomes active
    kLeave,  ///< components not in the next mode are deactivated; their connections end
    kEnter,  ///< parameters and connections of the next mode; its other components are activated
    kSafe,   ///< components not in the safe mode are deactivated; its parameters and connections
};

/// Why a step failed, or why a mode switch was aborted.
enum class ModeFailureCause : std::uint8_t {
    kNone,
    kRefused,     ///< on_deactivated or on_activated failed, or the component is not Inactive
    kOverrun,     ///< that action exhausted the budget of its window, or hangs
    kNoTurn,      ///< a window did not execute its step: overrun, hanging, or stopped (except in kSet)
    kParameters,  ///< configuration set rejected; see on_configuration_refused()
    kLate,        ///< a core did not execute the step in its major frame
    kStopped,     ///< an executive was stopped during the mode switch
    kRequested,   ///< request_safe_mode() was called
};

/// First failure since the last SystemModes::reset(); cause kNone: none.
struct ModeFailure {
    ModeFailureCause cause{ModeFailureCause::kNone};
    ModeStep step{ModeStep::kNone};
    std::size_t component{kNoIndex};  ///< responsible component, index in the system table; kNoIndex: none
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_MODE_STEP_HPP
