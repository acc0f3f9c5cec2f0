// SPDX-License-Identifier: Apache-2.0
/// @file
/// Component that supervises another node by its survival notices, which come over any transport.
///
/// @satisfies SWR-NTC-004, SWR-NTC-005, SWR-NTC-007, SWR-NTC-008, SWR-NTC-009, SWR-NTC-011
/// Design:   docs/design/supervision.md#survival-notice
#ifndef MAMORI_SAFETY_NOTICE_NODE_MONITOR_HPP
#define MAMORI_SAFETY_NOTICE_NODE_MONITOR_HPP

#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/assert.hpp"
#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/component/component.hpp"
#include "mamori/kernel/dataflow/data_port.hpp"
#include "mamori/kernel/payload/cdr.hpp"
#include "mamori/kernel/system/port_list.hpp"
#include "mamori/safety/e2e/checker.hpp"
#include "mamori/safety/e2e/frame.hpp"
#include "mamori/safety/e2e/frame_source.hpp"
#include "mamori/safety/e2e/hardened_sequence.hpp"
#include "mamori/safety/notice/node_supervisor.hpp"
#include "mamori/safety/notice/notice.hpp"

namespace mamori::safety {

/// Supervises one node. Give each node a monitor of its own. Corrupted notices count as lost ones.
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
