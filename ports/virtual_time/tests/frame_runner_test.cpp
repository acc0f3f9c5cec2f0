// SPDX-License-Identifier: Apache-2.0
// Goal: frames run in lockstep with their devices, each window at its place, and a run repeats to the bit.
// Method: devices that note their calls; a sensor, a channel and a doubler with modelled times; one hash
// that was computed apart from this code, by a script that knows only the publications and FNV-1a.
#include "mamori/ports/virtual_time/frame_runner.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "mamori/kernel/run/executive.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/ports/virtual_time/simulated_channel.hpp"
#include "mamori/trace/verifies.hpp"
#include "mamori/verification/failed_check.hpp"

namespace mamori::ports::virtual_time {
namespace {

using namespace verification;

/// Publishes what the devices gave it.
class Sensor final : public Component {
  public:
    constexpr Sensor() noexcept : Component("sensor") {}
    OutPort<double> out{*this, "out"};
    using Ports = mamori::Ports<&Sensor::out>;
    double measured{0.0};

    Status on_execute(ContextHandle) noexcept override {
        out.write(measured);
        return Status::kOk;
    }
};
/// Passes twice the value on.
class Doubler final : public Component {
  public:
    constexpr Doubler() noexcept : Component("doubler") {}
    InPort<double> in{*this, "in"};
    OutPort<double> out{*this, "out"};
    using Ports = mamori::Ports<&Doubler::in, &Doubler::out>;

    Status on_execute(ContextHandle) noexcept override {
        out.write(2.0 * in.read());
        return Status::kOk;
    }
};

/// Writes every call down, and moves a plant that follows the doubler's output.
class SpyDevices final : public Devices {
  public:
    SpyDevices(Sensor& sensor, const Doubler& doubler) : sensor_(sensor), doubler_(doubler) {}
    std::vector<std::string> heard;

    void sample(std::uint64_t frame, Instant now) noexcept override {
        heard.push_back("begin " + std::to_string(frame) + " @" + std::to_string(now.ns));
        sensor_.measured = plant_;
    }
    void apply(std::uint64_t frame, Instant now, Duration length) noexcept override {
        heard.push_back("end " + std::to_string(frame) + " @" + std::to_string(now.ns) + " for " +
                        std::to_string(length.ns));
        plant_ += 0.1 - 0.01 * doubler_.out.get_published();
    }

  private:
    Sensor& sensor_;
    const Doubler& doubler_;
    double plant_{1.0};
};

/// Sensor and channel in the first window, the doubler in the second.
struct Plant {
    Sensor sensor;
    SimulatedChannel<double, 4U> channel{"channel"};
    Doubler doubler;
    SystemTable<2U, 3U, 5U, 2U> table = system(
        frame(1000_ns), trace_hash(), window("sense", 0_ns, 300_ns, budget(200_ns), run(sensor, channel)),
        window("decide", 400_ns, 500_ns, budget(500_ns), run(doubler)),
        connect(sensor.out, channel.in, any_age()), connect(channel.out, doubler.in, any_age()));
    std::array<Duration, 3> durations{};
    ExecutiveFor<decltype(table)> executive{table};
    IndexedVirtualHost host{durations};
    SpyDevices devices{sensor, doubler};
    SimulatedCore core{executive, host};
    FrameRunner runner{{&core, 1U}, devices};

    Plant() {
        EXPECT_EQ(executive.initialize(), Status::kOk);
        EXPECT_EQ(executive.start(), Status::kOk);
    }
    void run_frames(int count) {
        for (int i = 0; i < count; ++i) {
            runner.run_frame();
        }
    }
};

TEST(FrameRunnerTest, DevicesAreSampledBeforeAndMovedOnAfterTheWindowsOfEachFrame) {
    verifies("SWR-VTM-003");
    Plant plant;

    plant.run_frames(2);

    EXPECT_EQ(plant.devices.heard, (std::vector<std::string>{"begin 0 @0", "end 0 @0 for 1000",
                                                             "begin 1 @1000", "end 1 @1000 for 1000"}));
    EXPECT_EQ(plant.runner.get_frame_count(), 2U);
    EXPECT_EQ(plant.host.get_now(), Instant{2000});
    EXPECT_DOUBLE_EQ(plant.doubler.out.get_published(), 2.0 * (1.0 + 0.1 - 0.01 * 2.0));
}

TEST(FrameRunnerTest, EachWindowOpensAtItsPlaceHoweverLongTheOneBeforeTook) {
    verifies("SWR-VTM-003", Technique::kFaultInjection);
    Plant plant;
    plant.durations[0] = kNever;
    plant.durations[2] = 500_ns;

    plant.run_frames(3);

    EXPECT_EQ(plant.runner.get_overrun_count(), 3U);
    EXPECT_EQ(plant.doubler.out.get_sequence(), 3U);
    EXPECT_EQ(plant.sensor.out.get_sequence(), 0U);
    EXPECT_EQ(plant.host.get_now(), Instant{3000});
}

TEST(FrameRunnerTest, OverrunsAreCountedOnlyBeyondTheBudget) {
    verifies("SWR-VTM-003", Technique::kBoundaryValues);
    Plant plant;
    plant.durations[0] = 100_ns;
    plant.durations[1] = 100_ns;
    plant.run_frames(5);
    EXPECT_EQ(plant.runner.get_overrun_count(), 0U);

    ASSERT_EQ(plant.host.set_duration(1U, 101_ns), Status::kOk);
    plant.run_frames(5);

    EXPECT_EQ(plant.runner.get_overrun_count(), 5U);
}

/// Reads the clock of a core before the first window of each frame.
class ClockReader final : public Devices {
  public:
    explicit ClockReader(const VirtualHost& host) : host_(host) {}
    std::vector<std::int64_t> seen;

