// SPDX-License-Identifier: Apache-2.0
// System modes: an operator starts the drive, and a monitor demands the safe mode.
#include <cstddef>
#include <cstdint>
#include <cstdio>

#include "mamori/kernel/parameter/parameter.hpp"
#include "mamori/kernel/run/executive.hpp"
#include "mamori/kernel/run/system_modes.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/ports/virtual_time/frame_runner.hpp"

using mamori::Status;
using namespace mamori::literals;  // NOLINT: units of the times below

/// Turns while it is active: by its parameter in each cycle.
class Drive final : public mamori::Component {
  public:
    constexpr Drive() noexcept : Component("drive") {}
    mamori::OutPort<double> angle{*this, "angle"};  // [rad]
    using Ports = mamori::Ports<&Drive::angle>;
    mamori::Parameter<double> step{*this, "step_rad", 0.1, mamori::between(0.0, 0.5)};
    using Parameters = mamori::Parameters<&Drive::step>;

    Status on_execute(mamori::ContextHandle) noexcept override {
        angle_rad_ += step.get();
        angle.write(angle_rad_);
        return Status::kOk;
    }

  private:
    double angle_rad_{0.0};
};

/// Detects an angle beyond its limit.
class Monitor final : public mamori::Component {
  public:
    constexpr Monitor() noexcept : Component("monitor") {}
    mamori::InPort<double, mamori::Need::kOptional> angle{*this, "angle"};
    using Ports = mamori::Ports<&Monitor::angle>;

    Status on_execute(mamori::ContextHandle) noexcept override {
        is_beyond_limit_ = angle.read() > 2.0;
        return Status::kOk;
    }
    bool is_beyond_limit() const noexcept { return is_beyond_limit_; }

  private:
    bool is_beyond_limit_{false};
};

enum class Command { kStart, kStop };
enum class Mode { kIdle, kWork, kHalt };

static Drive drive;
static Monitor monitor;
static constexpr auto kSystem = mamori::system(
    mamori::frame(10_ms), mamori::window("drive", 0_ms, 2_ms, mamori::budget(1_ms), mamori::run(drive)),
    mamori::window("watch", 2_ms, 2_ms, mamori::budget(1_ms), mamori::run(monitor)),
    mamori::connect(drive.angle, monitor.angle, mamori::fresh_within(10_ms)),
    mamori::configuration_set("fast", mamori::assign(drive.step, 0.5)),
    mamori::system_mode<Mode::kIdle>("idle", mamori::runs(monitor)),
    mamori::system_mode<Mode::kWork>("work", mamori::runs(drive, monitor), mamori::parameters("fast")),
    mamori::safe_mode<Mode::kHalt>("halt", mamori::runs(monitor)),
    mamori::mode_transition("idle", Command::kStart, "work"),
    mamori::mode_transition("work", Command::kStop, "idle"), mamori::modelled_time(drive, 100_us),
    mamori::modelled_time(monitor, 100_us));
MAMORI_CHECK(kSystem);
static mamori::SystemModes drive_modes{mamori::make_view(kSystem)};
static mamori::ExecutiveFor executive{kSystem, drive_modes};

/// Requests the mode switches, and prints the mode when it changes.
class Operator final : public mamori::ports::virtual_time::FrameDevices {
    void begin_frame(std::uint64_t frame, mamori::Instant) noexcept override {
        if (frame == 1U && drive_modes.request(Command::kStart) == Status::kOk) {
            std::printf("frame %2u: start requested\n", static_cast<unsigned>(frame));
        }
        if (monitor.is_beyond_limit() && drive_modes.get_failure().cause == mamori::ModeFailureCause::kNone) {
            static_cast<void>(drive_modes.request_safe_mode());
            std::printf("frame %2u: safe mode requested\n", static_cast<unsigned>(frame));
        }
    }
    void end_frame(std::uint64_t frame, mamori::Instant, mamori::Duration) noexcept override {
        const Mode mode = drive_modes.get_mode<Mode>();
        if (frame == 0U || mode != mode_) {
            mode_ = mode;
            std::printf("frame %2u: mode %s, angle %.1f rad\n", static_cast<unsigned>(frame),
                        executive.get_view().modes.modes[static_cast<std::size_t>(mode)].name,
                        drive.angle.get_published());
        }
    }

    Mode mode_{Mode::kIdle};
};

int main() {
    mamori::ports::virtual_time::VirtualHostFor host{kSystem};
    mamori::ports::virtual_time::SimulatedCore core{executive, host};
    Operator devices;
    mamori::ports::virtual_time::FrameRunner runner{{&core, 1U}, devices};
    const bool is_ok = executive.initialize() == Status::kOk && executive.start() == Status::kOk;
    for (int frame = 0; is_ok && frame < 30; ++frame) {
        runner.run_frame();
    }
    const bool is_refused = drive_modes.request(Command::kStart) == Status::kPreconditionNotMet;
    std::printf("start is %s until reset\n", is_refused ? "rejected" : "accepted");
    return is_ok && executive.stop() == Status::kOk && drive_modes.reset() == Status::kOk ? 0 : 1;
}
