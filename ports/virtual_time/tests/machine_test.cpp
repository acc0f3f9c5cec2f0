// SPDX-License-Identifier: Apache-2.0
// Goal: a machine runs a system exactly as its parts do. Method: the same table on a machine and on
// executives, hosts and runner; devices that note their calls; failures of start and stop; stops between and
// in runs.
#include "mamori/ports/virtual_time/machine.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "mamori/kernel/base/constant_init.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/trace/verifies.hpp"

namespace mamori::ports::virtual_time {
namespace {

using namespace verification;

class Counter final : public Component {
  public:
    constexpr Counter() noexcept : Component("counter") {}
    OutPort<std::int64_t> out{*this, "out"};
    using Ports = mamori::Ports<&Counter::out>;
    Status starts{Status::kOk};
    Status stops{Status::kOk};

    Status on_activated(ContextHandle) noexcept override { return starts; }
    Status on_deactivated(ContextHandle) noexcept override { return stops; }
    Status on_execute(ContextHandle) noexcept override {
        out.write(out.get_published() + 1);
        return Status::kOk;
    }
};
class Doubler final : public Component {
  public:
    constexpr Doubler() noexcept : Component("doubler") {}
    InPort<std::int64_t> in{*this, "in"};
    OutPort<std::int64_t> out{*this, "out"};
    using Ports = mamori::Ports<&Doubler::in, &Doubler::out>;

