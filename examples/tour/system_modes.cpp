// SPDX-License-Identifier: Apache-2.0
// System modes: an operator starts the drive, and a monitor demands the safe mode.
#include <cstddef>
#include <cstdint>
#include <cstdio>

#include "mamori/kernel/parameter/parameter.hpp"
#include "mamori/kernel/run/system_modes.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/ports/virtual_time/machine.hpp"

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
static mamori::ports::virtual_time::Machine<kSystem> machine;
static mamori::SystemModes& drive_modes = machine.get_executives().get_modes();

/// Requests the mode switches, and prints the mode when it changes.
class Operator final : public mamori::Devices {
    void sample(std::uint64_t frame, mamori::Instant) noexcept override {
        if (frame == 1U && drive_modes.request(Command::kStart) == Status::kOk) {
            std::printf("frame %2u: start requested\n", static_cast<unsigned>(frame));
        }
        if (monitor.is_beyond_limit() && drive_modes.get_failure().cause == mamori::ModeFailureCause::kNone) {
            static_cast<void>(drive_modes.request_safe_mode());
            std::printf("frame %2u: safe mode requested\n", static_cast<unsigned>(frame));
        }
    }
    void apply(std::uint64_t frame, mamori::Instant, mamori::Duration) noexcept override {
        const Mode mode = drive_modes.get_mode<Mode>();
        if (frame == 0U || mode != mode_) {
            mode_ = mode;
            std::printf("frame %2u: mode %s, angle %.1f rad\n", static_cast<unsigned>(frame),
                        kSystem.modes.modes[static_cast<std::size_t>(mode)].name,
                        drive.angle.get_published());
        }
        if (frame == 29U) {
            const bool is_refused = drive_modes.request(Command::kStart) == Status::kPreconditionNotMet;
            std::printf("start is %s until reset\n", is_refused ? "rejected" : "accepted");
        }
    }

    Mode mode_{Mode::kIdle};
};

int main() {
    Operator devices;
    const bool is_ok = machine.run(30U, devices) == Status::kOk;
    return is_ok && drive_modes.reset() == Status::kOk ? 0 : 1;
}
