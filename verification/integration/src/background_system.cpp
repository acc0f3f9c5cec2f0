// SPDX-License-Identifier: Apache-2.0
#include "background_system.hpp"

#include <time.h>

#include <algorithm>
#include <array>
#include <random>
#include <vector>

#include "mamori/kernel/system/system.hpp"
#include "mamori/ports/posix_rt/machine.hpp"
#include "mamori/ports/virtual_time/machine.hpp"

namespace mamori::verification {
namespace {

using namespace literals;

constexpr Duration kLoopMax = 100_us;
constexpr Duration kPlanMax = 12_ms;
constexpr Duration kPlanBudget = 15_ms;
constexpr Duration kPlanLong = 16_ms;  ///< an overrun that returns before the next window start
constexpr std::size_t kCyclesMax = 10'000U * 50U;

bool is_long(std::int64_t cycle) {
    return cycle % 7 == 3;
}

/// Processor time of the calling thread.
Duration read_used() {
    timespec now{};
    static_cast<void>(clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now));
    return Duration{static_cast<std::int64_t>(now.tv_sec) * 1'000'000'000 + now.tv_nsec};
}

void compute(Duration time) {
    const Duration end = read_used() + time;
    while (read_used() < end) {
    }
}

/// Random processor times in real time; none without a clock.
class Stage : public Component {
  public:
    explicit Stage(const char* name) : Component(name) {}
    InPort<std::int64_t, Need::kOptional> in{*this, "in"};
    OutPort<std::int64_t> out{*this, "out"};
    using Ports = mamori::Ports<&Stage::in, &Stage::out>;
    const ports::posix_rt::FrameClock* clock{nullptr};

  protected:
    ~Stage() = default;
    void write_next() {
        sum_ = (sum_ * 31 + in.read() + 1) & 0xFFFFFFF;
        out.write(sum_);
    }
    Duration roll(Duration max) {
        return Duration{std::uniform_int_distribution<std::int64_t>{0, max.ns}(engine_)};
    }

  private:
    std::int64_t sum_{0};
    std::mt19937_64 engine_{1U};
};

class Loop final : public Stage {
  public:
    Loop() : Stage("loop") { lateness_.reserve(kCyclesMax); }
    using Ports = mamori::Ports<&Loop::in, &Loop::out>;

    Status on_execute(ContextHandle context) noexcept override {
        if (clock != nullptr) {
            if (lateness_.size() < kCyclesMax) {
                lateness_.push_back((clock->get_now() - context.now).ns);
            }
            compute(roll(kLoopMax));
        }
        write_next();
        return Status::kOk;
    }
    /// @return 99th percentile since the last call [us].
    double take_lateness() {
        if (lateness_.empty()) {
            return -1.0;
        }
        const auto place = static_cast<std::ptrdiff_t>(lateness_.size() * 99U / 100U);
        std::nth_element(lateness_.begin(), lateness_.begin() + place, lateness_.end());
        const double result = static_cast<double>(*(lateness_.begin() + place)) / 1000.0;
        lateness_.clear();
        return result;
    }

  private:
    std::vector<std::int64_t> lateness_;
};

class Planner final : public Stage {
  public:
    Planner() : Stage("planner") {}
    using Ports = mamori::Ports<&Planner::in, &Planner::out>;

    Status on_execute(ContextHandle) noexcept override {
        const std::int64_t cycle = cycle_count++;
        write_next();
        if (clock != nullptr) {
            compute(is_long(cycle) ? kPlanLong : roll(kPlanMax));
        }
        return Status::kOk;
    }
    std::int64_t cycle_count{0};
};

template <int kNumber>
struct System {
    static inline Loop loop;
    static inline Planner planner;
    static inline Crossing<std::int64_t> to_planner;
    static inline Crossing<std::int64_t> to_loop;
    static constexpr auto kTable =
        system(frame(50_ms), publication_margin(200_us), trace_hash(),
               window("loop", 0_us, 650_us, every(1_ms), budget(650_us), run(loop)),
               window("plan", 850_us, 48'950_us, background(), budget(kPlanBudget), run(planner)),
               connect(loop.out, planner.in, through(to_planner), any_age()),
               connect(planner.out, loop.in, through(to_loop), any_age()));
};
using Real = System<0>;
using Virtual = System<1>;

Loop g_lonely;
constexpr auto kAlone =
    system(frame(50_ms), window("loop", 0_us, 650_us, every(1_ms), budget(650_us), run(g_lonely)));

class Ear final : public ExecutionObserver {
  public:
    std::uint64_t named{0U};
    void on_budget_overrun(std::size_t, std::size_t component, Instant) noexcept override {
        named += component == 1U ? 1U : 0U;
    }
    void on_late_release(std::size_t, Duration, Instant) noexcept override {}
};

ports::posix_rt::MachineOptions make_options(int processor) {
    static std::array<int, 1U> processors{};
    processors[0] = processor;
    ports::posix_rt::MachineOptions options;
    options.watch.lateness = 10_s;
    options.watchdog_timeout = 60_s;
    if (processor >= 0) {
        options.processors = processors;
    }
    return options;
}

double to_us(Duration time) {
    return static_cast<double>(time.ns) / 1000.0;
}

}  // namespace

BackgroundResult run_with_background(std::uint64_t frames, int processor) {
    static ports::posix_rt::Machine<Real::kTable> real{make_options(processor)};
    static ports::virtual_time::Machine<Virtual::kTable> simulated;
    static Ear ear;
    Real::loop.clock = &real.get_clock();
    Real::planner.clock = &real.get_clock();
    real.get_executives().get(1U).set_observer(&ear);
    ear.named = 0U;
    BackgroundResult result;
    const std::int64_t first = Real::planner.cycle_count;

    result.has_run = real.run(frames) == Status::kOk;
    const auto set_time = [] {
        const Duration time = is_long(Virtual::planner.cycle_count) ? kPlanLong : kPlanMax;
        static_cast<void>(simulated.get_host_of<1U>().set_duration(Virtual::planner, time));
    };
    set_time();
    result.has_run =
        simulated.run(frames, [&set_time](std::uint64_t) { set_time(); }) == Status::kOk && result.has_run;

    const ports::posix_rt::MachineReport& report = real.get_report();
    result.is_realtime = report.priority.is_granted;
    result.are_equal = true;
    for (std::size_t core = 0U; core < 2U; ++core) {
        result.are_equal = result.are_equal && real.get_executives().get(core).get_trace_hash() ==
                                                   simulated.get_executives().get(core).get_trace_hash();
    }
    for (std::int64_t cycle = first; cycle < Real::planner.cycle_count; ++cycle) {
        result.caused += is_long(cycle) ? 1U : 0U;
    }
    result.counted = report.background.overran;
    result.named = ear.named;
    result.other = report.openings.overran + report.openings.missed + report.background.missed;
    result.lateness_us = Real::loop.take_lateness();
    result.background_us = to_us(report.background.worst_lateness);
    return result;
}

double run_alone(std::uint64_t frames, int processor) {
    static ports::posix_rt::Machine<kAlone> machine{make_options(processor)};
    g_lonely.clock = &machine.get_clock();
    return machine.run(frames) == Status::kOk ? g_lonely.take_lateness() : -1.0;
}

}  // namespace mamori::verification
