// SPDX-License-Identifier: Apache-2.0
/// @file
/// Judges the measured arm: which encoder channel can be trusted, whether speed, position and torque are
/// inside their limits. It reports what it sees in this cycle; debouncing and
/// latching are the fault register's work.
///
/// @satisfies SWR-SAF-005, SWR-SAF-006, SWR-SAF-007, SWR-SAF-008, SWR-SAF-029, SWR-SAF-034, SWR-SAF-037
/// @satisfies SWR-SAF-043, SWR-SAF-046, SWR-SAF-048, SWR-SAF-049
/// Design: docs/design/safe_arm.md#monitor
#ifndef EXAMPLES_SAFE_ARM_JOINT_MONITOR_HPP
#define EXAMPLES_SAFE_ARM_JOINT_MONITOR_HPP

#include <array>
#include <cstddef>

#include "arm_faults.hpp"
#include "arm_limits.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/safety/base/rising_edge.hpp"
#include "mamori/safety/redundancy/clock_ratio.hpp"
#include "messages.hpp"

namespace safe_arm {

class JointMonitor final : public mamori::Component {
  public:
    constexpr JointMonitor() noexcept : Component("joint_monitor") {}

    mamori::InPort<JointReading> reading{*this, "reading"};
    mamori::InPort<TorqueCommand> command{*this, "command"};
    mamori::InPort<DriveCommand> drive{*this, "drive"};
    mamori::OutPort<JointState> state{*this, "state"};
    using Ports = mamori::Ports<&JointMonitor::reading, &JointMonitor::command, &JointMonitor::drive,
                                &JointMonitor::state>;

    /// Forgets everything: positions, distrust, times.
    mamori::Status on_activated(mamori::ContextHandle context) noexcept override;
    mamori::Status on_execute(mamori::ContextHandle context) noexcept override;

  private:
    /// Cycles over which the speed is averaged.
    static constexpr std::size_t kSpeedCycles = 4U;
    using StandstillDetector = mamori::safety::StandstillDetector;

    void begin_history(const JointReading& now) noexcept;
    std::uint32_t judge_channels(const JointReading& now, JointVector& position_rad) noexcept;
    void move_history_to_b(std::size_t joint) noexcept;
    std::uint32_t judge_stuck(const JointReading& now) noexcept;
    std::uint32_t judge_motion(const JointState& now) noexcept;
    std::uint32_t judge_torque(const JointReading& now) noexcept;
    std::uint32_t judge_power(const JointReading& now) noexcept;
    std::uint32_t judge_brakes(const JointReading& now) noexcept;
    std::uint32_t check_rest(const JointState& now) noexcept;
    std::uint32_t check_clock(mamori::Instant drives, mamori::Instant own) noexcept;
    std::uint32_t check_reference(const JointVector& position_rad) noexcept;
    std::uint32_t compare_with_model(const JointState& now) noexcept;
    bool is_controlled() const noexcept {
        return is_torque_on() && drive.read().source == TorqueSource::kController;
    }
    bool is_torque_on() const noexcept { return drive.has_value() && drive.read().torque_enable; }

    std::array<JointVector, kSpeedCycles> past_rad_{};  ///< trusted positions; the oldest at `oldest_`
    std::size_t oldest_{0U};
    std::array<JointVector, kSpeedCycles> past_rad_s_{};  ///< speeds of the same cycles
    JointVector last_rad_{};                              ///< trusted positions of the cycle before
    JointReading last_{};
    JointVector stuck_since_rad_{};  ///< setpoint when a count of the joint last changed
    mamori::safety::AxisSet distrusted_a_{};
    mamori::safety::AxisSet distrusted_b_{};
    mamori::safety::RisingEdge reset_edge_{};
    StandstillDetector standstill_{make_uniform(kStandstillRadS), kStandstillTime};
    mamori::Duration brake_contradiction_for_{};
    mamori::Duration torque_absent_for_{};
    mamori::Duration relay_open_for_{};
    mamori::Duration resting_for_{};
    JointVector rest_rad_{};  ///< where the brakes engaged
    mamori::safety::ClockRatio clocks_{kClockLimits};
    bool has_drive_clock_{false};
    JointVector mean_difference_nm_{};  ///< of the torque from gravity and friction
    JointVector mean_rad_s_{};          ///< over the same time
    bool has_history_{false};
};

}  // namespace safe_arm

#endif  // EXAMPLES_SAFE_ARM_JOINT_MONITOR_HPP
