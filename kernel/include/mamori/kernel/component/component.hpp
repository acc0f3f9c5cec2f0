// SPDX-License-Identifier: Apache-2.0
/// @file
/// An RT component: a named object with ports as members and the actions of the OMG RTC standard, which its
/// execution context calls. A component belongs to exactly one context; the system table proves it.
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

namespace mamori {

/// Names the context an action is called from. Valid for the duration of the call and as an identity.
struct ContextHandle {
    std::int32_t id{-1};  ///< index of the window in the system table; -1: no context
    /// Planned start of the window that runs the action (not the time of the call: see LET), or the instant
    /// that was given to the operation which calls it.
    Instant now{};
};

class Component;
class ExecutionContext;
class FsmMachine;
class ModeSwitch;
class PortBase;

/// Where a component stands in its context. Only the component and its context write it.
class LifecycleRegion {
  protected:
    constexpr LifecycleRegion() noexcept = default;
    ~LifecycleRegion() = default;

  private:
    friend class Component;
    friend class ExecutionContext;
    friend class FsmComponent;
    friend class MultiModeComponent;

    /// @name What makes a turn anything but on_execute alone
    /// @{
    static constexpr std::uint32_t kRateNotice = 1U;    ///< it must be told of its rate before
    static constexpr std::uint32_t kModeNotice = 2U;    ///< it must be told of its mode before
    static constexpr std::uint32_t kNotActive = 4U;     ///< its state is not kActive
    static constexpr std::uint32_t kServesEvents = 8U;  ///< its context is event-driven
    static constexpr std::uint32_t kNotices = kRateNotice | kModeNotice;
    /// @}

    LifecycleState get_state() const noexcept { return state_.load(std::memory_order_relaxed); }
    void set_state(LifecycleState state) noexcept {
        state_.store(state, std::memory_order_relaxed);
        turn_ = state == LifecycleState::kActive ? turn_ & ~kNotActive : turn_ | kNotActive;
    }

    /// Atomic, so that it may be looked at from outside while actions run.
    std::atomic<LifecycleState> state_{LifecycleState::kCreated};
    std::uint32_t turn_{kNotActive};      ///< any of the above; 0: the next turn is on_execute and no more
    bool is_changing_{false};             ///< on_initialize or on_finalize is being called
    ExecutionContext* context_{nullptr};  ///< the one that it participates in
    FsmMachine* machine_{nullptr};        ///< when it is a state machine
    ModeSwitch* mode_switch_{nullptr};    ///< when it has modes
    ActionFailure last_failure_{};
    std::size_t position_{0U};  ///< its place there
};

/// List of the ports that were constructed with a component.
class PortOwner {
  public:
    /// The port that was constructed last; nullptr: there is none. PortBase::get_next() leads to the others.
    constexpr const PortBase* get_first_port() const noexcept { return first_port_; }

  protected:
    constexpr PortOwner() noexcept = default;
    ~PortOwner() = default;

  private:
    friend class PortBase;
    const PortBase* first_port_{nullptr};
};

/// Base of every component. Derive, add ports, override the actions you need; each defaults to kOk.
///
/// Thread safety: none; actions are called by one context, never reentrantly, and what calls them is to be
///                called from the core that runs the component. is_alive() and get_name() from anywhere.
/// Time:          an action must return within its window's budget; O(1) beside the actions.
/// Memory:        no heap; instances are static and constant-initialised.
class Component : public LifecycleRegion, public PortOwner {
  public:
    Component(const Component&) = delete;
    Component& operator=(const Component&) = delete;

    /// @name RTC actions: once in a life
    /// @{
    /// Created -> Alive. Anything but kOk keeps the component Created.
    virtual Status on_initialize() noexcept { return Status::kOk; }
    /// Alive -> Created, whatever it returns.
    virtual Status on_finalize() noexcept { return Status::kOk; }
    /// @}

    /// @name RTC actions: changes of state
    /// @{
    /// The context starts. Anything but kOk keeps it Stopped.
    virtual Status on_startup(ContextHandle) noexcept { return Status::kOk; }
    /// The context stops, whatever it returns; the state of the component stays.
    virtual Status on_shutdown(ContextHandle) noexcept { return Status::kOk; }
    /// Inactive -> Active. Anything but kOk leads to Error.
    virtual Status on_activated(ContextHandle) noexcept { return Status::kOk; }
    /// Active -> Inactive, whatever it returns.
    virtual Status on_deactivated(ContextHandle) noexcept { return Status::kOk; }
    /// Once per entry into Error, which it cannot prevent; what it returns is ignored.
    virtual Status on_aborting(ContextHandle) noexcept { return Status::kOk; }
    /// Error -> Inactive when kOk, else it stays in Error.
    virtual Status on_reset(ContextHandle) noexcept { return Status::kOk; }
    /// @}

