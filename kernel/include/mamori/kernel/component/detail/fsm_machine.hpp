// SPDX-License-Identifier: Apache-2.0
/// @file
/// Run-time data of a state machine: its state, its queue and its current step. Its component makes them
/// readable, and its event-driven context updates them.
///
/// @satisfies SWR-RTC-006      Design: docs/design/rtc_semantics.md#state-machines
#ifndef MAMORI_KERNEL_FSM_MACHINE_HPP
#define MAMORI_KERNEL_FSM_MACHINE_HPP

#include <cstddef>
#include <cstdint>

#include "mamori/kernel/component/detail/event_server.hpp"
#include "mamori/kernel/component/detail/fsm_event_queue.hpp"
#include "mamori/kernel/component/fsm_table.hpp"

namespace mamori {

/// Current step of the state machine while on_action is called.
struct FsmStep {
    /// Purpose of the current call of on_action.
    enum class Phase : std::uint8_t { kNone, kExit, kTransition, kEntry };
    Phase phase{Phase::kNone};
    std::size_t transition{0U};  ///< row of the table
    FsmEvent event{};            ///< event in process
};

/// State, queue and step of one machine.
///
/// Thread safety: get_queue() and post() as the queue, get_context_id() from anywhere; the rest from the core
///                that runs the component.
/// Time:          O(transitions). Memory: no heap; the table, profile and cells must outlive it.
class FsmMachine final : public EventServer {
  public:
    /// @param[in] owner passed to the guards. The other parameters: see FsmComponent.
    constexpr FsmMachine(const FsmComponent& owner, const FsmTable& table, FsmProfile profile,
                         Span<FsmEventCell> cells) noexcept
        : owner_(owner), table_(table), profile_(profile), queue_(cells), state_(table.initial) {}
    FsmMachine(const FsmMachine&) = delete;
    FsmMachine& operator=(const FsmMachine&) = delete;

    /// Table of states, messages and transitions given at construction.
    const FsmTable& get_table() const noexcept { return table_; }
    /// Profile given at construction.
    FsmProfile get_profile() const noexcept { return profile_; }
    /// Row of the current state; during on_action, the source state until the entry phase.
    FsmIndex get_state() const noexcept { return state_; }
    /// Current step of on_action; phase kNone outside on_action. Valid as long as this object.
    const FsmStep& get_step() const noexcept { return step_; }
    /// Number of events consumed without a transition (wraps at 2^32).
    std::uint32_t get_ignored_count() const noexcept { return ignored_count_; }
    /// Queue of waiting events, with its counters; thread safety as the queue.
    const FsmEventQueue& get_queue() const noexcept { return queue_; }
    /// @return as FsmEventQueue::post().
    Status post(const FsmEvent& event, std::uint32_t epoch) noexcept { return queue_.post(event, epoch); }

    Status check_for(const ExecutionContext& context) const noexcept override;
    void restart() noexcept override;
    void serve(ExecutionContext& context, Component& component, ContextHandle handle) noexcept override;

  private:
    friend class ExecutionContext;

    /// Transition of the current state for the event; nullptr when there is none, which is counted as
    /// ignored.
    const FsmTransition* choose_transition(const FsmEvent& event) noexcept;

    const FsmComponent& owner_;
    const FsmTable& table_;
    FsmProfile profile_;
    FsmEventQueue queue_;
    FsmStep step_{};
    std::uint32_t ignored_count_{0U};
    FsmIndex state_;
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_FSM_MACHINE_HPP
