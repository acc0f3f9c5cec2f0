// SPDX-License-Identifier: Apache-2.0
/// @file
/// The steps in which a system goes from mode to mode, and what is known when one of them fails.
///
/// @satisfies SWR-MOD-005      Design: docs/design/modes.md#the-switch
#ifndef MAMORI_KERNEL_MODE_STEP_HPP
#define MAMORI_KERNEL_MODE_STEP_HPP

#include <cstddef>
#include <cstdint>

#include "mamori/kernel/table/table_index.hpp"

namespace mamori {

/// What all cores do at one frame boundary.
enum class ModeStep : std::uint8_t {
    kNone,   ///< nothing
    kSet,    ///< a configuration set that was asked for becomes active
    kLeave,  ///< components that the next mode does not run are deactivated, their connections end
    kEnter,  ///< parameters and connections of the next mode; its other components are activated
    kSafe,   ///< whatever the safe mode does not run is deactivated; its parameters and connections
};

/// Why a step failed, or a switch was broken off.
enum class ModeFailureCause : std::uint8_t {
    kNone,
    kRefused,     ///< on_deactivated or on_activated did not return kOk, or the component is not Inactive
    kOverrun,     ///< that action used up the budget of its window, or hangs
    kNoTurn,      ///< a window did not come to its part: overrun, hanging, or stopped in other than kSet
    kParameters,  ///< the configuration set of the mode was refused;
                  ///< ExecutionObserver::on_configuration_refused() names the value
    kLate,        ///< a core was not there in its frame
    kStopped,     ///< an executive was stopped in the middle of a switch
    kRequested,   ///< request_safe_mode()
};

/// The first failure since the last SystemModes::reset(); cause kNone when there was none.
struct ModeFailure {
    ModeFailureCause cause{ModeFailureCause::kNone};
    ModeStep step{ModeStep::kNone};
    std::size_t component{kNoIndex};  ///< guilty one, place in the system table; kNoIndex: none in particular
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_MODE_STEP_HPP
