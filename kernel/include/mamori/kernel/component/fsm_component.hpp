// SPDX-License-Identifier: Apache-2.0
/// @file
/// A component that is a state machine. It queues messages in a bounded queue. Its event-driven context
/// executes the transitions and calls on_action of the participants of the affected states and transitions.
///
///     class Lamp final : public mamori::FsmComponentFor<8U> {
///       public:
///         constexpr Lamp() noexcept : FsmComponentFor("lamp", kLampTable, kLampProfile) {}
///     };
///
/// @satisfies SWR-RTC-006, SWR-RTC-012      Design: docs/design/rtc_semantics.md#state-machines
/// Source:   OMG RTC 1.0, FsmObject, FsmService; OMG FSM4RTC, ExtendedFsmService
#ifndef MAMORI_KERNEL_FSM_COMPONENT_HPP
#define MAMORI_KERNEL_FSM_COMPONENT_HPP

#include <array>
#include <cstddef>
#include <cstdint>

#include "mamori/kernel/component/component.hpp"
#include "mamori/kernel/component/detail/fsm_machine.hpp"

namespace mamori {

/// Size-free state machine; derive from FsmComponentFor.
///
/// Thread safety: send_stimulus() from any thread or interrupt; the rest from the core that runs the
///                component.
/// Time:          O(1), send_stimulus() as FsmEventQueue::post(), find_message() O(messages). Processing an
///                event is O(transitions + behaviours of the profile), plus the actions. Nothing blocks.
/// Memory:        no heap.
class FsmComponent : public Component {
  public:
    /// Queues a message for the next cycle of the context of the machine. If the state at that time has no
    /// transition for the message, the message is consumed without effect.
    /// @param[in] message  row of the table.
    /// @param[in] context  the context of the machine, or id -1: the machine selects its context.
    /// @param[in] argument stored in the event.
    /// @return kOk; kBadParameter (unknown message, or a context that the machine does not participate in);
    ///         kPreconditionNotMet (no context, or not Active); kOutOfResources (queue full, or too many
    ///         concurrent senders; counted).
    Status send_stimulus(FsmIndex message, ContextHandle context = {}, std::int64_t argument = 0) noexcept;
    /// Row of the message with that name. O(messages). @return kBadParameter (no such message, or nullptr).
    Result<FsmIndex> find_message(const char* name) const noexcept;

    /// @name FsmService and ExtendedFsmService, for tools. Structures are static: each setter returns
    /// kUnsupported.
    /// @{
    FsmProfile get_fsm_profile() const noexcept { return fsm_.get_profile(); }
    Status set_fsm_profile(FsmProfile) noexcept { return Status::kUnsupported; }
    const FsmTable& get_fsm_structure() const noexcept { return fsm_.get_table(); }
    Status set_fsm_structure(const FsmTable&) noexcept { return Status::kUnsupported; }
    /// Row of the current state, 0 .. number of states - 1; during on_action, the source state until the
    /// entry phase.
    FsmIndex get_current_state() const noexcept { return fsm_.get_state(); }
    const char* get_current_state_name() const noexcept {
        return get_fsm_structure().states[get_current_state()].name;
    }
    /// @}

    /// Current step of on_action; phase kNone outside on_action.
    const FsmStep& get_step() const noexcept { return fsm_.get_step(); }
    /// Number of events consumed without a transition (wraps at 2^32).
    std::uint32_t get_ignored_count() const noexcept { return fsm_.get_ignored_count(); }
    const FsmEventQueue& get_queue() const noexcept { return fsm_.get_queue(); }

  protected:
    /// @param[in] name    instance name; static storage, not nullptr.
    /// @param[in] table   checked with MAMORI_CHECK_FSM; must outlive the component.
    /// @param[in] profile participants of the same context; must outlive the component.
    /// @param[in] cells   see FsmEventQueue; must outlive the component.
    constexpr FsmComponent(const char* name, const FsmTable& table, FsmProfile profile,
                           Span<FsmEventCell> cells) noexcept
        : Component(name), fsm_(*this, table, profile, cells) {
        machine_ = &fsm_;
    }
    ~FsmComponent() = default;

  private:
    FsmMachine fsm_;
};

namespace detail {
/// Base class, so that the cells are constructed before the component that refers to them.
template <std::size_t kCapacity>
struct FsmEventStorage {
    std::array<FsmEventCell, kCapacity> cells{};
};
}  // namespace detail

/// State machine with a queue of `kCapacity` events, a power of two, 2 .. 2^31.
template <std::size_t kCapacity>
class FsmComponentFor : private detail::FsmEventStorage<kCapacity>, public FsmComponent {
    static_assert(kCapacity > 1U && (kCapacity & (kCapacity - 1U)) == 0U && kCapacity <= 0x80000000U,
                  "the capacity of an event queue is a power of two, 2 or more");

  protected:
    /// See FsmComponent. @param[in] table must outlive the component.
    constexpr FsmComponentFor(const char* name, const FsmTable& table, FsmProfile profile = {}) noexcept
        : FsmComponent(name, table, profile, detail::FsmEventStorage<kCapacity>::cells) {}
    FsmComponentFor(const char* name, const FsmTable&& table, FsmProfile profile = {}) = delete;
    ~FsmComponentFor() = default;
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_FSM_COMPONENT_HPP