    /// @name RTC actions: each cycle
    /// @{
    /// First pass, while Active. Anything but kOk leads to Error.
    virtual Status on_execute(ContextHandle) noexcept { return Status::kOk; }
    /// Second pass, while Active. Anything but kOk leads to Error.
    virtual Status on_state_update(ContextHandle) noexcept { return Status::kOk; }
    /// In place of both while in Error; what it returns is ignored.
    virtual Status on_error(ContextHandle) noexcept { return Status::kOk; }
    /// @}

    /// @name RTC actions: changes around the component. Anything but kOk leads to Error when it is Active.
    /// @{
    /// The rate of its context has changed; in the first turn at the new rate, before anything else.
    virtual Status on_rate_changed(ContextHandle) noexcept { return Status::kOk; }
    /// A state machine leaves a state, takes a transition or enters a state that it has a behaviour for;
    /// event-driven contexts only, while Active. See FsmComponent::get_step().
    virtual Status on_action(ContextHandle) noexcept { return Status::kOk; }
    /// Its mode has changed; before the next on_execute. See MultiModeComponent.
    virtual Status on_mode_changed(ContextHandle) noexcept { return Status::kOk; }
    /// @}

    /// Created -> Alive. Calls on_initialize once.
    /// @return kOk; kPreconditionNotMet (not Created, or called from on_initialize or on_finalize); else what
    ///         on_initialize returned, and it stays Created.
    Status initialize() noexcept;

    /// Alive -> Created. Calls on_finalize once, whose failure is returned but does not keep it alive.
    /// @return kOk; kPreconditionNotMet (Created, still participating in a context, or called from
    ///         on_initialize or on_finalize); else on_finalize's code.
    Status finalize() noexcept;

    /// Ends the component wherever it stands: deactivates it when it is Active, drops its Error, finalizes
    /// it. Its context keeps its place, which stays empty until the next initialize(). Contexts belong to the
    /// system table and never to a component, so none is stopped.
    /// @param[in] now instant given to on_deactivated.
    /// @return kOk; kPreconditionNotMet (Created, so the second time too, or its context is busy); else the
    ///         first failing code of on_deactivated and on_finalize: it is Created anyway.
    Status exit(Instant now) noexcept;

    /// @name Contexts of the component, as the standard asks for them
    /// @{
    /// Those that it participates in: one or none. The span refers to this component.
    Span<ExecutionContext* const> get_participating_contexts() const noexcept {
        return {&context_, context_ == nullptr ? 0U : 1U};
    }
    /// Those that it owns: none.
    Span<ExecutionContext* const> get_owned_contexts() const noexcept { return {}; }
    /// The context whose handle that is. @return nullptr when it does not participate in it.
    ExecutionContext* get_context(ContextHandle handle) const noexcept;
    /// The handle of a context, at no instant. @return kBadParameter (it does not participate there).
    Result<ContextHandle> get_context_handle(const ExecutionContext& context) const noexcept;
    /// Contexts come and go with the system table. Both: @return kUnsupported.
    Status attach_context(ExecutionContext&) noexcept { return Status::kUnsupported; }
    Status detach_context(ContextHandle) noexcept { return Status::kUnsupported; }
    /// @}

    /// True from a successful initialize() until finalize() or exit(), whichever context is asked.
    bool is_alive() const noexcept { return get_state() != LifecycleState::kCreated; }

    /// The last answer to its context that was not kOk, without those of on_aborting and on_error; kept until
    /// the next.
    const ActionFailure& get_last_failure() const noexcept { return last_failure_; }

    /// Name given at construction; static storage, never nullptr.
    const char* get_name() const noexcept { return name_; }

  protected:
    /// @param[in] name instance name; must have static storage and not be nullptr.
    constexpr explicit Component(const char* name) noexcept : name_(name) {}
    ~Component() = default;

  private:
    Status end_life() noexcept;

    const char* name_;
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_COMPONENT_HPP
