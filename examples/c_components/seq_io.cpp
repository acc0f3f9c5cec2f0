// SPDX-License-Identifier: Apache-2.0
// SeqOut (C) -> SeqIn (C) in one window: ten cycles, each of which prints what SeqIn has calculated.
#include "seq_io.h"

#include <cstdio>

#include "mamori/kernel/c/c_component.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/ports/virtual_time/machine.hpp"

using namespace mamori::literals;  // NOLINT: units of the times below

MAMORI_FIELDS(Samples, length, counts, angles_rad)

class SeqOutComponent final : public mamori::CComponent {
  public:
    constexpr SeqOutComponent() noexcept : CComponent("seq_out", seq_out_actions, &self_) {}
    mamori::OutPort<Samples> samples{*this, "samples"};
    using Ports = mamori::Ports<&SeqOutComponent::samples>;

  private:
    SeqOut self_{mamori::c_port(samples), 0};
};

class SeqInComponent final : public mamori::CComponent {
  public:
    constexpr SeqInComponent() noexcept : CComponent("seq_in", seq_in_actions, &self_) {}
    mamori::InPort<Samples> samples{*this, "samples"};
    using Ports = mamori::Ports<&SeqInComponent::samples>;
    const SeqIn& get_self() const noexcept { return self_; }

  private:
    SeqIn self_{mamori::c_port(samples), 0, 0.0};
};

static SeqOutComponent seq_out;
static SeqInComponent seq_in;
static constexpr auto kSystem =
    mamori::system(mamori::frame(10_ms),
                   mamori::window("seq", 0_ms, 2_ms, mamori::budget(1_ms), mamori::run(seq_out, seq_in)),
                   mamori::connect(seq_out.samples, seq_in.samples, mamori::fresh_within(10_ms)),
                   mamori::modelled_time(seq_out, 100_us), mamori::modelled_time(seq_in, 100_us));
static mamori::ports::virtual_time::Machine<kSystem> machine;

static void print(std::uint64_t /*frame*/) {
    std::printf("%u elements: sum %d, largest angle %.1f rad\n", seq_in.samples.read().length,
                seq_in.get_self().count_sum, seq_in.get_self().angle_max_rad);
}

int main() {
    return machine.run(10U, print) == mamori::Status::kOk ? 0 : 1;
}
