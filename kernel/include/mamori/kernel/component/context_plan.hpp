// SPDX-License-Identifier: Apache-2.0
/// @file
/// What the system table plans for one execution context: its kind, its periods, and how a failure is told.
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

/// Who decides when a cycle comes; the numbers are those of the standard.
enum class ExecutionKind : std::uint32_t {
    kPeriodic = 0U,     ///< the frame: on_execute and on_state_update of its Active components
    kEventDriven = 1U,  ///< events: on_action of those that take part in a state machine
    kOther = 2U,        ///< an ExternalTrigger: the actions of kPeriodic, one cycle for each tick
};

/// Which actions a component gets when it leaves Active because something failed.
enum class AbortPolicy : std::uint8_t {
    kSpecOnly,       ///< on_aborting, as the text of the standard says
    kOpenRtmCompat,  ///< on_deactivated, then on_aborting, the order of OpenRTM-aist 2.x
};

/// Plan of one context; the table gives it to ExecutionContext::attach(), which says what it refuses.
struct ContextPlan {
    /// Time between two windows of the context, > 0. The period in use after attach().
    Duration period{};
    /// Slower periods that set_rate() may choose, each a whole multiple of `period`; kPeriodic only. The
    /// elements must outlive the context.
    Span<const Duration> alternative_periods{};
    ExecutionKind kind{ExecutionKind::kPeriodic};
    AbortPolicy abort_policy{AbortPolicy::kSpecOnly};
    /// Set exactly when the kind is kOther; must outlive the context and serve no other one.
    ExternalTrigger* trigger{nullptr};
    /// Upper bound of the events that each state machine takes in one cycle, >= 1 whatever the kind is; used
    /// in kEventDriven only.
    std::size_t events_per_cycle{1U};
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_CONTEXT_PLAN_HPP
