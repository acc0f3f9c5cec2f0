// SPDX-License-Identifier: Apache-2.0
/// @file
/// An RT component: a named object with ports as members and the actions of the OMG RTC standard, which its
/// execution context calls. A component belongs to exactly one context; the system table proves this.
///
/// @satisfies SWR-KRN-011, SWR-RTC-010      Design: docs/design/kernel.md#components
/// Source:   OMG RTC 1.0, LightweightRTObject, ComponentAction, DataFlowComponentAction,
///           FsmParticipantAction, MultiModeComponentAction
#ifndef MAMORI_KERNEL_COMPONENT_HPP
#define MAMORI_KERNEL_COMPONENT_HPP

#include <atomic>
#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/status.hpp"
#include "mamori/kernel/base/time.hpp"
#include "mamori/kernel/component/action_failure.hpp"
#include "mamori/kernel/component/lifecycle.hpp"
#include "mamori/kernel/component/member.hpp"

namespace mamori {

/// Identifies the context that calls an action. Valid during the call, and as an identity.
struct ContextHandle {
    std::int32_t id{-1};  ///< index of the window in the system table; -1: no context
    /// Planned start of the window that runs the action (not the time of the call: see LET), or the instant
    /// passed to the operation that calls the action.
    Instant now{};
};

class Component;
class ExecutionContext;
class EventServer;
class FsmMachine;
class ModeSwitch;

/// Life-cycle data of a component in its context. Only the component and its context write it.
class LifecycleRegion {
  protected:
    constexpr LifecycleRegion() noexcept = default;
    ~LifecycleRegion() = default;

  private:
    friend class Component;
    friend class ExecutionContext;
    friend class FsmComponent;
    friend class MultiModeComponent;

    /// @name Reasons why an invocation is not on_execute alone
    /// @{
    static constexpr std::uint32_t kRateNotice = 1U;    ///< on_rate_changed is pending
    static constexpr std::uint32_t kModeNotice = 2U;    ///< on_mode_changed is pending
    static constexpr std::uint32_t kNotActive = 4U;     ///< the state is not kActive
    static constexpr std::uint32_t kServesEvents = 8U;  ///< the context is event-driven
    static constexpr std::uint32_t kNotices = kRateNotice | kModeNotice;
    /// @}

    LifecycleState get_state() const noexcept { return state_.load(std::memory_order_relaxed); }
    void set_state(LifecycleState state) noexcept {
        state_.store(state, std::memory_order_relaxed);
        turn_ = state == LifecycleState::kActive ? turn_ & ~kNotActive : turn_ | kNotActive;
    }

    /// Atomic, so that other threads may read it while actions run.
    std::atomic<LifecycleState> state_{LifecycleState::kCreated};
    std::uint32_t turn_{kNotActive};  ///< set of the above flags; 0: the next invocation is on_execute alone
    ExecutionContext* context_{nullptr};  ///< context that it participates in; nullptr: none
    EventServer* machine_{nullptr};       ///< nullptr: not a state machine
    ModeSwitch* mode_switch_{nullptr};    ///< nullptr: no modes
    std::size_t position_{0U};            ///< position in the context
    ActionFailure last_failure_{};
    bool is_changing_{false};  ///< on_initialize or on_finalize is running
};

/// Base of every component. Derive, add ports and override the required actions; each default returns kOk.
///
/// Thread safety: none; one context calls the actions, never reentrantly. Call everything else from the core
///                that runs the component. is_alive() and get_name() from anywhere.
/// Time:          an action must return within the budget of its window; all else is O(1) plus the actions.
/// Memory:        no heap; instances are static and constant-initialised.
class Component : public LifecycleRegion, public MemberOwner {
  public:
    Component(const Component&) = delete;
    Component& operator=(const Component&) = delete;

    /// @name RTC actions: once per life cycle
    /// @{
    /// Created -> Alive. On any code except kOk, the component remains Created.
    virtual Status on_initialize() noexcept { return Status::kOk; }
    /// Alive -> Created, with each return code.
    virtual Status on_finalize() noexcept { return Status::kOk; }
    /// @}

    /// @name RTC actions: state changes
    /// @{
    /// The context starts. On any code except kOk, the context remains Stopped.
    virtual Status on_startup(ContextHandle) noexcept { return Status::kOk; }
    /// The context stops with each return code. The state of the component does not change.
    virtual Status on_shutdown(ContextHandle) noexcept { return Status::kOk; }
    /// Inactive -> Active. Any code except kOk leads to Error.
    virtual Status on_activated(ContextHandle) noexcept { return Status::kOk; }
    /// Active -> Inactive, with each return code.
    virtual Status on_deactivated(ContextHandle) noexcept { return Status::kOk; }
    /// Once per entry into Error, which it cannot prevent; the return code is ignored.
    virtual Status on_aborting(ContextHandle) noexcept { return Status::kOk; }
    /// Error -> Inactive when kOk; otherwise the component remains in Error.
    virtual Status on_reset(ContextHandle) noexcept { return Status::kOk; }
    /// @}

