// SPDX-License-Identifier: Apache-2.0
#include "scale_system.hpp"

#include <array>
#include <cstddef>
#include <utility>

#include "mamori/kernel/base/constant_init.hpp"
#include "mamori/kernel/dataflow/queue_in_port.hpp"
#include "mamori/kernel/run/introspection.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/ports/virtual_time/frame_runner.hpp"

namespace mamori::verification::integration {

/// The values that components exchange.
struct Sample {
    std::uint64_t mix{0U};
    double level{0.0};
    std::uint32_t step{0U};
};

}  // namespace mamori::verification::integration

MAMORI_FIELDS(mamori::verification::integration::Sample, mix, level, step)

namespace mamori::verification::integration {
namespace {

using ports::virtual_time::FrameRunner;
using ports::virtual_time::IndexedVirtualHost;
using ports::virtual_time::SimulatedCore;

/// A value that depends on every bit of the previous values, in integers and in real numbers.
class Mixture {
  public:
    constexpr explicit Mixture(std::uint64_t seed) noexcept { sample_.mix = seed; }
    void add(const Sample& other) noexcept {
        sample_.mix =
            (sample_.mix ^ (other.mix >> 17U) ^ (other.mix << 5U)) * 0x9E3779B97F4A7C15U + other.step;
        const double fresh = static_cast<double>(sample_.mix >> 40U) * 0x1p-24;
        sample_.level = 0.5 * sample_.level + 0.375 * other.level + 0.1 * fresh;
    }
    const Sample& step() noexcept {
        ++sample_.step;
        return sample_;
    }

  private:
    Sample sample_{};
};

/// Combines the latest values of two other components into its own.
class Stage final : public Component {
  public:
    constexpr Stage(const char* name, std::uint64_t seed) noexcept : Component(name), mixture_(seed) {}
    InPort<Sample, Need::kOptional> in{*this, "in"};
    InPort<Sample, Need::kOptional> second{*this, "second"};
    OutPort<Sample> out{*this, "out"};
    using Ports = mamori::Ports<&Stage::in, &Stage::second, &Stage::out>;

    Status on_execute(ContextHandle) noexcept override {
        mixture_.add(in.read());
        if (second.is_new()) {
            mixture_.add(second.read());
        }
        out.write(mixture_.step());
        return Status::kOk;
    }

  private:
    Mixture mixture_;
};

/// Combines the values in its queue, at most three in a cycle.
template <FullPolicy kFull>
class Collector final : public Component {
  public:
    constexpr explicit Collector(const char* name) noexcept : Component(name) {}
    QueueInPort<Sample, 8U, kFull, EmptyPolicy::kDoNothing> in{*this, "in"};
    OutPort<Sample> out{*this, "out"};
    using Ports = mamori::Ports<&Collector::in, &Collector::out>;

    Status on_execute(ContextHandle) noexcept override {
        Sample sample{};
        for (int i = 0; i < 3 && in.read(sample) == Status::kOk; ++i) {
            mixture_.add(sample);
        }
        out.write(mixture_.step());
        return Status::kOk;
    }

