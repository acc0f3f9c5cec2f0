// SPDX-License-Identifier: Apache-2.0
/// @file
/// Which action of a component failed last, how, and when: the answer to "why is it in Error?".
///
/// @satisfies SWR-RTC-004      Design: docs/design/rtc_semantics.md#failures
#ifndef MAMORI_KERNEL_ACTION_FAILURE_HPP
#define MAMORI_KERNEL_ACTION_FAILURE_HPP

#include <cstdint>

#include "mamori/kernel/base/status.hpp"
#include "mamori/kernel/base/time.hpp"

namespace mamori {

/// Actions whose answer counts, in the order of the standard. Not among them: on_aborting and on_error, which
/// run because something has failed already.
enum class ComponentAction : std::uint8_t {
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

/// Spelling of an action as the standard prints it; never nullptr.
constexpr const char* get_name(ComponentAction action) noexcept {
    switch (action) {
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
    return "invalid_action";  // only a corrupted value comes here
}

/// One answer that was not kOk.
struct ActionFailure {
    Instant at{};                                       ///< instant that the action was given
    Status status{Status::kOk};                         ///< kOk: nothing has failed yet
    ComponentAction action{ComponentAction::kStartup};  ///< without meaning while kOk
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_ACTION_FAILURE_HPP