    /// @name RTC actions: each cycle
    /// @{
    /// First pass, while Active. Any code except kOk leads to Error.
    virtual Status on_execute(ContextHandle) noexcept { return Status::kOk; }
    /// Second pass, while Active. Any code except kOk leads to Error.
    virtual Status on_state_update(ContextHandle) noexcept { return Status::kOk; }
    /// Replaces both passes while in Error; the return code is ignored.
    virtual Status on_error(ContextHandle) noexcept { return Status::kOk; }
    /// @}

    /// @name RTC actions: external changes. Any code except kOk leads to Error when the component is Active.
    /// @{
    /// The rate of the context has changed; called first in the first invocation at the new rate.
    virtual Status on_rate_changed(ContextHandle) noexcept { return Status::kOk; }
    /// A state machine leaves a state, takes a transition or enters a state for which the component has a
    /// behaviour. Event-driven contexts only, while Active. See FsmComponent::get_step().
    virtual Status on_action(ContextHandle) noexcept { return Status::kOk; }
    /// The mode has changed; called before the next on_execute. See MultiModeComponent.
    virtual Status on_mode_changed(ContextHandle) noexcept { return Status::kOk; }
    /// @}

    /// Created -> Alive. Calls on_initialize once.
    /// @return kOk; kPreconditionNotMet (not Created, or called from on_initialize or on_finalize); otherwise
    ///         the code of on_initialize; the component remains Created.
    Status initialize() noexcept;

    /// Alive -> Created. Calls on_finalize once; the component becomes Created even if on_finalize fails.
    /// @return kOk; kPreconditionNotMet (Created, still participating in a context, or called from
    ///         on_initialize or on_finalize); otherwise the code of on_finalize.
    Status finalize() noexcept;

    /// Ends the component in any state: deactivates it when it is Active, clears its Error, finalizes it. Its
    /// context keeps its position and skips it until the next initialize(). Contexts belong to the system
    /// table and never to a component, so none is stopped.
    /// @param[in] now instant passed to on_deactivated.
    /// @return kOk; kPreconditionNotMet (Created, also after an earlier exit(), or its context is busy);
    ///         otherwise the first code of on_deactivated and on_finalize that is not kOk; the component is
    ///         Created nevertheless.
    Status exit(Instant now) noexcept;

    /// @name Contexts of the component, as the standard requires
    /// @{
    /// Contexts that it participates in: one or none. The span refers to this component.
    Span<ExecutionContext* const> get_participating_contexts() const noexcept {
        return {&context_, context_ == nullptr ? 0U : 1U};
    }
    /// Contexts that it owns: none.
    Span<ExecutionContext* const> get_owned_contexts() const noexcept { return {}; }
    /// The context with this handle. @return nullptr when the component does not participate in it.
    ExecutionContext* get_context(ContextHandle handle) const noexcept;
    /// The handle of a context, with instant 0. @return kBadParameter (the component does not participate in
    /// it).
    Result<ContextHandle> get_context_handle(const ExecutionContext& context) const noexcept;
    /// The system table determines the contexts. Both: @return kUnsupported.
    Status attach_context(ExecutionContext&) noexcept { return Status::kUnsupported; }
    Status detach_context(ContextHandle) noexcept { return Status::kUnsupported; }
    /// @}

    /// True from a successful initialize() until finalize() or exit(), independent of the context.
    bool is_alive() const noexcept { return get_state() != LifecycleState::kCreated; }

    /// The last action that did not return kOk to the context, except on_aborting and on_error. Kept until
    /// the next failure.
    const ActionFailure& get_last_failure() const noexcept { return last_failure_; }

    /// Name given at construction; static storage, never nullptr.
    const char* get_name() const noexcept { return name_; }

    /// Number of the first pass. Inputs use the numbers below it for no value and for a value that was read.
    static constexpr std::uint64_t kFirstReadPass = 2U;
    /// For inputs: number of the current pass. A pass ends when the component, Active or in Error, has
    /// completed a first pass in a window with connections. The reference is valid as long as the component.
    constexpr const std::uint64_t& get_read_pass() const noexcept { return read_pass_; }
    /// For the executive, after such a pass: no input of the component is new now.
    void end_read_pass() noexcept { ++read_pass_; }

  protected:
    /// @param[in] name instance name; static storage, not nullptr.
    constexpr explicit Component(const char* name) noexcept : name_(name) {}
    ~Component() = default;

  private:
    Status end_life() noexcept;

    const char* name_;
    std::uint64_t read_pass_{kFirstReadPass};
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_COMPONENT_HPP