  private:
    Mixture mixture_{1U};
};

/// `stage 00`, `stage 01`, ...
template <std::size_t kSeed>
inline constexpr std::array<char, 9U> kStageName{
    's', 't', 'a', 'g', 'e', ' ', '0' + kSeed / 10U, '0' + kSeed % 10U, '\0'};

template <std::size_t... kSeeds>
constexpr std::array<Stage, sizeof...(kSeeds)> make_stages(std::index_sequence<kSeeds...>) noexcept {
    return {{Stage(kStageName<kSeeds>.data(), kSeeds)...}};
}

// Core 0 runs stages 0 .. 47, core 1 runs 48 .. 95, each half in four windows.
constexpr std::size_t kHalf = 48U;
constexpr std::size_t kFastCount = 10U;
constexpr std::size_t kControlCount = 11U;
constexpr std::size_t kPlanCount = 13U;
constexpr std::size_t kWatchCount = 14U;
static_assert(kFastCount + kControlCount + kPlanCount + kWatchCount == kHalf);
constexpr std::size_t kControlFirst = kFastCount;
constexpr std::size_t kPlanFirst = kControlFirst + kControlCount;
constexpr std::size_t kWatchFirst = kPlanFirst + kPlanCount;

MAMORI_CONSTINIT std::array<Stage, 2U * kHalf> g_stages = make_stages(std::make_index_sequence<2U * kHalf>{});
MAMORI_CONSTINIT Collector<FullPolicy::kOverwrite> g_near_0{"near 0"};
MAMORI_CONSTINIT Collector<FullPolicy::kOverwrite> g_near_1{"near 1"};
MAMORI_CONSTINIT Collector<FullPolicy::kDoNothing> g_far_0{"far 0"};
MAMORI_CONSTINIT Collector<FullPolicy::kOverwrite> g_far_1{"far 1"};
MAMORI_CONSTINIT Crossing<Sample> g_fast_to_1;
MAMORI_CONSTINIT Crossing<Sample> g_fast_to_0;
MAMORI_CONSTINIT Crossing<Sample> g_slow_to_1;
MAMORI_CONSTINIT Crossing<Sample> g_slow_to_0;

template <std::size_t kFirst, std::size_t... kIndices, typename... Others>
constexpr auto run_stages(std::index_sequence<kIndices...>, Others&... others) noexcept {
    return run(g_stages[kFirst + kIndices]..., others...);
}
template <std::size_t kFirst, std::size_t kCount, typename... Others>
constexpr auto run_stages(Others&... others) noexcept {
    return run_stages<kFirst>(std::make_index_sequence<kCount>{}, others...);
}

/// Each stage feeds the next one of its core.
template <std::size_t... kLinks>
constexpr auto make_system(std::index_sequence<kLinks...>) noexcept {
    return system(frame(10_ms), trace_hash(),
                  window("fast 0", 0_us, 200_us, every(1_ms), rate(1000_hz), budget(150_us),
                         run_stages<0U, kFastCount>()),
                  window("control 0", 200_us, 200_us, every(2_ms), rate(500_hz), budget(150_us),
                         run_stages<kControlFirst, kControlCount>(g_near_0)),
                  window("plan 0", 400_us, 200_us, every(5_ms), rate(200_hz), budget(150_us),
                         run_stages<kPlanFirst, kPlanCount>(g_far_0)),
                  window("watch 0", 600_us, 300_us, rate(100_hz), budget(250_us),
                         run_stages<kWatchFirst, kWatchCount>()),
                  window("fast 1", 0_us, 200_us, every(1_ms), rate(1000_hz), core(1), budget(150_us),
                         run_stages<kHalf, kFastCount>()),
                  window("control 1", 200_us, 200_us, every(2_ms), rate(500_hz), core(1), budget(150_us),
                         run_stages<kHalf + kControlFirst, kControlCount>(g_near_1)),
                  window("plan 1", 400_us, 200_us, every(5_ms), rate(200_hz), core(1), budget(150_us),
                         run_stages<kHalf + kPlanFirst, kPlanCount>(g_far_1)),
                  window("watch 1", 600_us, 300_us, rate(100_hz), core(1), budget(250_us),
                         run_stages<kHalf + kWatchFirst, kWatchCount>()),
                  connect(g_stages[kLinks].out, g_stages[kLinks + 1U].in, any_age())...,
                  connect(g_stages[kHalf + kLinks].out, g_stages[kHalf + kLinks + 1U].in, any_age())...,
                  connect(g_stages[kHalf - 1U].out, g_stages[kHalf].in, through(g_slow_to_1), any_age()),
                  connect(g_stages[2U * kHalf - 1U].out, g_stages[0].in, through(g_slow_to_0), any_age()),
                  connect(g_stages[kFastCount - 1U].out, g_stages[kHalf + kControlFirst].second,
                          through(g_fast_to_1), any_age()),
                  connect(g_stages[kHalf + kFastCount - 1U].out, g_stages[kControlFirst].second,
                          through(g_fast_to_0), any_age()),
                  connect(g_stages[0].out, g_near_0.in, any_age()),
                  connect(g_stages[kHalf].out, g_near_1.in, any_age()),
                  connect(g_stages[kHalf + 1U].out, g_far_0.in, any_age()),
                  connect(g_stages[1].out, g_far_1.in, any_age()),
                  connect(g_near_0.out, g_stages[kWatchFirst].second, any_age()),
                  connect(g_far_0.out, g_stages[kWatchFirst + 1U].second, any_age()),
                  connect(g_near_1.out, g_stages[kHalf + kWatchFirst].second, any_age()),
                  connect(g_far_1.out, g_stages[kHalf + kWatchFirst + 1U].second, any_age()));
}
constexpr auto kSystem = make_system(std::make_index_sequence<kHalf - 1U>{});
MAMORI_CHECK(kSystem);
using Table = std::remove_const_t<decltype(kSystem)>;
static_assert(Table::kComponentCount == 100U);

MAMORI_CONSTINIT ExecutiveFor<Table> g_core_0{kSystem, 0U};
MAMORI_CONSTINIT ExecutiveFor<Table> g_core_1{kSystem, 1U};
MAMORI_CONSTINIT IntrospectionFor<Table> g_introspection{kSystem};

/// Not a device; on request, reads the complete introspection `kCyclesPerFrame` times in a major frame of as
/// many milliseconds.
class Watcher final : public Devices {
  public:
    explicit Watcher(bool is_watching) noexcept : is_watching_(is_watching) {}
    std::uint64_t row_count{0U};

