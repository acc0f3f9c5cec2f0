// SPDX-License-Identifier: Apache-2.0
/// @file
/// The components of the example and the machine of the static table that wires them.
///
/// @satisfies SWR-SAF-017      Design: docs/design/safe_arm.md#components
#ifndef EXAMPLES_SAFE_ARM_SAFE_ARM_SYSTEM_HPP
#define EXAMPLES_SAFE_ARM_SAFE_ARM_SYSTEM_HPP

#include <array>
#include <cstdint>

#include "arm_limits.hpp"
#include "arm_reader.hpp"
#include "command_link.hpp"
#include "drive_gate.hpp"
#include "joint_monitor.hpp"
#include "mamori/kernel/record/event_log.hpp"
#include "mamori/kernel/run/executive.hpp"
#include "mamori/kernel/run/introspection.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/ports/virtual_time/machine.hpp"
#include "mamori/ports/virtual_time/simulated_channel.hpp"
#include "mamori/ports/virtual_time/virtual_host.hpp"
#include "mamori/ports/virtual_time/virtual_watchdog.hpp"
#include "motion_controller.hpp"
#include "safety_supervisor.hpp"

namespace safe_arm {

/// Windows that start first and last in a major frame.
extern const std::size_t kFirstWindow;
extern const std::size_t kLastWindow;

/// Messages that the channel can hold back: a delay of 63 ms at one message per frame.
inline constexpr std::size_t kChannelCapacity = 64U;

extern mamori::safety::ArmInputs inputs;
extern mamori::safety::ArmOutputs outputs;
extern mamori::EventLog event_log;
extern mamori::ports::virtual_time::VirtualWatchdog watchdog;
/// The channel carries and is not supervised; what it does wrong shows in its messages. The controller is not
/// safety-related: its failure is a fault with a reaction and leaves the watchdog alone.
extern mamori::safety::SafetyState safety_state;

extern ArmReader reader;
extern JointMonitor monitor;
extern SafetySupervisor supervisor;
extern MotionController controller;
extern CommandSender command_sender;
extern mamori::ports::virtual_time::SimulatedChannel<CommandFrame, kChannelCapacity> channel;
extern CommandReceiver command_receiver;
extern DriveGate gate;

/// Runs the static table, which is in safe_arm_system.cpp.
extern mamori::Executive& executive;
/// Operating modes of the same table.
extern mamori::SystemModes& modes;
/// Of the same table; shows nothing until it is attached to the executive.
extern mamori::Introspection& introspection;
/// Simulates it in virtual time.
extern mamori::ports::virtual_time::VirtualHost& virtual_host;
/// Number of simulated major frames; ends simulate() early by request_stop().
extern mamori::ports::virtual_time::MachineBase& simulation;

/// Modelled execution times.
inline constexpr mamori::Duration kSafetyComponentTime = 30_us;
inline constexpr mamori::Duration kControllerTime = 120_us;
inline constexpr mamori::Duration kLinkTime = 10_us;

/// Starts the system, runs `frames` major frames in virtual time and stops the system.
/// @return as mamori::ports::virtual_time::Machine::run().
mamori::Status simulate(std::uint64_t frames, mamori::Devices& devices) noexcept;

}  // namespace safe_arm

#endif  // EXAMPLES_SAFE_ARM_SAFE_ARM_SYSTEM_HPP
