// SPDX-License-Identifier: Apache-2.0
// ConsoleIn (C++) -> SimpleIO (C) -> ConsoleOut (C++). Reads numbers from the console until its end.
#include <cstdio>

#include "console.hpp"
#include "mamori/kernel/c/c_component.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/ports/virtual_time/machine.hpp"

using namespace mamori::literals;  // NOLINT: units of the times below

/// The component in C, with its ports and its memory.
class SimpleIoComponent final : public mamori::CComponent {
  public:
    constexpr SimpleIoComponent() noexcept : CComponent("simple_io", simple_io_actions, &self_) {}
    mamori::InPort<Number> in{*this, "in"};
    mamori::OutPort<Number> out{*this, "out"};
    using Ports = mamori::Ports<&SimpleIoComponent::in, &SimpleIoComponent::out>;

  private:
    SimpleIo self_{mamori::c_port(in), mamori::c_port(out), 0};
};

static ConsoleIn console_in;
static SimpleIoComponent simple_io;
static ConsoleOut console_out;
static constexpr auto kSystem = mamori::system(
    mamori::frame(10_ms), mamori::window("in", 0_ms, 1_ms, mamori::budget(1_ms), mamori::run(console_in)),
    mamori::window("sum", 1_ms, 1_ms, mamori::budget(1_ms), mamori::run(simple_io)),
    mamori::window("out", 2_ms, 1_ms, mamori::budget(1_ms), mamori::run(console_out)),
    mamori::connect(console_in.out, simple_io.in, mamori::fresh_within(5_ms)),
    mamori::connect(simple_io.out, console_out.in, mamori::any_age()),
    mamori::modelled_time(console_in, 100_us), mamori::modelled_time(simple_io, 100_us),
    mamori::modelled_time(console_out, 100_us));
static mamori::ports::virtual_time::Machine<kSystem> machine;

class Console final : public mamori::Devices {
    void sample(std::uint64_t /*frame*/, mamori::Instant /*now*/) noexcept override {
        int number = 0;
        if (std::scanf("%d", &number) == 1) {
            console_in.enter(number);
        } else {
            machine.request_stop();  // this frame is the last one
        }
    }
    void apply(std::uint64_t /*frame*/, mamori::Instant /*now*/, mamori::Duration) noexcept override {
        if (const Number* const number = console_out.get_received()) {
            std::printf("entered at %3u ms: sum %d\n", number->nsec / 1'000'000U, number->data);
        } else if (simple_io.get_last_failure().status != mamori::Status::kOk) {
            std::printf("simple_io: %s\n", mamori::get_name(simple_io.get_last_failure().status));
        }
    }
};

int main() {
    Console console;
    return machine.run(100U, console) == mamori::Status::kOk ? 0 : 1;
}
