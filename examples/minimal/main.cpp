// SPDX-License-Identifier: Apache-2.0
// A wheel and a monitor that brakes it: two components, one table, 200 ms of virtual time.
#include <cstdio>
#include "mamori/kernel/system/system.hpp"
#include "mamori/ports/virtual_time/machine.hpp"
using namespace mamori::literals;  // NOLINT: units of the times below

/// Speeds up by 1 rad/s in each cycle, and slows down by as much while the brake is on.
class Wheel final : public mamori::Component {
  public:
    constexpr Wheel() noexcept : Component("wheel") {}
    mamori::InPort<bool, mamori::Need::kOptional> brake{*this, "brake"};
    mamori::OutPort<double> speed{*this, "speed"};  // [rad/s]
    using Ports = mamori::Ports<&Wheel::brake, &Wheel::speed>;
    mamori::Status on_execute(mamori::ContextHandle) noexcept override {
        speed.write(speed.get_published() + (brake.read() ? -1.0 : 1.0));
        return mamori::Status::kOk;
    }
};
/// Brakes from 8 rad/s on, until the wheel is slower than 4 rad/s.
class Monitor final : public mamori::Component {
  public:
    constexpr Monitor() noexcept : Component("monitor") {}
    mamori::InPort<double> speed{*this, "speed"};
    mamori::OutPort<bool> brake{*this, "brake"};
    using Ports = mamori::Ports<&Monitor::speed, &Monitor::brake>;
    mamori::Status on_execute(mamori::ContextHandle) noexcept override {
        brake.write(speed.read() >= (brake.get_published() ? 4.0 : 8.0));
        return mamori::Status::kOk;
    }
};
static Wheel wheel;
static Monitor monitor;
static constexpr auto kSystem =
    mamori::system(mamori::frame(10_ms),  // everything repeats after it
                   mamori::window("drive", 0_ms, 2_ms, mamori::budget(1_ms), mamori::run(wheel)),
                   mamori::window("watch", 2_ms, 2_ms, mamori::budget(1_ms), mamori::run(monitor)),
                   mamori::connect(wheel.speed, monitor.speed, mamori::any_age()),
                   mamori::connect(monitor.brake, wheel.brake, mamori::any_age()),
                   mamori::modelled_time(wheel, 100_us), mamori::modelled_time(monitor, 200_us));
static mamori::ports::virtual_time::Machine<kSystem> machine;  // in real time: posix_rt::Machine
static void print(std::uint64_t frame) {
    if (frame % 4U == 3U) {
        std::printf("after %3u ms: %.0f rad/s, brake %s\n", static_cast<unsigned>(frame + 1U) * 10U,
                    wheel.speed.get_published(), monitor.brake.get_published() ? "on" : "off");
    }
}
int main() {
    return machine.run(20U, print) == mamori::Status::kOk ? 0 : 1;
}
