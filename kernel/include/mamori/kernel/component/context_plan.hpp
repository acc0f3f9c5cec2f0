// SPDX-License-Identifier: Apache-2.0
/// @file
/// Plan of one execution context in the system table: kind, periods and actions after a failure.
///
/// @satisfies SWR-RTC-001      Design: docs/design/rtc_semantics.md#context-plan
/// Source:   OMG RTC 1.0, ExecutionKind (IDL order is the wire value) and ExecutionContextProfile
#ifndef MAMORI_KERNEL_CONTEXT_PLAN_HPP
#define MAMORI_KERNEL_CONTEXT_PLAN_HPP

#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/time.hpp"

namespace mamori {

class ExternalTrigger;

/// Source of the cycles; the numbers are those of the standard.
enum class ExecutionKind : std::uint32_t {
    kPeriodic = 0U,     ///< schedule: on_execute and on_state_update of Active components
    kEventDriven = 1U,  ///< events: on_action of the participants of a state machine
    kOther = 2U,        ///< ExternalTrigger: the actions of kPeriodic, one cycle per tick
};

/// Actions that a component receives when it leaves Active because of a failure.
enum class AbortPolicy : std::uint8_t {
    kSpecOnly,       ///< on_aborting, as the standard specifies
    kOpenRtmCompat,  ///< on_deactivated, then on_aborting, the order of OpenRTM-aist 2.x
};

/// Plan of one context. The table passes it to ExecutionContext::attach(), which specifies what it rejects.
struct ContextPlan {
    /// Time between two windows of the context, > 0. The current period after attach().
    Duration period{};
    /// Longer periods that set_rate() may select, each an integer multiple of `period`; kPeriodic only. The
    /// elements must outlive the context.
    Span<const Duration> alternative_periods{};
    ExecutionKind kind{ExecutionKind::kPeriodic};
    AbortPolicy abort_policy{AbortPolicy::kSpecOnly};
    /// Not nullptr if and only if the kind is kOther; must outlive the context and trigger no other context.
    ExternalTrigger* trigger{nullptr};
    /// Maximum number of events that each state machine processes per cycle, >= 1 for every kind; used in
    /// kEventDriven only.
    std::size_t events_per_cycle{1U};
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_CONTEXT_PLAN_HPP
