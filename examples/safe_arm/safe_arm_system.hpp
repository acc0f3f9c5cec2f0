// SPDX-License-Identifier: Apache-2.0
/// @file
/// The system of the example: its components and the static table that wires them. Read it as a drawing.
///
/// @satisfies SWR-SAF-017      Design: docs/design/safe_arm.md#components
#ifndef EXAMPLES_SAFE_ARM_SAFE_ARM_SYSTEM_HPP
#define EXAMPLES_SAFE_ARM_SAFE_ARM_SYSTEM_HPP

#include "arm_limits.hpp"
#include "arm_reader.hpp"
#include "drive_gate.hpp"
#include "joint_monitor.hpp"
#include "mamori/kernel/event_log.hpp"
#include "mamori/kernel/executive.hpp"
#include "mamori/kernel/system.hpp"
#include "mamori/ports/virtual_time/simulated_channel.hpp"
#include "mamori/ports/virtual_time/virtual_watchdog.hpp"
#include "motion_controller.hpp"
#include "safety_supervisor.hpp"

namespace safe_arm {

/// Places of the components in the table below.
inline constexpr std::size_t kReaderIndex = 0U;
inline constexpr std::size_t kMonitorIndex = 1U;
inline constexpr std::size_t kSupervisorIndex = 2U;
inline constexpr std::size_t kControllerIndex = 3U;
inline constexpr std::size_t kChannelIndex = 4U;
inline constexpr std::size_t kGateIndex = 5U;
inline constexpr std::size_t kComponentCount = 6U;

/// Messages that the channel can hold back: a delay of 63 ms at one message per frame.
inline constexpr std::size_t kChannelCapacity = 64U;

inline mamori::safety::ArmInputs inputs;
inline mamori::safety::ArmOutputs outputs;
inline std::array<mamori::Event, 256U> event_storage;
inline mamori::EventLog event_log{event_storage};
inline mamori::ports::virtual_time::VirtualWatchdog watchdog{kWatchdogTimeout};
inline mamori::safety::ExecutionStorage<kComponentCount> supervision_storage;
inline mamori::safety::ExecutionSupervisor supervision{supervision_storage, kLatenessMax};

inline ArmReader reader{inputs};
inline JointMonitor monitor;
inline SafetySupervisor supervisor{supervision, kControllerIndex, watchdog, event_log};
inline MotionController controller;
inline mamori::ports::virtual_time::SimulatedChannel<TorqueCommand, kChannelCapacity> channel{"channel"};
inline DriveGate gate{outputs};

inline constexpr auto kSafeArm = mamori::system(
    mamori::frame(kFrame),
    mamori::window("protect", 0_us, 300_us, mamori::budget(250_us), mamori::run(reader, monitor, supervisor)),
    mamori::window("control", 300_us, 400_us, mamori::budget(350_us), mamori::run(controller)),
    mamori::window("transport", 700_us, 100_us, mamori::budget(80_us), mamori::run(channel)),
    mamori::window("act", 800_us, 100_us, mamori::budget(80_us), mamori::run(gate)),
    mamori::connect(reader.reading, monitor.reading), mamori::connect(channel.out, monitor.command),
    mamori::connect(gate.drive, monitor.drive), mamori::connect(reader.reading, supervisor.reading),
    mamori::connect(monitor.state, supervisor.arm_state), mamori::connect(monitor.state, controller.state),
    mamori::connect(supervisor.stop, controller.stop), mamori::connect(controller.command, channel.in),
    mamori::connect(supervisor.stop, gate.stop), mamori::connect(channel.out, gate.command));
MAMORI_CHECK(kSafeArm);

static_assert(kSafeArm.components.size() == kComponentCount && kSafeArm.components[kReaderIndex] == &reader &&
              kSafeArm.components[kChannelIndex] == &channel &&
              kSafeArm.components[kSupervisorIndex] == &supervisor &&
              kSafeArm.components[kControllerIndex] == &controller &&
              kSafeArm.components[kGateIndex] == &gate && kSafeArm.components[kMonitorIndex] == &monitor);

/// Modelled execution times.
inline constexpr mamori::Duration kSafetyComponentTime = 30_us;
inline constexpr mamori::Duration kControllerTime = 120_us;

inline mamori::ExecutiveFor executive{kSafeArm};

/// Puts the components under supervision. The channel carries and does not decide; what it does wrong shows
/// in its messages. The controller is not safety-related: its failure is a fault with a reaction and leaves
/// the watchdog alone.
/// @return kOk; kPreconditionNotMet (done before).
mamori::Status watch_components() noexcept;

}  // namespace safe_arm

#endif  // EXAMPLES_SAFE_ARM_SAFE_ARM_SYSTEM_HPP
