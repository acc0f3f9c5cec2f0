// SPDX-License-Identifier: Apache-2.0
// Goal: a machine runs background windows below all ordinary windows, on the processor of their core, and
//       names and counts each of their overruns apart.
// Method: real threads; components that note their scheduling or compute longer than their budget; limits are
//         long, and counts of windows are compared with what the components did.
#include <gtest/gtest.h>
#include <pthread.h>
#include <sched.h>

#include <array>
#include <atomic>
#include <memory>
#include <vector>

#include "mamori/kernel/system/system.hpp"
#include "mamori/ports/posix_rt/machine.hpp"
#include "mamori/trace/verifies.hpp"
#include "support/patient_options.hpp"

namespace mamori::ports::posix_rt {
namespace {

using namespace verification;
using literals::operator""_ms;
using literals::operator""_s;

/// Notes the scheduling of its thread; computes until it is told to stop in each second cycle.
class Worker final : public Component {
  public:
    constexpr explicit Worker(const char* name) noexcept : Component(name) {}
    OutPort<std::int64_t> out{*this, "out"};
    using Ports = mamori::Ports<&Worker::out>;

    Status on_execute(ContextHandle) noexcept override {
        int policy = 0;
        sched_param parameters{};
        static_cast<void>(pthread_getschedparam(pthread_self(), &policy, &parameters));
        priority = policy == SCHED_FIFO ? parameters.sched_priority : 0;
        processor = sched_getcpu();
        ++cycles;
        if (is_greedy && cycles % 2 == 0) {
            ++overruns;
            while (!is_to_stop) {
            }
        }
        out.write(cycles);
        return Status::kOk;
    }

    std::atomic<int> priority{-1};
    std::atomic<int> processor{-1};
    std::atomic<int> overruns{0};
    std::atomic<bool> is_greedy{false};
    std::atomic<bool> is_to_stop{false};
    std::int64_t cycles{0};
};

#define MAMORI_TEST_SYSTEM(name)                                                                        \
    Worker g_loop_##name{"loop"};                                                                       \
    Worker g_idle_##name{"idle"};                                                                       \
    Worker g_plan_##name{"plan"};                                                                       \
    constexpr auto name =                                                                               \
        system(frame(60_ms), window("loop", 0_ms, 2_ms, every(6_ms), budget(2_ms), run(g_loop_##name)), \
               window("plan", 4_ms, 50_ms, background(), budget(20_ms), run(g_idle_##name, g_plan_##name)))

MAMORI_TEST_SYSTEM(kPlaced);
MAMORI_TEST_SYSTEM(kGreedy);
MAMORI_TEST_SYSTEM(kRefused);

class Ear final : public ExecutionObserver {
  public:
    std::vector<std::size_t> components;
    void on_budget_overrun(std::size_t, std::size_t component, Instant) noexcept override {
        components.push_back(component);
    }
    void on_late_release(std::size_t, Duration, Instant) noexcept override {}
};

TEST(BackgroundMachineTest, ABackgroundWindowRunsBelowTheOrdinaryOnesOnTheProcessorOfItsCore) {
    verifies("SWR-PRT-081", Technique::kRequirementsBased);
    const std::array<int, 1U> processors{0};
    MachineOptions options = make_options();
    options.processors = processors;
    options.priority = MachineOptions::kBackgroundPriorityMin;
    static Machine<kPlaced> sut{options};

    ASSERT_EQ(sut.run(2U), Status::kOk) << describe(sut.get_report().failed_step);

    const MachineReport& report = sut.get_report();
    EXPECT_EQ(report.openings.opened, 20U);
    EXPECT_EQ(report.background.opened, 2U);
    if (report.priority.is_granted) {
        EXPECT_EQ(g_loop_kPlaced.priority, 11);
        EXPECT_EQ(g_plan_kPlaced.priority, 1);
    }
    if (report.processor.is_granted) {
        EXPECT_EQ(g_plan_kPlaced.processor, 0);
    }
}

TEST(BackgroundMachineTest, EachOverrunOfABackgroundWindowIsNamedAndCounted) {
    verifies("SWR-PRT-082", Technique::kFaultInjection, Polarity::kViolation);
    static Machine<kGreedy> sut{make_options()};
    static Ear ear;
    sut.get_executives().get(1U).set_observer(&ear);
    g_plan_kGreedy.is_greedy = true;
    struct Devices final : mamori::Devices {
        void sample(std::uint64_t, Instant) noexcept override { g_plan_kGreedy.is_to_stop = false; }
        /// Within the window of the planner, after its budget: the end of the ordinary windows of the frame.
        void apply(std::uint64_t, Instant, Duration) noexcept override { g_plan_kGreedy.is_to_stop = true; }
    } devices;

    ASSERT_EQ(sut.run(10U, devices), Status::kOk) << describe(sut.get_report().failed_step);

    const MachineReport& report = sut.get_report();
    EXPECT_EQ(report.background.opened, 10U);
    EXPECT_EQ(report.background.overran, ear.components.size());
    EXPECT_GE(report.background.overran, static_cast<std::uint64_t>(g_plan_kGreedy.overruns));
    EXPECT_GE(g_plan_kGreedy.overruns, 3);
    for (const std::size_t component : ear.components) {
        EXPECT_EQ(component, 2U);
    }
    EXPECT_GE(report.background.worst_lateness, Duration{0});
    sut.get_executives().get(1U).set_observer(nullptr);
}

TEST(BackgroundMachineTest, APriorityThatLeavesNoneForBackgroundWindowsIsRejected) {
    verifies("SWR-PRT-081", Technique::kBoundaryValues, Polarity::kViolation);
    MachineOptions options = make_options();
    options.priority = MachineOptions::kBackgroundPriorityMin - 1;
    const auto sut = std::make_unique<Machine<kRefused>>(options);

    EXPECT_EQ(sut->run(1U), Status::kBadParameter);
    EXPECT_EQ(sut->get_report().failed_step, MachineStep::kOptions);
}

TEST(BackgroundMachineTest, TheScheduleWatchAllowsForTheDelayByPreemption) {
    verifies("SWR-PRT-083", Technique::kBoundaryValues);
    GridBeat beat{make_view(kPlaced), 1U};

    beat.expect(Instant{0});
    EXPECT_EQ(beat.get_due(), Instant{} + 34_ms) << "start and 30 ms that its length exceeds its budget";
    beat.before_opening({1U, Instant{} + 4_ms}, Instant{} + 5_ms);
    EXPECT_EQ(beat.get_due(), Instant{} + 84_ms);
    beat.after_opening({1U, Instant{} + 4_ms}, WindowOutcome::kCompleted);
    EXPECT_EQ(beat.get_due(), Instant{} + 94_ms);

    GridBeat ordinary{make_view(kPlaced), 0U};
    ordinary.expect(Instant{1});
    EXPECT_EQ(ordinary.get_due(), Instant{} + 6_ms);
    GridBeat none{make_view(kPlaced), 2U};
    none.expect(Instant{0});
    EXPECT_EQ(none.get_due(), GridBeat::kNever);
}

}  // namespace
}  // namespace mamori::ports::posix_rt
