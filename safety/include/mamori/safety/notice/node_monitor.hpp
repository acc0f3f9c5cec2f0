// SPDX-License-Identifier: Apache-2.0
/// @file
/// Supervision of another node by its survival notices, which come over any transport: faults latch and name
/// their cause.
///
/// @satisfies SWR-NTC-003, SWR-NTC-004, SWR-NTC-005, SWR-NTC-006, SWR-NTC-007, SWR-NTC-008, SWR-NTC-009
/// @satisfies SWR-NTC-010, SWR-NTC-011
/// Design:   docs/design/supervision.md#survival-notice
#ifndef MAMORI_SAFETY_NOTICE_NODE_MONITOR_HPP
#define MAMORI_SAFETY_NOTICE_NODE_MONITOR_HPP

#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/assert.hpp"
#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/time.hpp"
#include "mamori/kernel/component/component.hpp"
#include "mamori/kernel/dataflow/data_port.hpp"
#include "mamori/kernel/payload/cdr.hpp"
#include "mamori/kernel/payload/cdr_scalar.hpp"
#include "mamori/kernel/payload/fields.hpp"
#include "mamori/kernel/system/port_list.hpp"
#include "mamori/safety/e2e/checker.hpp"
#include "mamori/safety/e2e/frame.hpp"
#include "mamori/safety/e2e/frame_source.hpp"
#include "mamori/safety/e2e/hardened_sequence.hpp"
#include "mamori/safety/notice/notice.hpp"

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
        MAMORI_REQUIRE(2, is_valid(limits, period));
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

namespace mamori::safety {

/// Component that supervises one node. Give each node a monitor of its own. Corrupted notices count as lost
/// ones.
///
/// @tparam kNode   constexpr NoticeNode of static storage duration: description of the other node.
/// @tparam kLimits constexpr NoticeLimits of static storage duration.
///
/// Thread safety: as Component; call the functions below from the context of the component.
/// Time:          O(components) per cycle. Memory: one notice, no heap.
template <const auto& kNode, const auto& kLimits>
class NodeMonitor final : public Component {
    static_assert(is_sound_node<kNode>(), "each component needs a name of the system table");
    static_assert(
        is_valid(kLimits, get_period(kNode)),
        "limits of the notice out of range; specify 1 <= late_periods < silent_periods, start_periods >= 3");
    using Notice = NoticeFor<kNode>;

  public:
    constexpr explicit NodeMonitor(const char* name) noexcept : Component(name) {}

    InPort<typename Notice::Frame> notice{*this, "notice"};
    OutPort<NodeStatus> status{*this, "status"};
    using Ports = mamori::Ports<&NodeMonitor::notice, &NodeMonitor::status>;

    /// Supervision starts. Two notices in order find the order; the third is the first that is used.
    Status on_activated(ContextHandle context) noexcept override {
        source_.forget();
        checker_.restart();
        supervisor_.start(context.now);
        return Status::kOk;
    }
    Status on_execute(ContextHandle context) noexcept override {
        if (source_.has_frame()) {
            take_message(detail::view_bytes(source_.take()), context.now);
        }
        supervisor_.step(context.now);
        status.write(supervisor_.get_status());
        return Status::kOk;
    }

    /// Clears all faults; the order is found again. Only for a deliberate reset. A fault that is still
    /// present latches again.
    void acknowledge(Instant now) noexcept {
        checker_.restart();
        supervisor_.acknowledge(now);
    }

    const NodeStatus& get_status() const noexcept { return supervisor_.get_status(); }
    /// @param[in] component 0 .. count - 1 of the description.
    /// @return its report in the last accepted notice; not alive and expired before the first.
    ComponentReport get_report(std::size_t component) const noexcept {
        MAMORI_REQUIRE(1, component < Notice::kCount);
        return has_value_ ? to_report(value_.components[component]) : ComponentReport{};
    }
    /// Content of the last accepted notice.
    const typename Notice::Value& get_value() const noexcept { return value_; }
    /// Cause of the last check and how often each came.
    const HardenedE2eChecker<typename Notice::Message::Profile>& get_checker() const noexcept {
        return checker_;
    }

  private:
    void take_message(Span<const std::byte> message, Instant now) noexcept {
        const bool is_searching = !checker_.get_order().is_synchronised();
        const CheckStatus checked = checker_.check(message);
        const FrameCause cause = checker_.get_cause();
        if (cause == FrameCause::kDataId) {
            supervisor_.report(NoticeFault::kWrongNode);
        }
        if (is_usable(checked)) {
            accept(message, now);
        } else if (checked != CheckStatus::kError && !is_searching) {
            supervisor_.report(NoticeFault::kOutOfOrder);
        }
    }
    void accept(Span<const std::byte> message, Instant now) noexcept {
        supervisor_.record_arrival(now);
        const Span<const std::byte> payload =
            message.subspan(Notice::Message::kPayloadAt, message.size() - Notice::Message::kPayloadAt);
        // Every pattern of bytes is a value; the length was checked.
        static_cast<void>(decode(payload, Notice::Message::kByteOrder, value_));
        has_value_ = value_.version == kVersion;
        if (has_value_) {
            supervisor_.evaluate(value_.components);
        } else {
            supervisor_.report(NoticeFault::kOtherTable);
        }
    }

    static constexpr std::uint64_t kVersion = calc_version(kNode);

    detail::FrameSource<InPort<typename Notice::Frame>> source_{notice};
    HardenedE2eChecker<typename Notice::Message::Profile> checker_{Notice::kChannel,
                                                                   {kLimits.silent_periods}};
    NodeSupervisor supervisor_{get_period(kNode), kLimits};
    typename Notice::Value value_{};
    bool has_value_{false};
};

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_NOTICE_NODE_MONITOR_HPP
