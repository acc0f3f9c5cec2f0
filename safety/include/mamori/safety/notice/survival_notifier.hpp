// SPDX-License-Identifier: Apache-2.0
/// @file
/// Component that sends the survival notice of its node, protected end to end, in every n-th major frame.
///
/// @satisfies SWR-NTC-001, SWR-NTC-002, SWR-NTC-003
/// Design:   docs/design/supervision.md#survival-notice
#ifndef MAMORI_SAFETY_NOTICE_SURVIVAL_NOTIFIER_HPP
#define MAMORI_SAFETY_NOTICE_SURVIVAL_NOTIFIER_HPP

#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/component/component.hpp"
#include "mamori/kernel/dataflow/data_port.hpp"
#include "mamori/kernel/system/port_list.hpp"
#include "mamori/safety/e2e/out_port.hpp"
#include "mamori/safety/notice/notice.hpp"

namespace mamori::safety {

namespace detail {

/// True when the components of a table have these names, in this order.
bool have_names(Span<Component* const> components, Span<const char* const> names) noexcept;
/// Reports each component. @param[out] bytes as many as components.
void report_components(Span<Component* const> components, const ExecutionSupervisor& supervision,
                       Span<std::uint8_t> bytes) noexcept;

}  // namespace detail

/// Sends the notice. Connect `notice` to one link component per addressee, or to receivers in the same table.
/// Run it after ExecutionSupervisor::step(), in its window or a later one.
///
/// @tparam kNode constexpr NoticeNode of static storage duration, which describes the table of this
/// component.
///
/// Thread safety: as Component. Time: O(components). Memory: one message, no heap.
template <const auto& kNode>
class SurvivalNotifier final : public Component {
  public:
    /// @param[in] name        as Component.
    /// @param[in] supervision with the storage of the table (ExecutionStorageFor); may be defined after the
    ///                        table; must outlive this object.
    constexpr SurvivalNotifier(const char* name, const ExecutionSupervisor& supervision) noexcept
        : Component(name), supervision_(supervision) {}

    OutPort<typename NoticeFor<kNode>::Frame> notice{*this, "notice"};
    using Ports = mamori::Ports<&SurvivalNotifier::notice>;

    /// @return kOk; kPreconditionNotMet (the components of the table differ from the description).
    Status on_startup(ContextHandle) noexcept override {
        return detail::have_names(supervision_.get_components(), kNode.components)
                   ? Status::kOk
                   : Status::kPreconditionNotMet;
    }
    /// Sends a notice in each n-th major frame.
    Status on_execute(ContextHandle context) noexcept override {
        const auto frame = static_cast<std::uint64_t>(context.now.ns / kNode.frame.ns);
        if (frame % kNode.every_frames != 0U) {
            return Status::kOk;
        }
        value_.version = kVersion;
        value_.frame = frame;
        value_.health = static_cast<std::uint8_t>(supervision_.get_global_status());
        detail::report_components(supervision_.get_components(), supervision_, value_.components);
        return out_.write(value_);
    }

  private:
    static constexpr std::uint64_t kVersion = calc_version(kNode);

    const ExecutionSupervisor& supervision_;
    E2eOutPort<typename NoticeFor<kNode>::Message> out_{notice};
    typename NoticeFor<kNode>::Value value_{};
};

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_NOTICE_SURVIVAL_NOTIFIER_HPP
