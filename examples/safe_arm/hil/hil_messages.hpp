// SPDX-License-Identifier: Apache-2.0
/// @file
/// Messages between plant, kernel and controller, when each is a process. `hil_types` prints them as LCM
/// types.
///
/// @satisfies SWR-HIL-001      Design: docs/design/safe_arm.md#hardware-in-the-loop
#ifndef EXAMPLES_SAFE_ARM_HIL_HIL_MESSAGES_HPP
#define EXAMPLES_SAFE_ARM_HIL_HIL_MESSAGES_HPP

#include <cstdint>

#include "arm_limits.hpp"
#include "mamori/kernel/base/time.hpp"
#include "mamori/ports/lcm/protected_message.hpp"
#include "mamori/ports/lcm/type_names.hpp"
#include "mamori/safety/arm/arm_device.hpp"
#include "mamori/safety/e2e/profile_04.hpp"
#include "mamori/safety/reaction/fault_register.hpp"
#include "messages.hpp"

namespace safe_arm {

/// From the plant: one sample of all devices, the answer to one DriveFrame.
struct DeviceFrame {
    std::int64_t answered_ns{0};  ///< start of the answered major frame; 0 also before the first one
    mamori::safety::ArmInputs inputs{};
};

/// State of the supervisor, for the record of the plant only.
struct SupervisorReport {
    std::uint8_t state{1U};                               ///< SafeState
    std::uint8_t reaction{0U};                            ///< Reaction: the severest so far
    std::uint16_t first_fault{mamori::safety::kNoFault};  ///< ArmFault
    bool is_stopping{false};                              ///< torque off, or a controlled stop requested
    std::uint32_t late_windows{0U};  ///< late releases, and 1 more if a component expired
    JointVector setpoint_rad{};
};

/// From the kernel to the plant, once per major frame.
struct DriveFrame {
    std::uint32_t frame{0U};              ///< number of the major frame
    std::uint32_t watchdog_services{0U};  ///< number so far, modulo 2^32
    mamori::safety::ArmOutputs outputs{};
    SupervisorReport report{};
};

/// From the kernel to the controller, once per major frame.
struct ControllerInput {
    std::int64_t sent_at_ns{0};  ///< for TorqueCommand::sent_at_ns of the answer
    JointVector position_rad{};
    JointVector velocity_rad_s{};
    bool is_operational{false};
    bool torque_enable{false};  ///< and no stop is requested
    bool is_reduced{false};     ///< any mode but automatic
};

}  // namespace safe_arm

MAMORI_LCM_NAMES(mamori::safety::ArmInputs, encoder_a_counts, encoder_b_counts, measured_torque_nm,
                 brake_closed, torque_enabled, relay_closed, power_good, start_button, reset_button,
                 emergency_stop_closed, protective_stop_closed, enabling_closed, enabling_squeezed,
                 run_button, reference_closed, drive_clock_ns, mode_selected)
MAMORI_LCM_NAMES(mamori::safety::ArmOutputs, torque_nm, torque_enable, brake_release, relay_close)
MAMORI_LCM_FIELDS(safe_arm::DeviceFrame, answered_ns, inputs)
MAMORI_LCM_FIELDS(safe_arm::SupervisorReport, state, reaction, first_fault, is_stopping, late_windows,
                  setpoint_rad)
MAMORI_LCM_FIELDS(safe_arm::DriveFrame, frame, watchdog_services, outputs, report)
MAMORI_LCM_FIELDS(safe_arm::ControllerInput, sent_at_ns, position_rad, velocity_rad_s, is_operational,
                  torque_enable, is_reduced)
MAMORI_LCM_NAMES(safe_arm::TorqueCommand, sequence, sent_at_ns, setpoint_rad, torque_nm)

namespace safe_arm {

using HilProfile = mamori::safety::E2eProfile04<>;

/// Channel of the messages of type T. @param[in] data_id of this link alone.
template <typename T>
constexpr mamori::safety::SentIdChannel make_hil_channel(std::uint32_t data_id) noexcept {
    return {data_id, mamori::ports::lcm::kChannelLengthMin<T, HilProfile>,
            mamori::ports::lcm::kChannelLengthMax<T, HilProfile>, 0U};
}

inline constexpr auto kDeviceE2e = make_hil_channel<DeviceFrame>(0x48494C01U);
inline constexpr auto kDriveE2e = make_hil_channel<DriveFrame>(0x48494C02U);
inline constexpr auto kStateE2e = make_hil_channel<ControllerInput>(0x48494C03U);
inline constexpr auto kCommandE2e = make_hil_channel<TorqueCommand>(0x48494C04U);

using DeviceMessage = mamori::ports::lcm::LcmMessage<DeviceFrame, HilProfile, kDeviceE2e>;
using DriveMessage = mamori::ports::lcm::LcmMessage<DriveFrame, HilProfile, kDriveE2e>;
using StateMessage = mamori::ports::lcm::LcmMessage<ControllerInput, HilProfile, kStateE2e>;
using CommandMessage = mamori::ports::lcm::LcmMessage<TorqueCommand, HilProfile, kCommandE2e>;

/// LCM channel of each link.
inline constexpr const char* kDeviceChannel = "ARM_DEVICES";
inline constexpr const char* kDriveChannel = "ARM_DRIVES";
inline constexpr const char* kStateChannel = "ARM_STATE";
inline constexpr const char* kCommandChannel = "ARM_COMMAND";

/// Messages that wait for one window.
inline constexpr std::size_t kHilQueueDepth = 16U;
/// Messages lost in a row after which a receiver closes its channel: above all tolerated losses.
inline constexpr std::uint32_t kHilMaxDelta = 10U;

/// Age of the newest answer of the plant at which it counts as missing. An answer is 1 ms old when it is
/// read, so two missing answers are tolerated.
inline constexpr mamori::Duration kDeviceAgeMax = 3500_us;
/// From the start of the last answered major frame to closed outputs: kDeviceAgeMax, up to one frame until
/// the next reading, one frame until the outputs are sent, and 500 us lateness of the host.
inline constexpr mamori::Duration kKernelClosesWithin = kDeviceAgeMax + kFrame + kFrame + 500_us;
/// The drives remove torque and close the brakes when no DriveFrame arrives for this time, and stay so until
/// power is cycled: two lost messages and a late one are tolerated, and it is not longer than the watchdog.
inline constexpr mamori::Duration kDriveSilenceMax = 5_ms;
static_assert(kDriveSilenceMax <= kWatchdogTimeout && kDriveSilenceMax > kDeviceAgeMax);

}  // namespace safe_arm

#endif  // EXAMPLES_SAFE_ARM_HIL_HIL_MESSAGES_HPP
