// SPDX-License-Identifier: Apache-2.0
#include "hil_system.hpp"

#include "arm_assumptions.hpp"
#include "mamori/safety/supervision/watch_check.hpp"

namespace safe_arm::hil {

mamori::safety::ArmInputs inputs;
mamori::safety::ArmOutputs outputs;
static std::array<mamori::Event, 256U> event_storage;
mamori::EventLog event_log{event_storage};
mamori::ports::virtual_time::VirtualWatchdog watchdog_mirror{kWatchdogTimeout};
static LinkWatchdog watchdog{watchdog_mirror};

static ArmChecks checks{watchdog_mirror};
static constexpr std::array kAssumptions = make_arm_assumptions(checks);
static_assert(mamori::safety::checks_all<kAssumptions, ArmAssumption::kCount>());
static mamori::safety::AssumptionMonitor assumptions{kAssumptions};
static DecisionFlow decision_flow;

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
SafetySupervisor supervisor{supervision, command_receiver, watchdog, event_log, assumptions, decision_flow};
ControllerView view;
mamori::ports::lcm::LinkSender<StateMessage> state_sender{"state_sender", state_sink};
mamori::ports::lcm::LinkReceiver<CommandMessage, CommandQueue> command_receiver{
    "command_receiver", command_queue, {kHilMaxDelta}};
DriveGate gate{outputs};
DriveEncoder encoder{outputs, watchdog, supervisor, supervision};
mamori::ports::lcm::LinkSender<DriveMessage> drive_sender{"drive_sender", drive_sink};

MAMORI_CHECK(kHilSystem);

static mamori::safety::ExecutionStorageFor<kHilSystem> supervision_storage;
mamori::safety::ExecutionSupervisor supervision{supervision_storage, kLatenessMax};

/// Budgets bound the times; here only silence counts, since a shared host can stretch a run.
static constexpr mamori::safety::ComponentLimits kSafetyLimits{
    kAliveLimits, {0_us, 390_us}, mamori::safety::SupervisionScope::kGlobal};
static constexpr std::array kLimits = {
    mamori::safety::watch(reader, kSafetyLimits),
    mamori::safety::watch(filter, kSafetyLimits),
    mamori::safety::watch(monitor, kSafetyLimits),
    mamori::safety::watch(supervisor, kSafetyLimits),
    mamori::safety::watch(gate, kSafetyLimits),
    mamori::safety::watch(encoder, kSafetyLimits),
    mamori::safety::watch(command_receiver,
                          {kAliveLimits, {0_us, 390_us}, mamori::safety::SupervisionScope::kLocal})};
static_assert(mamori::safety::is_watch_list_of<kHilSystem, kLimits>());

mamori::Status watch_components() noexcept {
    return supervision.watch(kLimits);
}

}  // namespace safe_arm::hil
