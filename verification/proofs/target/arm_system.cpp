// SPDX-License-Identifier: Apache-2.0
// The static table of the target image, in the layout of a drawing.
#include "arm_system.hpp"

#include "arm_assumptions.hpp"
#include "arm_reader.hpp"
#include "arm_safety.hpp"
#include "drive_gate.hpp"
#include "hold_controller.hpp"
#include "joint_monitor.hpp"
#include "mamori/kernel/record/event_log.hpp"
#include "mamori/kernel/run/introspection.hpp"
#include "mamori/ports/virtual_time/simulated_channel.hpp"
#include "mamori/ports/virtual_time/virtual_watchdog.hpp"
#include "safety_supervisor.hpp"

namespace proof {
namespace {

using namespace mamori::literals;  // NOLINT: units of the table
using mamori::Duration;
using mamori::Instant;
using mamori::Status;
using mamori::safety::alive;
using mamori::safety::confirmed_by;
using mamori::safety::deadline;
using mamori::safety::raises;
using mamori::safety::StopConfirmation;
using mamori::safety::supervise;
namespace virtual_time = mamori::ports::virtual_time;

constexpr double kCountsPerRad = 100000.0;

// The sequence of the run: start, encoder jump, reset and start, hang of the controller.
constexpr Instant kFirstStart{250000000};
constexpr Instant kEncoderJumps{400000000};
constexpr Instant kReset{900000000};
constexpr Instant kSecondStart{1150000000};
constexpr Instant kControllerHangs{1400000000};
constexpr Duration kPush = 50_ms;
constexpr Duration kControllerTime = 120_us;

mamori::safety::ArmInputs inputs;
mamori::safety::ArmOutputs outputs;
std::array<mamori::Event, 256U> event_storage;
mamori::EventLog event_log{event_storage};
virtual_time::VirtualWatchdog watchdog{safe_arm::kWatchdogTimeout};
extern mamori::safety::SafetyState safety_state;
Facts facts;

safe_arm::ArmChecks checks{watchdog};

safe_arm::ArmReader reader{inputs};
safe_arm::JointMonitor monitor;
HoldController controller;
safe_arm::SafetySupervisor supervisor{safety_state, event_log};
virtual_time::SimulatedChannel<safe_arm::TorqueCommand, 4U> channel{"channel"};
safe_arm::DriveGate gate{outputs};

// The controller is not part of the safety software: it has its own partition, reached through buffers.
mamori::Crossing<safe_arm::JointState> state_crossing;
mamori::Crossing<safe_arm::StopCommand> stop_crossing;
mamori::Crossing<safe_arm::TorqueCommand> command_crossing;

constexpr auto kSystem = mamori::safety::system(
    mamori::frame(safe_arm::kFrame), mamori::trace_hash(), safe_arm::make_arm_safety(safe_arm::kLatenessMax),
    safe_arm::make_arm_assumptions(checks),
    safe_arm::make_arm_modes(reader, monitor, supervisor, controller, channel, gate),
    supervise(reader, alive(), deadline(safe_arm::kControllerMax)),
    supervise(monitor, alive(), deadline(safe_arm::kControllerMax)),
    supervise(supervisor, alive(), deadline(safe_arm::kControllerMax)),
    supervise(controller, alive(), deadline(safe_arm::kControllerMax),
              raises(safe_arm::ArmFault::kControllerSilent)),
    supervise(channel, alive(), deadline(safe_arm::kControllerMax)),
    supervise(gate, alive(), deadline(safe_arm::kControllerMax)),
    confirmed_by(monitor.state, StopConfirmation::kStandstill),
    confirmed_by(reader.reading, StopConfirmation::kClosedBrakes, StopConfirmation::kTorqueOff),
    mamori::window("protect", 0_us, 300_us, mamori::budget(250_us), mamori::run(reader, monitor, supervisor)),
    mamori::window("control", 300_us, 400_us, mamori::partition("control"), mamori::budget(350_us),
                   mamori::run(controller)),
    mamori::window("transport", 700_us, 100_us, mamori::budget(80_us), mamori::run(channel)),
    mamori::window("act", 800_us, 100_us, mamori::budget(80_us), mamori::run(gate)),
    mamori::connect(reader.reading, monitor.reading, mamori::any_age()),
    mamori::connect(channel.out, monitor.command, mamori::any_age()),
    mamori::connect(gate.drive, monitor.drive, mamori::any_age()),
    mamori::connect(reader.reading, supervisor.reading, mamori::any_age()),
    mamori::connect(monitor.state, supervisor.arm_state, mamori::any_age()),
    mamori::connect(gate.drive, supervisor.drive, mamori::any_age()),
    mamori::connect(monitor.state, controller.state, mamori::through(state_crossing), mamori::any_age()),
    mamori::connect(supervisor.stop, controller.stop, mamori::through(stop_crossing), mamori::any_age()),
    mamori::connect(controller.command, channel.in, mamori::through(command_crossing), mamori::any_age()),
    mamori::connect(supervisor.stop, gate.stop, mamori::any_age()),
    mamori::connect(monitor.state, gate.arm_state, mamori::any_age()),
    mamori::connect(channel.out, gate.command, mamori::any_age()));
MAMORI_SAFETY_CHECK(kSystem);

mamori::safety::SafetyStorage<kSystem> safety_storage;
mamori::safety::SafetyState safety_state{safety_storage, watchdog};

mamori::SystemModes modes{mamori::make_view(kSystem)};
mamori::ExecutiveFor executive_of_table{kSystem, modes};
virtual_time::VirtualHostFor host_of_table{kSystem};
mamori::IntrospectionFor introspection{kSystem};

bool is_pushed(Instant since, Instant now) noexcept {
    return now >= since && now < since + kPush;
}

}  // namespace

mamori::Executive& executive = executive_of_table;
virtual_time::VirtualHost& virtual_host = host_of_table;

Status prepare() noexcept {
    executive.set_observer(&safety_state.get_observer());
    reader.set_modes(modes);
    executive.set_introspection(&introspection);
    return reader.configure({safe_arm::make_uniform(kCountsPerRad), safe_arm::make_uniform(kCountsPerRad)});
}

void ObedientDevices::sample(std::uint64_t, Instant now) noexcept {
    inputs.encoder_a_counts[2] = now >= kEncoderJumps && now < kReset ? 5000 : 0;
    inputs.measured_torque_nm = outputs.torque_nm;
    inputs.brake_closed.fill(!outputs.brake_release);
    inputs.torque_enabled = outputs.torque_enable && outputs.relay_close;
    inputs.relay_closed = outputs.relay_close;
    inputs.power_good = true;
    inputs.emergency_stop_closed.fill(true);
    inputs.protective_stop_closed.fill(true);
    inputs.mode_selected[0] = true;
    inputs.drive_clock_ns = now.ns + 1;  // a clock that has begun before the program
    inputs.start_button = is_pushed(kFirstStart, now) || is_pushed(kSecondStart, now);
    inputs.reset_button = is_pushed(kReset, now);
    const Duration controller_time = now < kControllerHangs ? kControllerTime : virtual_time::kNever;
    // The table contains the controller, so this call always succeeds.
    static_cast<void>(host_.set_duration(controller, controller_time));
}

void ObedientDevices::apply(std::uint64_t, Instant now, Duration length) noexcept {
    watchdog.check(now + length);
    facts.operational_frames += outputs.torque_enable ? 1U : 0U;
}

Facts get_facts() noexcept {
    facts.latched_count = 0U;
    for (std::size_t i = 0U; i < event_log.size(); ++i) {
        const mamori::Event& event = event_log.get(i);
        facts.latched_count +=
            event.code == static_cast<std::uint16_t>(mamori::safety::CycleEvent::kFaultLatched) ? 1U : 0U;
    }
    return facts;
}

}  // namespace proof
