// SPDX-License-Identifier: Apache-2.0
/// @file
/// A system with an exactly known number of instructions, for `mamori cost` and its proof.
///
///     cost_subject cost --by count|clock --cycles N --first A --every K --out DIR [unsteady]
///
/// In cycle n (from 1 on), component `linear` repeats a loop n times; `constant` always repeats it equally
/// often; `heavy` repeats it 20,000 times in its cycle 7, otherwise once. With `unsteady`, a step is omitted
/// in real time.
///
/// Design: docs/design/cost.md#proof
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "mamori/kernel/system/system.hpp"
#include "mamori/timing/cost_run.hpp"

namespace mamori::verification {
namespace {

using literals::operator""_us;

/// The same few instructions per iteration, with any optimisation.
void go_round(std::uint64_t count) noexcept {
    for (std::uint64_t i = 0U; i < count; ++i) {
        asm volatile("" : : : "memory");
    }
}

class Linear final : public Component {
  public:
    Linear() noexcept : Component("linear") {}
    Status on_execute(ContextHandle) noexcept override {
        ++cycle_;
        go_round(cycle_);
        return Status::kOk;
    }

  private:
    std::uint64_t cycle_{0U};
};

class Constant final : public Component {
  public:
    Constant() noexcept : Component("constant") {}
    Status on_execute(ContextHandle) noexcept override {
        go_round(10U);
        return Status::kOk;
    }
};

class Heavy final : public Component {
  public:
    Heavy() noexcept : Component("heavy") {}
    Status on_execute(ContextHandle) noexcept override {
        go_round(cycle_ == 7U ? 20'000U : 1U);
        ++cycle_;
        return Status::kOk;
    }

  private:
    std::uint64_t cycle_{0U};
};

Linear linear;
Constant constant;
Heavy heavy;
constexpr auto kSubject =
    system(frame(1000_us), window("light", 0_us, 300_us, budget(200_us), run(linear, constant)),
           window("heavy", 500_us, 300_us, budget(200_us), run(heavy)));
ExecutiveFor executive{kSubject};

int run_subject(int argc, char** argv) {
    if (argc < 12 || argc > 13) {
        std::fprintf(stderr, "usage: cost_subject cost --by WORD --cycles N --first A --every K --out DIR\n");
        return 2;
    }
    timing::CostOptions options;
    options.is_paced = std::strcmp(argv[3], "clock") == 0;
    options.cycles = std::strtoull(argv[5], nullptr, 10);
    options.counted = {std::strtoull(argv[7], nullptr, 10), std::strtoull(argv[9], nullptr, 10)};
    options.out = argv[11];
    ports::virtual_time::VirtualHostFor clock{kSubject};
    if (argc == 13 && options.is_paced) {
        static_cast<void>(clock.set_duration(constant, ports::virtual_time::kNever));
    }
    NoDevices devices;
    if (executive.initialize() != Status::kOk || executive.start() != Status::kOk) {
        return 1;
    }
    const timing::TimingResult result = timing::run_cost({{executive, clock}}, devices, options);
    if (!result.message.empty()) {
        std::fprintf(stderr, "cost_subject: %s\n", result.message.c_str());
    }
    return timing::get_exit_status(result.outcome);
}

}  // namespace
}  // namespace mamori::verification

int main(int argc, char** argv) {
    return mamori::verification::run_subject(argc, argv);
}
