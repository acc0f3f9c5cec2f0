// SPDX-License-Identifier: Apache-2.0
#include "mamori/safety/notice/node_monitor.hpp"

#include "mamori/safety/base/elapsed.hpp"

namespace mamori::safety {
namespace {

/// The fault of a component, the worst condition first.
NoticeFault find_fault(ComponentReport report) noexcept {
    if (report.state == LifecycleState::kCreated) {
        return NoticeFault::kComponentMissing;
    }
    if (report.state == LifecycleState::kError) {
        return NoticeFault::kComponentError;
    }
    return report.status == LocalStatus::kExpired ? NoticeFault::kComponentExpired : NoticeFault::kNone;
}

}  // namespace

const char* get_name(NoticeFault fault) noexcept {
    switch (fault) {
        case NoticeFault::kNone:
            return "None";
        case NoticeFault::kSilent:
            return "Silent";
        case NoticeFault::kLate:
            return "Late";
        case NoticeFault::kOutOfOrder:
            return "OutOfOrder";
        case NoticeFault::kWrongNode:
            return "WrongNode";
        case NoticeFault::kOtherTable:
            return "OtherTable";
        case NoticeFault::kComponentMissing:
            return "ComponentMissing";
        case NoticeFault::kComponentError:
            return "ComponentError";
        case NoticeFault::kComponentExpired:
            return "ComponentExpired";
    }
    return "Invalid";
}

void NodeSupervisor::start(Instant now) noexcept {
    arrived_at_ = now;
    has_notice_ = false;
    status_.is_proven = false;
}

void NodeSupervisor::record_arrival(Instant now) noexcept {
    step(now);  // a notice that comes too late does not hide that it was late
    arrived_at_ = now;
    has_notice_ = true;
}

void NodeSupervisor::evaluate(Span<const std::uint8_t> components) noexcept {
    for (std::size_t i = 0U; i < components.size(); ++i) {
        const NoticeFault fault = find_fault(to_report(components[i]));
        if (fault != NoticeFault::kNone) {
            report(fault, static_cast<std::uint16_t>(i));
        }
    }
}

void NodeSupervisor::report(NoticeFault fault, std::uint16_t component) noexcept {
    status_.faults |= std::uint32_t{1U} << static_cast<std::uint32_t>(fault);
    if (status_.first == NoticeFault::kNone) {
        status_.first = fault;
    }
    if (status_.component == kNoNoticeComponent) {
        status_.component = component;
    }
}

void NodeSupervisor::step(Instant now) noexcept {
    if (is_over(arrived_at_, now, has_notice_ ? silent_after_ : start_after_)) {
        report(NoticeFault::kSilent);
    } else if (has_notice_ && is_over(arrived_at_, now, late_after_)) {
        report(NoticeFault::kLate);
    }
    status_.is_proven = has_notice_ && status_.faults == 0U;
}

void NodeSupervisor::acknowledge(Instant now) noexcept {
    status_ = NodeStatus{};
    start(now);
}

}  // namespace mamori::safety
