// SPDX-License-Identifier: Apache-2.0
/// @file
/// The safety components of the arm in a table of their own: plant and controller are other processes, which
/// two pairs of link components connect. The components are those of the arm in one process.
///
/// @satisfies SWR-HIL-002      Design: docs/design/safe_arm.md#hardware-in-the-loop
#ifndef EXAMPLES_SAFE_ARM_HIL_HIL_SYSTEM_HPP
#define EXAMPLES_SAFE_ARM_HIL_HIL_SYSTEM_HPP

#include <cstdint>

#include "arm_reader.hpp"
#include "drive_gate.hpp"
#include "hil_components.hpp"
#include "hil_messages.hpp"
#include "joint_monitor.hpp"
#include "link_errors.hpp"
#include "mamori/kernel/record/event_log.hpp"
#include "mamori/kernel/run/devices.hpp"
#include "mamori/ports/lcm/link_components.hpp"
#include "mamori/ports/posix_rt/frame_clock.hpp"
#include "mamori/ports/posix_rt/machine_options.hpp"
#include "mamori/ports/virtual_time/virtual_host.hpp"
#include "mamori/ports/virtual_time/virtual_watchdog.hpp"
#include "mamori/safety/supervision/execution_supervisor.hpp"
#include "safety_supervisor.hpp"

namespace safe_arm::hil {

using DeviceQueue = mamori::ports::lcm::MessageQueue<DeviceMessage, kHilQueueDepth>;
using CommandQueue = mamori::ports::lcm::MessageQueue<CommandMessage, kHilQueueDepth>;

/// Lateness of a window that is tolerated: a shared host wakes a thread later than a controller does.
inline constexpr mamori::Duration kLatenessMax = 300_us;

extern mamori::safety::ArmInputs inputs;
extern mamori::safety::ArmOutputs outputs;
extern mamori::EventLog event_log;
extern mamori::ports::virtual_time::VirtualWatchdog watchdog_mirror;
extern mamori::safety::SafetyState safety_state;

extern DeviceQueue device_queue;
extern CommandQueue command_queue;
extern FaultySink drive_sink;
extern FaultySink state_sink;

extern mamori::ports::lcm::LinkReceiver<DeviceMessage, DeviceQueue> device_receiver;
extern DeviceImage device_image;
extern ArmReader reader;
extern ReadingFilter filter;
extern HangPoint hang_point;
extern JointMonitor monitor;
extern SafetySupervisor supervisor;
extern ControllerView view;
extern mamori::ports::lcm::LinkSender<StateMessage> state_sender;
extern mamori::ports::lcm::LinkReceiver<CommandMessage, CommandQueue> command_receiver;
extern DriveGate gate;
extern DriveEncoder encoder;
extern mamori::ports::lcm::LinkSender<DriveMessage> drive_sender;

/// Makes the system in real time, under supervision. One per process. @return its time line.
const mamori::ports::posix_rt::FrameClock& make_real_time(
    const mamori::ports::posix_rt::MachineOptions& options);
/// After make_real_time(). @return that of posix_rt::Machine::run().
mamori::Status run_in_real_time(std::uint64_t frames, mamori::Devices& devices) noexcept;
const mamori::ports::posix_rt::MachineReport& get_report() noexcept;

/// The system in virtual time, under supervision. @return that of virtual_time::Machine::run().
mamori::Status run_in_virtual_time(std::uint64_t frames, mamori::Devices& devices) noexcept;
mamori::ports::virtual_time::VirtualHost& get_virtual_host() noexcept;
std::uint64_t get_virtual_trace_hash() noexcept;

}  // namespace safe_arm::hil

#endif  // EXAMPLES_SAFE_ARM_HIL_HIL_SYSTEM_HPP
