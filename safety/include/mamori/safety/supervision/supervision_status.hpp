// SPDX-License-Identifier: Apache-2.0
/// @file
/// Health of supervised entities and of all of them together, and what took it away.
///
/// @satisfies SWR-SUP-026, SWR-SUP-028      Design: docs/design/supervision.md#local-status-of-an-entity
/// Source:   AUTOSAR Watchdog Manager (local and global supervision status)
#ifndef MAMORI_SAFETY_SUPERVISION_SUPERVISION_STATUS_HPP
#define MAMORI_SAFETY_SUPERVISION_SUPERVISION_STATUS_HPP

#include <cstdint>

#include "mamori/safety/supervision/execution_supervisor.hpp"

namespace mamori::safety {

/// Health of one entity; ordered, the worst is the largest.
enum class EntityStatus : std::uint8_t {
    kDeactivated,  ///< the mode does not want it: its reports are ignored
    kOk,
    kFailed,   ///< reference cycles were wrong, within the tolerance; heals by right ones
    kExpired,  ///< latched until acknowledge(), in every mode
};

/// Health of all entities; ordered, the worst is the largest.
enum class SupervisionStatus : std::uint8_t {
    kOk,
    kFailed,
    kExpired,
    kStopped,  ///< expired for longer than tolerated: for good
};

/// Why an entity expired. The first violation is kept. The numbers are stored over a reset and never change.
enum class CheckpointViolation : std::uint8_t {
    kNone = 0U,
    kLostReport = 1U,  ///< it reported more than the queue holds: a loop that runs wild
    kForeign = 2U,     ///< it reported a checkpoint that it does not have
    kClock = 3U,       ///< the clock ran backwards, or a report carries a time that has not come yet
    kOrder = 4U,       ///< no edge leads from the checkpoint before to this one, or it is not an initial one
    kTooShort = 5U,    ///< finish before the shortest time
    kTooLong = 6U,     ///< finish after the longest time
    kMissingFinish = 7U,  ///< the longest time is over without the finish, or it started anew without it
    kMissingStart = 8U,   ///< finish without a start
    kAlive = 9U,          ///< more wrong reference cycles than tolerated
};
/// Largest number of the enumerators above.
inline constexpr std::uint32_t kCheckpointViolationMax = 9U;

/// What the entities add to the status that a watchdog gate asks for.
constexpr GlobalStatus to_global_status(SupervisionStatus status) noexcept {
    if (status == SupervisionStatus::kOk) {
        return GlobalStatus::kOk;
    }
    return status == SupervisionStatus::kFailed ? GlobalStatus::kFailed : GlobalStatus::kExpired;
}

/// Status of a whole of which two parts are supervised.
constexpr GlobalStatus calc_worst(GlobalStatus a, GlobalStatus b) noexcept {
    return a > b ? a : b;
}

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_SUPERVISION_SUPERVISION_STATUS_HPP
