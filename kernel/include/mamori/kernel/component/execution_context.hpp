// SPDX-License-Identifier: Apache-2.0
/// @file
/// Execution context: starts and stops its participants, controls their life cycle and runs them once per
/// cycle in two passes: on_execute of all participants, then on_state_update of all participants.
///
/// @satisfies SWR-KRN-012, SWR-KRN-013, SWR-KRN-014, SWR-RTC-002, SWR-RTC-003, SWR-RTC-005, SWR-RTC-011
/// Design:   docs/design/rtc_semantics.md, docs/design/kernel.md#execution-context
/// Source:   OMG RTC 1.0, ExecutionContext; where the text leaves a choice, the design note
///           says which one was taken.
#ifndef MAMORI_KERNEL_EXECUTION_CONTEXT_HPP
#define MAMORI_KERNEL_EXECUTION_CONTEXT_HPP

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/status.hpp"
#include "mamori/kernel/base/time.hpp"
#include "mamori/kernel/component/action_caller.hpp"
#include "mamori/kernel/component/action_failure.hpp"
#include "mamori/kernel/component/component.hpp"
#include "mamori/kernel/component/context_plan.hpp"
#include "mamori/kernel/component/execution_record.hpp"
#include "mamori/kernel/component/fsm_table.hpp"
#include "mamori/kernel/component/window_host.hpp"

namespace mamori {

/// Runs the components of one window.
///
/// The context is busy while a cycle runs and while an action of a participant runs or hangs. A busy context
/// rejects every operation that changes anything with kPreconditionNotMet. Actions are therefore never
/// reentrant, and nothing changes during a cycle. The instant `now` of an operation is on the time line of
/// the windows. The operation only passes it to the actions in their ContextHandle.
///
/// Thread safety: none; call from the context that runs the windows. While an aborted action still runs on
///                another thread, calls of is_busy(), is_running(), get_acting_position() and get_state_at()
///                are allowed.
/// Time:          O(participants); attach() also checks the tables of state machines, and a cycle also
///                processes their events. Only the actions can block.
/// Memory:        no heap; refers to the participant list, which must outlive it.
class ExecutionContext final {
  public:
    constexpr ExecutionContext() noexcept = default;
    ExecutionContext(const ExecutionContext&) = delete;
    ExecutionContext& operator=(const ExecutionContext&) = delete;

    /// Assigns the participants. Call once, before any other operation.
    /// @param[in] id           identity passed to the actions, >= 0.
    /// @param[in] participants execution order, at least one; each must be in no other context.
    /// @param[in] plan         kind, periods and policy; copied, but its spans must outlive the context.
    /// @return kOk; kPreconditionNotMet (already attached, or a state machine in a context that is not
    ///         kEventDriven); kBadParameter (negative id; no participants; a participant that is null, in a
    ///         context or listed twice; a plan that violates a rule of ContextPlan; or a state machine whose
    ///         table violates a rule or whose profile names a component outside this context or an unknown
    ///         element).
    Status attach(std::int32_t id, Span<Component* const> participants, const ContextPlan& plan) noexcept;

    /// Releases the participants, so that they can be finalized. A participant in Error becomes Inactive,
    /// because Error is a state of this context only.
    /// @return kOk; kPreconditionNotMet (not attached, Running, busy, or a participant is Active).
    Status detach() noexcept;

    /// The system table determines the participants; they cannot change one by one. Both: @return
    /// kUnsupported.
    Status add_component(Component&) noexcept { return Status::kUnsupported; }
    Status remove_component(Component&) noexcept { return Status::kUnsupported; }

    /// Stopped -> Running; calls on_startup of every participant. If one fails, the context remains Stopped
    /// and the participants already started receive on_shutdown. Earlier ticks of the trigger are ignored.
    /// @return kOk; kPreconditionNotMet (not attached, Running, busy, or a participant is not alive);
    ///         otherwise the code of the failed on_startup.
    Status start(Instant now) noexcept;

    /// Running -> Stopped; calls on_shutdown of every participant that is alive. The states of components do
    /// not change.
    /// @return kOk; kPreconditionNotMet (Stopped, or busy); otherwise the code of the first on_shutdown that
    ///         failed; the context is Stopped nevertheless.
    Status stop(Instant now) noexcept;

