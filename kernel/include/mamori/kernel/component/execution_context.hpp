// SPDX-License-Identifier: Apache-2.0
/// @file
/// Execution context: starts and stops its participants, moves them through their life cycle and runs them
/// once per cycle in two passes, first on_execute of all, then on_state_update of all.
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
#include "mamori/kernel/component/component.hpp"
#include "mamori/kernel/component/context_plan.hpp"
#include "mamori/kernel/component/execution_record.hpp"
#include "mamori/kernel/component/fsm_table.hpp"
#include "mamori/kernel/component/window_host.hpp"

namespace mamori {

/// Runs the components of one window.
///
/// The context is busy while a cycle is under way and while an action of a participant is being called (or
/// hangs). Every operation that changes anything is refused with kPreconditionNotMet then, so that actions
/// are never reentrant and nothing changes in mid-cycle. The instant `now` of an operation is what the
/// actions find in their ContextHandle, by the clock of the windows; nothing else depends on it.
///
/// Thread safety: none; call from the context that runs the windows. While an abandoned action still runs
///                elsewhere, is_busy(), is_running(), get_acting_position() and get_state_at() may be asked.
/// Time:          O(participants); attach() also judges the tables of state machines, and a cycle serves
///                their events. Nothing blocks beyond the actions.
/// Memory:        no heap; refers to the participant list, which must outlive it.
class ExecutionContext final {
  public:
    constexpr ExecutionContext() noexcept = default;
    ExecutionContext(const ExecutionContext&) = delete;
    ExecutionContext& operator=(const ExecutionContext&) = delete;

    /// Takes its participants. Call once, before anything else.
    /// @param[in] id           identity handed to the actions, >= 0.
    /// @param[in] participants execution order; each must be in no other context.
    /// @param[in] plan         kind, periods and policy; copied, but its spans must outlive the context.
    /// @return kOk; kPreconditionNotMet (already attached, or a state machine in a context that is not
    ///         kEventDriven); kBadParameter (id, no participant, a null or already participating one, one
    ///         named twice, a plan that contradicts what ContextPlan says, or a state machine whose table
    ///         breaks a rule or whose profile names somebody else or an element that does not exist).
    Status attach(std::int32_t id, Span<Component* const> participants, const ContextPlan& plan) noexcept;

    /// Gives its participants up, so that they can be finalized; one in Error becomes Inactive, since Error
    /// is a state in this context only.
    /// @return kOk; kPreconditionNotMet (not attached, Running, busy, or one of them is Active).
    Status detach() noexcept;

    /// Participants come and go with the system table, all at once. Both: @return kUnsupported.
    Status add_component(Component&) noexcept { return Status::kUnsupported; }
    Status remove_component(Component&) noexcept { return Status::kUnsupported; }

    /// Stopped -> Running; on_startup of every participant. A participant that refuses keeps the context
    /// Stopped; those already started get on_shutdown. Ticks of the trigger that came before are ignored.
    /// @return kOk; kPreconditionNotMet (not attached, Running, busy, or a participant is not alive); else
    ///         on_startup's code.
    Status start(Instant now) noexcept;

    /// Running -> Stopped; on_shutdown of every participant. States of components do not change.
    /// @return kOk; kPreconditionNotMet (Stopped, or busy); else the first failing on_shutdown's code, and it
    ///         is Stopped anyway.
    Status stop(Instant now) noexcept;

    /// Inactive -> Active, after on_activated. When that fails: Error, on_aborting, and its code is returned;
    /// the component is never seen Active. Allowed while Stopped as well.
    /// @return kOk; kBadParameter (no participant, or not alive); kPreconditionNotMet (not Inactive, or
    ///         busy); else the code.
    Status activate_component(const Component& component, Instant now) noexcept;

    /// Active -> Inactive, then on_deactivated, whose failure is returned but does not keep it Active.
    /// @return kOk; kBadParameter (no participant, or not alive); kPreconditionNotMet (not Active, or busy);
    ///         else the code.
    Status deactivate_component(const Component& component, Instant now) noexcept;

    /// Error -> Inactive, after on_reset returned kOk; otherwise it stays in Error.
    /// @return kOk; kBadParameter (no participant); kPreconditionNotMet (not in Error, or busy); else
    ///         on_reset's code.
    Status reset_component(const Component& component, Instant now) noexcept;

    /// @return kInactive, kActive or kError; kBadParameter (no participant, or not alive).
    Result<LifecycleState> get_component_state(const Component& component) const noexcept;
    /// State of the participant at `position`, 0 .. get_participant_count() - 1, kCreated when it is not
    /// alive; a position out of range is an own bug.
    LifecycleState get_state_at(std::size_t position) const noexcept;