    void sample(std::uint64_t /*frame*/, Instant /*start*/) noexcept override {
        seen.push_back(host_.get_now().ns);
    }
    void apply(std::uint64_t /*frame*/, Instant /*start*/, Duration /*length*/) noexcept override {}

  private:
    const VirtualHost& host_;
};

TEST(FrameRunnerTest, ClockIsAtTheBeginOfTheFrameWhenDevicesAreSampledAlsoInALaterFirstFrame) {
    verifies("SWR-VTM-003", Technique::kBoundaryValues);
    Plant plant;
    ClockReader devices{plant.host};
    plant.host.advance_to(Instant{2500});
    SimulatedCore core{plant.executive, plant.host};
    FrameRunner runner{{&core, 1U}, devices, 3U};

    runner.run_frame();
    runner.run_frame();
    EXPECT_EQ(devices.seen, (std::vector<std::int64_t>{3000, 4000}));
}

/// Notes its name when it runs.
class Noter final : public Component {
  public:
    Noter(const char* name, std::vector<std::string>& heard) noexcept : Component(name), heard_(heard) {}
    using Ports = mamori::Ports<>;

    Status on_execute(ContextHandle) noexcept override {
        heard_.emplace_back(get_name());
        return Status::kOk;
    }

  private:
    std::vector<std::string>& heard_;
};

TEST(FrameRunnerTest, WindowsOfTheSameInstantRunInTheOrderOfTheirCores) {
    verifies("SWR-VTM-003", Technique::kBoundaryValues);
    std::vector<std::string> heard;
    Noter first{"first", heard};
    Noter second{"second", heard};
    const auto table = system(frame(1000_ns), window("a", 0_ns, 300_ns, budget(200_ns), run(first)),
                              window("b", 0_ns, 300_ns, core(1U), budget(200_ns), run(second)));
    ExecutiveFor core_0{table, 0U};
    ExecutiveFor core_1{table, 1U};
    std::array<Duration, 2U> durations{};
    IndexedVirtualHost host_0{durations};
    IndexedVirtualHost host_1{durations};
    ASSERT_EQ(core_0.initialize(), Status::kOk);
    ASSERT_EQ(core_1.initialize(), Status::kOk);
    ASSERT_EQ(core_0.start(), Status::kOk);
    ASSERT_EQ(core_1.start(), Status::kOk);
    std::array<SimulatedCore, 2U> cores{SimulatedCore{core_0, host_0}, SimulatedCore{core_1, host_1}};
    NoDevices devices;
    FrameRunner runner{cores, devices};

    runner.run_frame();
    runner.run_frame();
    EXPECT_EQ(heard, (std::vector<std::string>{"first", "second", "first", "second"}));
}

TEST(FrameRunnerTest, AStoppedSystemLetsTimePass) {
    verifies("SWR-VTM-003", Technique::kStateTransition);
    Plant plant;
    ASSERT_EQ(plant.executive.stop(), Status::kOk);

    plant.run_frames(2);

    EXPECT_EQ(plant.host.get_now(), Instant{2000});
    EXPECT_EQ(plant.sensor.out.get_sequence(), 0U);
    EXPECT_EQ(plant.runner.get_overrun_count(), 0U);
}

TEST(FrameRunnerTest, AClockThatIsPastTheFrameEndsInTheAssertion) {
    verifies("SWR-VTM-003", Technique::kErrorGuessing);
    Plant plant;
    plant.host.advance_to(Instant{1});

    EXPECT_CHECK_FAILS(plant.runner.run_frame(), "virtual_host.cpp", 1);
}

TEST(FrameRunnerTest, TheSameRunGivesTheSameHashAndModelledTimesInsideTheBudgetDoNotChangeIt) {
    verifies("SWR-KRN-006", Technique::kBackToBack);
    std::vector<std::uint64_t> hashes;

    for (const Duration duration : {0_ns, 0_ns, 1_ns, 100_ns}) {
        Plant plant;
        plant.durations = {duration, duration, duration};
        plant.run_frames(1000);
        hashes.push_back(plant.executive.get_trace_hash());
    }

    EXPECT_EQ(hashes, std::vector<std::uint64_t>(4U, hashes[0]));
}

TEST(FrameRunnerTest, AnOverrunOrAFaultOfTheChannelChangesTheHash) {
    verifies("SWR-KRN-006", Technique::kFaultInjection);
    Plant healthy;
    Plant late;
    Plant losing;
    late.durations[1] = 201_ns;

    healthy.run_frames(10);
    late.run_frames(10);
    losing.run_frames(5);
    losing.channel.set_fault({true, 0_ns});
    losing.run_frames(5);

    EXPECT_NE(late.executive.get_trace_hash(), healthy.executive.get_trace_hash());
    EXPECT_NE(losing.executive.get_trace_hash(), healthy.executive.get_trace_hash());
    EXPECT_EQ(losing.channel.out.get_sequence(), 5U);
}

TEST(FrameRunnerTest, AWholeRunGivesTheHashThatEveryCompilerAndOptimisationLevelGives) {
    verifies("SWR-KRN-006", Technique::kBackToBack);
    Plant plant;

    plant.run_frames(1000);

    EXPECT_EQ(plant.executive.get_trace_hash(), 0x7CC910DC182B8724U);
}

}  // namespace
}  // namespace mamori::ports::virtual_time
