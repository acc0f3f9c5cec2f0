// SPDX-License-Identifier: Apache-2.0
/// @file
/// The place of decision: latches faults, chooses the severest reaction, steps the safe-state machine,
/// commands its outputs and serves the watchdog on proven health.
///
/// @satisfies SWR-SAF-013, SWR-SAF-014, SWR-SAF-015, SWR-SAF-018, SWR-SAF-019, SWR-SAF-021, SWR-SAF-022
/// @satisfies SWR-SAF-023      Design: docs/design/safe_arm.md#reactions
#ifndef EXAMPLES_SAFE_ARM_SAFETY_SUPERVISOR_HPP
#define EXAMPLES_SAFE_ARM_SAFETY_SUPERVISOR_HPP

#include <array>
#include <cstdint>

#include "arm_faults.hpp"
#include "arm_limits.hpp"
#include "decision_flow.hpp"
#include "mamori/kernel/record/event_log.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/safety/assumptions/assumption_monitor.hpp"
#include "mamori/safety/base/elapsed.hpp"
#include "mamori/safety/base/rising_edge.hpp"
#include "mamori/safety/reaction/fault_register.hpp"
#include "mamori/safety/reaction/safe_state_machine.hpp"
#include "mamori/safety/reaction/stop_outputs.hpp"
#include "mamori/safety/redundancy/complement_stored.hpp"
#include "mamori/safety/supervision/execution_supervisor.hpp"
#include "mamori/safety/supervision/watchdog_gate.hpp"
#include "messages.hpp"

namespace safe_arm {

/// Codes of the events that the supervisor writes; arguments in brackets.
enum class ArmEvent : std::uint16_t {
    kStateEntered,      ///< [SafeState]
    kFaultLatched,      ///< [ArmFault]
    kReactionBegun,     ///< [Reaction]
    kWatchdogRefused,   ///< [GlobalStatus]
    kAssumptionFailed,  ///< [ArmAssumption]
};
/// Spelling of an event in logs, indexed by its code.
inline constexpr std::array<const char*, 5U> kArmEventNames{
    "state_entered", "fault_latched", "reaction_begun", "watchdog_refused", "assumption_failed"};

class SafetySupervisor final : public mamori::Component {
  public:
    /// @param[in] supervision judges the components of this executive; must have static storage.
    /// @param[in] controller  of the table of `supervision`; static storage.
    /// @param[in] watchdog    serviced through the gate; static storage.
    /// @param[in] log         takes the events; static storage.
    /// @param[in] assumptions stepped here, once per frame; static storage.
    /// @param[in] flow        of this component; static storage.
    constexpr SafetySupervisor(mamori::safety::ExecutionSupervisor& supervision, const Component& controller,
                               mamori::safety::Watchdog& watchdog, mamori::EventLog& log,
                               mamori::safety::AssumptionMonitor& assumptions, DecisionFlow& flow) noexcept
        : Component("safety_supervisor"),
          supervision_(supervision),
          controller_(controller),
          gate_(watchdog, kWatchdogWindow),
          log_(log),
          assumptions_(assumptions),
          flow_(flow) {}

    mamori::InPort<JointReading> reading{*this, "reading"};
    mamori::InPort<JointState> arm_state{*this, "arm_state"};
    mamori::OutPort<StopCommand> stop{*this, "stop"};
    using Ports =
        mamori::Ports<&SafetySupervisor::reading, &SafetySupervisor::arm_state, &SafetySupervisor::stop>;

    /// Sets the debouncing of the faults and finds the controller. @return kOk; else what the fault register
    /// refused.
    mamori::Status on_initialize() noexcept override;
    mamori::Status on_execute(mamori::ContextHandle context) noexcept override;

    mamori::safety::SafeState get_state() const noexcept { return machine_.get_state(); }
    /// Fault latched first since the start, also after it was acknowledged; kNoFault when there was none.
    mamori::safety::FaultIndex get_first_fault() const noexcept { return first_fault_; }
    /// Severest reaction begun since the start.
    Reaction get_reaction() const noexcept { return worst_reaction_; }

  private:
    mamori::safety::SelfTestStatus step_self_test(const JointReading& now, mamori::Instant instant) noexcept;
    mamori::safety::SelfTestStatus check_assumptions(mamori::Instant instant) noexcept;
    void report_faults(mamori::safety::SelfTestStatus self_test, mamori::Instant instant) noexcept;
    bool is_controller_silent() noexcept;
    void follow_reset(const JointReading& now) noexcept;
    bool is_sto_unconfirmed(const JointReading& now) noexcept;
    bool is_in_ss1() const noexcept {
        return machine_.get_state() == mamori::safety::SafeState::kProtectiveStopSs1;
    }
    bool are_brakes_due() noexcept;
    void note_reaction(Reaction reaction, mamori::Instant instant) noexcept;
    void serve_watchdog(mamori::safety::GlobalStatus health, bool is_trustworthy,
                        mamori::Instant instant) noexcept;
    void write_event(mamori::Instant instant, mamori::Severity severity, ArmEvent event,
                     std::int64_t argument) noexcept;

    mamori::safety::ExecutionSupervisor& supervision_;
    const Component& controller_;
    std::size_t controller_index_{mamori::kNoIndex};  ///< as `supervision_` finds it
    std::array<mamori::safety::FaultRecord, kArmFaultCount> fault_storage_{};
    mamori::safety::FaultRegister faults_{fault_storage_};
    mamori::safety::SafeStateMachine machine_{kStopBounds};
    mamori::safety::WatchdogGate gate_;
    mamori::EventLog& log_;
    mamori::safety::AssumptionMonitor& assumptions_;
    DecisionFlow& flow_;
    mamori::safety::RisingEdge reset_edge_{};
    /// With its complement: it decides when the watchdog has to switch off what the software cannot.
    mamori::safety::ComplementStored<mamori::Duration> torque_despite_sto_for_{mamori::Duration{0}};
    std::uint32_t good_frames_{0U};
    mamori::Instant self_test_began_{};
    mamori::safety::FaultIndex first_fault_{mamori::safety::kNoFault};
    Reaction worst_reaction_{Reaction::kNone};
    bool is_self_testing_{false};
    bool has_stood_in_ss1_{false};
    bool is_watchdog_refused_{false};
    bool is_watchdog_served_{false};  ///< in the frame before
};

}  // namespace safe_arm

#endif  // EXAMPLES_SAFE_ARM_SAFETY_SUPERVISOR_HPP
