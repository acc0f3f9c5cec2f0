// SPDX-License-Identifier: Apache-2.0
// Two cores: a fast axis on core 0 and a slow planner on core 1, which exceeds its budget once.
#include <array>
#include <cstdint>
#include <cstdio>

#include "mamori/kernel/dataflow/connection.hpp"
#include "mamori/kernel/run/executive.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/ports/virtual_time/frame_runner.hpp"

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
MAMORI_CHECK(kSystem);
static mamori::ExecutiveFor executive_0{kSystem, 0U};
static mamori::ExecutiveFor executive_1{kSystem, 1U};

/// Makes the planner slow in the third major frame, and prints.
class Devices final : public mamori::ports::virtual_time::FrameDevices {
  public:
    explicit Devices(mamori::ports::virtual_time::VirtualHost& planner_host) noexcept : host_(planner_host) {}

    void begin_frame(std::uint64_t frame, mamori::Instant) noexcept override {
        static_cast<void>(host_.set_duration(planner, frame == 2U ? 8_ms : 5_ms));
    }
    void end_frame(std::uint64_t frame, mamori::Instant, mamori::Duration) noexcept override {
        std::printf("after %u ms: angle %.1f rad, %s\n", static_cast<unsigned>(frame + 1U) * 10U,
                    axis.angle.get_published(), axis.is_moving() ? "moves" : "waits for a fresh setpoint");
    }

  private:
    mamori::ports::virtual_time::VirtualHost& host_;
};

int main() {
    namespace virtual_time = mamori::ports::virtual_time;
    virtual_time::VirtualHostFor host_0{kSystem};
    virtual_time::VirtualHostFor host_1{kSystem};
    std::array<virtual_time::SimulatedCore, 2U> cores{virtual_time::SimulatedCore{executive_0, host_0},
                                                      virtual_time::SimulatedCore{executive_1, host_1}};
    Devices devices{host_1};
    virtual_time::FrameRunner runner{cores, devices};
    bool is_ok = executive_0.initialize() == Status::kOk && executive_1.initialize() == Status::kOk;
    is_ok = is_ok && executive_0.start() == Status::kOk && executive_1.start() == Status::kOk;
    for (int frame = 0; is_ok && frame < 5; ++frame) {
        runner.run_frame();
    }
    is_ok = is_ok && executive_0.stop() == Status::kOk && executive_1.stop() == Status::kOk;
    return is_ok ? 0 : 1;
}
