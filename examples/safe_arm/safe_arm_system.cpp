// SPDX-License-Identifier: Apache-2.0
// The static table of the example: read it as a drawing.
#include "safe_arm_system.hpp"

#include "arm_assumptions.hpp"
#include "arm_safety.hpp"
#include "arm_self_check.hpp"

namespace safe_arm {

using mamori::safety::alive;
using mamori::safety::confirmed_by;
using mamori::safety::deadline;
using mamori::safety::protect;
using mamori::safety::raises;
using mamori::safety::StopConfirmation;
using mamori::safety::supervise;

// Components are defined beside their table: the compiler then compares their addresses under every
// sanitizer.
mamori::safety::ArmInputs inputs;
mamori::safety::ArmOutputs outputs;
static std::array<mamori::Event, 256U> event_storage;
mamori::EventLog event_log{event_storage};
mamori::ports::virtual_time::VirtualWatchdog watchdog{kWatchdogTimeout};

static ArmChecks checks{watchdog};
extern ArmSelfCheck self_check;

ArmReader reader{inputs};
JointMonitor monitor;
SafetySupervisor supervisor{safety_state, event_log};
MotionController controller;
CommandSender command_sender{"command_sender"};
mamori::ports::virtual_time::SimulatedChannel<CommandFrame, kChannelCapacity> channel{"channel"};
CommandReceiver command_receiver{"command_receiver"};
DriveGate gate{outputs};

static constexpr auto kSafeArm = mamori::safety::system(
    mamori::frame(kFrame), mamori::trace_hash(), make_arm_safety(kLatenessMax), make_arm_assumptions(checks),
    make_arm_self_check(self_check),
    make_arm_modes(reader, monitor, supervisor, controller, command_sender, channel, command_receiver, gate),
    supervise(reader, alive(), deadline(kSafetyComponentMax)),
    supervise(monitor, alive(), deadline(kSafetyComponentMax)),
    supervise(supervisor, alive(), deadline(kSafetyComponentMax)),
    supervise(command_receiver, alive(), deadline(kSafetyComponentMax)),
    supervise(gate, alive(), deadline(kSafetyComponentMax)),
    supervise(controller, alive(), deadline(kControllerMax), raises(ArmFault::kControllerSilent)),
    protect(command_receiver, mamori::fresh_within(kCommandAgeMax), raises(ArmFault::kCommandStale)),
    confirmed_by(monitor.state, StopConfirmation::kStandstill),
    confirmed_by(reader.reading, StopConfirmation::kClosedBrakes, StopConfirmation::kTorqueOff),
    mamori::window("protect", 0_us, 300_us, mamori::budget(250_us), mamori::run(reader, monitor, supervisor)),
    mamori::window("control", 300_us, 400_us, mamori::budget(350_us),
                   mamori::run(controller, command_sender)),
    mamori::window("transport", 700_us, 100_us, mamori::budget(80_us), mamori::run(channel)),
    mamori::window("act", 800_us, 100_us, mamori::budget(80_us), mamori::run(command_receiver, gate)),
    mamori::connect(reader.reading, monitor.reading, mamori::any_age()),
    mamori::connect(command_receiver.out, monitor.command, mamori::any_age()),
    mamori::connect(gate.drive, monitor.drive, mamori::any_age()),
    mamori::connect(reader.reading, supervisor.reading, mamori::any_age()),
    mamori::connect(monitor.state, supervisor.arm_state, mamori::any_age()),
    mamori::connect(gate.drive, supervisor.drive, mamori::any_age()),
    mamori::connect(monitor.state, controller.state, mamori::any_age()),
    mamori::connect(supervisor.stop, controller.stop, mamori::any_age()),
    mamori::connect(controller.command, command_sender.in, mamori::any_age()),
    mamori::connect(command_sender.out, channel.in, mamori::any_age()),
    mamori::connect(channel.out, command_receiver.in, mamori::any_age()),
    mamori::connect(supervisor.stop, gate.stop, mamori::any_age()),
    mamori::connect(monitor.state, gate.arm_state, mamori::any_age()),
    mamori::connect(command_receiver.out, gate.command, mamori::any_age()),
    mamori::modelled_time(reader, kSafetyComponentTime), mamori::modelled_time(monitor, kSafetyComponentTime),
    mamori::modelled_time(supervisor, kSafetyComponentTime),
    mamori::modelled_time(controller, kControllerTime), mamori::modelled_time(command_sender, kLinkTime),
    mamori::modelled_time(command_receiver, kLinkTime), mamori::modelled_time(channel, kSafetyComponentTime),
    mamori::modelled_time(gate, kSafetyComponentTime));
MAMORI_SAFETY_CHECK(kSafeArm);

ArmSelfCheck self_check{kSafeArm, inputs};
static mamori::safety::SafetyStorage<kSafeArm> safety_storage;
mamori::safety::SafetyState safety_state{safety_storage, watchdog};
constexpr std::size_t kFirstWindow = mamori::index_of(kSafeArm, "protect");
constexpr std::size_t kLastWindow = mamori::index_of(kSafeArm, "act");

static mamori::ports::virtual_time::Machine<kSafeArm> machine_of_table;
mamori::Executive& executive = machine_of_table.get_executives().get(0U);
mamori::SystemModes& modes = machine_of_table.get_executives().get_modes();
mamori::ports::virtual_time::VirtualHost& virtual_host = machine_of_table.get_host_of<0U>();
mamori::ports::virtual_time::MachineBase& simulation = machine_of_table;
static mamori::IntrospectionFor introspection_of_table{kSafeArm};
mamori::Introspection& introspection = introspection_of_table;

mamori::Status simulate(std::uint64_t frames, mamori::Devices& devices) noexcept {
    return machine_of_table.run(frames, devices);
}

}  // namespace safe_arm
