// SPDX-License-Identifier: Apache-2.0
// A wheel, a component of RTMSafety that checks its speed, and the safety cycle that supervises the
// component.
#include <cstdio>

#include "mamori/kernel/c/rtmsafety_component.hpp"
#include "mamori/ports/virtual_time/machine.hpp"
#include "mamori/ports/virtual_time/virtual_watchdog.hpp"
#include "mamori/safety/cycle/safety_cycle.hpp"

extern "C" {
#include "SPEED.h"
}

using namespace mamori;          // NOLINT: the module is made of them
using namespace mamori::safety;  // NOLINT

enum class Fault { kSpeedCheckFailed, kInternal };
static StopOutputs outputs;  // to the drive
struct Drive {
    bool brakes_closed{}, has_torque{true};
};
MAMORI_FIELDS(Drive, brakes_closed, has_torque)

/// Turns faster in each cycle while it has torque, and stands soon without it.
class Wheel final : public Component {
  public:
    constexpr Wheel() noexcept : Component("wheel") {}
    OutPort<double> speed_rad_s{*this, "speed_rad_s"};
    OutPort<Drive> drive{*this, "drive"};
    using Ports = mamori::Ports<&Wheel::speed_rad_s, &Wheel::drive>;
    Status on_execute(ContextHandle) noexcept override {
        const double before = speed_rad_s.get_published();
        speed_rad_s.write(outputs.torque_enable ? before + 0.5 : before / 2.0);
        drive.write({!outputs.brake_release, outputs.torque_enable});
        return Status::kOk;
    }
};
class Speed final : public RtmSafetyComponent<&SPEED_create> {
  public:
    constexpr Speed() noexcept : RtmSafetyComponent("speed") {}
    InPort<double> speed_rad_s{*this, "speed_rad_s"};
    OutPort<bool> is_standing{*this, "is_standing"};
    using Ports = mamori::Ports<&Speed::speed_rad_s, &Speed::is_standing>;
};
class Supervisor final : public SafetyCycle {
  public:
    constexpr explicit Supervisor(SafetyState& own) noexcept : SafetyCycle("supervisor", own) {}
    InPort<bool> is_standing{*this, "is_standing"};
    InPort<Drive> drive{*this, "drive"};
    using Ports = mamori::Ports<&Supervisor::is_standing, &Supervisor::drive>;
    bool is_started{false};  ///< the start button

  private:
    CycleInputs read_inputs(Instant) noexcept override {
        const Drive& in = drive.read();
        return {is_standing.read(), in.brakes_closed, in.has_torque, is_started, false, true, outputs};
    }
    SelfTestStatus step_self_test(bool is_first, Instant) noexcept override {
        return !is_first && is_watchdog_serviced() ? SelfTestStatus::kPassed : SelfTestStatus::kRunning;
    }
    bool is_present(FaultIndex) noexcept override { return false; }
    void command(SafeState, const StopOutputs& wanted) noexcept override { outputs = wanted; }
};

extern SafetyState state;
static Wheel wheel;
static Speed speed;
static Supervisor supervisor{state};
extern "C" {
const SpeedPorts speed_ports{c_port(speed.speed_rad_s), c_port(speed.is_standing)};
}
static constexpr auto kModule = safety::system(
    frame(10_ms), window("protect", 0_ms, 3_ms, budget(2_ms), run(wheel, speed, supervisor)),
    connect(wheel.speed_rad_s, speed.speed_rad_s, any_age()),
    connect(wheel.drive, supervisor.drive, any_age()),
    connect(speed.is_standing, supervisor.is_standing, any_age()),
    faults<Fault::kSpeedCheckFailed, Fault::kInternal>(),
    react(Fault::kSpeedCheckFailed, Reaction::kSto, within(20_ms)),
    react(Fault::kInternal, Reaction::kSto, within(20_ms)), supervise(supervisor, alive(), deadline(1_ms)),
    supervise(wheel, alive(), deadline(1_ms), raises(Fault::kInternal)),
    supervise(speed, alive(), deadline(1_ms), raises(Fault::kSpeedCheckFailed)),
    confirmed_by(speed.is_standing, StopConfirmation::kStandstill),
    confirmed_by(wheel.drive, StopConfirmation::kClosedBrakes, StopConfirmation::kTorqueOff),
    cycle(StopBounds{2_s, 2_s}, BrakeLimits{50_ms, true}, WatchdogWindow{5_ms, 40_ms}, torque_feedback(50_ms),
          tolerated_lateness(1_ms), on_late_reaction(raises(Fault::kInternal)),
          on_failed_self_test(raises(Fault::kInternal)), on_unconfirmed_brakes(raises(Fault::kInternal))));
MAMORI_SAFETY_CHECK(kModule);
static ports::virtual_time::VirtualWatchdog relay{50_ms};
static SafetyStorage<kModule> module_memory;
SafetyState state{module_memory, relay};
static ports::virtual_time::Machine<kModule> machine;

class Robot final : public Devices {
    void sample(std::uint64_t frame, Instant) noexcept override { supervisor.is_started = frame == 10U; }
    void apply(std::uint64_t frame, Instant, Duration) noexcept override {
        if (supervisor.get_state() != shown_) {
            shown_ = supervisor.get_state();
            std::printf("%4u ms: %-18s wheel %.1f rad/s, speed check: %s\n",
                        static_cast<unsigned>(frame) * 10U, safety::get_name(shown_),
                        wheel.speed_rad_s.get_published(), mamori::get_name(speed.get_last_failure().status));
        }
    }
    SafeState shown_{SafeState::kLockedOut};
};
int main() {
    Robot robot;
    machine.get_executives().get(0U).set_observer(&state.get_observer());
    return machine.run(60U, robot) == Status::kOk ? 0 : 1;
}