    /// Kind from the plan; kPeriodic while not attached.
    ExecutionKind get_kind() const noexcept { return plan_.kind; }
    /// Time between two cycles in use now; 0 while not attached.
    Duration get_period() const noexcept { return period_; }
    /// Windows of the plan per cycle in use now, >= 1; 1 while not attached.
    std::int64_t get_divisor() const noexcept { return divisor_; }
    /// Cycles per second in use now; negative when the kind has no periodic processing, and while not
    /// attached.
    double get_rate() const noexcept;

    /// Wishes for another rate: that of the plan's period or of an alternative. It comes into use with
    /// apply_pending_rate(), and a later wish replaces an earlier one.
    /// @param[in] rate_hz cycles per second; names the period that lies within half a nanosecond of 1 / rate.
    /// @return kOk; kBadParameter (0, negative, infinite, not a number); kUnsupported (no periodic
    ///         processing, not attached, or a rate that the plan does not declare); kPreconditionNotMet
    ///         (busy).
    Status set_rate(double rate_hz) noexcept;

    /// Brings the wished rate into use, the next window being the first at the new rate, in which each
    /// participant gets on_rate_changed. For the executive, at the boundary of a frame.
    /// @return true when the rate has changed; a wish waits while the context is busy.
    bool apply_pending_rate() noexcept;

    /// True while a cycle is under way, an action of a participant is being called or hangs, or work that was
    /// cut off has not come back.
    bool is_busy() const noexcept {
        return phase_.load(std::memory_order_relaxed) != Phase::kIdle ||
               acting_position_.load(std::memory_order_acquire) != kNoPosition;
    }
    /// Identity from attach(); -1 while not attached.
    std::int32_t get_id() const noexcept { return id_; }
    /// From a start() that returned kOk until stop().
    bool is_running() const noexcept { return is_running_; }
    /// Positions are 0 .. this - 1, in execution order; 0 while not attached.
    std::size_t get_participant_count() const noexcept { return participants_.size(); }

    /// Position of the participant whose action is being called or hangs, else of the one that was cut off
    /// and has not come back. @return kPreconditionNotMet: none.
    Result<std::size_t> get_acting_position() const noexcept;
    /// Position of the participant that the last start() of an attached, stopped and idle context failed at:
    /// it is not alive, or its on_startup refused. @return kPreconditionNotMet: none.
    Result<std::size_t> get_refusing_position() const noexcept;

    /// @name One cycle in steps, as the executive needs it: take_turn, begin, execute 0..n-1,
    /// update_state 0..n-1, end. Calling a step outside a cycle, or with a position out of range, is an own
    /// bug. A range that its host abandoned ends after the action that is under way.
    /// @{
    /// Counts one window of the context. @return true when a cycle is due in it: always, each n-th time at a
    /// rate that is n times slower than the plan's, or once for each tick of the trigger; false while
    /// Stopped.
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
    /// @return kOk; kPreconditionNotMet (Stopped, or busy).
    Status begin_cycle(Instant now) noexcept {
        if (!is_running_ || is_busy()) {
            return Status::kPreconditionNotMet;
        }
        phase_.store(Phase::kInCycle, std::memory_order_relaxed);
        cycle_start_ = now;
        return Status::kOk;
    }
    /// on_execute when Active, on_error when in Error, nothing when Inactive. In a kEventDriven context an
    /// Active state machine serves its events instead, and only a machine in Error gets on_error here.
    void execute(std::size_t position) noexcept { execute_range(position, 1U); }
    /// execute() of `count` positions from `first` on.
    void execute_range(std::size_t first, std::size_t count) noexcept {
        get_first_pass(StepObservation::kNone)(this, first, first + count);
    }
    /// on_state_update when Active, so not when on_execute failed in this cycle; nothing when kEventDriven.
    void update_state(std::size_t position) noexcept { update_range(position, 1U); }
    /// update_state() of `count` positions from `first` on.
    void update_range(std::size_t first, std::size_t count) noexcept {
        run_second_pass(this, first, first + count);
    }

    /// Observes the steps of a first pass, while the context still counts as acting.
    struct StepObserver {
        ExecutionContext* context;  ///< whose steps they are
        ExecutionRecord* records;   ///< of position 0 and on; null: no step is measured
        const WindowHost* host;     ///< reports the end of a step; needed with records
        Instant deadline;           ///< of the pass; a step that ends later is not recorded
        Instant step_start;         ///< start of the first step, then of the current step
        /// Called after each step, for StepObservation::kAfterStep. @param[in] used as it was recorded;
        /// negative: the step was not recorded.
        void (*after_step)(void* argument, std::size_t position, Duration used) noexcept;
        void* argument;