    void apply(std::uint64_t, Instant, Duration) noexcept override {
        for (std::uint64_t i = 0U; is_watching_ && i < kCyclesPerFrame; ++i) {
            const auto count = [this](std::size_t, const auto&) noexcept { ++row_count; };
            static_cast<void>(g_introspection.for_each_window(count));
            static_cast<void>(g_introspection.for_each_component(count));
            static_cast<void>(g_introspection.for_each_port(count));
        }
    }

  private:
    bool is_watching_;
};

void initialize(Executive& executive, bool is_watched) {
    executive.set_introspection(is_watched ? &g_introspection : nullptr);
    MAMORI_REQUIRE(1, executive.initialize() == Status::kOk);
}

std::uint64_t count_lost() noexcept {
    std::uint64_t count = 0U;
    for (const PortRow& port : kSystem.ports) {
        if (port.input != nullptr) {
            const PortCounts counts = port.count(*port.input);
            count += counts.rejected + counts.overwritten;
        }
    }
    return count;
}

}  // namespace

ScaleResult run_scale(std::uint64_t frames, bool is_watched) {
    std::array<Duration, Table::kComponentCount> durations{};
    durations.fill(2_us);
    IndexedVirtualHost host_0{durations};
    IndexedVirtualHost host_1{durations};
    initialize(g_core_0, is_watched);
    initialize(g_core_1, is_watched);
    MAMORI_REQUIRE(2, g_core_0.start() == Status::kOk && g_core_1.start() == Status::kOk);
    std::array<SimulatedCore, 2U> cores{SimulatedCore{g_core_0, host_0}, SimulatedCore{g_core_1, host_1}};
    Watcher watcher{is_watched};
    FrameRunner runner{cores, watcher};
    for (std::uint64_t i = 0U; i < frames; ++i) {
        runner.run_frame();
    }
    TraceHash hash{};
    hash(g_core_0.get_trace_hash());
    hash(g_core_1.get_trace_hash());
    return {hash.get_value(), runner.get_overrun_count(), count_lost(), watcher.row_count};
}

}  // namespace mamori::verification::integration
