// SPDX-License-Identifier: Apache-2.0
// MyDataOut (C) -> MyDataIn (C): five cycles. The fourth has an invalid value, which stops MyDataIn.
#include "my_data_io.h"

#include <cstdio>

#include "mamori/kernel/c/c_component.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/ports/virtual_time/machine.hpp"

using namespace mamori::literals;  // NOLINT: units of the times below

MAMORI_FIELDS(Tool, name, mass_kg, is_closed)
MAMORI_FIELDS(MyData, arm, tools)

class MyDataOutComponent final : public mamori::CComponent {
  public:
    constexpr MyDataOutComponent() noexcept : CComponent("my_data_out", my_data_out_actions, &self_) {}
    mamori::OutPort<MyData> data{*this, "data"};
    using Ports = mamori::Ports<&MyDataOutComponent::data>;

  private:
    MyDataOut self_{mamori::c_port(data), 0U};
};

class MyDataInComponent final : public mamori::CComponent {
  public:
    constexpr MyDataInComponent() noexcept : CComponent("my_data_in", my_data_in_actions, &self_) {}
    mamori::InPort<MyData> data{*this, "data"};
    using Ports = mamori::Ports<&MyDataInComponent::data>;
    double get_mass_kg() const noexcept { return self_.mass_kg; }

  private:
    MyDataIn self_{mamori::c_port(data), 0.0};
};

static MyDataOutComponent my_data_out;
static MyDataInComponent my_data_in;
static constexpr auto kSystem = mamori::system(
    mamori::frame(10_ms), mamori::window("send", 0_ms, 2_ms, mamori::budget(1_ms), mamori::run(my_data_out)),
    mamori::window("receive", 2_ms, 2_ms, mamori::budget(1_ms), mamori::run(my_data_in)),
    mamori::connect(my_data_out.data, my_data_in.data, mamori::fresh_within(10_ms)),
    mamori::modelled_time(my_data_out, 100_us), mamori::modelled_time(my_data_in, 100_us));
static mamori::ports::virtual_time::Machine<kSystem> machine;

static void print(std::uint64_t /*frame*/) {
    const MyData& data = my_data_in.data.read();
    const mamori::ActionFailure& failure = my_data_in.get_last_failure();
    std::printf("arm %u, tools %s and %s: %.2f kg, last failure %s\n", data.arm, data.tools[0].name,
                data.tools[1].name, my_data_in.get_mass_kg(), mamori::get_name(failure.status));
}

int main() {
    return machine.run(5U, print) == mamori::Status::kOk ? 0 : 1;
}