    /// Inactive -> Active, after on_activated. If on_activated fails, the component enters Error without
    /// becoming Active, and on_aborting is called. Allowed while Stopped as well.
    /// @return kOk; kBadParameter (not a participant, or not alive); kPreconditionNotMet (not Inactive, or
    ///         busy); otherwise the code of on_activated.
    Status activate_component(const Component& component, Instant now) noexcept;

    /// Active -> Inactive, then on_deactivated. The component becomes Inactive even if on_deactivated fails.
    /// @return kOk; kBadParameter (not a participant, or not alive); kPreconditionNotMet (not Active, or
    ///         busy); otherwise the code of on_deactivated.
    Status deactivate_component(const Component& component, Instant now) noexcept;

    /// @name The same, with each action called by `caller`. After an action that does not return in time, the
    /// operation ends with kError, and the context is busy until readmit().
    /// @{
    Status start(Instant now, ActionCaller& caller) noexcept;
    Status stop(Instant now, ActionCaller& caller) noexcept;
    Status activate_component(const Component& component, Instant now, ActionCaller& caller) noexcept;
    Status deactivate_component(const Component& component, Instant now, ActionCaller& caller) noexcept;
    /// @}

    /// Error -> Inactive, after on_reset returned kOk; otherwise the component remains in Error.
    /// @return kOk; kBadParameter (not a participant); kPreconditionNotMet (not in Error, or busy); otherwise
    ///         the code of on_reset.
    Status reset_component(const Component& component, Instant now) noexcept;

    /// @return kInactive, kActive or kError; kBadParameter (not a participant, or not alive).
    Result<LifecycleState> get_component_state(const Component& component) const noexcept;
    /// State of the participant at `position`, 0 .. get_participant_count() - 1; kCreated when it is not
    /// alive. A position out of range is a contract violation.
    LifecycleState get_state_at(std::size_t position) const noexcept;

    /// Kind from the plan; kPeriodic while not attached.
    ExecutionKind get_kind() const noexcept { return plan_.kind; }
    /// Current time between two cycles; 0 while not attached.
    Duration get_period() const noexcept { return period_; }
    /// Current number of planned windows per cycle, >= 1; 1 while not attached.
    std::int64_t get_divisor() const noexcept { return divisor_; }
    /// Current rate [Hz]; -1.0 when the kind is not kPeriodic, and while not attached.
    double get_rate() const noexcept;

    /// Requests the rate of the planned period or of an alternative period. apply_pending_rate() applies the
    /// rate; a later request replaces an earlier one.
    /// @param[in] rate_hz cycles per second; selects the period that is within half a nanosecond of 1 / rate.
    /// @return kOk; kBadParameter (0, negative, infinite, not a number); kUnsupported (kind not kPeriodic,
    ///         not attached, or a rate that the plan does not declare); kPreconditionNotMet (busy).
    Status set_rate(double rate_hz) noexcept;

    /// Applies the requested rate. The next window is the first at the new rate; in it, each participant
    /// receives on_rate_changed. For the executive, at the boundary of a major frame.
    /// @return true when the rate has changed; while the context is busy, the request remains pending.
    bool apply_pending_rate() noexcept;

    /// True while a cycle runs, an action of a participant runs or hangs, or aborted work has not returned.
    bool is_busy() const noexcept {
        return phase_.load(std::memory_order_relaxed) != Phase::kIdle ||
               acting_position_.load(std::memory_order_acquire) != kNoPosition;
    }
    /// Identity from attach(), >= 0; -1 while not attached.
    std::int32_t get_id() const noexcept { return id_; }
    /// True from a start() that returned kOk until stop().
    bool is_running() const noexcept { return is_running_; }
    /// Number of positions, which are numbered from 0 in execution order; 0 while not attached.
    std::size_t get_participant_count() const noexcept { return participants_.size(); }

    /// Position of the participant whose action runs or hangs; otherwise, of the participant whose aborted
    /// work has not returned. @return kPreconditionNotMet: no such participant.
    Result<std::size_t> get_acting_position() const noexcept;
    /// Position of the participant that made the last start() of an attached, stopped and idle context fail:
    /// it is not alive, or its on_startup failed or was late. @return kPreconditionNotMet: no such
    /// participant.
    Result<std::size_t> get_refusing_position() const noexcept;

