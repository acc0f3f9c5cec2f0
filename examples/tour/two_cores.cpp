// SPDX-License-Identifier: Apache-2.0
// Two cores: a fast axis on core 0 and a slow planner on core 1, which exceeds its budget once.
#include <cstdint>
#include <cstdio>

#include "mamori/kernel/dataflow/connection.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/ports/virtual_time/machine.hpp"

using mamori::Status;
using namespace mamori::literals;  // NOLINT: units of the times below

/// Moves to the setpoint; stops while the setpoint is too old.
class Axis final : public mamori::Component {
  public:
    constexpr Axis() noexcept : Component("axis") {}
    mamori::InPort<double> setpoint{*this, "setpoint"};  // [rad]
    mamori::OutPort<double> angle{*this, "angle"};       // [rad]
    using Ports = mamori::Ports<&Axis::setpoint, &Axis::angle>;

    Status on_execute(mamori::ContextHandle context) noexcept override {
        is_moving_ = setpoint.calc_status(context.now) == mamori::PortStatus::kOk;
        angle_rad_ = is_moving_ ? setpoint.read() : angle_rad_;
        angle.write(angle_rad_);
        return Status::kOk;
    }
    bool is_moving() const noexcept { return is_moving_; }

  private:
    double angle_rad_{0.0};
    bool is_moving_{false};
};

/// Plans the next setpoint from the measured angle.
class Planner final : public mamori::Component {
  public:
    constexpr Planner() noexcept : Component("planner") {}
    mamori::InPort<double> angle{*this, "angle"};         // [rad]
    mamori::OutPort<double> setpoint{*this, "setpoint"};  // [rad]
    using Ports = mamori::Ports<&Planner::angle, &Planner::setpoint>;

    Status on_execute(mamori::ContextHandle) noexcept override {
        setpoint.write(angle.read() + 0.1);
        return Status::kOk;
    }
};

static Axis axis;
static Planner planner;
static mamori::Crossing<double> to_planner;
static mamori::Crossing<double> to_axis;
static constexpr auto kSystem = mamori::system(
    mamori::frame(10_ms), mamori::publication_margin(200_us),
    mamori::window("move", 0_ms, 1_ms, mamori::budget(500_us), mamori::run(axis)),
    mamori::window("plan", 1200_us, 8_ms, mamori::core(1U), mamori::budget(7_ms), mamori::run(planner)),
    mamori::connect(axis.angle, planner.angle, mamori::through(to_planner), mamori::fresh_within(5_ms)),
    mamori::connect(planner.setpoint, axis.setpoint, mamori::through(to_axis), mamori::fresh_within(5_ms)),
    mamori::modelled_time(axis, 100_us), mamori::modelled_time(planner, 5_ms));
static mamori::ports::virtual_time::Machine<kSystem> machine;

/// Makes the planner slow in the third major frame, and prints.
class Observer final : public mamori::Devices {
    void sample(std::uint64_t frame, mamori::Instant) noexcept override {
        static_cast<void>(machine.get_host_of<1U>().set_duration(planner, frame == 2U ? 8_ms : 5_ms));
    }
    void apply(std::uint64_t frame, mamori::Instant, mamori::Duration) noexcept override {
        std::printf("after %u ms: angle %.1f rad, %s\n", static_cast<unsigned>(frame + 1U) * 10U,
                    axis.angle.get_published(), axis.is_moving() ? "moves" : "waits for a fresh setpoint");
    }
};

int main() {
    Observer devices;
    return machine.run(5U, devices) == Status::kOk ? 0 : 1;
}
