// SPDX-License-Identifier: Apache-2.0
/// @file
/// Supervision of another node by its survival notices: faults latch and name their cause.
///
/// @satisfies SWR-NTC-003, SWR-NTC-004, SWR-NTC-006, SWR-NTC-009, SWR-NTC-010
/// Design:   docs/design/supervision.md#survival-notice
#ifndef MAMORI_SAFETY_NOTICE_NODE_SUPERVISOR_HPP
#define MAMORI_SAFETY_NOTICE_NODE_SUPERVISOR_HPP

#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/assert.hpp"
#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/time.hpp"
#include "mamori/kernel/payload/cdr_scalar.hpp"
#include "mamori/kernel/payload/fields.hpp"

namespace mamori::safety {

/// What is wrong with a node. The first fault of a node is kept.
enum class NoticeFault : std::uint8_t {
    kNone,
    kSilent,            ///< no notice for longer than the silent time
    kLate,              ///< no notice for longer than the late time
    kOutOfOrder,        ///< repeated or older notice, or more lost ones than tolerated
    kWrongNode,         ///< intact message with another data id
    kOtherTable,        ///< version of another description: states are not used
    kComponentMissing,  ///< a component is not alive
    kComponentError,    ///< a component is in Error
    kComponentExpired,  ///< the supervision of a component has expired
};
/// Largest number of the enumerators above.
inline constexpr std::uint32_t kNoticeFaultMax = 8U;

/// "No component".
inline constexpr std::uint16_t kNoNoticeComponent = 0xFFFFU;

/// Spelling for logs and reports; "Invalid" for a corrupted value, never nullptr.
const char* get_name(NoticeFault fault) noexcept;

/// When missing notices are a fault. The tolerance covers transport, window offsets and clock difference.
struct NoticeLimits {
    Duration tolerance{0};           ///< added to each time, >= 0
    std::uint32_t late_periods{2U};  ///< 1 .. silent_periods - 1; one more than the notices that may be lost
    std::uint32_t silent_periods{3U};
    /// From the start to the first accepted notice, >= 3: two successive notices find the order, so losses
    /// prolong the start.
    std::uint32_t start_periods{10U};
};

/// True when the limits are inside their range and each time is at most 73 years without its tolerance.
constexpr bool is_valid(NoticeLimits limits, Duration period) noexcept {
    constexpr std::int64_t kLongest = std::int64_t{1} << 61U;
    return limits.tolerance >= Duration{0} && limits.tolerance.ns <= kLongest && period > Duration{0} &&
           limits.late_periods >= 1U && limits.late_periods < limits.silent_periods &&
           limits.start_periods >= 3U && period.ns <= kLongest / limits.silent_periods &&
           period.ns <= kLongest / limits.start_periods;
}

/// Summary of a node for other components of the receiver.
struct NodeStatus {
    std::uint32_t faults{0U};                     ///< bit n: the fault with number n is latched
    NoticeFault first{NoticeFault::kNone};        ///< fault that was latched first
    std::uint16_t component{kNoNoticeComponent};  ///< index of the first component with a fault
    bool is_proven{false};  ///< a notice was accepted since the start or acknowledgement; no fault is latched
};
constexpr bool has_fault(const NodeStatus& status, NoticeFault fault) noexcept {
    return (status.faults & (std::uint32_t{1U} << static_cast<std::uint32_t>(fault))) != 0U;
}

/// Evaluates the notices of one node, after their check.
///
/// Thread safety: none; call every member from the same execution context.
/// Time:          evaluate() is O(components), the others are O(1). Nothing blocks. Memory: no heap.
class NodeSupervisor final {
  public:
    /// @param[in] period time between two notices. @param[in] limits valid for it.
    constexpr NodeSupervisor(Duration period, NoticeLimits limits) noexcept
        : start_after_{limits.start_periods * period.ns + limits.tolerance.ns},
          late_after_{limits.late_periods * period.ns + limits.tolerance.ns},
          silent_after_{limits.silent_periods * period.ns + limits.tolerance.ns} {
        MAMORI_REQUIRE(1, is_valid(limits, period));
    }

    /// Starts the times; latched faults remain. Until the first accepted notice, the start time is the limit
    /// instead of the late and silent times.
    void start(Instant now) noexcept;
    /// A notice was accepted: the times restart.
    void record_arrival(Instant now) noexcept;
    /// Evaluates the reports of all components in it. @param[in] components bytes of to_byte().
    void evaluate(Span<const std::uint8_t> components) noexcept;
    /// Latches a fault. @param[in] component index, or kNoNoticeComponent.
    void report(NoticeFault fault, std::uint16_t component = kNoNoticeComponent) noexcept;
    /// Ends a cycle: evaluates the times, the worst condition first. A clock that runs backwards is silence.
    void step(Instant now) noexcept;
    /// Clears all faults and starts again. Only for a deliberate reset. A fault that is still present latches
    /// again.
    void acknowledge(Instant now) noexcept;

    constexpr const NodeStatus& get_status() const noexcept { return status_; }

  private:
    Duration start_after_;
    Duration late_after_;
    Duration silent_after_;
    Instant arrived_at_{};
    NodeStatus status_{};
    bool has_notice_{false};
};

}  // namespace mamori::safety

MAMORI_LAST_ENUMERATOR(mamori::safety::NoticeFault, kComponentExpired)
MAMORI_FIELDS(mamori::safety::NodeStatus, faults, first, component, is_proven)

#endif  // MAMORI_SAFETY_NOTICE_NODE_SUPERVISOR_HPP