    /// @name One cycle in steps, for the executive: take_turn, begin_cycle, execute 0..n-1, update_state
    /// 0..n-1, end_cycle. A step outside a cycle, or with a position out of range, is a contract violation.
    /// An aborted range ends after the action that runs.
    /// @{
    /// Counts one window of the context. @return true when a cycle is due in this window: in each window; in
    /// each n-th window at a rate n times lower than the planned rate; or once per tick of the trigger. False
    /// while Stopped.
    bool take_turn() noexcept {
        if (!is_running_) {
            return false;
        }
        if (plan_.trigger != nullptr) {
            return take_tick();
        }
        if (windows_to_skip_ > 0) {
            --windows_to_skip_;
            return false;
        }
        windows_to_skip_ = divisor_ - 1;
        return true;
    }
    /// Starts a cycle. @param[in] now planned window start. @return kOk; kPreconditionNotMet (Stopped, or
    /// busy).
    Status begin_cycle(Instant now) noexcept {
        if (!is_running_ || is_busy()) {
            return Status::kPreconditionNotMet;
        }
        phase_.store(Phase::kInCycle, std::memory_order_relaxed);
        cycle_start_ = now;
        return Status::kOk;
    }
    /// Calls on_execute when Active, on_error when in Error, nothing when Inactive. In a kEventDriven
    /// context, an Active state machine processes its events instead, and only a state machine in Error
    /// receives on_error.
    void execute(std::size_t position) noexcept { execute_range(position, 1U); }
    /// execute() of `count` positions from `first` on.
    void execute_range(std::size_t first, std::size_t count) noexcept {
        get_first_pass()(this, first, first + count);
    }
    /// Calls on_state_update when still Active after on_execute in this cycle; nothing when kEventDriven.
    void update_state(std::size_t position) noexcept { update_range(position, 1U); }
    /// update_state() of `count` positions from `first` on.
    void update_range(std::size_t first, std::size_t count) noexcept {
        run_second_pass(this, first, first + count);
    }

    /// Observes the steps of a first pass, while the context is still busy with the step.
    struct StepObserver {
        ExecutionContext* context;  ///< context of the steps
        ExecutionRecord* records;   ///< first element: position 0; nullptr: no step is measured
        const WindowHost* host;     ///< reports the end of a step; required with records
        Instant deadline;           ///< of the pass; a step that ends later is not recorded
        Instant step_start;         ///< start of the first step, then of the current step
        /// Called after each step, for StepObservation::kAfterStep. @param[in] used recorded duration;
        /// negative: the step was not recorded.
        void (*after_step)(void* argument, std::size_t position, Duration used) noexcept;
        void* argument;

        /// Records in `record` the run that ends now. @return its duration; negative after the deadline.
        Duration measure(ExecutionRecord& record) noexcept {
            const Instant ended = host->get_step_end();
            Duration used{-1};
            if (ended <= deadline) {
                record.note_run(step_start, ended);
                used = ended - step_start;
            }
            step_start = ended;
            return used;
        }
    };
    /// What a first pass does after each step.
    enum class StepObservation : std::uint8_t {
        kNone,       ///< nothing
        kRecords,    ///< records the step
        kAfterStep,  ///< records the step if there are records, then calls after_step
    };
    /// The passes as WindowHost::Work::run. A call runs the steps at the positions `first` .. `end` - 1.
    using Pass = void (*)(void* argument, std::size_t first, std::size_t end) noexcept;
    /// The first pass without observation. Its argument is the context.
    static Pass get_first_pass() noexcept;
    /// The first pass with one. Its argument is a StepObserver of the context.
    static Pass get_observed_pass(StepObservation observation) noexcept;
    /// The second pass. @param[in] argument the context.
    static void run_second_pass(void* argument, std::size_t first, std::size_t end) noexcept;
    /// Ends the cycle, even if steps are missing. No step may be running.
    void end_cycle() noexcept { phase_.store(Phase::kIdle, std::memory_order_relaxed); }
    /// Ends the cycle, or a step outside a cycle, whose work the platform host has aborted. The context
    /// remains busy until readmit(). A step that starts before readmit() does nothing.
    /// @param[in] position participant whose work was aborted, 0 .. get_participant_count() - 1.
    void abandon(std::size_t position) noexcept {
        abandoned_position_ = position;
        phase_.store(Phase::kAbandoned, std::memory_order_release);
    }
    /// The platform host reports that the aborted work has returned.
    void readmit() noexcept { phase_.store(Phase::kIdle, std::memory_order_relaxed); }
    /// @}

