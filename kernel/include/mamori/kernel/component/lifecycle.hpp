// SPDX-License-Identifier: Apache-2.0
/// @file
/// Life cycle of an RT component in its execution context: four states and one table of the events that each
/// state allows. Only this table decides transitions.
///
/// @satisfies SWR-KRN-010      Design: docs/design/kernel.md#life-cycle
/// Source:   OMG RTC 1.0, LifeCycleState and ExecutionContextOperations
#ifndef MAMORI_KERNEL_LIFECYCLE_HPP
#define MAMORI_KERNEL_LIFECYCLE_HPP

#include <array>
#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/assert.hpp"
#include "mamori/kernel/base/status.hpp"

namespace mamori {

/// State of a component in its context; the numbers are those of the standard.
enum class LifecycleState : std::uint32_t { kCreated = 0U, kInactive = 1U, kActive = 2U, kError = 3U };
inline constexpr std::size_t kLifecycleStateCount = 4U;

/// Events in the life cycle of a component.
enum class LifecycleEvent : std::uint32_t {
    kInitialize,  ///< RTC.initialize()
    kActivate,    ///< ExecutionContext.activate_component()
    kDeactivate,  ///< ExecutionContext.deactivate_component()
    kReset,       ///< ExecutionContext.reset_component()
    kFail,        ///< an action that leads to Error did not return kOk: see Component
};
inline constexpr std::size_t kLifecycleEventCount = 5U;

/// One cell of the table.
struct LifecycleTransition {
    /// kOk: allowed; otherwise the code that the caller receives.
    Status admission{Status::kPreconditionNotMet};
    /// State after an allowed event whose action returned kOk; undefined when the event is not allowed.
    LifecycleState target{LifecycleState::kCreated};
};

/// Cell for (state, event). Pure; O(1). A value that is not an enumerator (memory corruption) is a contract
/// violation.
/// @return admission kOk with the target; kBadParameter (kActivate or kDeactivate of a component that is not
///         alive); kPreconditionNotMet (any other event that the state does not allow).
constexpr LifecycleTransition get_transition(LifecycleState state, LifecycleEvent event) noexcept {
    constexpr LifecycleTransition kBad{Status::kBadParameter, LifecycleState::kCreated};
    constexpr LifecycleTransition kNo{};
    constexpr LifecycleTransition kToInactive{Status::kOk, LifecycleState::kInactive};
    constexpr LifecycleTransition kToActive{Status::kOk, LifecycleState::kActive};
    constexpr LifecycleTransition kToError{Status::kOk, LifecycleState::kError};
    constexpr std::array<std::array<LifecycleTransition, kLifecycleEventCount>, kLifecycleStateCount> kTable{{
        //  kInitialize  kActivate  kDeactivate  kReset       kFail
        {{kToInactive, kBad, kBad, kNo, kNo}},     // kCreated
        {{kNo, kToActive, kNo, kNo, kToError}},    // kInactive
        {{kNo, kNo, kToInactive, kNo, kToError}},  // kActive
        {{kNo, kNo, kNo, kToInactive, kNo}},       // kError
    }};
    const auto row = static_cast<std::size_t>(state);
    const auto column = static_cast<std::size_t>(event);
    MAMORI_REQUIRE(1, row < kLifecycleStateCount && column < kLifecycleEventCount);
    return kTable[row][column];
}

/// Name of a state in the RTC standard; never nullptr.
constexpr const char* get_name(LifecycleState state) noexcept {
    switch (state) {
        case LifecycleState::kCreated:
            return "CREATED_STATE";
        case LifecycleState::kInactive:
            return "INACTIVE_STATE";
        case LifecycleState::kActive:
            return "ACTIVE_STATE";
        case LifecycleState::kError:
            return "ERROR_STATE";
    }
    return "INVALID_STATE";  // only a corrupted value gets here
}

}  // namespace mamori

#endif  // MAMORI_KERNEL_LIFECYCLE_HPP
