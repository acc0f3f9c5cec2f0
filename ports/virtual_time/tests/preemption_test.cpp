// SPDX-License-Identifier: Apache-2.0
// Goal: ordinary windows preempt the background windows of their core by their modelled times, each limit of
//       a background window is enforced, and its data do not depend on execution times.
// Method: modelled times on both sides of each limit, calculated by hand; random modelled times, compared
//         with the same system without any.
#include "mamori/ports/virtual_time/preemption.hpp"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "mamori/kernel/dataflow/queue_in_port.hpp"
#include "mamori/kernel/run/execution_observer.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/ports/virtual_time/machine.hpp"
#include "mamori/trace/verifies.hpp"

namespace mamori::ports::virtual_time {
namespace {

using namespace verification;

#ifdef __OPTIMIZE__
constexpr std::uint64_t kCases = 20'000;
#else
constexpr std::uint64_t kCases = 500;
#endif

/// Adds one to what it reads, and notes the instant of the cycle.
class Stage final : public Component {
  public:
    constexpr explicit Stage(const char* name) noexcept : Component(name) {}
    InPort<std::int64_t, Need::kOptional> in{*this, "in"};
    QueueInPort<std::int64_t, 16U, FullPolicy::kDoNothing, EmptyPolicy::kDoNothing, Need::kOptional> each{
        *this, "each"};
    OutPort<std::int64_t> out{*this, "out"};
    using Ports = mamori::Ports<&Stage::in, &Stage::each, &Stage::out>;
    std::int64_t sum{0};