  private:
    friend class FsmMachine;
    friend class MultiModeComponent;
    class ActionScope;
    static constexpr std::size_t kNoPosition = std::numeric_limits<std::size_t>::max();

    /// kInCycle and Status::kOk are both 0, so that one comparison in a step checks both.
    enum class Phase : std::uint8_t { kInCycle, kIdle, kAbandoned };

    bool is_in_cycle() const noexcept { return phase_.load(std::memory_order_relaxed) == Phase::kInCycle; }
    bool admits_steps(std::size_t first, std::size_t end) const noexcept;
    bool take_tick() noexcept;
    static void release_participants(Span<Component* const> participants) noexcept;
    Result<std::size_t> find(const Component& component) const noexcept;
    Result<std::size_t> admit(const Component& component, LifecycleEvent event) const noexcept;
    template <typename... Caller>
    Status start_by(Instant now, Caller&... caller) noexcept;
    template <typename... Caller>
    Status stop_by(Instant now, Caller&... caller) noexcept;
    template <typename... Caller>
    Status shut_down(std::size_t count, Instant now, Caller&... caller) noexcept;
    Status act(ComponentAction action, std::size_t position, Instant now) noexcept;
    Status act(ComponentAction action, std::size_t position, Instant now, ActionCaller& caller) noexcept;
    static void run_action(void* argument, std::size_t position, std::size_t end) noexcept;
    template <StepObservation kObservation>
    static void run_first_pass(void* argument, std::size_t first, std::size_t end) noexcept;
    static void end_step(StepObserver& observer, std::size_t position, bool was_active) noexcept;
    bool execute_unusual(std::size_t position) noexcept;
    void judge_execution(std::size_t position, Status answer) noexcept;
    void give_notices(Component& component, ContextHandle handle) noexcept;
    static void note(Component& component, ComponentAction action, Status answer,
                     ContextHandle handle) noexcept;
    Status tell_mode(Component& component, Instant now) noexcept;
    Status judge_machines(Span<Component* const> participants, ExecutionKind kind) const noexcept;
    void serve_events(FsmMachine& machine, Component& component, ContextHandle handle) noexcept;
    void act(const FsmMachine& machine, FsmElement element, ContextHandle handle) noexcept;
    /// Marks the participant at `position` as the owner of the next action. Call within an ActionScope.
    void move_to(std::size_t position) noexcept {
        acting_position_.store(position, std::memory_order_relaxed);
    }
    void judge(Component& component, ComponentAction action, Status answer, ContextHandle handle) noexcept;
    void enter_error(Component& component, ContextHandle handle) noexcept;
    ContextHandle make_handle(Instant now) const noexcept { return {id_, now}; }

    /// Participant whose action runs. Atomic, because an aborted action ends on another thread. kNoPosition
    /// is stored last: a thread that reads it also sees the effects of the actions. The first member, so that
    /// a step needs no register for its address.
    std::atomic<std::size_t> acting_position_{kNoPosition};
    Span<Component* const> participants_{};
    ContextPlan plan_{};
    Duration period_{};  ///< current
    std::int64_t divisor_{1};
    std::int64_t pending_divisor_{1};  ///< requested; equal to divisor_ without a request
    std::int64_t windows_to_skip_{0};
    Instant cycle_start_{};  ///< or the instant that an operation passes to its actions
    std::size_t refusing_position_{kNoPosition};
    std::size_t abandoned_position_{0U};  ///< valid in kAbandoned
    std::atomic<Phase> phase_{Phase::kIdle};
    bool is_running_{false};
    ComponentAction action_{ComponentAction::kStartup};  ///< called by an ActionCaller
    Status action_result_{Status::kOk};
    std::int32_t id_{-1};
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_EXECUTION_CONTEXT_HPP
