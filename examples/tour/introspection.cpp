// SPDX-License-Identifier: Apache-2.0
// Introspection: a tool reads copies of the state of a running system, in which a sensor fails.
#include <cstddef>
#include <cstdint>
#include <cstdio>

#include "mamori/kernel/run/introspection.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/ports/virtual_time/machine.hpp"

using mamori::Status;
using namespace mamori::literals;  // NOLINT: units of the times below

/// Measures; fails in its third cycle.
class Sensor final : public mamori::Component {
  public:
    constexpr Sensor() noexcept : Component("sensor") {}
    mamori::OutPort<double> speed{*this, "speed"};  // [rad/s]
    using Ports = mamori::Ports<&Sensor::speed>;

    Status on_execute(mamori::ContextHandle) noexcept override {
        ++cycles_;
        speed.write(1.0);
        return cycles_ < 3U ? Status::kOk : Status::kError;
    }

  private:
    std::uint32_t cycles_{0U};
};

class Monitor final : public mamori::Component {
  public:
    constexpr Monitor() noexcept : Component("monitor") {}
    mamori::InPort<double> speed{*this, "speed"};  // [rad/s]
    using Ports = mamori::Ports<&Monitor::speed>;
};

static Sensor sensor;
static Monitor monitor;
static constexpr auto kSystem = mamori::system(
    mamori::frame(10_ms), mamori::window("sense", 0_ms, 2_ms, mamori::budget(1_ms), mamori::run(sensor)),
    mamori::window("watch", 2_ms, 2_ms, mamori::budget(1_ms), mamori::run(monitor)),
    mamori::connect(sensor.speed, monitor.speed, mamori::fresh_within(5_ms)),
    mamori::modelled_time(sensor, 100_us), mamori::modelled_time(monitor, 200_us));
static mamori::ports::virtual_time::Machine<kSystem> machine;
static mamori::IntrospectionFor introspection{kSystem};

/// A tool: needs only the introspection, and may run in another thread.
static void print(const mamori::Introspection& shown) {
    shown.for_each_window([](std::size_t, const mamori::WindowSnapshot& window) noexcept {
        std::printf("window %s: %u cycles, %u overruns, at most %d us\n", window.name,
                    static_cast<unsigned>(window.cycles), static_cast<unsigned>(window.overruns),
                    static_cast<int>(window.worst_used.ns / 1000));
    });
    shown.for_each_component([](std::size_t, const mamori::ComponentSnapshot& component) noexcept {
        const bool has_failed = component.last_failure.status != Status::kOk;
        std::printf("component %s: %s%s%s\n", component.name, get_name(component.state),
                    has_failed ? ", failed in " : "",
                    has_failed ? get_name(component.last_failure.action) : "");
    });
    shown.for_each_port([](std::size_t, const mamori::PortSnapshot& port) noexcept {
        std::printf("%s of component %u: age %d us, %s\n", port.is_input ? "input" : "output",
                    static_cast<unsigned>(port.component), static_cast<int>(port.calc_age().ns / 1000),
                    port.status == mamori::PortStatus::kOk ? "ok" : "too old");
    });
}

int main() {
    machine.get_executives().get(0U).set_introspection(&introspection);
    const auto print_at_end = [](std::uint64_t frame) {
        if (frame == 3U) {
            print(introspection);
        }
    };
    return machine.run(4U, print_at_end) == Status::kOk ? 0 : 1;
}