    /// Depends on the order of the values; never overflows.
    static std::int64_t mix(std::int64_t sum, std::int64_t value) noexcept {
        return (31 * sum + value) & 0xFFFFFFF;
    }
    Status on_activated(ContextHandle) noexcept override {
        sum = 0;
        return Status::kOk;
    }
    Status on_execute(ContextHandle) noexcept override {
        std::int64_t value = in.read() + 1;
        sum = mix(sum, value);
        while (each.read(value) == Status::kOk) {
            sum = mix(sum, value);
        }
        out.write(sum);
        return Status::kOk;
    }
};

// The planner and the mapper may take 400 ns of processor time within 800 ns. A component belongs to one
// machine at a time.
#define MAMORI_TEST_SYSTEM(name)                                                                             \
    Stage g_first_##name{"first"};                                                                           \
    Stage g_second_##name{"second"};                                                                         \
    Stage g_planner_##name{"planner"};                                                                       \
    Stage g_mapper_##name{"mapper"};                                                                         \
    Crossing<std::int64_t> g_to_planner_##name;                                                              \
    Crossing<std::int64_t> g_to_first_##name;                                                                \
    constexpr auto name = system(                                                                            \
        frame(1000_ns), trace_hash(),                                                                        \
        window("first", 0_ns, 20_ns, every(100_ns), budget(20_ns), run(g_first_##name)),                     \
        window("second", 20_ns, 20_ns, every(200_ns), budget(20_ns), run(g_second_##name)),                  \
        window("plan", 50_ns, 800_ns, background(), budget(400_ns), run(g_planner_##name, g_mapper_##name)), \
        connect(g_second_##name.out, g_planner_##name.in, through(g_to_planner_##name), any_age()),          \
        connect(g_first_##name.out, g_mapper_##name.each, any_age()),                                        \
        connect(g_mapper_##name.out, g_first_##name.in, through(g_to_first_##name), any_age()))

MAMORI_TEST_SYSTEM(kSystem);
MAMORI_TEST_SYSTEM(kRandom);
MAMORI_TEST_SYSTEM(kPlanned);
MAMORI_CHECK(kSystem);
Stage& g_first = g_first_kSystem;
Stage& g_second = g_second_kSystem;
Stage& g_planner = g_planner_kSystem;
Stage& g_mapper = g_mapper_kSystem;
using Subject = Machine<kSystem>;

class SpyObserver final : public ExecutionObserver {
  public:
    std::vector<std::string> heard;
    void on_budget_overrun(std::size_t window, std::size_t component, Instant now) noexcept override {
        heard.push_back("overrun " + std::to_string(window) + "/" + std::to_string(component) + " @" +
                        std::to_string(now.ns));
    }
    void on_late_release(std::size_t window, Duration lateness, Instant) noexcept override {
        heard.push_back("late " + std::to_string(window) + " by " + std::to_string(lateness.ns));
    }
};

class PreemptionTest : public ::testing::Test {
  protected:
    ~PreemptionTest() override { EXPECT_EQ(finalize(), Status::kOk); }

    /// The components belong to the executives of one machine at a time.
    Status finalize() {
        Status result = Status::kOk;
        for (std::size_t core = 0U; core < 2U; ++core) {
            machine_.get_executives().get(core).set_observer(nullptr);
            const Status status = machine_.get_executives().get(core).finalize();
            result = status == Status::kOk ? result : status;
        }
        return result;
    }
    void set(const Stage& stage, Duration duration) {
        EXPECT_EQ(machine_.get_host_of<0U>().set_duration(stage, duration), Status::kOk);
        EXPECT_EQ(machine_.get_host_of<1U>().set_duration(stage, duration), Status::kOk);
    }
    /// Runs one frame. @return what the observer of the background windows heard.
    std::vector<std::string> run_frame() {
        Hang hang{*this};
        machine_.get_executives().get(1U).set_observer(&observer_);
        EXPECT_EQ(machine_.run(1U, hang), Status::kOk);
        return observer_.heard;
    }
    /// Lets components hang in the windows only, not at the start and the stop of the system.
    class Hang final : public Devices {
      public:
        explicit Hang(PreemptionTest& test) noexcept : test_(test) {}
        void sample(std::uint64_t, Instant) noexcept override { set_all(kNever); }
        void apply(std::uint64_t, Instant, Duration) noexcept override { set_all(0_ns); }

      private:
        void set_all(Duration duration) noexcept {
            for (const Stage* stage : test_.hanging_) {
                test_.set(*stage, duration);
            }
        }
        PreemptionTest& test_;
    };
    std::vector<const Stage*> hanging_;
    Subject machine_;
    SpyObserver observer_;
};
using Heard = std::vector<std::string>;

/// Reads the clock of the background windows at the end of a step.
Instant calc_end(Duration first, Duration own) {
    Subject machine;
    VirtualHost& host = machine.get_host_of<0U>();
    EXPECT_EQ(host.set_duration(g_first, first), Status::kOk);
    EXPECT_EQ(machine.get_executives().start(), Status::kOk);
    Preemption preemption{machine.get_executives().get(0U), host,
                          FrameSchedule{make_view(kSystem), 0U, Instant{50}}, 400_ns};
    const StepEnd end = preemption.run_step(Instant{50}, own, Instant{850});
    EXPECT_TRUE(end.is_in_time);
    EXPECT_EQ(machine.get_executives().stop(), Status::kOk);
    for (std::size_t core = 0U; core < 2U; ++core) {
        EXPECT_EQ(machine.get_executives().get(core).finalize(), Status::kOk);
    }
    return end.at;
}

TEST(PreemptionStepTest, EndsLaterByTheTimesOfTheWindowsThatStartMeanwhile) {
    verifies("SWR-VTM-010", Technique::kBoundaryValues);
    EXPECT_EQ(calc_end(0_ns, 0_ns), Instant{50});
    EXPECT_EQ(calc_end(15_ns, 50_ns), Instant{100}) << "done when the next window starts";
    EXPECT_EQ(calc_end(15_ns, 51_ns), Instant{116});
    EXPECT_EQ(calc_end(15_ns, 135_ns), Instant{200});
    EXPECT_EQ(calc_end(15_ns, 136_ns), Instant{216});
    EXPECT_EQ(calc_end(kNever, 51_ns), Instant{121}) << "hanging work is aborted after its budget";
    EXPECT_EQ(calc_end(0_ns, 400_ns), Instant{450});
}

TEST_F(PreemptionTest, TheBudgetIsProcessorTimeOfAllComponentsOfTheWindow) {
    verifies("SWR-VTM-011", Technique::kBoundaryValues);
    set(g_first, 20_ns);
    set(g_planner, 100_ns);
    set(g_mapper, 300_ns);

    EXPECT_EQ(run_frame(), Heard{});
    EXPECT_EQ(machine_.get_overrun_count(), 0U);
}

TEST_F(PreemptionTest, WorkBeyondTheBudgetIsAbortedWhenItIsExhausted) {
    verifies("SWR-VTM-011", Technique::kBoundaryValues, Polarity::kViolation);
    set(g_planner, 100_ns);
    set(g_mapper, 301_ns);

    EXPECT_EQ(run_frame(), Heard{"overrun 2/3 @450"});
    EXPECT_EQ(machine_.get_overrun_count(), 1U);
}

TEST_F(PreemptionTest, HangingWorkIsAbortedWhenItsBudgetIsExhausted) {
    verifies("SWR-VTM-011", Technique::kFaultInjection, Polarity::kViolation);
    set(g_first, 20_ns);
    hanging_ = {&g_planner};

    // 50 ns until 100, then 80 ns in each 100 ns.
    EXPECT_EQ(run_frame(), Heard{"overrun 2/2 @550"});
}

TEST_F(PreemptionTest, AHangingOrdinaryWindowCountsWithItsBudget) {
    verifies("SWR-VTM-010", Technique::kFaultInjection);
    hanging_ = {&g_first, &g_second};
    set(g_planner, 400_ns);

    // 50 ns until 100, 80 ns in the next 100 ns, 60 ns in each 100 ns with both windows: all within 850.
    EXPECT_EQ(run_frame(), Heard{});
    EXPECT_EQ(machine_.get_overrun_count(), 15U) << "only the ordinary windows";
}

TEST(PreemptionStartTest, AWindowThatIsReleasedDuringAnOrdinaryOneStartsLate) {
    verifies("SWR-VTM-010", Technique::kBoundaryValues);
    static Stage busy{"busy"};
    static Stage next{"next"};
    static Stage late{"late"};
    static constexpr auto kTable =
        system(frame(100_ns), window("busy", 0_ns, 20_ns, budget(20_ns), run(busy)),
               window("next", 20_ns, 20_ns, budget(20_ns), run(next)),
               window("late", 10_ns, 90_ns, background(), budget(50_ns), run(late)),
               modelled_time(busy, 20_ns), modelled_time(next, 5_ns), modelled_time(late, 50_ns));
    static Machine<kTable> machine;
    SpyObserver observer;
    machine.get_executives().get(1U).set_observer(&observer);

    ASSERT_EQ(machine.run(2U), Status::kOk);

    EXPECT_EQ(observer.heard, (Heard{"late 2 by 15", "late 2 by 15"})) << "until the second window ends";
    EXPECT_EQ(machine.get_overrun_count(), 0U);
    machine.get_executives().get(1U).set_observer(nullptr);
}

/// New random times for each frame, within the budgets.
class RandomTimes final : public Devices {
  public:
    explicit RandomTimes(Machine<kRandom>& machine) : machine_(machine) {}
    void sample(std::uint64_t, Instant) noexcept override {
        const Duration own = roll(400);
        const Duration part = roll(own.ns);
        set<0U>(g_first_kRandom, roll(20));
        set<0U>(g_second_kRandom, roll(20));
        set<1U>(g_planner_kRandom, part);
        set<1U>(g_mapper_kRandom, own - part);
    }
    void apply(std::uint64_t, Instant, Duration) noexcept override {}

  private:
    Duration roll(std::int64_t last) {
        return Duration{std::uniform_int_distribution<std::int64_t>{0, last}(engine_)};
    }
    template <std::size_t kCore>
    void set(const Stage& stage, Duration duration) {
        EXPECT_EQ(machine_.get_host_of<kCore>().set_duration(stage, duration), Status::kOk);
    }
    Machine<kRandom>& machine_;
    std::mt19937_64 engine_{20261127U};
};

TEST(PreemptionDataTest, DataOfRandomExecutionTimesAreThoseWithoutAny) {
    verifies("SWR-VTM-010", Technique::kBackToBack);
    static Machine<kRandom> random;
    static Machine<kPlanned> planned;
    RandomTimes times{random};

    ASSERT_EQ(random.run(kCases, times), Status::kOk);
    ASSERT_EQ(planned.run(kCases), Status::kOk);

    for (std::size_t core = 0U; core < 2U; ++core) {
        EXPECT_EQ(random.get_executives().get(core).get_trace_hash(),
                  planned.get_executives().get(core).get_trace_hash());
    }
    EXPECT_NE(g_mapper_kRandom.sum, 0);
    EXPECT_EQ(g_mapper_kRandom.sum, g_mapper_kPlanned.sum);
    EXPECT_EQ(random.get_overrun_count(), 0U);
}

// Modes.

enum class Command { kStop };
Stage g_fast{"fast"};
Stage g_slow{"slow"};
constexpr auto kModes =
    system(frame(1000_ns), window("fast", 0_ns, 20_ns, every(100_ns), budget(20_ns), run(g_fast)),
           window("slow", 50_ns, 800_ns, background(), budget(400_ns), run(g_slow)),
           system_mode("work", runs(g_fast, g_slow)), safe_mode("halt", runs(g_fast)),
           mode_transition("work", Command::kStop, "halt"));
MAMORI_CHECK(kModes);

TEST(PreemptionModeTest, AModeSwitchStopsABackgroundComponentInTheAgreedFrame) {
    verifies("SWR-VTM-010", Technique::kStateTransition);
    static Machine<kModes> machine;
    SystemModes& modes = machine.get_executives().get_modes();
    std::vector<std::int64_t> slow;
    std::vector<std::int64_t> fast;
    const auto after_frame = [&](std::uint64_t number) {
        slow.push_back(g_slow.out.get_published());
        fast.push_back(g_fast.out.get_published());
        if (number == 2U) {
            EXPECT_EQ(modes.request(Command::kStop), Status::kOk);
        }
    };

    ASSERT_EQ(machine.run(6U, after_frame), Status::kOk);

    ASSERT_EQ(slow.size(), 6U);
    EXPECT_NE(slow[1], slow[0]);
    EXPECT_NE(slow[2], slow[1]);
    EXPECT_NE(slow[3], slow[2]) << "both executives agree on the switch in this frame";
    for (std::size_t frame = 4U; frame < 6U; ++frame) {
        EXPECT_EQ(slow[frame], slow[3]) << frame;
        EXPECT_NE(fast[frame], fast[frame - 1U]) << frame;
    }
    EXPECT_EQ(modes.get_mode(), 1U);
}

}  // namespace
}  // namespace mamori::ports::virtual_time