    Status on_execute(ContextHandle) noexcept override {
        out.write(2 * in.read());
        return Status::kOk;
    }
};

// One table per test: a component belongs to one executive as long as it is alive.
#define MAMORI_TEST_SYSTEM(name)                                                                            \
    Counter g_counter_##name;                                                                               \
    Doubler g_doubler_##name;                                                                               \
    Crossing<std::int64_t> g_crossing_##name;                                                               \
    constexpr auto name = system(                                                                           \
        frame(1000_ns), trace_hash(), window("count", 0_ns, 300_ns, budget(200_ns), run(g_counter_##name)), \
        window("double", 400_ns, 500_ns, core(1U), budget(400_ns), run(g_doubler_##name)),                  \
        connect(g_counter_##name.out, g_doubler_##name.in, through(g_crossing_##name), any_age()),          \
        modelled_time(g_counter_##name, 100_ns), modelled_time(g_doubler_##name, 50_ns))

MAMORI_TEST_SYSTEM(kRuns);
MAMORI_TEST_SYSTEM(kParts);
MAMORI_TEST_SYSTEM(kStops);
MAMORI_TEST_SYSTEM(kFailsAtStart);
MAMORI_TEST_SYSTEM(kFailsAtStop);
MAMORI_TEST_SYSTEM(kSlow);
MAMORI_TEST_SYSTEM(kRunsAlready);

/// One core, whose frame has room five times in the time line.
Counter g_counter_kLong;
constexpr auto kLong = system(frame(Duration{std::numeric_limits<std::int64_t>::max() / 5}),
                              window("count", 0_ns, 300_ns, budget(200_ns), run(g_counter_kLong)));

/// Gives itself a modelled time in one of its actions, so that the next action has it.
class Hanger final : public Component {
  public:
    constexpr Hanger() noexcept : Component("hanger") {}
    VirtualHost* host{nullptr};
    ComponentAction before{ComponentAction::kExecute};  ///< the action before the one that is to be late
    Duration duration{kNever};
    int cycles{0};

    Status on_startup(ContextHandle) noexcept override { return act(ComponentAction::kStartup); }
    Status on_activated(ContextHandle) noexcept override { return act(ComponentAction::kActivated); }
    Status on_execute(ContextHandle) noexcept override {
        ++cycles;
        return act(ComponentAction::kExecute);
    }
    Status on_deactivated(ContextHandle) noexcept override { return act(ComponentAction::kDeactivated); }

  private:
    Status act(ComponentAction action) noexcept {
        return action == before ? host->set_duration(*this, duration) : Status::kOk;
    }
};
Counter g_near;
Hanger g_hanger;
constexpr auto kActions =
    system(frame(1000_ns), action_budget(700_ns), window("near", 0_ns, 300_ns, budget(200_ns), run(g_near)),
           window("far", 400_ns, 500_ns, core(1U), budget(400_ns), run(g_hanger)));

int g_call_count = 0;
Status count_call(int& count, ContextHandle) noexcept {
    ++count;
    return Status::kOk;
}
SystemFunction<&count_call> g_function{"function", g_call_count};
Counter g_counted;
constexpr auto kFunction =
    system(frame(1000_ns), window("count", 0_ns, 300_ns, budget(200_ns), run(g_counted)),
           system_window("call", 300_ns, 200_ns, every(500_ns), budget(100_ns), g_function),
           modelled_time(g_function, 100_ns));
MAMORI_CHECK(kFunction);

MAMORI_CONSTINIT Machine<kRuns> g_machine;

class SpyDevices final : public Devices {
  public:
    void sample(std::uint64_t frame, Instant start) noexcept override { sampled.push_back({frame, start}); }
    void apply(std::uint64_t frame, Instant start, Duration length) noexcept override {
        applied.push_back({frame, start});
        lengths.push_back(length);
    }
    struct Call {
        std::uint64_t frame;
        Instant start;
    };
    std::vector<Call> sampled;
    std::vector<Call> applied;
    std::vector<Duration> lengths;
};

TEST(VirtualMachineTest, RunsEqualThoseOfThePartsAndContinueTheTimeLine) {
    verifies("SWR-VTM-006", Technique::kBackToBack, Polarity::kNominal);
    SpyDevices devices;
    ASSERT_EQ(g_machine.run(3U, devices), Status::kOk);
    std::vector<std::int64_t> values;
    ASSERT_EQ(g_machine.run(2U,
                            [&values](std::uint64_t frame) {
                                values.push_back(static_cast<std::int64_t>(frame));
                                values.push_back(g_doubler_kRuns.out.get_published());
                            }),
              Status::kOk);

    EXPECT_EQ(values, (std::vector<std::int64_t>{3, 8, 4, 10}));
    EXPECT_EQ(g_machine.get_frame_count(), 5U);
    EXPECT_EQ(g_machine.get_overrun_count(), 0U);
    ASSERT_EQ(devices.sampled.size(), 3U);
    ASSERT_EQ(devices.applied.size(), 3U);
    EXPECT_EQ(devices.sampled[2].frame, 2U);
    EXPECT_EQ(devices.applied[2].start, Instant{2000});
    EXPECT_EQ(devices.lengths[2], 1000_ns);

    ExecutiveFor core_0{kParts, 0U};
    ExecutiveFor core_1{kParts, 1U};
    VirtualHostFor host_0{kParts};
    VirtualHostFor host_1{kParts};
    NoDevices none;
    ASSERT_EQ(core_0.initialize(), Status::kOk);
    ASSERT_EQ(core_1.initialize(), Status::kOk);
    for (const std::uint64_t first : {0U, 3U}) {
        ASSERT_EQ(core_0.start(), Status::kOk);
        ASSERT_EQ(core_1.start(), Status::kOk);
        std::array<SimulatedCore, 2U> cores{SimulatedCore{core_0, host_0}, SimulatedCore{core_1, host_1}};
        FrameRunner runner{cores, none, first};
        while (runner.get_frame_count() < (first == 0U ? 3U : 5U)) {
            runner.run_frame();
        }
        ASSERT_EQ(core_1.stop(), Status::kOk);
        ASSERT_EQ(core_0.stop(), Status::kOk);
    }
    EXPECT_EQ(g_machine.get_executives().get(0U).get_trace_hash(), core_0.get_trace_hash());
    EXPECT_EQ(g_machine.get_executives().get(1U).get_trace_hash(), core_1.get_trace_hash());
}

TEST(VirtualMachineTest, RequestedStopEndsTheRunAfterItsFrameAndTheNextRunStartsAgain) {
    verifies("SWR-VTM-006", Technique::kRequirementsBased, Polarity::kNominal);
    static Machine<kStops> sut;

    ASSERT_EQ(sut.run(100U,
                      [](std::uint64_t frame) {
                          if (frame == 4U) {
                              sut.request_stop();
                          }
                      }),
              Status::kOk);
    EXPECT_EQ(sut.get_frame_count(), 5U);
    sut.request_stop();
    ASSERT_EQ(sut.run(), Status::kOk);
    EXPECT_EQ(sut.get_frame_count(), 5U);
    ASSERT_EQ(sut.run(1U), Status::kOk);
    EXPECT_EQ(sut.get_frame_count(), 6U);
}

TEST(VirtualMachineTest, FailureOfTheStartRunsNoFrame) {
    verifies("SWR-VTM-006", Technique::kFaultInjection, Polarity::kViolation);
    static Machine<kFailsAtStart> sut;
    SpyDevices devices;
    g_counter_kFailsAtStart.starts = Status::kUnsupported;

    EXPECT_EQ(sut.run(3U, devices), Status::kUnsupported);
    EXPECT_EQ(sut.get_executives().get_failed_core(), 0U);
    EXPECT_TRUE(devices.sampled.empty());
}

TEST(VirtualMachineTest, StopRequestedBeforeARunThatFailsToStartDoesNotStopTheNextOne) {
    verifies("SWR-VTM-006", Technique::kStateTransition, Polarity::kViolation);
    static Machine<kRunsAlready> sut;
    ASSERT_EQ(sut.get_executives().start(), Status::kOk);
    sut.request_stop();
    ASSERT_EQ(sut.run(3U), Status::kPreconditionNotMet);

    ASSERT_EQ(sut.get_executives().stop(), Status::kOk);
    ASSERT_EQ(sut.run(3U), Status::kOk);
    EXPECT_EQ(sut.get_frame_count(), 3U);
}

TEST(VirtualMachineTest, RunsEndOneFrameBeforeTheEndOfTheTimeLine) {
    verifies("SWR-VTM-006", Technique::kBoundaryValues, Polarity::kViolation);
    static Machine<kLong> sut;

    ASSERT_EQ(sut.run(2U), Status::kOk);
    EXPECT_EQ(sut.get_frame_count(), 2U);
    ASSERT_EQ(sut.run(3U), Status::kOk);
    EXPECT_EQ(sut.get_frame_count(), 4U);
    ASSERT_EQ(sut.run(), Status::kOk);
    EXPECT_EQ(sut.get_frame_count(), 4U);
    EXPECT_EQ(sut.get_overrun_count(), 0U);
}

TEST(VirtualMachineTest, FailureOfTheStopIsReturned) {
    verifies("SWR-VTM-006", Technique::kFaultInjection, Polarity::kViolation);
    static Machine<kFailsAtStop> sut;
    SpyDevices devices;
    g_counter_kFailsAtStop.stops = Status::kOutOfResources;

    EXPECT_EQ(sut.run(1U, devices), Status::kOutOfResources);
    EXPECT_EQ(devices.applied.size(), 1U);
}

TEST(VirtualMachineTest, ActionThatExceedsItsBudgetIsNamedAndAnActionWithinItIsNot) {
    verifies("SWR-VTM-015", Technique::kBoundaryValues, Polarity::kViolation);
    static Machine<kActions> sut;
    g_hanger.host = &sut.get_host_of<1U>();
    const auto run = [](ComponentAction before, Duration duration) {
        // The component is initialised once: the first action of any later run is on_startup.
        const bool is_first = before == ComponentAction::kInitialize;
        EXPECT_EQ(g_hanger.host->set_duration(g_hanger, is_first ? duration : 0_ns), Status::kOk);
        g_hanger.before = before;
        g_hanger.duration = duration;
        const Status status = sut.run(1U);
        EXPECT_EQ(sut.get_action_overrun().component, status == Status::kOk ? kNoIndex : 1U);
        EXPECT_EQ(g_hanger.host->set_duration(g_hanger, 0_ns), Status::kOk);
        return status;
    };
    EXPECT_EQ(run(ComponentAction::kInitialize, kNever), Status::kError);
    EXPECT_EQ(sut.get_action_overrun().action, ComponentAction::kInitialize);
    EXPECT_EQ(sut.get_executives().get_failed_core(), 1U);
    ASSERT_EQ(run(ComponentAction::kInitialize, 700_ns), Status::kOk);

    const std::array<std::array<ComponentAction, 2U>, 4U> pairs{
        {{ComponentAction::kInitialize, ComponentAction::kStartup},
         {ComponentAction::kStartup, ComponentAction::kActivated},
         {ComponentAction::kExecute, ComponentAction::kDeactivated},
         {ComponentAction::kDeactivated, ComponentAction::kShutdown}}};
    for (const auto& [before, late] : pairs) {
        for (const Duration duration : {701_ns, kNever}) {
            EXPECT_EQ(run(before, duration), Status::kError) << get_name(late);
            EXPECT_EQ(sut.get_action_overrun().action, late);
            // What the failed run has left behind is stopped first.
            EXPECT_EQ(sut.get_executives().stop(), Status::kOk);
        }
        EXPECT_EQ(run(before, 700_ns), Status::kOk) << get_name(late);
    }
}

TEST(VirtualMachineTest, ActionsTakeNoTimeOfTheTimeLine) {
    verifies("SWR-VTM-015", Technique::kRequirementsBased, Polarity::kNominal);
    Duration duration{500};
    IndexedVirtualHost host{{&duration, 1U}};
    int calls = 0;
    const auto count = [](void* argument, std::size_t, std::size_t) noexcept {
        ++*static_cast<int*>(argument);
    };
    WindowHost::Work work{count, &calls, 0U, 0U, 0U, 1U, WindowHost::Pass::kAction};

    EXPECT_EQ(host.run_within(work, host.get_now() + 500_ns), 1U);
    EXPECT_EQ(host.run_within(work, host.get_now() + 499_ns), 0U);
    EXPECT_EQ(calls, 2);
    EXPECT_EQ(host.get_now(), Instant{0});
    work.pass = WindowHost::Pass::kModeStep;
    EXPECT_EQ(host.run_within(work, host.get_now() + 500_ns), 1U);
    EXPECT_EQ(host.get_now(), Instant{500});
}

TEST(VirtualMachineTest, ModelledTimeOfACoreChangesAtRunTime) {
    verifies("SWR-VTM-006", Technique::kRequirementsBased, Polarity::kViolation);
    static Machine<kSlow> sut;

    ASSERT_EQ(sut.get_host_of<1U>().set_duration(g_doubler_kSlow, 500_ns), Status::kOk);
    ASSERT_EQ(sut.run(2U), Status::kOk);
    EXPECT_EQ(sut.get_overrun_count(), 2U);
    ASSERT_EQ(sut.get_host_of<1U>().set_duration(g_doubler_kSlow, 400_ns), Status::kOk);
    ASSERT_EQ(sut.run(1U), Status::kOk);
    EXPECT_EQ(sut.get_overrun_count(), 2U);
}

TEST(VirtualMachineTest, SystemWindowHasItsModelledTimeAndItsBudget) {
    verifies("SWR-KRN-097", Technique::kBoundaryValues, Polarity::kViolation);
    static Machine<kFunction> sut;

    ASSERT_EQ(sut.run(3U), Status::kOk);
    EXPECT_EQ(g_call_count, 6);
    EXPECT_EQ(sut.get_overrun_count(), 0U);
    ASSERT_EQ(sut.get_host_of<0U>().set_duration(g_function, 101_ns), Status::kOk);
    ASSERT_EQ(sut.run(1U), Status::kOk);
    EXPECT_EQ(sut.get_overrun_count(), 2U);
    EXPECT_EQ(g_counted.out.get_published(), 4);
}

}  // namespace
}  // namespace mamori::ports::virtual_time
