// SPDX-License-Identifier: Apache-2.0
/// @file
/// Last failed action of a component, its status and its time. Explains why the component is in Error.
///
/// @satisfies SWR-RTC-004      Design: docs/design/rtc_semantics.md#failures
#ifndef MAMORI_KERNEL_ACTION_FAILURE_HPP
#define MAMORI_KERNEL_ACTION_FAILURE_HPP

#include <cstdint>

#include "mamori/kernel/base/status.hpp"
#include "mamori/kernel/base/time.hpp"

namespace mamori {

/// Actions whose return code is evaluated, in the order of the standard. on_aborting and on_error are
/// excluded, because they run after another action has failed.
enum class ComponentAction : std::uint8_t {
    kInitialize,
    kFinalize,
    kStartup,
    kShutdown,
    kActivated,
    kDeactivated,
    kReset,
    kExecute,
    kStateUpdate,
    kRateChanged,
    kAction,
    kModeChanged,
};

/// Name of an action in the RTC standard; never nullptr.
constexpr const char* get_name(ComponentAction action) noexcept {
    switch (action) {
        case ComponentAction::kInitialize:
            return "on_initialize";
        case ComponentAction::kFinalize:
            return "on_finalize";
        case ComponentAction::kStartup:
            return "on_startup";
        case ComponentAction::kShutdown:
            return "on_shutdown";
        case ComponentAction::kActivated:
            return "on_activated";
        case ComponentAction::kDeactivated:
            return "on_deactivated";
        case ComponentAction::kReset:
            return "on_reset";
        case ComponentAction::kExecute:
            return "on_execute";
        case ComponentAction::kStateUpdate:
            return "on_state_update";
        case ComponentAction::kRateChanged:
            return "on_rate_changed";
        case ComponentAction::kAction:
            return "on_action";
        case ComponentAction::kModeChanged:
            return "on_mode_changed";
    }
    return "invalid_action";  // only a corrupted value gets here
}

/// One action that did not return kOk.
struct ActionFailure {
    Instant at{};                                       ///< instant passed to the action
    Status status{Status::kOk};                         ///< returned code; kOk: nothing has failed yet
    ComponentAction action{ComponentAction::kStartup};  ///< undefined while status is kOk
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_ACTION_FAILURE_HPP
