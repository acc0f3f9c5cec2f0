// SPDX-License-Identifier: Apache-2.0
/// @file
/// The supervisor of the arm: the safety cycle with the inputs, the self test and the outputs of this
/// machine.
///
/// @satisfies SWR-SAF-013, SWR-SAF-014, SWR-SAF-015, SWR-SAF-018, SWR-SAF-019, SWR-SAF-021, SWR-SAF-022
/// @satisfies SWR-SAF-023, SWR-SAF-025, SWR-SAF-028, SWR-SAF-033, SWR-SAF-047, SWR-SAF-062      Design:
/// docs/design/safe_arm.md#reactions
#ifndef EXAMPLES_SAFE_ARM_SAFETY_SUPERVISOR_HPP
#define EXAMPLES_SAFE_ARM_SAFETY_SUPERVISOR_HPP

#include "mamori/kernel/system/system.hpp"
#include "mamori/safety/cycle/safety_cycle.hpp"
#include "mamori/safety/redundancy/complement_stored.hpp"
#include "messages.hpp"
#include "start_up_check.hpp"

namespace safe_arm {

class SafetySupervisor final : public mamori::safety::SafetyCycle {
  public:
    /// @param[in] state of the table that runs this component. @param[in] log takes the events. Both have
    /// static storage.
    constexpr SafetySupervisor(mamori::safety::SafetyState& state, mamori::EventLog& log) noexcept
        : SafetyCycle("safety_supervisor", state, &log) {}

    mamori::InPort<JointReading> reading{*this, "reading"};
    mamori::InPort<JointState> arm_state{*this, "arm_state"};
    mamori::InPort<DriveCommand> drive{*this, "drive"};  ///< what the gate gave to the drives
    mamori::OutPort<StopCommand> stop{*this, "stop"};
    using Ports = mamori::Ports<&SafetySupervisor::reading, &SafetySupervisor::arm_state,
                                &SafetySupervisor::drive, &SafetySupervisor::stop>;

  private:
    mamori::safety::CycleInputs read_inputs(mamori::Instant now) noexcept override;
    mamori::safety::SelfTestStatus step_self_test(bool is_first, mamori::Instant now) noexcept override;
    bool wants_test_torque() noexcept override { return start_up_.is_torque_wanted(); }
    bool is_present(mamori::safety::FaultIndex fault) noexcept override;
    void command(mamori::safety::SafeState state,
                 const mamori::safety::StopOutputs& outputs) noexcept override;

    std::uint32_t find_panel_faults(const JointReading& now) const noexcept;

    /// Torque is on, or a stop is under way.
    bool is_active() const noexcept {
        return get_state() >= mamori::safety::SafeState::kOperational &&
               get_state() <= mamori::safety::SafeState::kStandstillHold;
    }

    StartUpCheck start_up_{};
    mamori::safety::ComplementStored<mamori::Instant> brakes_tested_at_{mamori::Instant{}};
    std::uint32_t panel_faults_{0U};  ///< that count in the mode; bit n = ArmFault n
    bool is_brake_test_old_{false};
    bool has_ended_hold_{false};  ///< in the frame before
};

}  // namespace safe_arm

#endif  // EXAMPLES_SAFE_ARM_SAFETY_SUPERVISOR_HPP