        /// Records in `record` the run that ends now. @return its duration; negative when it was too late.
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
    /// The passes as WindowHost::Work::run. The steps are the positions `first` .. `end` - 1.
    using Pass = void (*)(void* argument, std::size_t first, std::size_t end) noexcept;
    /// The first pass. Its argument is the context for kNone, else a StepObserver of the context.
    static Pass get_first_pass(StepObservation observation) noexcept;
    /// The second pass. @param[in] argument the context.
    static void run_second_pass(void* argument, std::size_t first, std::size_t end) noexcept;
    /// Ends the cycle, whether all steps were made or not. Nobody may be within one.
    void end_cycle() noexcept { phase_.store(Phase::kIdle, std::memory_order_relaxed); }
    /// Ends the cycle, or a step outside of it, whose work the host has cut off: the context stays busy until
    /// readmit(). A step that begins in the meantime does nothing.
    /// @param[in] position 0 .. get_participant_count() - 1, of the one that was cut off.
    void abandon(std::size_t position) noexcept {
        abandoned_position_ = position;
        phase_.store(Phase::kAbandoned, std::memory_order_release);
    }
    /// The host says that the work which was cut off has come back.
    void readmit() noexcept { phase_.store(Phase::kIdle, std::memory_order_relaxed); }
    /// @}

  private:
    friend class MultiModeComponent;
    class ActionScope;
    static constexpr std::size_t kNoPosition = std::numeric_limits<std::size_t>::max();

    /// kInCycle is 0, as Status::kOk is: a turn asks for both in one.
    enum class Phase : std::uint8_t { kInCycle, kIdle, kAbandoned };

    bool is_in_cycle() const noexcept { return phase_.load(std::memory_order_relaxed) == Phase::kInCycle; }
    bool admits_steps(std::size_t first, std::size_t end) const noexcept;
    bool take_tick() noexcept;
    static void release_participants(Span<Component* const> participants) noexcept;
    Result<std::size_t> find(const Component& component) const noexcept;
    Result<std::size_t> admit(const Component& component, LifecycleEvent event) const noexcept;
    template <StepObservation kObservation>
    static void run_first_pass(void* argument, std::size_t first, std::size_t end) noexcept;
    static void end_step(StepObserver* observer, std::size_t position, bool was_active) noexcept;
    bool execute_unusual(std::size_t position) noexcept;
    void judge_execution(std::size_t position, Status answer) noexcept;
    void give_notices(Component& component, ContextHandle handle) noexcept;
    static void note(Component& component, ComponentAction action, Status answer,
                     ContextHandle handle) noexcept;
    Status tell_mode(Component& component, Instant now) noexcept;
    Status judge_machines(Span<Component* const> participants, ExecutionKind kind) const noexcept;
    void serve_events(Component& component, ContextHandle handle) noexcept;
    void act(const FsmMachine& machine, FsmElement element, ContextHandle handle) noexcept;
    /// The next action is one of the participant at `position`. Within an ActionScope.
    void move_to(std::size_t position) noexcept {
        acting_position_.store(position, std::memory_order_relaxed);
    }
    void judge(Component& component, ComponentAction action, Status answer, ContextHandle handle) noexcept;
    void enter_error(Component& component, ContextHandle handle) noexcept;
    ContextHandle make_handle(Instant now) const noexcept { return {id_, now}; }

    /// Whose action is being called. Atomic, since an action that its host has abandoned ends on another
    /// thread; kNoPosition is stored last, so that whoever sees it sees all that the actions did. The first
    /// member, so that a turn needs no register for its address.
    std::atomic<std::size_t> acting_position_{kNoPosition};
    Span<Component* const> participants_{};
    ContextPlan plan_{};
    Duration period_{};          ///< in use
    Duration pending_period_{};  ///< wished for; equal to period_ when there is no wish
    std::int64_t divisor_{1};
    std::int64_t windows_to_skip_{0};
    Instant cycle_start_{};
    std::size_t refusing_position_{kNoPosition};
    std::atomic<Phase> phase_{Phase::kIdle};
    std::size_t abandoned_position_{0U};  ///< in kAbandoned
    bool is_running_{false};
    std::int32_t id_{-1};
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_EXECUTION_CONTEXT_HPP
