// SPDX-License-Identifier: Apache-2.0
// Safety module of a mobile robot with two wheels: emergency stop, light curtain with muting, speed monitor.
#include <array>
#include <cstdio>

#include "mamori/ports/virtual_time/machine.hpp"
#include "mamori/ports/virtual_time/virtual_watchdog.hpp"
#include "mamori/safety/arm/guards.hpp"
#include "mamori/safety/cycle/safety_cycle.hpp"

using namespace mamori;          // NOLINT: the module is made of them
using namespace mamori::safety;  // NOLINT
// Process image of the robot. Contacts are closed while all is well.
static struct {
    bool stop_a{true}, stop_b{true}, curtain{true}, muting_a{}, muting_b{}, start{}, reset{};
    std::array<double, 2U> wheel_rad_s{};
} inputs;
static StopOutputs outputs;
struct Seen {
    std::uint32_t faults{};  ///< bit n for fault n
    bool is_standing{}, brakes_closed{}, has_torque{true};
};
MAMORI_FIELDS(Seen, faults, is_standing, brakes_closed, has_torque)
enum class Fault { kStopPressed, kContactsDiffer, kPersonInField, kOverspeed, kInternal };
static constexpr std::array<const char*, 5U> kNames{"stop pressed", "contacts differ", "person in field",
                                                    "overspeed", "internal"};
static constexpr std::array<double, 2U> kSpeedMax{6.0, 6.0}, kStandstill{0.1, 0.1};  // [rad/s]
static std::uint32_t flag(Fault fault, bool is_present) noexcept {
    return is_present ? std::uint32_t{1U} << static_cast<unsigned>(fault) : 0U;
}

/// Finds what is wrong in this cycle, and what confirms a stop.
class Monitor final : public Component {
  public:
    constexpr Monitor() noexcept : Component("monitor") {}
    OutPort<Seen> seen{*this, "seen"};
    using Ports = mamori::Ports<&Monitor::seen>;
    Status on_execute(ContextHandle) noexcept override {
        const bool is_muted = inputs.muting_a && inputs.muting_b;
        const bool is_standing = calc_speed_violations(inputs.wheel_rad_s, kStandstill).is_empty();
        const bool is_fast = !calc_speed_violations(inputs.wheel_rad_s, kSpeedMax).is_empty();
        seen.write({flag(Fault::kStopPressed, !inputs.stop_a || !inputs.stop_b) |
                        flag(Fault::kContactsDiffer, inputs.stop_a != inputs.stop_b) |
                        flag(Fault::kPersonInField, !inputs.curtain && !is_muted) |
                        flag(Fault::kOverspeed, is_fast),
                    is_standing, !outputs.brake_release, outputs.torque_enable});
        return Status::kOk;
    }
};
/// The inputs and outputs of this machine; SafetyCycle does the rest.
class Supervisor final : public SafetyCycle {
  public:
    constexpr explicit Supervisor(SafetyState& own) noexcept : SafetyCycle("supervisor", own) {}
    InPort<Seen> seen{*this, "seen"};
    using Ports = mamori::Ports<&Supervisor::seen>;

  private:
    CycleInputs read_inputs(Instant) noexcept override {
        const Seen& in = seen.read();
        return {in.is_standing, in.brakes_closed, in.has_torque, inputs.start, inputs.reset, true, outputs};
    }
    SelfTestStatus step_self_test(bool is_first, Instant) noexcept override {
        return !is_first && is_watchdog_serviced() ? SelfTestStatus::kPassed : SelfTestStatus::kRunning;
    }
    bool is_present(FaultIndex fault) noexcept override {
        return (seen.read().faults & flag(static_cast<Fault>(fault), true)) != 0U;
    }
    void command(SafeState, const StopOutputs& wanted) noexcept override { outputs = wanted; }
};

extern SafetyState state;
static Monitor monitor;
static Supervisor supervisor{state};
static constexpr auto kModule = safety::system(
    frame(10_ms), window("protect", 0_ms, 2_ms, budget(1_ms), run(monitor, supervisor)),
    connect(monitor.seen, supervisor.seen, any_age()),
    faults<Fault::kStopPressed, Fault::kContactsDiffer, Fault::kPersonInField, Fault::kOverspeed,
           Fault::kInternal>(),
    react(Fault::kStopPressed, Reaction::kSs1, within(20_ms)),
    react(Fault::kContactsDiffer, Reaction::kSto, within(20_ms)), confirm(Fault::kContactsDiffer, {5U}),
    react(Fault::kPersonInField, Reaction::kSs1, within(20_ms)),
    react(Fault::kOverspeed, Reaction::kSto, within(20_ms)), confirm(Fault::kOverspeed, {2U}),
    react(Fault::kInternal, Reaction::kSto, within(20_ms)), supervise(supervisor, alive(), deadline(1_ms)),
    supervise(monitor, alive(), deadline(1_ms), raises(Fault::kInternal)),
    confirmed_by(monitor.seen, StopConfirmation::kStandstill, StopConfirmation::kClosedBrakes,
                 StopConfirmation::kTorqueOff),
    cycle(StopBounds{2_s, 2_s}, BrakeLimits{50_ms, true}, WatchdogWindow{5_ms, 40_ms}, torque_feedback(50_ms),
          tolerated_lateness(1_ms), on_late_reaction(raises(Fault::kInternal)),
          on_failed_self_test(raises(Fault::kInternal)), on_unconfirmed_brakes(raises(Fault::kInternal))));
MAMORI_SAFETY_CHECK(kModule);
static ports::virtual_time::VirtualWatchdog relay{50_ms};
static SafetyStorage<kModule> module_memory;
SafetyState state{module_memory, relay};
static ports::virtual_time::Machine<kModule> machine;
/// A robot that drives at 5 rad/s, and what happens to it.
class Robot final : public Devices {
    void sample(std::uint64_t frame, Instant) noexcept override {
        inputs.start = frame == 10U || frame == 170U;
        inputs.curtain = !(frame >= 60U && frame < 70U) && !(frame >= 200U && frame < 210U);
        inputs.muting_a = inputs.muting_b = frame >= 58U && frame < 72U;
        inputs.stop_a = inputs.stop_b = !(frame >= 100U && frame < 150U);
        inputs.reset = frame == 160U;
        const double wanted = outputs.torque_enable && !outputs.stop_requested ? 5.0 : 0.0;
        inputs.wheel_rad_s.fill(inputs.wheel_rad_s[0] + (wanted - inputs.wheel_rad_s[0]) / 4.0);
    }
    void apply(std::uint64_t frame, Instant, Duration) noexcept override {
        if (supervisor.get_state() != shown_) {
            shown_ = supervisor.get_state();
            const FaultIndex first = state.get_faults().get_first();
            std::printf("%4u ms: %-18s latched: %s\n", static_cast<unsigned>(frame) * 10U,
                        safety::get_name(shown_), first == kNoFault ? "none" : kNames[first]);
        }
    }
    SafeState shown_{SafeState::kLockedOut};
};
int main() {
    Robot robot;
    machine.get_executives().get(0U).set_observer(&state.get_observer());
    return machine.run(260U, robot) == Status::kOk ? 0 : 1;
}
