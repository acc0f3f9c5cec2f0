// SPDX-License-Identifier: Apache-2.0
/// @file
/// The component that decides: supervises, latches faults, chooses the severest reaction, steps the
/// safe-state machine, commands its outputs and services the watchdog on proven health, always in this order.
/// A machine derives its supervisor and adds only its inputs and outputs.
///
/// @satisfies SWR-CYC-003, SWR-CYC-004, SWR-CYC-005, SWR-CYC-006, SWR-CYC-007, SWR-CYC-008, SWR-CYC-009
/// @satisfies SWR-CYC-010, SWR-CYC-013, SWR-CYC-014, SWR-CYC-020, SWR-CYC-021, SWR-CYC-022, SWR-CYC-030
/// @satisfies SWR-CYC-031, SWR-CYC-034, SWR-CYC-037
/// Design:   docs/design/safety_cycle.md#order
#ifndef MAMORI_SAFETY_SAFETY_CYCLE_HPP
#define MAMORI_SAFETY_SAFETY_CYCLE_HPP

#include <array>
#include <cstdint>

#include "mamori/kernel/component/component.hpp"
#include "mamori/kernel/record/event_log.hpp"
#include "mamori/safety/base/rising_edge.hpp"
#include "mamori/safety/cycle/safety_state.hpp"

namespace mamori::safety {

/// Codes of the events that the cycle writes with source 0; arguments in brackets. Numbers are never reused.
enum class CycleEvent : std::uint16_t {
    kStateEntered,      ///< [SafeState]
    kFaultLatched,      ///< [fault]
    kReactionBegun,     ///< [Reaction], the severest since the start
    kWatchdogRefused,   ///< [GlobalStatus]
    kAssumptionFailed,  ///< [AssumptionIndex]
    kComponentExpired,  ///< [ExpiryCause]; source: index of the component in the table plus 1
    kSelfTestFailed,    ///< [index of the self test in the table]
};
/// Spelling of an event in logs, indexed by its code.
inline constexpr std::array<const char*, 7U> kCycleEventNames{
    "state_entered",     "fault_latched",     "reaction_begun",  "watchdog_refused",
    "assumption_failed", "component_expired", "self_test_failed"};

/// Which component expired, and why.
struct ComponentExpiry {
    std::size_t component{kNoIndex};  ///< index in the table; kNoIndex: none
    ExpiryCause cause{ExpiryCause::kNone};
};

/// What the machine reports in one cycle. The defaults permit nothing. The table names the source of each
/// confirmation of a stop with confirmed_by(...).
struct CycleInputs {
    bool is_standing{false};                        ///< as measured
    bool are_brakes_closed{false};                  ///< contacts of all brakes
    bool has_torque{true};                          ///< feedback of the drives: torque is possible
    bool start_button{false};                       ///< level
    bool reset_button{false};                       ///< level
    bool may_start{false};                          ///< the start is bumpless
    StopOutputs applied{true, true, false, false};  ///< what the outputs of the last frame were
    std::size_t mode{0U};  ///< of the system; 0 without modes. An invalid one demands STO
    bool can_hold{false};  ///< torque can hold the machine without its brakes
};

/// Thread safety: none; the executive calls it. Time: O(components + faults * reactions), and one step of
///                each self test of the table.
/// Memory:        no heap; all state of the decision is in the SafetyState.
class SafetyCycle : public Component, public CycleComponent {
  public:
    /// Confirmations and supervision of the table. @return kOk; kPreconditionNotMet (a second call while a
    /// fault is latched or a component is watched); kBadParameter (checkpoints<kTable>(...) names a
    /// supervisor of another table, or two passes of a self test do not fit into its found_within(...)).
    Status on_initialize() noexcept final { return apply_table(); }
    Status on_execute(ContextHandle context) noexcept final {
        decide(context.now);
        return Status::kOk;
    }

    SafeState get_state() const noexcept { return state_.get_state(); }
    /// Fault latched first since the start, also after it was acknowledged; kNoFault when there was none.
    FaultIndex get_first_fault() const noexcept { return first_fault_; }
    /// Severest reaction begun since the start.
    Reaction get_reaction() const noexcept { return worst_reaction_; }
    /// Longest time from a latched fault to the cycle that finds its reaction in the applied outputs.
    Duration get_longest_reaction() const noexcept { return longest_reaction_; }
    /// Last expiry of a component, also after it was acknowledged. While the fault that a component raises is
    /// latched, its further expiries do not count.
    const ComponentExpiry& get_last_expiry() const noexcept { return last_expiry_; }

