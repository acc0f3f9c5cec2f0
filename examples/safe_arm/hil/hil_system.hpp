// SPDX-License-Identifier: Apache-2.0
/// @file
/// The safety components of the arm in a table of their own: plant and controller are other processes, which
/// two pairs of link components connect. The components are those of the arm in one process.
///
/// @satisfies SWR-HIL-002      Design: docs/design/safe_arm.md#hardware-in-the-loop
#ifndef EXAMPLES_SAFE_ARM_HIL_HIL_SYSTEM_HPP
#define EXAMPLES_SAFE_ARM_HIL_HIL_SYSTEM_HPP

#include <array>

#include "arm_reader.hpp"
#include "drive_gate.hpp"
#include "hil_components.hpp"
#include "hil_messages.hpp"
#include "joint_monitor.hpp"
#include "link_errors.hpp"
#include "mamori/kernel/record/event_log.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/ports/lcm/link_components.hpp"
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
extern mamori::safety::ExecutionSupervisor supervision;

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

/// As with the arm in one process, the gate uses the command of its frame, which the monitor checks in the
/// next one. Controller and plant reply in the gaps before and after the window `act`; a later reply is used
/// in the next frame.
inline constexpr auto kHilSystem = mamori::system(
    mamori::frame(kFrame), mamori::trace_hash(),
    mamori::window(
        "protect", 0_us, 400_us, mamori::budget(390_us),
        mamori::run(device_receiver, device_image, reader, filter, hang_point, monitor, supervisor)),
    mamori::window("control", 400_us, 200_us, mamori::budget(190_us), mamori::run(view, state_sender)),
    mamori::window("act", 600_us, 390_us, mamori::budget(380_us),
                   mamori::run(command_receiver, gate, encoder, drive_sender)),
    mamori::connect(device_receiver.out, device_image.device, mamori::any_age()),
    mamori::connect(device_receiver.out, filter.device, mamori::any_age()),
    mamori::connect(reader.reading, filter.in, mamori::any_age()),
    mamori::connect(filter.out, monitor.reading, mamori::any_age()),
    mamori::connect(filter.out, supervisor.reading, mamori::any_age()),
    mamori::connect(command_receiver.out, monitor.command, mamori::any_age()),
    mamori::connect(gate.drive, monitor.drive, mamori::any_age()),
    mamori::connect(monitor.state, supervisor.arm_state, mamori::any_age()),
    mamori::connect(monitor.state, view.state, mamori::any_age()),
    mamori::connect(supervisor.stop, view.stop, mamori::any_age()),
    mamori::connect(view.out, state_sender.in, mamori::any_age()),
    mamori::connect(supervisor.stop, gate.stop, mamori::any_age()),
    mamori::connect(command_receiver.out, gate.command, mamori::any_age()),
    mamori::connect(supervisor.stop, encoder.stop, mamori::any_age()),
    mamori::connect(command_receiver.out, encoder.command, mamori::any_age()),
    mamori::connect(encoder.out, drive_sender.in, mamori::any_age()));

/// Puts the components under supervision, the controller's link in local scope. @return kOk;
/// kPreconditionNotMet (done before).
mamori::Status watch_components() noexcept;

}  // namespace safe_arm::hil

#endif  // EXAMPLES_SAFE_ARM_HIL_HIL_SYSTEM_HPP
