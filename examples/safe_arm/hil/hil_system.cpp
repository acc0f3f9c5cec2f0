// SPDX-License-Identifier: Apache-2.0
#include "hil_system.hpp"

#include <array>

#include "arm_assumptions.hpp"
#include "arm_safety.hpp"
#include "arm_self_check.hpp"
#include "mamori/ports/posix_rt/machine.hpp"
#include "mamori/ports/virtual_time/machine.hpp"

namespace safe_arm::hil {

using mamori::safety::alive;
using mamori::safety::confirmed_by;
using mamori::safety::deadline;
using mamori::safety::protect;
using mamori::safety::raises;
using mamori::safety::StopConfirmation;
using mamori::safety::supervise;

mamori::safety::ArmInputs inputs;
mamori::safety::ArmOutputs outputs;
static std::array<mamori::Event, 256U> event_storage;
mamori::EventLog event_log{event_storage};
mamori::ports::virtual_time::VirtualWatchdog watchdog_mirror{kWatchdogTimeout};
static LinkWatchdog watchdog{watchdog_mirror};

static ArmChecks checks{watchdog_mirror};
extern ArmSelfCheck self_check;

DeviceQueue device_queue;
CommandQueue command_queue;
FaultySink drive_sink{Link::kDrive, kDriveE2e};
FaultySink state_sink{Link::kState, kStateE2e};

mamori::ports::lcm::LinkReceiver<DeviceMessage, DeviceQueue> device_receiver{
    "device_receiver", device_queue, {kHilMaxDelta}};
DeviceImage device_image{inputs};
ArmReader reader{inputs};
ReadingFilter filter;
HangPoint hang_point;
JointMonitor monitor;
SafetySupervisor supervisor{safety_state, event_log};
ControllerView view;
mamori::ports::lcm::LinkSender<StateMessage> state_sender{"state_sender", state_sink};
mamori::ports::lcm::LinkReceiver<CommandMessage, CommandQueue> command_receiver{
    "command_receiver", command_queue, {kHilMaxDelta}};
DriveGate gate{outputs};
DriveEncoder encoder{outputs, watchdog, supervisor, safety_state};
mamori::ports::lcm::LinkSender<DriveMessage> drive_sender{"drive_sender", drive_sink};

// In the file of its components: the compiler then compares their addresses under every sanitizer.
/// As with the arm in one process, the gate uses the command of its frame, which the monitor checks in the
/// next one. Controller and plant reply in the gaps before and after the window `act`; a later reply is used
/// in the next frame.
/// Budgets bound the times; here only silence counts, since a shared host can stretch a run.
static constexpr auto kHilSystem = mamori::safety::system(
    mamori::frame(kFrame), mamori::trace_hash(), make_arm_safety(hil::kLatenessMax),
    make_arm_assumptions(checks), make_arm_self_check(self_check),
    make_arm_modes(device_receiver, device_image, reader, filter, hang_point, monitor, supervisor, view,
                   state_sender, command_receiver, gate, encoder, drive_sender),
    supervise(reader, alive(), deadline(390_us)), supervise(filter, alive(), deadline(390_us)),
    supervise(monitor, alive(), deadline(390_us)), supervise(supervisor, alive(), deadline(390_us)),
    supervise(gate, alive(), deadline(390_us)), supervise(encoder, alive(), deadline(390_us)),
    supervise(command_receiver, alive(), deadline(390_us), raises(ArmFault::kControllerSilent)),
    protect(command_receiver, mamori::fresh_within(kCommandAgeMax), raises(ArmFault::kCommandStale)),
    confirmed_by(monitor.state, StopConfirmation::kStandstill),
    confirmed_by(filter.out, StopConfirmation::kClosedBrakes, StopConfirmation::kTorqueOff),
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
    mamori::connect(gate.drive, supervisor.drive, mamori::any_age()),
    mamori::connect(monitor.state, supervisor.arm_state, mamori::any_age()),
    mamori::connect(monitor.state, view.state, mamori::any_age()),
    mamori::connect(supervisor.stop, view.stop, mamori::any_age()),
    mamori::connect(view.out, state_sender.in, mamori::any_age()),
    mamori::connect(supervisor.stop, gate.stop, mamori::any_age()),
    mamori::connect(monitor.state, gate.arm_state, mamori::any_age()),
    mamori::connect(command_receiver.out, gate.command, mamori::any_age()),
    mamori::connect(supervisor.stop, encoder.stop, mamori::any_age()),
    mamori::connect(command_receiver.out, encoder.command, mamori::any_age()),
    mamori::connect(encoder.out, drive_sender.in, mamori::any_age()));
MAMORI_SAFETY_CHECK(kHilSystem);

ArmSelfCheck self_check{kHilSystem, inputs};
static mamori::safety::SafetyStorage<kHilSystem> safety_storage;
mamori::safety::SafetyState safety_state{safety_storage, watchdog};

using RealTimeMachine = mamori::ports::posix_rt::Machine<kHilSystem>;
using VirtualMachine = mamori::ports::virtual_time::Machine<kHilSystem>;

/// @param[in] options of the first call.
static RealTimeMachine& get_real_time_machine(const mamori::ports::posix_rt::MachineOptions& options) {
    static RealTimeMachine machine{options};
    return machine;
}
static VirtualMachine& get_virtual_machine() {
    static VirtualMachine machine;
    return machine;
}

/// Connects the executive of a machine with what observes it and follows its modes.
static void attach(mamori::Executive& executive, mamori::SystemModes& modes) noexcept {
    executive.set_observer(&safety_state.get_observer());
    reader.set_modes(modes);
}

const mamori::ports::posix_rt::FrameClock& make_real_time(
    const mamori::ports::posix_rt::MachineOptions& options) {
    RealTimeMachine& machine = get_real_time_machine(options);
    attach(machine.get_executives().get(0U), machine.get_executives().get_modes());
    return machine.get_clock();
}

mamori::Status run_in_real_time(std::uint64_t frames, mamori::Devices& devices) noexcept {
    return get_real_time_machine({}).run(frames, devices);
}

const mamori::ports::posix_rt::MachineReport& get_report() noexcept {
    return get_real_time_machine({}).get_report();
}

mamori::Status run_in_virtual_time(std::uint64_t frames, mamori::Devices& devices) noexcept {
    VirtualMachine& machine = get_virtual_machine();
    attach(machine.get_executives().get(0U), machine.get_executives().get_modes());
    return machine.run(frames, devices);
}

mamori::ports::virtual_time::VirtualHost& get_virtual_host() noexcept {
    return get_virtual_machine().get_host_of<0U>();
}

std::uint64_t get_virtual_trace_hash() noexcept {
    return get_virtual_machine().get_executives().get(0U).get_trace_hash();
}

}  // namespace safe_arm::hil