  protected:
    /// @param[in] name static storage. @param[in] state of the table that runs this component, static
    /// storage.
    /// @param[in] log takes the events; static storage; nullptr: none.
    constexpr SafetyCycle(const char* name, SafetyState& state, EventLog* log = nullptr) noexcept
        : Component(name), state_(state), log_(log) {}
    ~SafetyCycle() = default;

    /// @name The machine. Called once per cycle in this order; is_present() for each fault of the table, also
    ///       if a row of the table raises it.
    /// @{
    virtual CycleInputs read_inputs(Instant now) noexcept = 0;
    /// @param[in] is_first first cycle of the self test, at power-up and after a reset. Only called there.
    virtual SelfTestStatus step_self_test(bool is_first, Instant now) noexcept = 0;
    /// @return true while the fault is present.
    virtual bool is_present(FaultIndex fault) noexcept = 0;
    /// @return true for torque against the closed brakes in this frame of the self test. Only called there.
    virtual bool wants_test_torque() noexcept { return false; }
    /// Writes the commands. @param[in] state of the machine.
    virtual void command(SafeState state, const StopOutputs& outputs) noexcept = 0;
    /// @}

    /// Whether the table reacts to the fault in this mode, with other than Reaction::kNone.
    bool has_reaction(FaultIndex fault, std::size_t mode) const noexcept;
    /// The watchdog took the service of the cycle before.
    bool is_watchdog_serviced() const noexcept { return is_watchdog_serviced_; }

  private:
    // Each virtual function here is inline, so that an application with RTTI can derive from this class.
    Status apply_table() noexcept;
    void decide(Instant now) noexcept;
    void step_checkpoints(Instant now) noexcept;
    void drop_unproven(CycleInputs& machine) const noexcept;
    bool is_proven(StopConfirmation confirmation) const noexcept;
    SelfTestStatus test(Instant now) noexcept;
    SelfTestStatus check_assumptions(Instant now) noexcept;
    SelfTestStatus repeat_self_tests(Instant now) noexcept;
    bool has_failed_test(FaultIndex fault) const noexcept;
    bool has_lost_connection(FaultIndex fault, Instant now) const noexcept;
    bool are_connections_fresh(Instant now) const noexcept;
    void report_faults(SelfTestStatus self_test, Instant now) noexcept;
    bool find_presence(FaultIndex fault, SelfTestStatus self_test, Instant now) noexcept;
    void record_expiries(Instant now) noexcept;
    bool is_expired(const SuperviseRow& row) noexcept;
    Status require_healing(const SuperviseRow& row) noexcept;
    void follow_reset(bool reset_button) noexcept;
    bool have_brakes_failed(const CycleInputs& machine, SafeState state, Instant now) const noexcept;
    bool waits_for_brakes(FaultIndex fault) const noexcept {
        return ((state_.table_.cycle.brakes_first >> (fault & 63U)) & 1U) !=
               0U;  // a table that uses it has at most 64
    }
    bool has_begun(const ReactionDemand& demand, const StopOutputs& applied) const noexcept;
    bool carries_until_closed(SafeState state, bool can_hold, Instant now) const noexcept;
    bool is_sto_unconfirmed(bool has_torque, Instant now) noexcept;
    void measure_reaction(const ReactionDemand& demand, const StopOutputs& applied, Instant now) noexcept;
    void service_watchdog(GlobalStatus health, bool is_trustworthy, Instant now) noexcept;
    void write_event(Instant now, Severity severity, CycleEvent event, std::int64_t argument,
                     std::uint16_t source = 0U) noexcept;

    SafetyState& state_;
    EventLog* log_;
    RisingEdge reset_edge_{};
    Instant stepped_at_{};
    FaultIndex first_fault_{kNoFault};
    FaultIndex measured_fault_{kNoFault};  ///< its reaction was found in the outputs
    Reaction worst_reaction_{Reaction::kNone};
    Duration longest_reaction_{0};
    ComponentExpiry last_expiry_{};
    std::size_t followed_mode_{kNoIndex};  ///< by the supervision
    bool has_stepped_{false};
    bool was_torque_wanted_{false};  ///< in the frame before
    bool is_self_testing_{false};
    bool is_test_failed_{false};  ///< one of those that the table repeats
    bool is_reaction_late_{false};
    bool is_watchdog_refused_{false};
    bool is_watchdog_serviced_{false};  ///< in the frame before
};

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_SAFETY_CYCLE_HPP
